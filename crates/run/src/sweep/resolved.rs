//! Scenes of the runs of a study, built before any run is made, and the identities by which their results are known; the length of
//! the runs, and their cost.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::PathBuf;
use std::time::Duration;

use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use plateau_core::simulation::Simulation;
use plateau_io::run_file::size_estimate;
use plateau_io::scene::{Scene, memory_estimate};
use plateau_io::study::Study;
use plateau_io::study::plan::Plan;
use plateau_io::study::record::{Digests, Identity, dataset_of};
use plateau_io::study::response::{Question, Response, lacking};
use plateau_io::{input, number, surface, text};
use rayon::iter::Either;
use rayon::prelude::*;

use crate::error::Failure;
use crate::execution::time_per_step;
use crate::sweep::warnings::{Found, SceneWarnings, SweepObserver, of_scene, of_surfaces};

/// Problems that are shown.
const SHOWN: usize = 10;

/// Folder of run files, in that of the results.
pub const RUN_FILES: &str = "runs";

/// Path of the run file of a run.
pub fn file_of(study: &Study, of: &Identity, number: usize, scene: &Scene) -> PathBuf {
    study.directory.join(RUN_FILES).join(of.run_file(number, scene))
}

/// Bytes of the run file of a scene, at most.
pub fn file_size(scene: &Scene) -> u64 {
    let (schedule, maps) = (scene.schedule(), &scene.output.maps);
    let moments = if maps.is_empty() { 0 } else { schedule.maps() };
    let extras = scene.extras(scene.adaptive.is_some());
    size_estimate(&scene.parameters.mesh, maps, &extras, schedule.samples(), moments as u64)
}

/// A run before it is made.
#[derive(Debug, Clone)]
pub struct ResolvedRun {
    /// Name by which its result is known: that of [`of`](Self::of).
    pub identity: String,
    /// Identity of the run.
    pub of: Identity,
    /// Run file of the run, where the study keeps those.
    pub file: PathBuf,
    /// Number of steps.
    pub steps: u64,
    /// Length of the run.
    pub length: RunLength,
    /// Series and quantities of events that the responses of the study need and its scene records.
    pub needed: BTreeSet<String>,
}

/// Runs before they are made.
#[derive(Debug)]
pub struct Resolved {
    /// Runs by their numbers.
    pub runs: BTreeMap<usize, ResolvedRun>,
    /// Values of the scenes that can hardly be meant.
    pub warnings: SceneWarnings,
    /// The files of the scenes, and those that they read.
    pub files: BTreeSet<PathBuf>,
    /// Runs that repeat one of these before them.
    repeats: BTreeSet<usize>,
    /// Responses that some runs do not record, by place: how many runs, and what their scenes lack.
    unrecorded: BTreeMap<usize, (usize, String)>,
}

/// A run as its scene tells it.
struct Known {
    run: ResolvedRun,
    warnings: Vec<Found>,
    /// Part that the scene lacks to record the series of each response, if it lacks any.
    lacking: Vec<Option<String>>,
    files: Vec<(PathBuf, String)>,
}

impl Resolved {
    /// Runs up to which every scene is built where no run is made, to see what there is to know of them.
    pub const MOST_AT_ONCE: usize = 20_000;

    /// Tells whether a run repeats another one of these, so that it has its result.
    pub fn is_repeat(&self, number: usize) -> bool {
        self.repeats.contains(&number)
    }

    /// Number of runs that repeat another one.
    pub fn repeats(&self) -> usize {
        self.repeats.len()
    }

    /// Names by which results are known, in the order of the design.
    pub fn identities(&self) -> Vec<String> {
        self.runs.values().map(|run| run.identity.clone()).collect()
    }

    /// Lengths of the runs.
    pub fn lengths(&self) -> Vec<RunLength> {
        self.runs.values().map(|run| run.length).collect()
    }

