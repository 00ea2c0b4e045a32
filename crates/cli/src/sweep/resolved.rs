//! The scenes of all runs of a study: whether they can be built, and what their results are told by.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use plateau_io::brief;
use plateau_io::study::Study;
use plateau_io::study::identity::{Digests, firsts, identity};
use plateau_io::study::plan::Plan;
use plateau_io::study::record::EVENT;
use plateau_io::study::response::Response;
use plateau_io::study::unrecorded::lacking;
use rayon::prelude::*;

use super::run_length::{RunLength, seconds};
use super::scene_warnings::{Found, SceneWarnings, of_scene};
use crate::failure::Failure;
use crate::{message, version};

/// Problems that are shown.
const SHOWN: usize = 10;

/// What a scene tells of its run.
struct KnownScene {
    steps: u64,
    length: RunLength,
    warnings: Vec<Found>,
    /// For each response what it lacks to record its series, if anything.
    lacking: Vec<Option<String>>,
}

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
    /// Of every response that some runs do not record: its place, how many, and what their scenes lack.
    unrecorded: BTreeMap<usize, (usize, String)>,
}

impl Resolved {
    /// Runs up to which every scene is built where no run is made, to see what there is to know of them.
    pub const MOST_AT_ONCE: usize = 20_000;

    /// Whether a run, by its place in the design, repeats another one, so that it has its result.
    pub fn is_repeat(&self, place: usize) -> bool {
        self.firsts.get(place).is_some_and(|first| *first != place)
    }

    /// How many runs repeat another one.
    pub fn repeats(&self) -> usize {
        (0..self.firsts.len()).filter(|place| self.is_repeat(*place)).count()
    }

    /// Warns of responses that ask for a time after the end of some run, or of all, which then give none. Another question to the same runs costs
    /// none of them, so nothing is refused.
    pub fn warn_of_late_questions(&self, study: &Study) {
        let ends = || self.lengths.iter().map(|length| length.duration);
        let (shortest, longest) = (ends().fold(f64::INFINITY, f64::min), ends().fold(0.0, f64::max));
        let is_after = |time: f64, end: f64| time > end * (1.0 + 1e-9);
        for response in &study.responses {
            let Some(time) = response.latest_time().filter(|time| is_after(*time, shortest)) else { continue };
            let why = if is_after(time, longest) {
                format!("every run ends at {} or before: none has a value of it", seconds(longest))
            } else {
                format!("the shortest run ends at {}: runs that end before have no value of it", seconds(shortest))
            };
            let (file, name) = (study.path.display(), &response.name);
            message::warning(format_args!("{file}: response \"{name}\" asks for {}, and {why}", seconds(time)));
        }
    }

    /// Refuses responses to series that no run records, before any is made, and warns of those that some do not.
    ///
    /// # Errors
    /// [`Failure::Input`] with what the scenes lack.
    pub fn refuse_unrecorded(&self, study: &Study) -> Result<(), Failure> {
        let file = study.path.display();
        let mut refused = Vec::new();
        for (place, (runs, lacking)) in &self.unrecorded {
            let Response { name, series, .. } = &study.responses[*place];
            let dataset = if series.starts_with(EVENT) { format!("/{series}") } else { format!("/series/{series}") };
            let told = format!("{file}: response \"{name}\": {dataset} is recorded only with {lacking}");
            if *runs == self.identities.len() {
                refused.push(format!("{told}; add it to the base scene, or to `set` in the study"));
            } else {
                let all = self.identities.len();
                message::warning(format_args!("{told}, which {runs} of {all} runs do not have: they give no value"));
            }
        }
        if refused.is_empty() { Ok(()) } else { Err(Failure::input(brief::list(refused, "\n"))) }
    }

    /// Builds the scene of every run.
    ///
    /// # Errors
    /// [`Failure::Input`] with the runs whose scenes cannot be built, before any is made.
    pub fn of(plan: &Plan) -> Result<Self, Failure> {
        super::refuse_without_scene(plan)?;
        let (digests, program) = (Digests::default(), version::this().build());
        // What is imported asks no series.
        let asked: Vec<&str> = plan.study().responses.iter().map(|response| response.series.as_str()).collect();
        let resolve = |number: usize| {
            let run = plan.run(number);
            let scene = plan.scene(&run).map_err(|error| error.to_string())?;
            let identity = identity(&scene, &digests, &program)
                .map_err(|(path, error)| format!("cannot read {}: {error}", path.display()))?;
            let known = KnownScene {
                steps: scene.steps,
                length: RunLength::of(&scene),
                warnings: of_scene(&scene),
                lacking: asked.iter().map(|series| lacking(&scene, series)).collect(),
            };
            Ok(((identity, known), scene.files))
        };
        let all: Vec<Result<_, String>> = (1..=plan.runs()).into_par_iter().map(resolve).collect();
        let problems: Vec<(usize, &String)> =
            (1..).zip(&all).filter_map(|(number, result)| Some((number, result.as_ref().err()?))).collect();
        if problems.is_empty() {
            let (known, files): (Vec<(String, KnownScene)>, Vec<Vec<PathBuf>>) = all.into_iter().flatten().unzip();
            let files = files.into_iter().flatten().chain(digests.files()).collect();
            let (mut identities, mut steps, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
            let (mut warnings, mut unrecorded) = (SceneWarnings::default(), BTreeMap::new());
            for (identity, scene) in known {
                identities.push(identity);
                steps.push(scene.steps);
                lengths.push(scene.length);
                warnings.add(scene.warnings);
                for (place, lacking) in scene.lacking.into_iter().enumerate() {
                    if let Some(lacking) = lacking {
                        unrecorded.entry(place).or_insert((0, lacking)).0 += 1;
                    }
                }
            }
            return Ok(Self { firsts: firsts(&identities), identities, steps, lengths, warnings, files, unrecorded });
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
