//! What changes between two steps: time acceleration, load and speed, and wear rates that follow the temperature.

use std::sync::Arc;

use super::Worker;
use crate::engine::coefficients::Coefficients;
use crate::engine::comm::Communicator;
use crate::engine::kernel::Rules;
use crate::engine::sums::RowWeights;
use crate::model::accounts::Accounts;
use crate::model::error::SimulationError;
use crate::model::parameters::Parameters;

impl<C: Communicator> Worker<C> {
    /// Has the accounts take the pauses before the coming step, and takes over the wear rates that hold in it.
    pub(super) fn begin_accounts(&mut self) -> Result<(), SimulationError> {
        let Some(accounts) = &mut self.accounts else { return Ok(()) };
        accounts.begin(self.course.steps + 1, self.parameters.step_angle());
        if accounts.wear_rate_factor() == self.wear_rate_factor {
            return Ok(());
        }
        self.accept_coefficients(&self.parameters.clone());
        // The sums of the coming step were taken with the weights of before. No bracket has missed, so this is not
        // counted; and who goes on from a checkpoint has read them again anyway.
        let extra_readings = self.course.extra_readings;
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))?;
        self.course.extra_readings = extra_readings;
        Ok(())
    }

    /// Has the coming steps stand for `acceleration` revolutions each, in place of what it was so far (model 4.6).
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        let parameters = Parameters { time_acceleration: acceleration, ..Parameters::clone(&self.parameters) };
        self.clock = self.clock.changed(self.course.steps, parameters.step_time());
        self.accept_coefficients(&parameters);
        // The sums of the coming step were taken with the weights of before.
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))
    }

    /// Has the coming steps taken under another load (N, or N m) and at another speed (rad/s).
    pub fn operate(&mut self, load: f64, angular_velocity: f64) -> Result<(), SimulationError> {
        let parameters = self.parameters.under(load, angular_velocity);
        self.clock = self.clock.changed(self.course.steps, parameters.step_time());
        if parameters.largest_load() <= self.weights.largest_load {
            self.parameters = Arc::new(parameters);
            return Ok(());
        }
        self.accept_coefficients(&parameters);
        self.bracket.map_or(Ok(()), |bracket| self.read_columns(&bracket))
    }

    /// Makes everything that depends on the acceleration, and on wear rates that change with temperature, anew.
    pub(super) fn accept_coefficients(&mut self, parameters: &Parameters) {
        self.parameters = Arc::new(parameters.clone());
        self.wear_rate_factor = self.accounts.as_deref().map_or(1.0, Accounts::wear_rate_factor);
        let now = match self.wear_rate_factor {
            1.0 => self.parameters.clone(),
            factor => Arc::new(parameters.with_wear_rate_factor(factor)),
        };
        self.course.largest_stiffness_number = self.course.largest_stiffness_number.max(now.stiffness_number());
        self.coefficients = Coefficients::new(&now);
        self.rules = Rules::new(&now, &self.coefficients, self.filling.reference_height(), self.shortcut);
        self.weights = RowWeights::new(&now, &self.coefficients, self.rows.clone(), self.weights.relief);
        self.debris.set_coefficients(&self.coefficients);
    }
}
