//! The range that nearly all of many values lie in.

use std::ops::RangeInclusive;

/// Part of the values that may lie below, and above, the colours of a map.
pub const BEYOND: f64 = 0.005;
/// Values of one map that are looked at, at most: more do not move a quantile that can be seen.
const MOST: usize = 250_000;

/// Half of the width of the range of equal values.
const WIDTH: f64 = 0.01;

/// Values of several maps.
#[derive(Debug, Clone, Default)]
pub struct RobustRange {
    values: Vec<f64>,
}

impl RobustRange {
    /// Adds the values of a map, or evenly chosen ones of a large map.
    pub fn add(&mut self, values: impl ExactSizeIterator<Item = f64>) {
        let every = values.len().div_ceil(MOST).max(1);
        self.values.extend(values.step_by(every).filter(|value| value.is_finite()));
    }

    /// The value that this fraction of all values is not above; none without values.
    pub fn quantile(&mut self, fraction: f64) -> Option<f64> {
        let rank = (fraction * self.values.len().checked_sub(1)? as f64).round() as usize;
        Some(*self.values.select_nth_unstable_by(rank, f64::total_cmp).1)
    }

    /// The range between two quantiles; of a little width where all values are equal.
    pub fn between(&mut self, low: f64, high: f64) -> RangeInclusive<f64> {
        let (low, high) = (self.quantile(low).unwrap_or(0.0), self.quantile(high).unwrap_or(0.0));
        // What rounding makes of equal values is no range.
        let equal = high - low <= 1e-9 * low.abs().max(high.abs());
        if equal { low - WIDTH..=high + WIDTH } else { low..=high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outliers_do_not_count() {
        let mut range = RobustRange::default();
        range.add((0..1001).map(f64::from));
        range.add([f64::NAN, 1e9].into_iter());
        // By hand: of 1002 values the ranks 5 and 996.
        assert_eq!(range.between(BEYOND, 1.0 - BEYOND), 5.0..=996.0);
        let mut equal = RobustRange::default();
        equal.add([3.0; 4].into_iter());
        assert!(
            equal.between(0.1, 0.9).contains(&3.0) && equal.between(0.1, 0.9).end() > equal.between(0.1, 0.9).start()
        );
        assert_eq!(RobustRange::default().quantile(0.5), None);
    }
}