    /// Warns of responses that ask for a time after the end of some run, or of all, which then give none. Another question to the same runs
    /// costs none of them, so nothing is refused.
    pub fn warn_of_late_questions(&self, study: &Study, observer: &dyn SweepObserver) {
        let ends = || self.runs.values().map(|run| run.length.duration);
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
            observer.warning(&format_args!("{file}: response \"{name}\" asks for {}, and {why}", seconds(time)));
        }
    }

    /// Refuses responses to series that no run records, before any is made, and warns of those that some do not.
    pub fn refuse_unrecorded(&self, study: &Study, observer: &dyn SweepObserver) -> Result<(), Failure> {
        let file = study.path.display();
        let mut refused = Vec::new();
        for (place, (runs, lacking)) in &self.unrecorded {
            let Response { name, series, .. } = &study.responses[*place];
            let dataset = dataset_of(series);
            let told = format!("{file}: response \"{name}\": {dataset} is recorded only with {lacking}");
            if *runs == self.runs.len() {
                refused.push(format!("{told}; add it to the base scene, or to `set` in the study"));
            } else {
                let all = self.runs.len();
                observer.warning(&format_args!("{told}, which {runs} of {all} runs do not have: they give no value"));
            }
        }
        if refused.is_empty() { Ok(()) } else { Err(Failure::input(text::list(refused, "\n"))) }
    }

    /// Builds the scene of every run.
    pub fn of(plan: &Plan) -> Result<Self, Failure> {
        Self::of_runs(plan, (1..=plan.runs()).collect())
    }

    /// Builds the scenes of some runs, by their numbers.
    pub fn of_runs(plan: &Plan, numbers: Vec<usize>) -> Result<Self, Failure> {
        refuse_without_scene(plan)?;
        let digests = Digests::default();
        let study = plan.study();
        // What is imported asks no series.
        let asked: Vec<&str> = study.responses.iter().map(|response| response.series.as_str()).collect();
        let resolve = |number: usize| {
            let scene = plan.scene(&plan.run(number)).map_err(Failure::input)?;
            let of = Identity::expected(&scene, &digests).map_err(|(path, error)| {
                Failure::because(&error, format_args!("cannot read {}: {error}", path.display()))
            })?;
            let run = ResolvedRun {
                identity: of.name(),
                file: file_of(study, &of, number, &scene),
                of,
                steps: scene.steps,
                length: RunLength::of(&scene),
                needed: needed(study, &scene),
            };
            Ok(Known {
                run,
                warnings: of_scene(&scene),
                lacking: asked.iter().map(|series| lacking(&scene, series)).collect(),
                files: scene.files,
            })
        };
        let of_all = numbers.len();
        let (known, problems): (Vec<_>, Vec<_>) =
            numbers.into_par_iter().partition_map(|number| match resolve(number) {
                Ok(known) => Either::Left((number, known)),
                Err(problem) => Either::Right((number, problem)),
            });
        if !problems.is_empty() {
            return Err(cannot_be_made(plan, of_all, &problems));
        }
        let (mut runs, mut files) = (BTreeMap::new(), BTreeSet::from_iter(digests.files()));
        let (mut warnings, mut unrecorded) = (SceneWarnings::default(), BTreeMap::new());
        for (number, known) in known {
            runs.insert(number, known.run);
            warnings.add(known.warnings);
            files.extend(known.files.into_iter().map(|(file, _)| file));
            for (place, lacking) in known.lacking.into_iter().enumerate() {
                if let Some(lacking) = lacking {
                    unrecorded.entry(place).or_insert((0, lacking)).0 += 1;
                }
            }
        }
        let mut seen = HashSet::new();
        let repeats = runs.iter().filter(|(_, run)| !seen.insert(&run.identity)).map(|(number, _)| *number).collect();
        Ok(Self { runs, warnings, files, repeats, unrecorded })
    }
}

