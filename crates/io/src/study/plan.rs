//! A study, read and checked, and its runs: the points of its design, each with every seed, in the order in which they are made.

use std::path::{Path, PathBuf};

use plateau_study::design::{self, Aliases, Design, Kind, Setting};
use plateau_study::shuffle;
use thiserror::Error;

use crate::scene::{self, Origin, Problem, Scene, SceneError};
use crate::study::factor::{Factor, Level};
use crate::study::response::Response;
use crate::study::value_table;
use crate::text;

/// The table, among the results of a study, of responses that come from elsewhere.
const IMPORTED: &str = "imported.csv";

/// A study, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Title; the file's stem if the study gives none.
    pub title: String,
    /// The study file.
    pub path: PathBuf,
    /// The study file and the tables that it names; scenes and what they read are not among them.
    pub files: Vec<PathBuf>,
    /// The scene that is varied; none of a study whose responses are all imported.
    pub base: Option<PathBuf>,
    /// Place in the study that names it.
    pub base_place: Origin,
    /// Folder of the results.
    pub directory: PathBuf,
    /// Tells whether that is another one than the study names.
    pub is_elsewhere: bool,
    /// Name of the design.
    pub design: String,
    /// Arguments of `--set` for every run.
    pub sets: Vec<String>,
    /// Seed of the order and of designs that are drawn by lot.
    pub seed: u64,
    /// Source of the points.
    pub source: DesignSource,
    /// Factors that are varied.
    pub factors: Vec<Factor>,
    /// Seeds with which every point is run, if there are several.
    pub replicates: Option<Replicates>,
    /// Order in which runs are made.
    pub order: Order,
    /// Responses that are asked of the runs.
    pub responses: Vec<Response>,
    /// The series that are kept; all unless given.
    pub series: Option<Vec<String>>,
}

/// Source of the points of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum DesignSource {
    /// A design that the program makes, with so many centre points besides those of its kind.
    Kind(Kind, usize),
    /// A table of one's own.
    File(value_table::Points),
}

/// Seeds with which every point is run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replicates {
    /// Keys that are set to the seed.
    pub keys: Vec<String>,
    /// The seeds.
    pub seeds: Vec<i64>,
}

/// Order in which runs are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Order by lot, so that what drifts meanwhile is not taken for an effect.
    Random,
    /// Order of the design.
    Standard,
}

/// Reason why a study cannot be used: everything that is wrong with it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", text::problems(.0))]
pub struct StudyError(pub Vec<Problem>);

impl Study {
    /// Tells whether all responses come from elsewhere, so that runs need not be made.
    pub fn is_imported(&self) -> bool {
        !self.responses.is_empty() && self.responses.iter().all(Response::is_imported)
    }

    /// All that is read of a study but its scenes and what those read: the study file, the tables that it names, its base scene, and
    /// what is kept of its results.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let kept = ["journal", "under-way"].map(|name| self.directory.join(name));
        let files =
            |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let mut inputs = self.files.clone();
        inputs.extend(self.base.clone());
        inputs.push(self.directory.join(IMPORTED));
        inputs.extend(kept.into_iter().flat_map(files));
        inputs
    }
}

/// The runs of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    study: Study,
    /// Design; none where the points are those of a table.
    design: Option<Design>,
    /// Runs in the order in which they are made, counted from 0 in that of the design.
    order: Vec<u32>,
}

/// One run of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of the run in the order of the design, from 1.
    pub number: usize,
    /// The point of the design, from 0.
    pub point: usize,
    /// Place of its seed among those of the study, from 0.
    pub replicate: usize,
    /// Settings of the factors.
    pub levels: Vec<Level>,
    /// Arguments of `--set` that make its scene out of the base.
    pub sets: Vec<String>,
}

impl Plan {
    /// Makes the design of a study.
    pub fn new(study: Study) -> Result<Self, StudyError> {
        let refused = |study: &Study, message: String| {
            StudyError(vec![Problem::new(&Origin::File(study.path.as_path().into()), "design", message)])
        };
        let design = match &study.source {
            DesignSource::File(_) => None,
            DesignSource::Kind(kind, centre) => {
                let kinds: Vec<_> = study.factors.iter().map(Factor::kind).collect();
                let design = design::design_with_centre(kind, *centre, &kinds);
                let design = design.map_err(|error| refused(&study, error.to_string()))?;
                let tests: Vec<_> = study.factors.iter().map(|factor| (factor, factor.has_value())).collect();
                for point in 0..design.points() {
                    let mut pairs = tests.iter().zip(design.point(point));
                    if let Some(((factor, _), setting)) = pairs.find(|((_, has_value), setting)| !has_value(**setting))
                    {
                        let message = format!("\"{}\" has no value at {}", factor.name, place(*setting));
                        return Err(refused(&study, message));
                    }
                }
                Some(design)
            }
        };
        let mut plan = Self { study, design, order: Vec::new() };
        let runs = u32::try_from(plan.runs())
            .map_err(|_| refused(&plan.study, format!("{} runs, expected at most {}", plan.runs(), u32::MAX)))?;
        plan.order = (0..runs).collect();
        if plan.study.order == Order::Random {
            shuffle(&mut plan.order, plan.study.seed);
        }
        Ok(plan)
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Number of points of the design.
    pub fn points(&self) -> usize {
        match &self.study.source {
            DesignSource::File(points) => points.len(),
            DesignSource::Kind(..) => self.design.as_ref().map_or(0, Design::points),
        }
    }

    /// Number of seeds with which every point is run.
    pub fn replicates(&self) -> usize {
        self.study.replicates.as_ref().map_or(1, |replicates| replicates.seeds.len())
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.points().saturating_mul(self.replicates())
    }

    /// Aliases, for designs that are a fraction.
    pub fn aliases(&self) -> Option<&Aliases> {
        self.design.as_ref()?.aliases()
    }

    /// Numbers of the runs (from 1), in the order in which they are made.
    pub fn order(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.order.iter().map(|run| *run as usize + 1)
    }

    /// A run by its number, from 1.
    pub fn run(&self, number: usize) -> Run {
        let replicates = self.replicates();
        let (point, replicate) = ((number - 1) / replicates, (number - 1) % replicates);
        let factors = &self.study.factors;
        let levels: Vec<Level> = match &self.study.source {
            DesignSource::File(points) => points[point].clone(),
            DesignSource::Kind(..) => {
                let settings = self.design.iter().flat_map(|design| design.point(point));
                // That every factor has a value at every point was seen when the plan was made.
                factors.iter().zip(settings).filter_map(|(factor, setting)| factor.at(*setting)).collect()
            }
        };
        let mut sets = self.study.sets.clone();
        for (factor, level) in factors.iter().zip(&levels) {
            sets.extend(factor.keys.iter().map(|key| format!("{key}={}", level.text)));
        }
        if let Some(seeds) = &self.study.replicates {
            sets.extend(seeds.keys.iter().map(|key| format!("{key}={}", seeds.seeds[replicate])));
        }
        Run { number, point, replicate, levels, sets }
    }

    /// The scene of a run.
    pub fn scene(&self, run: &Run) -> Result<Scene, SceneError> {
        // Without a base there is no scene; the message of the empty path says so.
        let base = self.study.base.as_deref().unwrap_or(Path::new(""));
        scene::load(base, &run.sets)
    }
}

fn place(setting: Setting) -> String {
    match setting {
        Setting::Level(level) => format!("level {}", level + 1),
        Setting::Coded(coded) => format!("{coded} (where −1 and 1 are its ends)"),
    }
}
