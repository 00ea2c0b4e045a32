//! Sums that do not depend on the order of their terms.
//!
//! Every term is rounded to a multiple of a quantum, and the multiples are added as integers: so the sum of many workers
//! is that of one, whatever part of the cells each of them has.

use std::ops::Range;

use crate::kernel::{IntegerChunk, LANES};

/// A power of two of which terms are multiples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantum {
    exponent: i32,
    value: f64,
    anchor: f64,
}

impl Quantum {
    /// The quantum of up to `terms` terms up to `bound`: their sum fits an integer.
    ///
    /// A term is less than 2^50 quanta, so its rounding is at most 2^−51 of the bound; beyond 2^13 terms it is less of
    /// them and more rounding.
    pub fn of(bound: f64, terms: usize) -> Self {
        let exponent = if bound > 0.0 { libm::ilogb(bound) } else { 0 };
        let beyond = terms.div_ceil(1 << 13).next_power_of_two().trailing_zeros();
        Self::of_exponent(exponent + 1 - 50 + beyond as i32)
    }

    fn of_exponent(exponent: i32) -> Self {
        // Kept where 2^52 quanta are neither subnormal nor infinite.
        let exponent = exponent.clamp(-1000, 900);
        Self { exponent, value: libm::ldexp(1.0, exponent), anchor: libm::ldexp(1.5, exponent + 52) }
    }

    /// A coarser one, for terms up to 2^`bits` times as large.
    pub fn coarser(self, bits: i32) -> Self {
        Self::of_exponent(self.exponent + bits)
    }

    /// The quantum.
    pub fn value(self) -> f64 {
        self.value
    }

    /// 1.5 · 2^52 quanta: a number whose last bit is worth one quantum, so that the bits of `anchor` + x, less those of
    /// `anchor`, are x in quanta.
    pub fn anchor(self) -> f64 {
        self.anchor
    }

    /// A term in quanta.
    pub fn count(self, term: f64) -> i64 {
        ((self.anchor + term).to_bits() as i64).wrapping_sub(self.anchor_bits())
    }

    /// Bits of [`Quantum::anchor`] as an integer.
    pub fn anchor_bits(self) -> i64 {
        self.anchor.to_bits() as i64
    }
}

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

    /// Sums of two, row by row.
    pub fn add(&mut self, words: &[u64]) {
        for (value, word) in self.0.as_flattened_mut().iter_mut().zip(words) {
            *value = value.wrapping_add(*word as i64);
        }
    }

    /// Those of some rows.
    pub fn rows(&self, rows: Range<usize>) -> &[i64] {
        &self.0.as_flattened()[rows]
    }

    /// As words of a message.
    pub fn words(&self) -> impl Iterator<Item = u64> + '_ {
        self.0.as_flattened().iter().map(|value| *value as u64)
    }
}

/// A length or volume as an integer of 2^−100 m or m³: any sum of what this program adds up is exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exact(i128);

impl Exact {
    /// The nearest.
    pub fn of(value: f64) -> Self {
        Self(libm::ldexp(value, 100) as i128)
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
        libm::ldexp(self.0 as f64, -100)
    }

    /// As words of a message.
    pub fn words(self) -> [u64; 2] {
        [self.0 as u64, (self.0 >> 64) as u64]
    }

    /// From words of a message.
    pub fn of_words(low: u64, high: u64) -> Self {
        Self(((u128::from(high) << 64) | u128::from(low)) as i128)
    }
}

/// Σ a b over the rows, eight partial sums in a fixed order.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut partial = [0.0; LANES];
    let (a_chunks, b_chunks) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = a_chunks.remainder().iter().zip(b_chunks.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_chunks.zip(b_chunks) {
        for lane in 0..LANES {
            partial[lane] += a[lane] * b[lane];
        }
    }
    let [a, b, c, d, e, f, g, h] = partial;
    ((a + b) + (c + d)) + ((e + f) + (g + h)) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_whole_quanta() {
        for bound in [1e-3, 1.0, 3.7e-9, 4e5] {
            let quantum = Quantum::of(bound, 1 << 13);
            for term in [0.0, bound, bound / 3.0, -bound / 7.0, quantum.value(), 0.4 * quantum.value()] {
                let quanta = ((quantum.anchor() + term).to_bits() as i64).wrapping_sub(quantum.anchor_bits());
                assert_eq!(quanta as f64, (term / quantum.value()).round_ties_even(), "{term} of {bound}");
                assert!(quanta.abs() <= 1 << 50);
                assert_eq!(Quantum::of(bound, 5 << 13).value(), 8.0 * quantum.value());
            }
        }
    }

    #[test]
    fn exact_sums_do_not_depend_on_order() {
        let terms = [1e-9, 3.3e-22, -1e-9, 7.25, 1e-15, -7.25];
        let sum = |terms: &mut dyn Iterator<Item = &f64>| {
            let mut sum = Exact::default();
            terms.for_each(|term| sum.add(Exact::of(*term)));
            sum
        };
        let (forward, backward) = (sum(&mut terms.iter()), sum(&mut terms.iter().rev()));
        assert_eq!(forward, backward);
        // The exact sum of the terms is 1e-15 + 3.3e-22.
        assert!((forward.value() / (1e-15 + 3.3e-22) - 1.0).abs() < 1e-14);
        assert_eq!(Exact::of_words(forward.words()[0], forward.words()[1]), forward);
        let mut negative = Exact::default();
        negative.subtract(forward);
        assert_eq!(Exact::of_words(negative.words()[0], negative.words()[1]), negative);
    }

    #[test]
    fn dot_products_are_those_of_the_definition() {
        let a: Vec<f64> = (0..21).map(f64::from).collect();
        // Closed form: Σ i² = n (n + 1) (2n + 1) / 6 for i up to 20.
        assert_eq!(dot(&a, &a), 20.0 * 21.0 * 41.0 / 6.0);
    }
}
