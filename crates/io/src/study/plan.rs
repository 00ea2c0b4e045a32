//! The runs of a study: the points of its design, each with every seed, in the order in which they are made.

use std::path::Path;

use plateau_study::design::{self, Aliases, Design, Setting};
use plateau_study::shuffle;

use super::contents::{DesignSource, Order, Study, StudyError};
use super::factor::Level;
use crate::scene::{self, Origin, Problem, Scene, SceneError};

/// The runs of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    study: Study,
    points: Points,
    /// Runs in the order in which they are made, counted from 0 in that of the design.
    order: Vec<u32>,
}

/// Where the factors are set to.
#[derive(Debug, Clone, PartialEq)]
enum Points {
    Design(Design),
    File,
}

/// One run of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Its number in the order of the design, from 1.
    pub number: usize,
    /// The point of the design, from 0.
    pub point: usize,
    /// Which seed, from 0.
    pub replicate: usize,
    /// Settings of the factors.
    pub levels: Vec<Level>,
    /// Arguments of `--set` that make its scene out of the base.
    pub sets: Vec<String>,
}

impl Plan {
    /// Makes the design of a study.
    pub fn new(study: Study) -> Result<Self, StudyError> {
        let refuse = |message: String| {
            StudyError(vec![Problem::new(&Origin::File(study.path.as_path().into()), "design", message)])
        };
        let points = match &study.source {
            DesignSource::File(_) => Points::File,
            DesignSource::Kind(kind, centre) => {
                let kinds: Vec<_> = study.factors.iter().map(super::factor::Factor::kind).collect();
                let design =
                    design::design_with_centre(kind, *centre, &kinds).map_err(|error| refuse(error.to_string()))?;
                let tests: Vec<_> = study.factors.iter().map(|factor| (factor, factor.has_value())).collect();
                for point in 0..design.points() {
                    let mut pairs = tests.iter().zip(design.point(point));
                    if let Some(((factor, _), setting)) = pairs.find(|((_, has_value), setting)| !has_value(**setting))
                    {
                        let message = format!("\"{}\" has no value at {}", factor.name, place(*setting));
                        return Err(refuse(message));
                    }
                }
                drop(tests);
                Points::Design(design)
            }
        };
        let mut plan = Self { study, points, order: Vec::new() };
        let runs = u32::try_from(plan.runs()).map_err(|_| {
            let message = format!("{} runs, expected at most {}", plan.runs(), u32::MAX);
            StudyError(vec![Problem::new(&Origin::File(plan.study.path.as_path().into()), "design", message)])
        })?;
        plan.order = order(plan.study.order, plan.study.seed, runs);
        Ok(plan)
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Number of points of the design.
    pub fn points(&self) -> usize {
        match (&self.points, &self.study.source) {
            (Points::Design(design), _) => design.points(),
            (Points::File, DesignSource::File(points)) => points.len(),
            (Points::File, DesignSource::Kind(..)) => 0,
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
        match &self.points {
            Points::Design(design) => design.aliases(),
            Points::File => None,
        }
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
        let levels: Vec<Level> = match (&self.points, &self.study.source) {
            (Points::Design(design), _) => {
                // That every factor has a value at every point was seen when the plan was made.
                factors.iter().zip(design.point(point)).filter_map(|(factor, setting)| factor.at(*setting)).collect()
            }
            (Points::File, DesignSource::File(points)) => points[point].clone(),
            (Points::File, DesignSource::Kind(..)) => Vec::new(),
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

/// A setting in words.
fn place(setting: Setting) -> String {
    match setting {
        Setting::Level(level) => format!("level {}", level + 1),
        Setting::Coded(coded) => format!("{coded} (where −1 and 1 are its ends)"),
    }
}

/// Runs in the order in which they are made.
fn order(order: Order, seed: u64, runs: u32) -> Vec<u32> {
    let mut numbers: Vec<u32> = (0..runs).collect();
    if order == Order::Random {
        shuffle(&mut numbers, seed);
    }
    numbers
}
