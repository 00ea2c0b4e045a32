//! Sums that do not depend on the order of their terms: they are sums of integers.
//!
//! Every term is rounded to a multiple of a quantum, and the multiples are added as integers: so the sum of many workers
//! is that of one, whatever part of the cells each of them has.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::engine::lanes::{IntegerChunk, LANES};

/// A power of two of which terms are multiples.
///
/// Terms are counted by adding them to an anchor, a number whose last bit is worth one quantum. Sums of the bits of such
/// anchored terms hold both how many terms there are and what they add up to, see [`Quantum::split`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct Quantum {
    exponent: i32,
    value: f64,
    anchor: f64,
    /// The lowest bit of the anchor that is set: sums below it do not mix with the number of their terms.
    room: u32,
}

/// A quantum as it is read, which may be anything.
#[derive(Deserialize)]
struct Stored {
    exponent: i32,
    value: f64,
    anchor: f64,
    room: u32,
}

impl TryFrom<Stored> for Quantum {
    type Error = &'static str;

    fn try_from(Stored { exponent, value, anchor, room }: Stored) -> Result<Self, Self::Error> {
        let found = Self { exponent, value, anchor, room };
        let is_one = (1..=MOST_ROOM).contains(&room) && found == Self::of_exponent(exponent, room);
        if is_one { Ok(found) } else { Err("the quantum of sums is none") }
    }
}

impl Quantum {
    /// The quantum of up to `terms` terms up to `bound`: their sum fits an integer.
    ///
    /// A term is less than 2^50 quanta, so its rounding is at most 2^−50 of the bound; beyond 2^13 terms it is less of
    /// them and more rounding.
    pub fn of(bound: f64, terms: usize) -> Self {
        let exponent = if bound > 0.0 { libm::ilogb(bound) } else { 0 };
        let room = room(terms);
        Self::of_exponent(exponent.saturating_add(2 - room as i32), room)
    }

    /// The finest quantum at which the sum of `terms` anchored terms up to `largest`, and some times as large, leaves room
    /// for their number: see [`Quantum::split`].
    pub fn of_sum(largest: f64, terms: usize) -> Self {
        let sum = largest * terms as f64;
        let exponent = if sum > 0.0 { libm::ilogb(sum) } else { 0 };
        let room = room(terms);
        Self::of_exponent(exponent.saturating_add(1 + SPARE_BITS_OF_A_STEP - room as i32), room)
    }

    fn of_exponent(exponent: i32, room: u32) -> Self {
        // Kept where 2^52 quanta are neither subnormal nor infinite.
        let exponent = exponent.clamp(-1000, 900);
        // 1.5 · 2^52, and the bit of the room if that is another.
        let anchor = ((3 << 51) | (1u64 << room)) as f64;
        Self { exponent, value: libm::ldexp(1.0, exponent), anchor: libm::ldexp(anchor, exponent), room }
    }

    /// Coarser quantum, for terms up to 2^`bits` times as large.
    pub fn coarser(self, bits: i32) -> Self {
        Self::of_exponent(self.exponent.saturating_add(bits), self.room)
    }

    /// Value of the quantum, in the unit of the terms.
    pub fn value(self) -> f64 {
        self.value
    }

    /// Anchor of some 1.5 · 2^52 quanta: its last bit is worth one quantum, so that the bits of `anchor` + x, less those
    /// of `anchor`, are x in quanta.
    pub fn anchor(self) -> f64 {
        self.anchor
    }

    /// The difference to a multiple of the quantum, in quanta, with one rounding.
    pub fn count_difference(self, multiple: f64, other: f64) -> i64 {
        let anchored = (self.anchor + multiple) - other;
        (anchored.to_bits() as i64).wrapping_sub(self.anchor.to_bits() as i64)
    }

    /// The nearest multiple of the quantum, of a number within [`Quantum::reach`].
    pub fn nearest(self, number: f64) -> f64 {
        (self.anchor + number) - self.anchor
    }

    /// Largest number that may be anchored beside a term.
    pub fn reach(self) -> f64 {
        libm::ldexp(1.0, self.exponent + 50)
    }

    /// Tells whether the sum of `terms` anchored terms up to `largest` leaves room for their number.
    pub fn holds(self, largest: f64, terms: usize) -> bool {
        largest * (terms as f64) < libm::ldexp(1.0, self.exponent + self.room as i32)
    }

