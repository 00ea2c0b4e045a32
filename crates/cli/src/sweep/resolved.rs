//! The scenes of all runs of a study: whether they can be built, and what their results are told by.

use std::collections::BTreeSet;
use std::path::PathBuf;

use plateau_io::brief;
use plateau_io::study::Study;
use plateau_io::study::identity::{Digests, firsts, identity};
use plateau_io::study::plan::Plan;
use rayon::prelude::*;

use super::run_length::{RunLength, seconds};
use super::scene_warnings::{Found, SceneWarnings, of_scene};
use crate::failure::Failure;
use crate::{message, version};

/// Problems that are shown.
const SHOWN: usize = 10;

/// Identity of a run, with its steps, how long it is, and its warnings.
type Known = (String, (u64, RunLength, Vec<Found>));

/// What is known of every run before it is made, in the order of the design.
#[derive(Debug, Clone)]
pub struct Resolved {
    /// By what its results are known.
    pub identities: Vec<String>,
    /// The place of the first run with the same identity: that of the run itself unless it repeats another one.
    pub firsts: Vec<usize>,
    /// Its steps.
    pub steps: Vec<u64>,
    /// How long each is.
    pub lengths: Vec<RunLength>,
    /// What the scenes can hardly mean.
    pub warnings: SceneWarnings,
    /// The files of the scenes, and those that they read.
    pub files: BTreeSet<PathBuf>,
}

impl Resolved {
    /// Whether a run, by its place in the design, repeats another one, so that it has its result.
    pub fn is_repeat(&self, place: usize) -> bool {
        self.firsts.get(place).is_some_and(|first| *first != place)
    }

    /// How many runs repeat another one.
    pub fn repeats(&self) -> usize {
        (0..self.firsts.len()).filter(|place| self.is_repeat(*place)).count()
    }

    /// Warns of responses that ask for a time after the end of some run, which then gives none.
    pub fn warn_of_late_questions(&self, study: &Study) {
        for response in &study.responses {
            let shortest = self.lengths.iter().map(|length| length.duration).fold(f64::INFINITY, f64::min);
            if let Some(time) = response.latest_time().filter(|time| *time > shortest * (1.0 + 1e-9)) {
                message::warning(format_args!(
                    "{}: response \"{}\" asks for {}, and the shortest run ends at {}: runs that end before have no value of it",
                    study.path.display(),
                    response.name,
                    seconds(time),
                    seconds(shortest)
                ));
            }
        }
    }

    /// Builds the scene of every run.
    ///
    /// # Errors
    /// [`Failure::Input`] with the runs whose scenes cannot be built, before any is made.
    pub fn of(plan: &Plan) -> Result<Self, Failure> {
        super::refuse_without_scene(plan)?;
        let (digests, program) = (Digests::default(), version::this().build());
        let resolve = |number: usize| {
            let run = plan.run(number);
            let scene = plan.scene(&run).map_err(|error| error.to_string())?;
            let identity = identity(&scene, &digests, &program)
                .map_err(|(path, error)| format!("cannot read {}: {error}", path.display()))?;
            let length = RunLength::of(&scene);
            Ok(((identity, (scene.steps, length, of_scene(&scene))), scene.files))
        };
        let all: Vec<Result<_, String>> = (1..=plan.runs()).into_par_iter().map(resolve).collect();
        let problems: Vec<(usize, &String)> =
            (1..).zip(&all).filter_map(|(number, result)| Some((number, result.as_ref().err()?))).collect();
        if problems.is_empty() {
            let (known, files): (Vec<Known>, Vec<Vec<PathBuf>>) = all.into_iter().flatten().unzip();
            let files = files.into_iter().flatten().chain(digests.files()).collect();
            let (mut identities, mut steps, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
            let mut warnings = SceneWarnings::default();
            for (identity, (count, length, found)) in known {
                identities.push(identity);
                steps.push(count);
                lengths.push(length);
                warnings.add(found);
            }
            return Ok(Self { firsts: firsts(&identities), identities, steps, lengths, warnings, files });
        }
        // The same mistake shows in many runs.
        let mut said: Vec<&String> = Vec::new();
        let heading =
            format!("{}: {} of {} runs cannot be made", plan.study().path.display(), problems.len(), plan.runs());
        let mut lines = Vec::new();
        for (number, problem) in &problems {
            if !said.contains(problem) && said.len() < SHOWN {
                said.push(problem);
                lines.push(format!("{}:\n{problem}", run_in_words(plan, *number)));
            }
        }
        Err(Failure::input(format_args!("{heading}\n{}", brief::list(lines, "\n"))))
    }
}

/// A run with its settings: `run 2 (debris = contact)`.
pub fn run_in_words(plan: &Plan, number: usize) -> String {
    let levels = plan.run(number).levels;
    let settings = plan.study().factors.iter().zip(&levels);
    let settings = settings.map(|(factor, level)| format!("{} = {}", factor.name, level.label));
    format!("run {number} ({})", brief::list(settings, ", "))
}