/// Failure of a study of so many runs, some of which have problems.
fn cannot_be_made(plan: &Plan, runs: usize, problems: &[(usize, Failure)]) -> Failure {
    // The same mistake shows in many runs.
    let mut said = Vec::new();
    let mut lines = Vec::new();
    for (number, problem) in problems {
        let problem = problem.to_string();
        if !said.contains(&problem) && said.len() < SHOWN {
            lines.push(format!("{}:\n{problem}", run_in_words(plan, *number)));
            said.push(problem);
        }
    }
    let heading = format!("{}: {} of {runs} runs cannot be made", plan.study().path.display(), problems.len());
    let message = format!("{heading}\n{}", text::list(lines, "\n"));
    // What the system lacks at the moment is no mistake of the study.
    let is_lack = problems.iter().any(|(_, problem)| problem.status == Failure::RUN);
    if is_lack { Failure::run(message) } else { Failure::input(message) }
}

/// Series that the responses of a study need of a run of this scene; what the scene does not record is lacking in every run of it, which is
/// said elsewhere.
pub fn needed(study: &Study, scene: &Scene) -> BTreeSet<String> {
    let needs = study.responses.iter().flat_map(|response| response.needs());
    needs.filter(|series| lacking(scene, series).is_none()).map(str::to_owned).collect()
}

/// A run with its settings: `run 2 (debris = contact)`.
pub fn run_in_words(plan: &Plan, number: usize) -> String {
    let levels = plan.run(number).levels;
    let settings = plan.study().factors.iter().zip(&levels);
    let settings = settings.map(|(factor, level)| format!("{} = {}", factor.name, level.label));
    format!("run {number} ({})", text::list(settings, ", "))
}

/// Refuses a study that has no scene to run.
pub(super) fn refuse_without_scene(plan: &Plan) -> Result<(), Failure> {
    let path = plan.study().path.display();
    match &plan.study().base {
        Some(base) => input::open(base).map(drop).map_err(|error| {
            let problem = format!("{}: cannot read the scene: {error}", base.display());
            Failure::because(&error, format_args!("{}: base: {problem}", plan.study().base_place))
        }),
        None => Err(Failure::input(format!(
            "{path}: no base scene, so there is nothing to run; `plateau sweep import` takes in its responses"
        ))),
    }
}

/// Length of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunLength {
    /// Duration of the run, s.
    pub duration: f64,
    /// Simulated revolutions of the run; none where it chooses its time acceleration as it goes.
    pub revolutions: Option<f64>,
}

impl RunLength {
    /// Computes the length of the run of a scene: a step takes the pin on by a column of the disc.
    pub fn of(scene: &Scene) -> Self {
        let revolutions = scene.steps as f64 / scene.parameters.mesh.disc_columns() as f64;
        Self { duration: scene.duration, revolutions: scene.adaptive.is_none().then_some(revolutions) }
    }

    /// Part of the run, at its end, over which a mean over its last tenth is taken, 1.
    pub fn part(&self) -> f64 {
        self.revolutions.map_or(0.1, |turns| (LEAST_REVOLUTIONS / turns).clamp(0.1, 1.0))
    }
}

/// A time in words.
pub(super) fn seconds(time: f64) -> String {
    format!("{} s", number::rounded(time, 6))
}

/// Notes the part of the run over which responses that ask for the last tenth are a mean, where that is more.
pub fn note_short_tenths(study: &Study, lengths: &[RunLength], observer: &dyn SweepObserver) {
    let asks = study.responses.iter().filter(|response| response.question == Question::MeanOfLastTenth);
    let names: Vec<String> = asks.map(|response| format!("\"{}\"", response.name)).collect();
    if let (false, Some(what)) = (names.is_empty(), longer(lengths)) {
        let responses = if names.len() == 1 { "response" } else { "responses" };
        observer.note(&format_args!("note: {}: {responses} {}: {what}", study.path.display(), text::list(names, ", ")));
    }
}

/// Describes the mean over more than a tenth, in the run with the fewest simulated revolutions; none where there is none.
fn longer(lengths: &[RunLength]) -> Option<String> {
    let longer = lengths.iter().filter(|length| length.part() > 0.1 * (1.0 + 1e-9));
    let (count, most) = (longer.clone().count(), longer.max_by(|one, other| one.part().total_cmp(&other.part()))?);
    let turns = most.revolutions.unwrap_or_default();
    let (part, whole) = (seconds(most.part() * most.duration), seconds(most.duration));
    let over = if most.part() < 1.0 { format!("the last {part} of {whole}") } else { format!("all of the {whole}") };
    Some(format!(
        "a tenth of a run has fewer than {LEAST_REVOLUTIONS} simulated revolutions in {count} of {}, so the mean is over more: with \
         {} revolutions in all it is over {over}; for a mean over a tenth take longer runs, or a smaller time_acceleration",
        number::count(lengths.len(), "run"),
        number::rounded(turns, 2)
    ))
}

