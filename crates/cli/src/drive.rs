//! Drives a simulation from its first step to its last and hands out samples and maps on the way.

use std::time::{Duration, Instant};

use plateau_core::acceleration::scout::{Scout, ScoutCheckpoint};
use plateau_core::observe::schedule::Schedule;
use plateau_core::observe::{ACCELERATION, Sample, Snapshot};
use plateau_core::simulation::checkpoint::Checkpoint;
use plateau_core::simulation::{Simulation, SimulationError};
use plateau_io::scene::recipe::OutputRecipe;

/// Time between two looks at progress and signals.
const LOOK_EVERY: Duration = Duration::from_millis(100);

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

    /// Called every few steps. `steps` is the number proposed until the next call; returns the number that it shall be.
    ///
    /// # Errors
    /// When the run is to end here.
    fn look(&mut self, _simulation: &Simulation, steps: u64) -> Result<u64, Self::Error> {
        Ok(steps)
    }

    /// Called between two steps when all that was due is done: here the run may be stopped and gone on with later.
    ///
    /// # Errors
    /// When the run is to end here.
    fn rest(&mut self, _simulation: &mut Simulation, _scout: Option<&mut Scout>) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Puts what is to be driven where it was between two steps of a run that was stopped.
///
/// # Errors
/// When the state is of another run.
pub fn go_on(
    simulation: &mut Simulation,
    scout: Option<&mut Scout>,
    schedule: &mut Schedule,
    (run, ahead): (&Checkpoint, Option<&ScoutCheckpoint>),
) -> Result<(), SimulationError> {
    simulation.restore(run)?;
    if let (Some(scout), Some(ahead)) = (scout, ahead) {
        scout.restore(ahead)?;
    }
    schedule.go_on(run.clock());
    Ok(())
}

/// Runs all steps; the samples and maps that `output` asks for go to `sink`. A run with a scout chooses its acceleration.
///
/// # Errors
/// When a step fails or the sink does.
pub fn drive<S: Sink>(
    simulation: &mut Simulation,
    mut scout: Option<&mut Scout>,
    mut schedule: Schedule,
    output: &OutputRecipe,
    sink: &mut S,
) -> Result<(), S::Error> {
    let OutputRecipe { maps, extras, .. } = output;
    let mut steps_per_look = 1;
    if simulation.steps_done() == 0 && schedule.has_maps(0) && !maps.is_empty() {
        sink.snapshot(simulation.snapshot(maps)?)?;
    }
    while simulation.steps_done() < schedule.last() {
        let done = simulation.steps_done();
        let event =
            schedule.next_event(done).min(scout.as_ref().and_then(|scout| scout.comparison()).unwrap_or(u64::MAX));
        let (sampled, mapped) = (schedule.next_sample(done) == event, schedule.has_maps(event) && !maps.is_empty());
        while simulation.steps_done() < event {
            let start = Instant::now();
            match simulation.steps_done().saturating_add(steps_per_look) {
                before if before < event => simulation.pass_to(before)?,
                _ if sampled || mapped => simulation.advance_to(event)?,
                _ => simulation.pass_to(event)?,
            }
            steps_per_look = sink.look(simulation, adapted(steps_per_look, start.elapsed()))?;
            if simulation.steps_done() < event {
                sink.rest(simulation, scout.as_deref_mut())?;
            }
        }
        if sampled {
            let mut sample = simulation.sample_with(extras)?;
            if let Some(choice) = scout.as_deref().map(Scout::choice) {
                sample.add(ACCELERATION.quantities, [choice.acceleration(), choice.error()]);
            }
            sink.sample(sample)?;
        }
        if mapped {
            sink.snapshot(simulation.snapshot(maps)?)?;
        }
        if let Some(scout) = scout.as_mut().filter(|scout| scout.comparison() == Some(event) && event < schedule.last())
        {
            while !scout.advance(steps_per_look)? {
                sink.look(simulation, steps_per_look)?;
            }
            if scout.compare(simulation)? {
                schedule.change(event, simulation.parameters().step_time());
            }
        }
        sink.rest(simulation, scout.as_deref_mut())?;
    }
    simulation.check_heights()?;
    Ok(())
}

/// The number of steps between two looks, after that many took so long.
fn adapted(steps: u64, time: Duration) -> u64 {
    if time > LOOK_EVERY {
        (steps / 2).max(1)
    } else if time < LOOK_EVERY / 2 {
        steps.saturating_mul(2)
    } else {
        steps
    }
}
