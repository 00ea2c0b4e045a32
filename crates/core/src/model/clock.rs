//! Physical time of steps, and load and times of one step (model 4.6 and 9).

use serde::{Deserialize, Serialize};

/// Physical time at the ends of steps since the time of a step changed last.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Steps done when the time of a step changed last.
    step: u64,
    /// t then, s.
    time: f64,
    /// m Δt, s.
    step_time: f64,
}

impl Clock {
    /// A clock that stands at t = 0 before the first step, each of which takes `step_time` (s).
    pub fn new(step_time: f64) -> Self {
        Self { step: 0, time: 0.0, step_time }
    }

    /// Steps done when the time of a step changed last.
    pub fn since(&self) -> u64 {
        self.step
    }

    /// m Δt = m Δθ/ω, s: physical time of one step.
    pub fn step_time(&self) -> f64 {
        self.step_time
    }

    /// t at the end of a step (counted from 1), s; not of one before the last change.
    pub fn time_at(&self, step: u64) -> f64 {
        self.time + (step - self.step) as f64 * self.step_time
    }

    /// Steps done when t ≥ `time` (s) for the first time: ceil(time/(m Δt) − 1e-9) where nothing changed yet.
    ///
    /// Saturates at `u64::MAX`.
    pub fn steps_until(&self, time: f64) -> u64 {
        self.step.saturating_add(((time - self.time) / self.step_time - 1e-9).ceil().max(0.0) as u64)
    }

    /// Clock that goes on with steps of `step_time` (s) after `step`.
    pub fn changed(&self, step: u64, step_time: f64) -> Self {
        // Nothing is rounded once more where nothing changes.
        if step_time == self.step_time { *self } else { Self { step, time: self.time_at(step), step_time } }
    }
}

/// Load and speed of the coming steps, set between two steps in place of those of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// F_N, N, or the braking torque where that is given, N m.
    pub load: f64,
    /// ω, rad/s.
    pub angular_velocity: f64,
    /// Record of the changes; none where load and speed are those of the scene.
    pub control: Option<Control>,
}

/// Record of load and speed that were set between steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Steps done from which the angle is counted on.
    pub steps: u64,
    /// Angle by which the disc had turned then, rad.
    pub angle: f64,
    /// The largest load so far, N or N m: it sets the quantum of sums.
    pub largest_load: f64,
}

/// Load and times of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOperation {
    /// t at its end, s.
    pub end: f64,
    /// F_N, or F̄_n of a cycle, N.
    pub load: f64,
    /// Time for which the pin stands on the disc before the step turns it, s.
    pub standing_before: f64,
    /// Time for which the pin is on the disc from then to the end of the step, s.
    pub loaded: f64,
    /// Time with load and speed in the step, s.
    pub active: f64,
}

#[cfg(test)]
#[path = "../../tests/unit/model/clock.rs"]
mod tests;
