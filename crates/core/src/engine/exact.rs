//! Sums that do not depend on the order of their terms: they are sums of integers.

use std::ops::Range;

use crate::engine::lanes::{IntegerChunk, LANES};

/// An integer for every row, in chunks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowIntegers(pub Vec<IntegerChunk>);

impl RowIntegers {
    /// All 0.
    pub fn new(strips: usize) -> Self {
        Self(vec![[0; LANES]; strips])
    }

    /// All 0 again.
    pub fn clear(&mut self) {
        self.0.fill([0; LANES]);
    }

    /// Those of some rows.
    pub fn rows(&self, rows: Range<usize>) -> &[i64] {
        &self.0.as_flattened()[rows]
    }
}

/// An area or volume as an integer of 2^−BITS m² or m³, below 2^(127−BITS) of them: sums of such are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exact<const BITS: i32>(i128);

/// Volumes that one step moves, m³.
pub type StepVolume = Exact<140>;
/// Areas and volumes of the whole ring, m² and m³.
pub type RingSum = Exact<110>;

impl<const BITS: i32> Exact<BITS> {
    /// The value to the last whole unit.
    #[inline]
    pub fn of(value: f64) -> Self {
        // Mantissa and exponent: a conversion of the product would be a call of a routine.
        let bits = value.abs().to_bits();
        let exponent = (bits >> 52) as i32;
        let mantissa = i128::from((bits & ((1 << 52) - 1)) | u64::from(exponent > 0) << 52);
        let shift = exponent.max(1) - 1075 + BITS;
        let size = if shift >= 0 { mantissa << shift.min(74) } else { mantissa >> (-shift).min(127) };
        Self(if value < 0.0 { -size } else { size })
    }

    /// Adds another.
    pub fn add(&mut self, other: Self) {
        self.0 = self.0.wrapping_add(other.0);
    }

    /// Takes another off.
    pub fn subtract(&mut self, other: Self) {
        self.0 = self.0.wrapping_sub(other.0);
    }

    /// The nearest double-precision number.
    pub fn value(self) -> f64 {
        libm::ldexp(float(self.0), -BITS)
    }

    /// The integer.
    pub fn integer(self) -> i128 {
        self.0
    }

    /// From the integer.
    pub fn of_integer(integer: i128) -> Self {
        Self(integer)
    }
}

/// Weights of the rows as integers times a unit, so that weighted sums are exact.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    rows: Vec<i64>,
    unit: f64,
}

impl Weights {
    /// The weights to the 53rd bit of the largest.
    pub fn new(rows: &[f64]) -> Self {
        let largest = rows.iter().copied().fold(0.0, |largest, weight| f64::max(largest, weight.abs()));
        let exponent = if largest > 0.0 { libm::ilogb(largest) - 52 } else { 0 };
        let rows = rows.iter().map(|weight| libm::rint(libm::ldexp(*weight, -exponent)) as i64).collect();
        Self { rows, unit: libm::ldexp(1.0, exponent) }
    }

    /// The weights of some rows.
    #[inline]
    pub fn rows(&self, rows: Range<usize>) -> &[i64] {
        &self.rows[rows]
    }

    /// The weight of a row, in units.
    pub fn row(&self, row: usize) -> i64 {
        self.rows[row]
    }

    /// The weight of a row.
    pub fn value(&self, row: usize) -> f64 {
        self.rows[row] as f64 * self.unit
    }

    /// Σ weight · count over some rows, in units.
    pub fn sum(&self, rows: Range<usize>, counts: &[i64]) -> i128 {
        let weights = self.rows(rows);
        let counts = &counts[..weights.len()];
        (0..weights.len()).map(|row| product(weights[row], counts[row])).sum()
    }

    /// What one unit is worth.
    pub fn unit(&self) -> f64 {
        self.unit
    }
}

/// An exact sum as words of a message.
pub fn words(sum: i128) -> [u64; 2] {
    [sum as u64, (sum >> 64) as u64]
}

/// An exact sum from the next two words of a message.
pub fn of_words(words: &mut impl Iterator<Item = u64>) -> i128 {
    let (low, high) = (words.next().unwrap_or(0), words.next().unwrap_or(0));
    ((u128::from(high) << 64) | u128::from(low)) as i128
}

/// weight · count.
#[inline(always)]
pub fn product(weight: i64, count: i64) -> i128 {
    i128::from(weight) * i128::from(count)
}

/// An exact sum as a floating-point number.
#[inline]
pub fn float(sum: i128) -> f64 {
    // Two conversions that processors have, instead of a routine.
    let size = sum.unsigned_abs();
    let size = (size >> 64) as u64 as f64 * 18_446_744_073_709_551_616.0 + size as u64 as f64;
    if sum < 0 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sums_do_not_depend_on_order() {
        let terms = [1e-9, 3.3e-22, -1e-9, 7.25e-5, 1e-15, -7.25e-5];
        let sum = |terms: &mut dyn Iterator<Item = &f64>| {
            let mut sum = StepVolume::default();
            terms.for_each(|term| sum.add(Exact::of(*term)));
            sum
        };
        let (forward, backward) = (sum(&mut terms.iter()), sum(&mut terms.iter().rev()));
        assert_eq!(forward, backward);
        // The exact sum of the terms is 1e-15 + 3.3e-22.
        assert!((forward.value() / (1e-15 + 3.3e-22) - 1.0).abs() < 1e-14);
        let mut negative = StepVolume::default();
        negative.subtract(forward);
        assert_eq!(StepVolume::of_integer(negative.integer()), negative);
        assert_eq!(negative.value(), -forward.value());
    }

    #[test]
    fn values_are_cut_to_whole_units() {
        for value in [0.0, 1.0, -1.0, 3.25e-5, -7.1e-19, 1.9e-36, 1e-50, f64::MIN_POSITIVE, 0.5 * f64::MIN_POSITIVE] {
            let unit = libm::ldexp(1.0, -110);
            assert_eq!(RingSum::of(value).integer(), (value / unit).trunc() as i128, "{value:e}");
        }
    }

    #[test]
    fn weighted_sums_are_those_of_the_definition() {
        // Closed form: Σ i² = n (n + 1) (2n + 1) / 6 for i up to 20.
        let weights = Weights::new(&(0..24).map(f64::from).collect::<Vec<_>>());
        let mut counts = RowIntegers::new(3);
        counts.0.as_flattened_mut().iter_mut().zip(0..).for_each(|(count, row)| *count = row);
        assert_eq!(float(weights.sum(0..21, counts.rows(0..21))) * weights.unit(), 20.0 * 21.0 * 41.0 / 6.0);
        assert_eq!(float(weights.sum(20..21, counts.rows(20..21))) * weights.unit(), 400.0);
    }

    #[test]
    fn exact_sums_become_the_nearest_numbers() {
        for sum in [0, 1, -1, 3 << 70, -(3 << 70), i128::from(i64::MIN), i128::MAX, (1 << 100) + 1] {
            // One rounding of the low part, one of the sum.
            assert!((float(sum) / sum as f64 - 1.0).abs() <= 2.0 * f64::EPSILON || sum == 0, "{sum}");
        }
    }
}
