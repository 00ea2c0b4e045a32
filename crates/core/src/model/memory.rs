//! Memory of a simulation between two steps, whatever takes its steps: course of the steps so far; contact area over them: mean over
//! the last revolution and integral over time (model section 5).

use serde::{Deserialize, Serialize};

use crate::model::accounts::AccountsState;
use crate::model::clock::{Clock, StepOperation};
use crate::model::sums::{Revolution, RunningSum};
use crate::model::totals::Account;

/// Heights of disc and pin, m, column by column.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Heights {
    /// z_d.
    pub disc_height: Vec<f64>,
    /// b_d.
    pub disc_substrate: Vec<f64>,
    /// z_p.
    pub pin_height: Vec<f64>,
    /// b_p.
    pub pin_substrate: Vec<f64>,
}

/// State of a simulation beside its heights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Course of the steps so far.
    pub course: Course,
    /// Physical time at the ends of steps.
    pub clock: Clock,
    /// m: time acceleration, 1.
    pub time_acceleration: f64,
    /// Debris in the pools, and volumes moved.
    pub account: Account,
    /// Contact area over the steps so far.
    pub history: History,
    /// Accounts of friction, heat and emission, where the scene asks for any.
    pub accounts: Option<AccountsState>,
}

/// Course of the steps so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Course {
    /// Steps done.
    pub steps: u64,
    /// t, s.
    pub time: f64,
    /// F̄ of the last step, N.
    pub load: f64,
    /// Contact area of the last step, m².
    pub contact_area: f64,
    /// Σ contact area · m Δt since t = 0, m² s.
    pub contact_area_integral: f64,
    /// Largest load residual of any step.
    pub largest_load_residual: f64,
    /// Largest Π so far, with the time acceleration and the wear rates that held (model section 8).
    pub largest_stiffness_number: f64,
    /// Passes over the pin beyond one a step: each is a bracket that missed the displacement.
    pub extra_readings: u64,
}

/// Contact area over the steps so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Contact area of the steps of the last revolution, m².
    revolution: Revolution,
    /// Σ contact area · m Δt, m² s.
    integral: RunningSum,
}

impl History {
    /// History before the first step.
    pub fn new(steps_per_revolution: usize) -> Self {
        Self { revolution: Revolution::new(steps_per_revolution), integral: RunningSum::default() }
    }

    /// Adds a step with this contact area (m²).
    pub fn record(&mut self, contact_area: f64, operation: &StepOperation) {
        if operation.standing_before > 0.0 {
            self.integral.add(self.revolution.newest().unwrap_or(0.0) * operation.standing_before);
        }
        self.revolution.record(contact_area);
        self.integral.add(contact_area * operation.loaded);
    }

    /// Mean over the last simulated revolution, m²; over all steps so far before the first is done.
    pub fn revolution_mean(&self) -> f64 {
        self.revolution.mean()
    }

    /// Σ contact area · m Δt since t = 0, m² s.
    pub fn integral(&self) -> f64 {
        self.integral.value()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/memory.rs"]
mod tests;
