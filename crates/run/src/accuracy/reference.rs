//! One run, its steps taken and timed, and what is kept of it; the reference: such a run of the same scene, made here or read from a
//! run file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::Sample;
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::run_file::{InputFile, RunFile, State};
use plateau_io::scene::schema::{self, Role};
use plateau_io::scene::{Difference, OutputSettings, Scene, differences};

use crate::accuracy::error::{ReferenceError, Unfinished};
use crate::accuracy::quantity::{COMPARED, Course, Windows, values_of};
use crate::assembly::{Assembly, Sink};
use crate::error::{InputError, RunError};
use crate::execution::time_per_step;
use crate::options::{Observer, Program};

/// Run that every other one is compared with, and where it comes from.
#[derive(Debug, Clone)]
pub struct Reference {
    /// Time acceleration m of the run.
    pub time_acceleration: f64,
    /// Keys and values in which it differs from the scene.
    pub setting: String,
    /// Outcome of the run, as far as it is kept.
    pub outcome: Outcome,
    /// The run file, and the longest time between two samples of it, s; none for a run made here.
    pub file: Option<(InputFile, f64)>,
    /// Program that made it, and the revision of its source.
    pub program: Program,
    /// Machine on which it was made.
    pub host: String,
    /// Number of workers.
    pub workers: u64,
    /// Time at which it was started, ISO 8601.
    pub start_time: String,
}

/// Number of different keys that a message names.
const MOST_KEYS: usize = 5;

/// Reads the reference of a scene; `inputs` are the surface files that the scene reads, with their digests.
pub fn read(path: &Path, scene: &Scene, inputs: &[(PathBuf, String)]) -> Result<Reference, ReferenceError> {
    let run = RunFile::open(path)?;
    let shown = path.display();
    let refused = |message| Err(ReferenceError::Refused(message));
    if run.state() != State::Finished {
        return refused(format!("the reference {shown} is {}, expected a run that is finished", run.state().name()));
    }
    refuse_another_scene(&run, scene, inputs)?;
    let Some(time_acceleration) = run.given_acceleration() else {
        return refused(format!("the scene of the reference {shown} has no numerics.time_acceleration"));
    };
    let mut parameters = scene.parameters.clone();
    parameters.time_acceleration = time_acceleration;
    let end = run.time().last().copied().unwrap_or(0.0);
    // A run ends at its duration or up to a step later.
    if (end - scene.duration).abs() > 1.01 * parameters.step_time() {
        let expected = scene.duration;
        return refused(format!("the reference {shown} ends at {end} s, expected {expected} s as the scene says"));
    }
    let outcome = outcome(&run, parameters.steps_of(scene.duration))?;
    let sample_every = [0.0].iter().chain(run.time()).zip(run.time()).map(|(one, next)| next - one).fold(0.0, f64::max);
    let file = InputFile::read(path).map_err(|error| ReferenceError::File(shown.to_string(), error))?;
    let text = |name: &str| run.attribute(name).unwrap_or_default();
    Ok(Reference {
        time_acceleration,
        setting: format!("time_acceleration = {time_acceleration}"),
        outcome,
        file: Some((file, sample_every)),
        program: Program { name: text("program"), revision: text("source_revision") },
        host: text("host"),
        workers: run.number("workers").unwrap_or(0.0) as u64,
        start_time: text("start_time"),
    })
}

fn outcome(run: &RunFile, steps: u64) -> Result<Outcome, ReferenceError> {
    let mut sums = Vec::new();
    for compared in &COMPARED {
        let mut sum = vec![0.0; run.time().len()];
        for name in compared.series {
            let Some(values) = run.values(name)? else {
                let message = format!("the reference {} has no series {name}", run.path().display());
                return Err(ReferenceError::Refused(message));
            };
            sum.iter_mut().zip(&values).for_each(|(sum, value)| *sum += value);
        }
        sums.push(sum);
    }
    let mut course = Course::start();
    for (index, time) in run.time().iter().enumerate() {
        course.record(*time, std::array::from_fn(|one| sums[one][index]));
    }
    // A file that a run did not write may hold no number.
    let wall_time = run.number("wall_time").filter(|time| time.is_finite());
    Ok(Outcome { steps, wall_time, course })
}

