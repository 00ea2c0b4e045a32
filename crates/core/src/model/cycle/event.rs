//! Events of a cycle: its maximal active stretches (model 9).

use std::f64::consts::TAU;

use super::interval::Node;

/// Simulated revolutions below which an event is too short for its mean to say much.
const LEAST_REVOLUTIONS: f64 = 10.0;

/// A maximal stretch of active intervals, such as one stop of a car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When it begins, with F and ω then.
    pub start: Node,
    /// When it ends, with F and ω then.
    pub end: Node,
}

/// The largest m with which an event that turns by an angle (rad) has ten simulated revolutions: below 1 none has.
pub fn largest_acceleration(angle: f64) -> f64 {
    angle / (LEAST_REVOLUTIONS * TAU)
}
