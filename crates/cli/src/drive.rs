//! Drives a simulation from its first step to its last and hands out samples and maps on the way.

use plateau_core::observe::{Map, Sample, Snapshot};
use plateau_core::schedule::Schedule;
use plateau_core::simulation::{Simulation, SimulationError};

/// Steps between two looks at the clock.
const STEPS_PER_LOOK: u64 = 64;

/// Takes what a simulation reports.
pub trait Sink {
    /// Why it cannot.
    type Error: From<SimulationError>;

    /// A sample of the step just done.
    ///
    /// # Errors
    /// When it cannot be taken; the run then ends.
    fn sample(&mut self, sample: Sample) -> Result<(), Self::Error>;

    /// The maps after the step just done.
    ///
    /// # Errors
    /// When they cannot be taken; the run then ends.
    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), Self::Error>;

    /// Called every few steps.
    ///
    /// # Errors
    /// When the run is to end here.
    fn look(&mut self, _simulation: &Simulation) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The worst load balance of a run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Outcome {
    /// Largest load residual of any step.
    pub load_residual: f64,
    /// Load evaluations per step, mean.
    pub evaluations: f64,
}

/// Runs all steps; samples and maps go to `sink`.
///
/// # Errors
/// When a step fails or the sink does.
pub fn drive<S: Sink>(
    simulation: &mut Simulation,
    schedule: &Schedule,
    maps: &[Map],
    sink: &mut S,
) -> Result<Outcome, S::Error> {
    let last = simulation.parameters().steps;
    let mut outcome = Outcome::default();
    let mut evaluations = 0;
    if schedule.has_maps(0) && !maps.is_empty() {
        sink.snapshot(simulation.snapshot(maps))?;
    }
    while simulation.steps_done() < last {
        let event = schedule.next_event(simulation.steps_done());
        let sampled = schedule.next_sample(simulation.steps_done()) == event;
        while simulation.steps_done() < event {
            for _ in 0..STEPS_PER_LOOK.min(event - simulation.steps_done()) {
                simulation.advance()?;
                outcome.load_residual = outcome.load_residual.max(simulation.contact().residual());
                evaluations += u64::from(simulation.contact().iterations());
            }
            sink.look(simulation)?;
        }
        if sampled {
            sink.sample(simulation.sample())?;
        }
        if schedule.has_maps(event) && !maps.is_empty() {
            sink.snapshot(simulation.snapshot(maps))?;
        }
    }
    outcome.evaluations = evaluations as f64 / last as f64;
    Ok(outcome)
}
