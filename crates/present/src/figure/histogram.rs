//! How many heights are in which class.

use std::ops::RangeInclusive;

/// Classes of equal width over a range.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Values at the ends of the classes.
    pub range: RangeInclusive<f64>,
    /// Fraction of all values in each class, the lowest first.
    pub fractions: Vec<f64>,
    /// Fraction of the values that are in no class.
    pub outside: f64,
}

impl Histogram {
    /// Sorts the values that are there into classes, each less `offset`.
    pub fn of(values: &[f64], offset: f64, range: RangeInclusive<f64>, classes: usize) -> Self {
        let mut counts = vec![0_u64; classes];
        let (mut all, mut outside) = (0_u64, 0_u64);
        let scale = classes as f64 / (range.end() - range.start());
        for value in values.iter().filter(|value| !value.is_nan()).map(|value| value - offset) {
            all += 1;
            // The highest value of the range is in the last class.
            let class = (((value - range.start()) * scale) as usize).min(classes.saturating_sub(1));
            match counts.get_mut(class) {
                Some(count) if range.contains(&value) => *count += 1,
                _ => outside += 1,
            }
        }
        let fraction = |count: u64| if all > 0 { count as f64 / all as f64 } else { 0.0 };
        Self { range, fractions: counts.into_iter().map(fraction).collect(), outside: fraction(outside) }
    }
}

#[cfg(test)]
mod tests {
    use super::Histogram;

    #[test]
    fn counts_every_value_once() {
        let values = [1.0, 1.4, f64::NAN, 2.0, 3.0, 3.1, 0.9, 2.0];
        let histogram = Histogram::of(&values, 1.0, 0.0..=2.0, 2);
        assert_eq!(histogram.fractions, [2.0 / 7.0, 3.0 / 7.0]);
        assert_eq!(histogram.outside, 2.0 / 7.0);
    }
}
