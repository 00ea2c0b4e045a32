//! What the steps so far were like.

use serde::{Deserialize, Serialize};

/// What the steps so far were like.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Course {
    /// Steps done.
    pub steps: u64,
    /// t, s.
    pub time: f64,
    /// Contact area of the last step, m².
    pub contact_area: f64,
    /// Σ contact area · m Δt since t = 0, m² s.
    pub contact_area_integral: f64,
    /// Largest load residual of any step.
    pub largest_load_residual: f64,
    /// Passes over the pin beyond one a step: each is a bracket that missed the displacement.
    pub extra_readings: u64,
}
