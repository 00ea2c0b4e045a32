//! What the terms of a sum are multiples of, so that it does not depend on their order.
//!
//! Every term is rounded to a multiple of a quantum, and the multiples are added as integers: so the sum of many workers
//! is that of one, whatever part of the cells each of them has.

use serde::{Deserialize, Serialize};

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
    /// A term is less than 2^50 quanta, so its rounding is at most 2^−51 of the bound; beyond 2^13 terms it is less of
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
        Self::of_exponent(exponent.saturating_add(1 + SPARE_BITS - room as i32), room)
    }

    fn of_exponent(exponent: i32, room: u32) -> Self {
        // Kept where 2^52 quanta are neither subnormal nor infinite.
        let exponent = exponent.clamp(-1000, 900);
        // 1.5 · 2^52, and the bit of the room if that is another.
        let anchor = ((3 << 51) | (1u64 << room)) as f64;
        Self { exponent, value: libm::ldexp(1.0, exponent), anchor: libm::ldexp(anchor, exponent), room }
    }

    /// A coarser one, for terms up to 2^`bits` times as large.
    pub fn coarser(self, bits: i32) -> Self {
        Self::of_exponent(self.exponent.saturating_add(bits), self.room)
    }

    /// The quantum.
    pub fn value(self) -> f64 {
        self.value
    }

    /// Some 1.5 · 2^52 quanta: a number whose last bit is worth one quantum, so that the bits of `anchor` + x, less those
    /// of `anchor`, are x in quanta.
    pub fn anchor(self) -> f64 {
        self.anchor
    }

    /// A term in quanta.
    pub fn count(self, term: f64) -> i64 {
        self.count_difference(term, 0.0)
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

    /// How large a number may be that is anchored beside a term.
    pub fn reach(self) -> f64 {
        libm::ldexp(1.0, self.exponent + 50)
    }

    /// Whether the sum of `terms` anchored terms up to `largest` leaves room for their number.
    pub fn holds(self, largest: f64, terms: usize) -> bool {
        largest * (terms as f64) < libm::ldexp(1.0, self.exponent + self.room as i32)
    }

    /// From the sum of the bits of anchored terms, none negative: how many they are, and what they add up to in quanta.
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
const SPARE_BITS: i32 = 3;

/// Bits below the number of up to `terms` terms.
fn room(terms: usize) -> u32 {
    MOST_ROOM - (terms + 1).div_ceil(1 << 13).next_power_of_two().trailing_zeros()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_whole_quanta() {
        for bound in [1e-3, 1.0, 3.7e-9, 4e5] {
            let quantum = Quantum::of(bound, (1 << 13) - 1);
            for term in [0.0, bound, bound / 3.0, -bound / 7.0, quantum.value(), 0.4 * quantum.value()] {
                let quanta = quantum.count(term);
                assert_eq!(quanta as f64, (term / quantum.value()).round_ties_even(), "{term} of {bound}");
                assert_eq!(quantum.nearest(term), quanta as f64 * quantum.value());
                assert!(quanta.abs() <= 1 << 50);
                assert_eq!(Quantum::of(bound, (4 << 13) + 1).value(), 8.0 * quantum.value());
            }
        }
    }

    #[test]
    fn sums_of_anchored_terms_split_into_their_number_and_their_sum() {
        for (bound, terms) in [(1.0, 161), (3e-7, 8191), (1e-12, 8192), (1e5, 1 << 16)] {
            let quantum = Quantum::of(bound, terms);
            // Terms that just leave room for their number.
            let largest = libm::ldexp(1.0, quantum.exponent + quantum.room as i32) / (terms + 1) as f64;
            assert!(quantum.holds(largest, terms) && !quantum.holds(2.0 * largest, terms));
            let mut sum = 0i64;
            let mut expected = 0;
            for number in 0..=terms {
                assert_eq!(quantum.split()(sum), (number as i64, expected), "{number} of {terms}");
                let term = largest * ((number * 7919 % 1000) as f64 / 1000.0);
                sum = sum.wrapping_add((quantum.anchor() + term).to_bits() as i64);
                expected += (term / quantum.value()).round_ties_even() as i64;
            }
            for largest in [largest, 64.0 * largest, 1e-3 * largest] {
                let fine = Quantum::of_sum(largest, terms);
                assert!(fine.holds(7.9 * largest, terms) && !fine.holds(16.1 * largest, terms));
            }
        }
    }
}
