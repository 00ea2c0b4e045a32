//! Parameters of a simulation, apart from the initial surfaces (model section 3).

use std::sync::Arc;

use crate::model::clock::{Clock, Control, Operation, StepOperation};
use crate::model::cycle::Cycle;
use crate::model::emission::Emission;
use crate::model::error::SimulationError;
use crate::model::friction::Friction;
use crate::model::material::Materials;
use crate::model::mesh::Mesh;
use crate::model::thermal::Thermal;

/// Rule for the place where debris is compacted (model 4L and 4P).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DebrisRule {
    /// Gap behind the cell that wears, in the same step; what finds no room leaves the contact.
    Local,
    /// All open cells evenly, out of one pool for the whole contact.
    Contact,
    /// All open cells of a row evenly, out of one pool for each row.
    Track,
}

/// Rule by which the wear of one step follows from its contact (model 4.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// Δh = κ p ds: the paper's rule. Unstable when the stiffness number Π exceeds 2.
    Explicit,
    /// The overlap decays exponentially over the step; stable for any Π.
    Exponential,
}

/// Formation and destruction of secondary plateaus (model 4L and 4P).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateauRules {
    /// Rule for the place where debris is compacted.
    pub debris: DebrisRule,
    /// η: fraction of the worn volume that stays in the contact (pools) or may be compacted (local debris).
    pub captured_fraction: f64,
    /// η of what wears off resin, where it has one of its own.
    pub captured_resin_fraction: Option<f64>,
    /// β: the pin's share of a deposit where both surfaces can form a plateau; pools only.
    pub pad_share: f64,
    /// True if plateaus form; without it captured debris stays in its pool, and with local debris all leaves the contact.
    pub formation: bool,
    /// True if unsupported plateaus of the pin go back to their pool; pools only.
    pub destruction: bool,
    /// ℓ, m: length over which debris is gathered and spread; local debris only, which without it goes from one cell to the
    /// next.
    pub transport_length: Option<f64>,
}

impl PlateauRules {
    /// Local debris, all of which may be compacted.
    pub const LOCAL: Self = Self {
        debris: DebrisRule::Local,
        captured_fraction: 1.0,
        captured_resin_fraction: None,
        pad_share: 0.0,
        formation: true,
        destruction: false,
        transport_length: None,
    };

    /// One pool for the whole contact with this captured fraction; half of a deposit goes to the pin where it can.
    pub const fn pool(captured_fraction: f64) -> Self {
        Self { debris: DebrisRule::Contact, captured_fraction, pad_share: 0.5, destruction: true, ..Self::LOCAL }
    }

    /// η of what wears off resin.
    pub fn captured_of_resin(&self) -> f64 {
        self.captured_resin_fraction.unwrap_or(self.captured_fraction)
    }
}

/// Coefficient of friction below which a braking torque asks for too large a load (model 9).
pub const LEAST_FRICTION: f64 = 0.01;

/// Parameters of one simulation, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// Ring mesh.
    pub mesh: Mesh,
    /// F_N, N, or the braking torque where that is given, N m; a cycle takes its place.
    pub normal_force: f64,
    /// True if load is a braking torque, N m, that friction has to give (model 9); it needs friction.
    pub by_torque: bool,
    /// ω, rad/s; a cycle takes its place.
    pub angular_velocity: f64,
    /// Load and speed that change with time (model 9).
    pub cycle: Option<Arc<Cycle>>,
    /// Record of load and speed that were set between steps ([`Simulation::operate`](crate::simulation::Simulation::operate)).
    pub control: Option<Control>,
    /// h, m: height of the elastic foundation.
    pub foundation_height: f64,
    /// Properties by (body, status).
    pub materials: Materials,
    /// Formation and destruction.
    pub plateaus: PlateauRules,
    /// m ≥ 1: number of revolutions that one simulated revolution stands for (model 4.6).
    pub time_acceleration: f64,
    /// Rule by which wear follows from contact.
    pub integrator: Integrator,
    /// Friction, where it is reckoned (model 10).
    pub friction: Option<Friction>,
    /// Heat and what it changes, where it is reckoned (model 11); it needs friction.
    pub thermal: Option<Arc<Thermal>>,
    /// Airborne emission, where it is reckoned (model 12).
    pub emission: Option<Emission>,
}

impl Parameters {
    /// Parameters with the wear rates of the pin's plateaus multiplied by f_κ (model 11, feedback).
    pub fn with_wear_rate_factor(&self, factor: f64) -> Self {
        Self { materials: self.materials.with_wear_rate_factor(factor), ..self.clone() }
    }

    /// Parameters under another load (N, or N m of a braking torque) and at another rotational speed (rad/s).
    pub fn under(&self, operation: &Operation) -> Self {
        let Operation { load, angular_velocity, control } = *operation;
        Self { normal_force: load, angular_velocity, control, ..self.clone() }
    }

    /// Parameters with this time acceleration in the coming steps, after so many.
    pub fn accelerated(&self, time_acceleration: f64, steps: u64) -> Self {
        let is_same = time_acceleration == self.time_acceleration;
        let changed = |control| Control { steps, angle: self.angle_turned(steps, f64::NAN), ..control };
        let control = if is_same { self.control } else { self.control.map(changed) };
        Self { time_acceleration, control, ..self.clone() }
    }

    /// Π with the wear rates of the temperature with which a run begins.
    pub fn first_stiffness_number(&self) -> f64 {
        let factor = self.thermal.as_ref().map_or(1.0, |thermal| thermal.wear_rate_factor.at(thermal.ambient));
        self.with_wear_rate_factor(factor).stiffness_number()
    }

