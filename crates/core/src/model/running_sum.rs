//! Sums that do not drift over a billion steps.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_million_tenths_make_a_million() {
        // The exact sum of the doubles nearest to 0.1 is 1e6 (1 + 5.55e-17); plain summation is off by 1e-10 relative.
        let mut sum = RunningSum::default();
        (0..10_000_000).for_each(|_| sum.add(0.1));
        assert_eq!(sum.value(), 1e6);
    }

    #[test]
    fn small_terms_survive_a_large_one() {
        let mut sum = RunningSum::default();
        [1.0, 1e100, 1.0, -1e100].into_iter().for_each(|term| sum.add(term));
        assert_eq!(sum.value(), 2.0);
    }
}
