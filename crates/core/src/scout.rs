//! A second simulation that goes before a run, to see what its acceleration costs.

use crate::acceleration::{Choice, RATIO};
use crate::simulation::{Simulation, SimulationError};

/// A simulation of the same surfaces as a run, with [`RATIO`] times its acceleration.
///
/// The two are compared whenever the scout has taken one revolution and the run [`RATIO`] of them, in which the same
/// physical time passes.
#[derive(Debug)]
pub struct Scout {
    simulation: Simulation,
    choice: Choice,
    /// Where the run was when the two were compared last.
    run: Mark,
    /// Where the scout was.
    scout: Mark,
}

/// A moment of a simulation.
#[derive(Debug, Clone, Copy, Default)]
struct Mark {
    steps: u64,
    time: f64,
    contact_area_integral: f64,
}

impl Mark {
    fn of(simulation: &Simulation) -> Self {
        let course = simulation.course();
        Self { steps: course.steps, time: course.time, contact_area_integral: course.contact_area_integral }
    }
}

impl Scout {
    /// A scout for a run that has not begun; `simulation` is another one like it.
    ///
    /// # Errors
    /// [`SimulationError`] when a worker failed.
    pub fn new(mut simulation: Simulation, choice: Choice) -> Result<Self, SimulationError> {
        simulation.accelerate(f64::from(RATIO) * choice.acceleration())?;
        Ok(Self { simulation, choice, run: Mark::default(), scout: Mark::default() })
    }

    /// m of the run and the estimate of its error.
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// The step of the run after which the two are compared.
    pub fn comparison(&self) -> u64 {
        self.run.steps + u64::from(RATIO) * self.revolution()
    }

    /// Takes at most `steps` steps; whether it is where the two are compared.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance(&mut self, steps: u64) -> Result<bool, SimulationError> {
        let end = self.scout.steps + self.revolution();
        self.simulation.pass_to(self.simulation.steps_done().saturating_add(steps).min(end))?;
        Ok(self.simulation.steps_done() == end)
    }

    /// Compares the run with the scout, chooses the acceleration anew and changes that of both; whether it changed.
    ///
    /// # Errors
    /// [`SimulationError`] when a worker failed.
    pub fn compare(&mut self, run: &mut Simulation) -> Result<bool, SimulationError> {
        let [before, scout_before] = [self.run, self.scout];
        (self.run, self.scout) = (Mark::of(run), Mark::of(&self.simulation));
        let area = self.run.contact_area_integral - before.contact_area_integral;
        let scouted = self.scout.contact_area_integral - scout_before.contact_area_integral;
        let acceleration = self.choice.acceleration();
        self.choice.note(scouted / area - 1.0, self.run.time - before.time);
        let chosen = self.choice.acceleration();
        if chosen == acceleration {
            return Ok(false);
        }
        run.accelerate(chosen)?;
        self.simulation.accelerate(f64::from(RATIO) * chosen)?;
        Ok(true)
    }

    /// Steps of a simulated revolution.
    fn revolution(&self) -> u64 {
        self.simulation.parameters().mesh.disc_columns() as u64
    }
}