/// Refuses a run whose scene differs in more than numerics and output.
fn refuse_another_scene(run: &RunFile, scene: &Scene, inputs: &[(PathBuf, String)]) -> Result<(), ReferenceError> {
    let read = run.inputs();
    let digest_there = |path: &str| read.iter().find(|input| input.path == path).map(|input| input.sha256.as_str());
    let digest_here =
        |path: &str| inputs.iter().find(|(input, _)| input.as_os_str() == path).map(|(_, sha256)| sha256.as_str());
    let plain = |value: &Option<String>| value.as_deref().unwrap_or_default().trim_matches(['"', '\'']).to_owned();
    let mut different: Vec<Difference> = differences(&scene.resolved, run.scene());
    // A file may have another place and the same content.
    different.retain(|Difference { key, first, second }| {
        let same_content = schema::is_input(key)
            && digest_here(&plain(first)).is_some_and(|digest| digest_there(&plain(second)) == Some(digest));
        // How long runs are is compared by their ends.
        schema::role(key) == Role::Physics && !same_content
    });
    let mut message = format!(
        "the reference {} is a run of another scene; only numerics and output may differ:",
        run.path().display()
    );
    let bare = message.len();
    for Difference { key, first, second } in different.iter().take(MOST_KEYS) {
        let shown = |value: &Option<String>| value.clone().unwrap_or_else(|| "not given".to_owned());
        // Writing to a String cannot fail.
        let _ = write!(message, "\n  {key}: {} there, {} here", shown(second), shown(first));
    }
    if different.len() > MOST_KEYS {
        let _ = write!(message, "\n  and {} other keys", different.len() - MOST_KEYS);
    }
    for (path, sha256) in inputs {
        let changed = digest_there(&path.to_string_lossy()).is_some_and(|there| there != sha256);
        if changed {
            let _ = write!(message, "\n  the content of {} has changed since", path.display());
        }
    }
    if message.len() == bare { Ok(()) } else { Err(ReferenceError::Refused(message)) }
}

/// Wall time for which the first steps are timed.
const TRIAL: Duration = Duration::from_millis(200);

/// A run that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Number of steps.
    pub steps: u64,
    /// Wall time of all steps, s: without making the surfaces, and without a run file. None where a run file does not tell.
    pub wall_time: Option<f64>,
    /// Quantities at the ends of the windows.
    pub course: Course,
}

/// Takes all steps of a scene, in memory, and keeps its quantities at the ends of windows.
pub fn make(
    scene: &Scene,
    surfaces: InitialSurfaces,
    execution: Execution,
    windows: &Windows,
    observer: &dyn Observer,
) -> Result<Outcome, Unfinished> {
    let output = OutputSettings {
        file: PathBuf::new(),
        sample_every: SampleEvery::Time(windows.width),
        maps_at: Vec::new(),
        maps: Vec::new(),
        extras: Vec::new(),
        checkpoint_every: f64::INFINITY,
    };
    let mut assembly = Assembly::new(&Scene { output, ..scene.clone() }, surfaces, execution)?;
    let mut record = Record { observer, windows: windows.count, course: Course::start() };
    let start = Instant::now();
    assembly.run_to_end(&mut record)?;
    let wall_time = Some(start.elapsed().as_secs_f64());
    Ok(Outcome { steps: assembly.simulation.steps_done(), wall_time, course: record.course })
}

/// Wall time of the first steps of a scene, s each.
pub fn try_steps(scene: &Scene, surfaces: InitialSurfaces, execution: Execution) -> Result<f64, RunError> {
    let simulation = Simulation::with_execution(scene.parameters.clone(), surfaces, execution);
    Ok(time_per_step(&mut simulation.map_err(InputError::Simulation)?, scene.steps, TRIAL)?)
}

/// Keeps what is compared.
struct Record<'a> {
    observer: &'a dyn Observer,
    windows: usize,
    course: Course,
}

impl Sink for Record<'_> {
    type Error = Unfinished;

    fn sample(&mut self, sample: Sample) -> Result<(), Unfinished> {
        let values = values_of(&sample);
        if !values.iter().all(|value| value.is_finite()) {
            return Err(Unfinished::NotFinite { step: sample.step });
        }
        // What comes after the last window is its end.
        if self.course.moments() < self.windows {
            self.course.record(sample.time, values);
        }
        Ok(())
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, Unfinished> {
        self.observer.progress(simulation);
        self.observer.asked_to_stop().map_or(Ok(steps), |signal| Err(Unfinished::Stopped(signal)))
    }
}