    /// Returns a function that splits the sum of the bits of anchored terms, none negative, into their number and their sum in quanta.
    pub fn split(self) -> impl Fn(i64) -> (i64, i64) {
        // The bits of the anchor are an odd number times 2^room. Its inverse tells from the upper bits of the sum, which
        // what is added up does not reach, how often it was added.
        let bits = self.anchor.to_bits();
        let odd = bits >> self.room;
        let inverse = (0..5).fold(odd, |inverse, _| inverse.wrapping_mul(2u64.wrapping_sub(odd.wrapping_mul(inverse))));
        let (room, upper) = (self.room, u64::MAX >> self.room);
        move |sum| {
            let count = (sum as u64 >> room).wrapping_mul(inverse) & upper;
            (count as i64, (sum as u64).wrapping_sub(count.wrapping_mul(bits)) as i64)
        }
    }
}

/// The room of the fewest terms.
const MOST_ROOM: u32 = 51;
/// Bits by which sums may grow from one step to the next and still leave room.
const SPARE_BITS_OF_A_STEP: i32 = 3;

/// Bits below the number of up to `terms` terms.
fn room(terms: usize) -> u32 {
    MOST_ROOM - (terms + 1).div_ceil(1 << 13).next_power_of_two().trailing_zeros()
}

/// An integer for every row, in chunks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowIntegers(pub Vec<IntegerChunk>);

impl RowIntegers {
    /// Creates integers of so many strips, all 0.
    pub fn new(strips: usize) -> Self {
        Self(vec![[0; LANES]; strips])
    }

    /// Sets all of them to 0 again.
    pub fn clear(&mut self) {
        self.0.fill([0; LANES]);
    }

    /// Integers of some rows.
    pub fn rows(&self, rows: Range<usize>) -> &[i64] {
        &self.0.as_flattened()[rows]
    }
}

/// A power of two: areas, volumes or loads that are multiples of it add up exactly, in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    exponent: i32,
}

/// Bits by which sums may grow beyond what a scene has at its start.
const SPARE_BITS: i32 = 12;
/// Bits of the largest size of a sum.
const BITS: i32 = 126;

impl Unit {
    /// Unit of 2^`finest`, or of what is so much coarser that a sum may be 2^12 times as large as `size`.
    pub fn new(finest: i32, size: f64) -> Self {
        let needed = if size > 0.0 { libm::ilogb(size).saturating_add(1 + SPARE_BITS - BITS) } else { finest };
        // 2^126 of the coarsest is still a number.
        Self { exponent: needed.clamp(finest, 800) }
    }

    /// Cuts a value to the last whole unit.
    #[inline]
    pub fn exact(self, value: f64) -> ExactSum {
        // Mantissa and exponent: a conversion of the product would be a call of a routine.
        let bits = value.abs().to_bits();
        let exponent = (bits >> 52) as i32;
        let mantissa = i128::from((bits & ((1 << 52) - 1)) | u64::from(exponent > 0) << 52);
        let shift = exponent.max(1) - 1075 - self.exponent;
        if shift > BITS - 52 && mantissa > 0 {
            return ExactSum::OUT_OF_RANGE;
        }
        let size = if shift >= 0 { mantissa << shift.min(BITS) } else { mantissa >> (-shift).min(BITS) };
        ExactSum(if value < 0.0 { -size } else { size })
    }

    /// The double-precision number nearest to a sum; infinite where that is out of range.
    pub fn value(self, sum: ExactSum) -> f64 {
        if sum == ExactSum::OUT_OF_RANGE { f64::INFINITY } else { libm::ldexp(float(sum.0), self.exponent) }
    }
}

/// A sum of whole [`Unit`]s. One that has left its range stays out of it, and is infinite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ExactSum(i128);

impl ExactSum {
    const OUT_OF_RANGE: Self = Self(i128::MIN);

    /// Adds another sum.
    pub fn add(&mut self, other: Self) {
        *self = self.with(other, i128::checked_add);
    }

    /// Subtracts another sum.
    pub fn subtract(&mut self, other: Self) {
        *self = self.with(other, i128::checked_sub);
    }

    fn with(self, other: Self, operation: fn(i128, i128) -> Option<i128>) -> Self {
        if self == Self::OUT_OF_RANGE || other == Self::OUT_OF_RANGE {
            return Self::OUT_OF_RANGE;
        }
        operation(self.0, other.0).map_or(Self::OUT_OF_RANGE, Self)
    }

    /// Number of whole units.
    pub fn integer(self) -> i128 {
        self.0
    }

    /// Returns the sum of so many whole units.
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

    /// Sum Σ weight · count over some rows, in units.
    pub fn sum(&self, rows: Range<usize>, counts: &[i64]) -> i128 {
        let weights = self.rows(rows);
        let counts = &counts[..weights.len()];
        (0..weights.len()).map(|row| product(weights[row], counts[row])).sum()
    }

    /// Value of one unit.
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

/// Product weight · count.
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
#[path = "../../tests/unit/engine/exact.rs"]
mod tests;
