//! One run of a ladder: its steps taken and timed, and what is kept of it.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::Sample;
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::scene::{OutputSettings, Scene};

use super::error::Unfinished;
use super::quantity::{Course, values_of};
use super::windows::Windows;
use crate::assembly::Assembly;
use crate::error::{InputError, RunError};
use crate::execution::time_per_step;
use crate::options::Observer;
use crate::time_loop::Sink;

/// How long the first steps are timed.
const TRIAL: Duration = Duration::from_millis(200);

/// A run that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Steps.
    pub steps: u64,
    /// Wall time of all steps, s: without making the surfaces, and without a run file. None where a run file does not tell.
    pub wall_time: Option<f64>,
    /// Its quantities at the ends of the windows.
    pub course: Course,
}

/// Takes all steps of a scene, in memory, and keeps its quantities at the ends of windows.
///
/// # Errors
/// [`Unfinished`].
pub fn make(
    scene: &Scene,
    surfaces: InitialSurfaces,
    execution: Execution,
    windows: &Windows,
    observer: &mut dyn Observer,
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
///
/// # Errors
/// When parameters and surfaces make no simulation, or a step fails.
pub fn try_steps(scene: &Scene, surfaces: InitialSurfaces, execution: Execution) -> Result<f64, RunError> {
    let simulation = Simulation::with_execution(scene.parameters.clone(), surfaces, execution);
    Ok(time_per_step(&mut simulation.map_err(InputError::Simulation)?, scene.steps, TRIAL)?)
}

/// Keeps what is compared.
struct Record<'a> {
    observer: &'a mut dyn Observer,
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
