//! Load and time of a single step: constant operation, or a step of a cycle (model 4.1, 4.6 and 9).

use super::clock::Clock;
use super::parameters::Parameters;

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
}

impl Parameters {
    /// Load and time of a step, counted from 1, by a clock of constant operation.
    pub fn operation_of(&self, step: u64, clock: &Clock) -> StepOperation {
        match &self.cycle {
            Some(cycle) => cycle.step(step, self.step_angle()),
            None => StepOperation {
                end: clock.time_at(step),
                load: self.normal_force,
                standing_before: 0.0,
                loaded: clock.step_time(),
            },
        }
    }

    /// m Δθ, rad: by how much one step turns the disc.
    pub fn step_angle(&self) -> f64 {
        self.time_acceleration * self.mesh.column_angle()
    }

    /// The angle that so many steps turned, which end at a time (s), rad.
    pub fn angle_turned(&self, steps: u64, time: f64) -> f64 {
        // The time of constant operation knows steps of another acceleration, too.
        if self.cycle.is_some() { steps as f64 * self.step_angle() } else { time * self.angular_velocity }
    }

    /// The load of a step, counted from 1, N.
    pub fn load_of(&self, step: u64) -> f64 {
        self.operation_of(step, &self.clock()).load
    }

    /// The largest load of any step, N.
    pub fn largest_load(&self) -> f64 {
        self.cycle.as_ref().map_or(self.normal_force, |cycle| cycle.largest_force())
    }
}
