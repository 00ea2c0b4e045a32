//! Forecast of the displacement of the next step.
//!
//! After a revolution the pin faces the same columns again, and the displacement follows the same course with a drift;
//! so it is foretold much better by the last revolutions than by the last step. A good forecast saves time and nothing
//! else: the balance is solved exactly whatever was foretold.

use serde::{Deserialize, Serialize};

/// Ways to foretell: by the last step, by the change one revolution ago, and by that change and how it changed.
const WAYS: usize = 3;

/// Fraction of an error that is forgotten in a step, 1.
const FORGOTTEN: f64 = 1.0 / 64.0;

/// Steps before errors mean anything.
const FIRST_STEPS: u64 = 16;

/// The displacements of the last two revolutions, and how well each way would have foretold them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    revolution: usize,
    /// The last displacements, m; the oldest is overwritten.
    past: Vec<f64>,
    /// Index in `past` at which the next displacement is stored.
    next: usize,
    steps: u64,
    /// Largest error of each way, slowly forgotten, m.
    errors: [f64; WAYS],
}

impl Forecast {
    /// Creates a forecast that knows no displacement yet.
    pub fn new(steps_per_revolution: usize) -> Self {
        let past = vec![0.0; places(steps_per_revolution)];
        Self { revolution: steps_per_revolution, past, next: 0, steps: 0, errors: [0.0; WAYS] }
    }

    /// Steps of a revolution; none where what was read is no forecast of any.
    pub fn revolution(&self) -> Option<usize> {
        let is_whole = self.next < self.past.len() && self.past.len() == places(self.revolution);
        is_whole.then_some(self.revolution)
    }

    /// The displacement `ago` steps before the next one, m; `ago` is at least 1.
    fn ago(&self, ago: usize) -> f64 {
        let index = self.next + self.past.len() - ago;
        self.past[if index < self.past.len() { index } else { index - self.past.len() }]
    }

    /// Returns the displacement that each way foretells, m, and the number of ways that reach back to known steps.
    fn ways(&self) -> ([f64; WAYS], usize) {
        let revolution = self.revolution as u64;
        let known = if self.steps > 2 * revolution {
            3
        } else if self.steps > revolution {
            2
        } else {
            usize::from(self.steps > 0)
        };
        let last = self.ago(1);
        let mut ways = [last; WAYS];
        if known > 1 {
            let change = self.ago(self.revolution) - self.ago(self.revolution + 1);
            ways[1] = last + change;
            if known > 2 {
                let before = self.ago(2 * self.revolution) - self.ago(2 * self.revolution + 1);
                ways[2] = last + (2.0 * change - before);
            }
        }
        (ways, known)
    }

    /// The displacement expected in the next step and how far it may be off, m; `overlap` is a typical overlap, m.
    pub fn expect(&self, overlap: f64) -> (f64, f64) {
        let (ways, known) = self.ways();
        let best = (0..known).min_by(|a, b| self.errors[*a].total_cmp(&self.errors[*b])).unwrap_or(0);
        let least = if self.steps < FIRST_STEPS { 0.1 * overlap } else { 1e-9 * overlap };
        (ways[best], (1.5 * self.errors[best]).max(least))
    }

    /// Takes note of the displacement of a step, m.
    pub fn record(&mut self, displacement: f64) {
        let (ways, known) = self.ways();
        for (error, way) in self.errors.iter_mut().zip(&ways[..known]) {
            *error = (*error * (1.0 - FORGOTTEN)).max((way - displacement).abs());
        }
        self.past[self.next] = displacement;
        self.next = (self.next + 1) % self.past.len();
        self.steps += 1;
    }
}

/// Number of displacements kept: those of two revolutions, and the one before.
fn places(revolution: usize) -> usize {
    revolution.saturating_mul(2).saturating_add(1)
}

#[cfg(test)]
#[path = "../../tests/unit/engine/forecast.rs"]
mod tests;
