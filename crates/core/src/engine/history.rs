//! What the steps so far were like; contact area over them: mean over the last revolution and integral over time (model
//! section 5).

use serde::{Deserialize, Serialize};

use crate::engine::running_sum::RunningSum;
use crate::model::operation::StepOperation;

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

/// What a sample needs to know of the steps before its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Contact area of the last steps, m²; at most one simulated revolution, then the oldest is overwritten.
    revolution: Vec<f64>,
    /// Where the next step goes in a full `revolution`.
    oldest: usize,
    /// Steps of one simulated revolution.
    steps_per_revolution: usize,
    /// Σ contact area · m Δt, m² s.
    integral: RunningSum,
}

impl History {
    /// No step yet.
    pub fn new(steps_per_revolution: usize) -> Self {
        Self { revolution: Vec::new(), oldest: 0, steps_per_revolution, integral: RunningSum::default() }
    }

    /// Adds a step.
    pub fn record(&mut self, contact_area: f64, operation: &StepOperation) {
        if operation.standing_before > 0.0 {
            self.integral.add(self.newest() * operation.standing_before);
        }
        if self.revolution.len() < self.steps_per_revolution {
            self.revolution.push(contact_area);
        } else {
            self.revolution[self.oldest] = contact_area;
            self.oldest = (self.oldest + 1) % self.steps_per_revolution;
        }
        self.integral.add(contact_area * operation.loaded);
    }

    /// Contact area of the last step, m²; 0 before the first.
    fn newest(&self) -> f64 {
        let newest = if self.oldest == 0 { self.revolution.last() } else { self.revolution.get(self.oldest - 1) };
        newest.copied().unwrap_or(0.0)
    }

    /// Mean over the last simulated revolution, m²; over all steps so far before the first is done.
    pub fn revolution_mean(&self) -> f64 {
        let (newer, older) = self.revolution.split_at(self.oldest);
        let sum: f64 = older.iter().chain(newer).sum();
        sum / self.revolution.len().max(1) as f64
    }

    /// Σ contact area · m Δt since t = 0, m² s.
    pub fn integral(&self) -> f64 {
        self.integral.value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_over_all_steps_until_a_revolution_is_done() {
        let mut history = History::new(4);
        let mut means = Vec::new();
        for area in [1.0, 3.0, 5.0, 7.0, 9.0, 11.0] {
            let standing_before = if area == 9.0 { 2.0 } else { 0.0 };
            history.record(area, &StepOperation { end: 0.0, load: 1.0, standing_before, loaded: 0.5 });
            means.push(history.revolution_mean());
        }
        assert_eq!(means, [1.0, 2.0, 3.0, 4.0, 6.0, 8.0]);
        // Half of the sum, and 2 s of the contact of the step before the fifth.
        assert_eq!(history.integral(), 18.0 + 14.0);
    }
}
