//! The time loop: takes a simulation from its first step to its last and hands out samples and maps on the way.

use std::time::{Duration, Instant};

use plateau_core::acceleration::scout::Scout;
use plateau_core::observe::{ACCELERATION, Sample, Snapshot};
use plateau_core::simulation::{Simulation, SimulationError};

use crate::assembly::Assembly;

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

    /// The maps after the step just done. Not called where the scene asks for none.
    ///
    /// # Errors
    /// When they cannot be taken; the run then ends.
    fn snapshot(&mut self, _snapshot: Snapshot) -> Result<(), Self::Error> {
        Ok(())
    }

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
    fn rest(&mut self, _assembly: &mut Assembly) -> Result<(), Self::Error> {
        Ok(())
    }
}

impl Assembly {
    /// Takes all steps that are left; the samples and maps that the scene asks for go to `sink`. A run with a scout chooses its
    /// acceleration.
    ///
    /// # Errors
    /// When a step fails or the sink does.
    pub fn run_to_end<S: Sink>(&mut self, sink: &mut S) -> Result<(), S::Error> {
        let has_maps = !self.output.maps.is_empty();
        let mut steps_per_look = 1;
        if self.simulation.steps_done() == 0 && has_maps && self.schedule.has_maps(0) {
            sink.snapshot(self.simulation.snapshot(&self.output.maps)?)?;
        }
        while self.simulation.steps_done() < self.schedule.last() {
            let done = self.simulation.steps_done();
            let comparison = self.scout.as_ref().and_then(Scout::comparison);
            let event = self.schedule.next_event(done).min(comparison.unwrap_or(u64::MAX));
            let sampled = self.schedule.next_sample(done) == event;
            let mapped = has_maps && self.schedule.has_maps(event);
            while self.simulation.steps_done() < event {
                let start = Instant::now();
                match self.simulation.steps_done().saturating_add(steps_per_look) {
                    before if before < event => self.simulation.pass_to(before)?,
                    _ if sampled || mapped => self.simulation.advance_to(event)?,
                    _ => self.simulation.pass_to(event)?,
                }
                steps_per_look = sink.look(&self.simulation, adapted(steps_per_look, start.elapsed()))?;
                if self.simulation.steps_done() < event {
                    sink.rest(self)?;
                }
            }
            if sampled {
                sink.sample(self.sample()?)?;
            }
            if mapped {
                sink.snapshot(self.simulation.snapshot(&self.output.maps)?)?;
            }
            if comparison == Some(event) && event < self.schedule.last() {
                self.choose_acceleration(sink, steps_per_look)?;
            }
            sink.rest(self)?;
        }
        Ok(self.simulation.check_heights()?)
    }

    /// What is reported of the step just done.
    fn sample(&mut self) -> Result<Sample, SimulationError> {
        let mut sample = self.simulation.sample_with(&self.output.extras)?;
        if let Some(choice) = self.scout.as_ref().map(Scout::choice) {
            sample.add(ACCELERATION.quantities, [choice.acceleration(), choice.error()]);
        }
        Ok(sample)
    }

    /// Has the scout come to where the run is, and chooses the acceleration anew.
    fn choose_acceleration<S: Sink>(&mut self, sink: &mut S, steps_per_look: u64) -> Result<(), S::Error> {
        let Some(scout) = &mut self.scout else { return Ok(()) };
        while !scout.advance(steps_per_look)? {
            sink.look(&self.simulation, steps_per_look)?;
        }
        if scout.compare(&mut self.simulation)? {
            self.schedule.change(self.simulation.steps_done(), self.simulation.parameters().step_time());
        }
        Ok(())
    }
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
