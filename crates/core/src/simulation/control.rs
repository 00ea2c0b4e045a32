//! Changes from outside between two steps: of load and speed, and of heights.

use std::sync::Arc;

use super::Simulation;
use crate::engine::parts::Needs;
use crate::model::clock::{Control, Operation};
use crate::model::error::SimulationError;
use crate::model::memory::{Course, Heights};
use crate::model::parameters::Parameters;

/// Height above the highest initial one that counts as rounding, m: the thickness below which debris is no build-up.
const ROUNDING: f64 = 1e-15;

impl Operation {
    /// Tells whether a simulation with so many steps done can be given this operation.
    pub(super) fn is_possible(&self, steps: u64) -> bool {
        let Some(Control { steps: since, angle, largest_load }) = self.control else { return false };
        let numbers = [self.load, self.angular_velocity, largest_load];
        numbers.iter().all(|number| number.is_finite() && *number > 0.0)
            && self.load <= largest_load
            && since <= steps
            && angle.is_finite()
    }
}

impl Simulation {
    /// Has the coming steps taken under another load, N (N m where the scene gives a braking torque), and at another rotational
    /// speed, rad/s.
    ///
    /// # Errors
    /// [`SimulationError::Operation`] unless both are finite and above 0, [`SimulationError::TimeLost`] where the time of a step is
    /// lost in rounding, [`SimulationError::OfCycle`] where a cycle gives them.
    pub fn operate(&mut self, load: f64, angular_velocity: f64) -> Result<(), SimulationError> {
        if self.parameters.cycle.is_some() {
            return Err(SimulationError::OfCycle);
        }
        let load_name = if self.parameters.by_torque { "braking torque" } else { "normal force" };
        for (what, found) in [(load_name, load), ("rotational speed", angular_velocity)] {
            if !(found.is_finite() && found > 0.0) {
                return Err(SimulationError::Operation { what, found });
            }
        }
        let Course { steps, time, .. } = self.course();
        // Steps of one length have turned the disc by their number, others by the time that they took.
        let (since, angle) = match self.clock.since() {
            0 => (0, 0.0),
            _ => (steps, self.parameters.angle_turned(steps, time)),
        };
        let begin = Control { steps: since, angle, largest_load: self.parameters.normal_force };
        let control = self.parameters.control.unwrap_or(begin);
        let control = Some(Control { largest_load: control.largest_load.max(load), ..control });
        let operation = Operation { load, angular_velocity, control };
        let parameters = self.parameters.under(&operation);
        let (step_time, now) = (parameters.step_time(), self.parameters.angular_velocity);
        let clock = self.clock.changed(steps, step_time);
        let next = clock.time_at(steps + 1);
        if !(next.is_finite() && next > time) {
            return Err(SimulationError::TimeLost { found: angular_velocity, step_time, time, now });
        }
        self.workers.operate(&operation)?;
        if steps > 0 {
            self.last_speed = Some(self.last_speed());
        }
        self.resting = None;
        (self.parameters, self.clock) = (Arc::new(parameters), clock);
        Ok(())
    }

    /// Returns load and speed of the coming steps.
    pub(super) fn operation(&self) -> Operation {
        let Parameters { normal_force, angular_velocity, control, .. } = *self.parameters;
        Operation { load: normal_force, angular_velocity, control }
    }

    /// Takes over other heights; statuses follow from them. Volumes that are reported count what steps moved, so that `balance_residual`
    /// shows what was changed here. Pressures of the last step are kept only after [`Simulation::keep_contact`].
    ///
    /// # Errors
    /// [`SimulationError::Checkpoint`] where the sizes are not those of the mesh, [`SimulationError::Cell`] for a height that is no
    /// finite number, on the wrong side of its substrate, or above the disc's highest initial height where debris fills the disc.
    pub fn set_heights(&mut self, mut heights: Heights) -> Result<(), SimulationError> {
        for cell in self.parameters.mesh.absent_cells() {
            for field in [&mut heights.pin_height, &mut heights.pin_substrate] {
                // These heights mean nothing, and are not to be refused.
                field.get_mut(cell).into_iter().for_each(|height| *height = 0.0);
            }
        }
        let mut state = self.checkpoint()?;
        state.heights = heights;
        state.check(&self.parameters.mesh)?;
        self.check_cells(&state.heights)?;
        self.restore(&state)
    }

    /// Refuses heights that no cell can have.
    fn check_cells(&self, heights: &Heights) -> Result<(), SimulationError> {
        let Heights { disc_height, disc_substrate, pin_height, pin_substrate } = heights;
        let rows = self.parameters.mesh.rows();
        let error = |field, cell: usize, found, expected| {
            Err(SimulationError::Cell { field, column: cell / rows, row: cell % rows, found, expected })
        };
        let fields = [
            ("disc_height", disc_height),
            ("disc_substrate", disc_substrate),
            ("pin_height", pin_height),
            ("pin_substrate", pin_substrate),
        ];
        for (name, values) in fields {
            if let Some(cell) = values.iter().position(|height| !height.is_finite()) {
                return error(name, cell, values[cell], "a finite number, in m".to_owned());
            }
        }
        let forms = Needs::of(&self.parameters).forms;
        let highest = self.reference_height;
        // What filled a cell may have rounded it above.
        let is_above = |height: &f64| forms && height - highest > ROUNDING;
        if let Some(cell) = disc_height.iter().position(is_above) {
            let expected =
                format!("at most {highest:e} m, the disc's highest initial height, to which debris fills it");
            return error("disc_height", cell, disc_height[cell], expected);
        }
        let bodies =
            [("disc_height", disc_height, disc_substrate, 1.0), ("pin_height", pin_height, pin_substrate, -1.0)];
        for (name, height, substrate, sign) in bodies {
            let is_wrong = |cell: &usize| {
                let build_up = sign * (height[*cell] - substrate[*cell]);
                build_up < 0.0 || (!forms && build_up > 0.0)
            };
            if let Some(cell) = (0..height.len()).find(is_wrong) {
                let side = match (forms, sign > 0.0) {
                    (false, _) => "its substrate, for no plateaus form in this scene:",
                    (true, true) => "at least its substrate,",
                    (true, false) => "at most its substrate,",
                };
                return error(name, cell, height[cell], format!("{side} {} m; set both", substrate[cell]));
            }
        }
        Ok(())
    }
}
