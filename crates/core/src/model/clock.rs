//! Physical time of steps, and what a step is told of the operation (model 4.6 and 9).

use serde::{Deserialize, Serialize};

/// At which physical time steps end, from the last change of the acceleration on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// The step after which it changed.
    step: u64,
    /// t at its end, s.
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

    /// The same clock whose steps take `step_time` (s) after `step`.
    pub fn changed(&self, step: u64, step_time: f64) -> Self {
        // Nothing is rounded once more where nothing changes.
        if step_time == self.step_time { *self } else { Self { step, time: self.time_at(step), step_time } }
    }
}

/// Load and speed of the coming steps, set between two steps in place of those of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// F_N, N, or where the brake is told its torque, that, N m.
    pub load: f64,
    /// ω, rad/s.
    pub angular_velocity: f64,
    /// None where they are those of the scene.
    pub control: Option<Control>,
}

/// What is known of a simulation whose load and speed are set between steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Steps done when the angle of a step changed.
    pub steps: u64,
    /// How far the disc had turned then, rad.
    pub angle: f64,
    /// The largest load so far, N or N m: what sums are multiples of goes by it.
    pub largest_load: f64,
}

/// What a step is told of the operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOperation {
    /// t at its end, s.
    pub end: f64,
    /// F_N, or F̄_n of a cycle, N.
    pub load: f64,
    /// For how long the pin stands on the disc before the step turns it, s.
    pub standing_before: f64,
    /// For how long it is on the disc from then to the end of the step, s.
    pub loaded: f64,
    /// For how long there is load and speed in the step, s.
    pub active: f64,
}

#[cfg(test)]
#[path = "../../tests/unit/model/clock.rs"]
mod tests;