    /// m Δt = m Δθ/ω, s: physical time of one step.
    pub fn step_time(&self) -> f64 {
        self.time_acceleration * self.mesh.column_angle() / self.angular_velocity
    }

    /// The clock of a simulation whose acceleration never changes.
    pub fn clock(&self) -> Clock {
        Clock::new(self.step_time())
    }

    /// Steps of a run of `duration` (s) whose acceleration never changes: at least one, but for a cycle that turns less far.
    pub fn steps_of(&self, duration: f64) -> u64 {
        match &self.cycle {
            Some(cycle) => cycle.steps_done(duration, self.step_angle()),
            None => self.clock().steps_until(duration).max(1),
        }
    }

    /// L: columns over which debris is gathered and spread (model 4L); none where it goes from one cell to the next.
    pub fn transport_columns(&self) -> Option<usize> {
        let column = self.mesh.column_width();
        self.plateaus.transport_length.map(|length| (length / column).round().max(1.0) as usize)
    }

    /// Load and time of a step, counted from 1, by a clock of constant operation, with the coefficient of friction of the step
    /// before, where there is friction: a braking torque asks for the load that it takes.
    ///
    /// # Errors
    /// [`SimulationError::NoFriction`] where friction is too little to brake.
    pub fn operation_by(
        &self,
        step: u64,
        clock: &Clock,
        coefficient: Option<f64>,
    ) -> Result<StepOperation, SimulationError> {
        let operation = self.operation_of(step, clock);
        Ok(StepOperation { load: self.load_by(operation.load, coefficient, step)?, ..operation })
    }

    /// F̄ of a step, N, in whose place there may be a braking torque, with the coefficient of friction of the step before;
    /// before the first its ceiling.
    fn load_by(&self, given: f64, coefficient: Option<f64>, step: u64) -> Result<f64, SimulationError> {
        if !self.by_torque {
            return Ok(given);
        }
        let ceiling = self.friction.map_or(f64::NAN, |friction| friction.maximum);
        let coefficient = coefficient.unwrap_or(ceiling);
        if coefficient >= LEAST_FRICTION {
            return Ok(self.load_at(given, coefficient));
        }
        Err(SimulationError::NoFriction { step, coefficient })
    }

    /// Load and time of a step, counted from 1, by a clock of constant operation. A braking torque stands for the load.
    pub fn operation_of(&self, step: u64, clock: &Clock) -> StepOperation {
        match &self.cycle {
            Some(cycle) => cycle.step(step, self.step_angle()),
            None => StepOperation {
                end: clock.time_at(step),
                load: self.normal_force,
                standing_before: 0.0,
                loaded: clock.step_time(),
                active: clock.step_time(),
            },
        }
    }

    /// Mean speed over the angle of a step, counted from 1, rad/s.
    pub fn mean_speed_of(&self, step: u64) -> f64 {
        match &self.cycle {
            Some(cycle) if step > 0 => self.step_angle() / cycle.step(step, self.step_angle()).active,
            _ => self.angular_velocity,
        }
    }

    /// m Δθ, rad: angle that one step stands for.
    pub fn step_angle(&self) -> f64 {
        self.time_acceleration * self.mesh.column_angle()
    }

    /// The angle that so many steps turned, which end at a time (s), rad.
    pub fn angle_turned(&self, steps: u64, time: f64) -> f64 {
        match &self.control {
            Some(control) => control.angle + (steps - control.steps) as f64 * self.step_angle(),
            None if self.cycle.is_some() => steps as f64 * self.step_angle(),
            // The time of constant operation knows steps of another acceleration, too.
            None => time * self.angular_velocity,
        }
    }

    /// The load of a step, counted from 1, N; or its braking torque, N m.
    pub fn load_of(&self, step: u64) -> f64 {
        self.operation_of(step, &self.clock()).load
    }

    /// The load of so many steps, N, mean over their angle.
    pub fn mean_load(&self, steps: u64) -> f64 {
        // As if all of them were one.
        self.cycle.as_ref().map_or(self.normal_force, |cycle| cycle.step(1, steps as f64 * self.step_angle()).load)
    }

    /// F_N, N; of a braking torque the load that it asks for where friction is at its ceiling, as in the first step.
    pub fn usual_load(&self) -> f64 {
        self.load_by(self.normal_force, None, 1).unwrap_or(f64::NAN)
    }

    /// Upper bound of the load of any step, N.
    pub fn largest_load(&self) -> f64 {
        let set = self.control.map_or(self.normal_force, |control| control.largest_load);
        let largest = self.cycle.as_ref().map_or(set, |cycle| cycle.largest_force());
        if self.by_torque { self.load_at(largest, LEAST_FRICTION) } else { largest }
    }

    /// F̄ that gives a braking torque (N m) with a coefficient of friction, N.
    fn load_at(&self, torque: f64, coefficient: f64) -> f64 {
        torque / (self.mesh.mean_radius() * coefficient)
    }

    /// Π = κ k m r Δθ at the outer radius for the fastest wearing pair: above 1 the explicit rule overshoots, above 2
    /// it is unstable (model section 8).
    pub fn stiffness_number(&self) -> f64 {
        use crate::model::material::Status::{Primary, Secondary};
        let radius = self.mesh.radius().last().copied().unwrap_or(0.0);
        let sliding = self.time_acceleration * radius * self.mesh.column_angle();
        let mut largest = 0.0_f64;
        for pin in [Primary, Secondary] {
            for disc in [false, true] {
                let wear_rate = self.materials.pin_wear_rate(pin, disc) + self.materials.disc(disc).specific_wear_rate;
                let stiffness = self.materials.combined_modulus(pin, disc) / self.foundation_height;
                largest = largest.max(wear_rate * stiffness * sliding);
            }
        }
        largest
    }
}