/// Runs whose steps are counted.
const COUNTED: usize = 64;
/// Runs whose first steps are timed.
const TIMED: usize = 3;
/// Time for which they are tried.
const TRIAL: Duration = Duration::from_millis(150);

/// Cost of one run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Estimate {
    /// Memory of the largest run, bytes.
    pub memory: u64,
    /// Size of the run file of a run, mean of what it can be at most, bytes.
    pub file_size: u64,
    /// Wall time of a run, mean, s.
    pub mean_time: f64,
    /// Wall time of the longest, s.
    pub longest_time: f64,
    /// Warnings of the surfaces of the runs that were tried.
    pub warnings: SceneWarnings,
}

impl Estimate {
    /// Looks at some of the runs.
    pub fn of(plan: &Plan) -> Result<Self, Failure> {
        refuse_without_scene(plan)?;
        let (mut per_cell, mut warnings) = (0.0_f64, SceneWarnings::default());
        for number in spread(plan.runs(), TIMED) {
            let scene = scene(plan, number)?;
            let start = std::time::Instant::now();
            let loaded = surface::load(&scene).map_err(Failure::input)?;
            let making = start.elapsed().as_secs_f64();
            warnings.add(of_surfaces(&scene, &loaded));
            let surfaces = loaded.surfaces;
            let mut simulation = Simulation::new(scene.parameters.clone(), surfaces).map_err(Failure::input)?;
            let step = time_per_step(&mut simulation, scene.steps, TRIAL).map_err(Failure::run)?;
            // Surfaces are a part of the run that does not grow with its steps.
            let steps = scene.steps.max(1) as f64;
            per_cell = per_cell.max((step + making / steps) / scene.parameters.mesh.pin_cells() as f64);
        }
        let (mut memory, mut file_sizes, mut times) = (0, 0, Vec::new());
        for number in spread(plan.runs(), COUNTED) {
            let scene = scene(plan, number)?;
            memory = memory.max(memory_estimate(&scene));
            file_sizes += file_size(&scene);
            times.push(scene.steps as f64 * scene.parameters.mesh.pin_cells() as f64 * per_cell);
        }
        let mean_time = times.iter().sum::<f64>() / times.len().max(1) as f64;
        let file_size = file_sizes / times.len().max(1) as u64;
        Ok(Self { memory, file_size, mean_time, longest_time: times.iter().copied().fold(0.0, f64::max), warnings })
    }
}

/// The scene of a run that somebody asks for by its number.
///
/// # Errors
/// A wrong input when the study has no such run, or no scene, or that cannot be built.
pub fn scene_of_run(plan: &Plan, number: usize) -> Result<Scene, Failure> {
    refuse_without_scene(plan)?;
    if !(1..=plan.runs()).contains(&number) {
        let (study, runs) = (plan.study().path.display(), plan.runs());
        return Err(Failure::input(format!("{study}: there is no run {number}; its runs are 1 to {runs}")));
    }
    scene(plan, number)
}

/// The scene of a run.
fn scene(plan: &Plan, number: usize) -> Result<Scene, Failure> {
    let failed = |error| Failure::input(format!("{}:\n{error}", run_in_words(plan, number)));
    plan.scene(&plan.run(number)).map_err(failed)
}

/// Some of so many numbers from 1 on, evenly spread, with the first and the last.
fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let taken = most.min(count);
    (0..taken).map(move |at| if taken == 1 { 1 } else { 1 + at * (count - 1) / (taken - 1) })
}

#[cfg(test)]
#[path = "../../tests/unit/sweep/resolved.rs"]
mod tests;
