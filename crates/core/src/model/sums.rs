//! Sums over steps: those that do not drift over a billion of them, and what a quantity was in the steps of the last simulated revolution.

use serde::{Deserialize, Serialize};

/// A running sum with Neumaier's compensation: its error does not grow with the number of terms.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RunningSum {
    sum: f64,
    compensation: f64,
}

impl RunningSum {
    /// Adds a term.
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.compensation +=
            if self.sum.abs() >= term.abs() { (self.sum - sum) + term } else { (term - sum) + self.sum };
        self.sum = sum;
    }

    /// The sum so far of what is never less than nothing: where its terms are differences, rounding may make it so.
    pub fn amount(&self) -> f64 {
        let value = self.value();
        // What is no number stays so.
        if value < 0.0 { 0.0 } else { value }
    }

    /// The sum so far.
    pub fn value(&self) -> f64 {
        self.sum + self.compensation
    }
}

impl From<f64> for RunningSum {
    fn from(sum: f64) -> Self {
        Self { sum, compensation: 0.0 }
    }
}

/// The values of the last steps, at most so many as a revolution has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct Revolution {
    /// Values of the last steps; in a full revolution, the oldest is overwritten.
    values: Vec<f64>,
    /// Place of the next value in a full revolution.
    oldest: usize,
    /// Steps of one revolution.
    steps: usize,
}

/// A revolution as it is read, which may be of anything.
#[derive(Deserialize)]
struct Stored {
    values: Vec<f64>,
    oldest: usize,
    steps: usize,
}

impl TryFrom<Stored> for Revolution {
    type Error = &'static str;

    fn try_from(Stored { values, oldest, steps }: Stored) -> Result<Self, Self::Error> {
        let is_one = values.len() < steps && oldest == 0 || values.len() == steps && oldest < steps;
        if is_one { Ok(Self { values, oldest, steps }) } else { Err("the steps of a revolution do not fit it") }
    }
}

impl Revolution {
    /// Revolution before the first step; it has so many.
    pub fn new(steps: usize) -> Self {
        Self { values: Vec::new(), oldest: 0, steps }
    }

    /// Adds the value of a step.
    pub fn record(&mut self, value: f64) {
        if self.values.len() < self.steps {
            self.values.push(value);
        } else {
            self.values[self.oldest] = value;
            self.oldest = (self.oldest + 1) % self.steps;
        }
    }

    /// The value of the last step; none before the first.
    pub fn newest(&self) -> Option<f64> {
        let newest = if self.oldest == 0 { self.values.last() } else { self.values.get(self.oldest - 1) };
        newest.copied()
    }

    /// Sum over the last revolution; over all steps so far before the first is done.
    pub fn sum(&self) -> f64 {
        // From the oldest to the newest, so that a run that goes on adds in the same order.
        let (newer, older) = self.values.split_at(self.oldest);
        older.iter().chain(newer).sum()
    }

    /// Mean over the last revolution; over all steps so far before the first is done, 0 before any.
    pub fn mean(&self) -> f64 {
        self.sum() / self.values.len().max(1) as f64
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/sums.rs"]
mod tests;
