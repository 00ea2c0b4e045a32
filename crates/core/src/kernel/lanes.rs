//! A few numbers side by side.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use crate::state::Base;

/// Cells that are worked on side by side; fixed, so that results do not depend on the machine.
pub const LANES: usize = 8;

/// [`LANES`] numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes(pub [f64; LANES]);

/// [`LANES`] yes-or-no answers: all bits set or none, as vector comparisons give them.
#[derive(Debug, Clone, Copy)]
pub struct Mask([u64; LANES]);

const YES: u64 = u64::MAX;
const NO: u64 = 0;

impl Lanes {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|lane| operation(self.0[lane], other.0[lane])))
    }

    /// The larger of two numbers in every lane; neither is NaN.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    /// The smaller of two numbers in every lane; neither is NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    /// Where this is larger than the other.
    #[inline(always)]
    pub fn exceeds(self, other: Self) -> Mask {
        Mask(std::array::from_fn(|lane| if self.0[lane] > other.0[lane] { YES } else { NO }))
    }

    /// Adds the numbers to sums.
    #[inline(always)]
    pub fn add_to(self, sums: &mut [f64; LANES]) {
        *sums = (Self(*sums) + self).0;
    }

    /// The first number.
    #[cfg(test)]
    pub fn first(self) -> f64 {
        self.0[0]
    }

    /// Sum of all lanes, in one order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|number| -number))
    }
}

impl Mask {
    /// The same answer in every lane.
    #[inline(always)]
    pub fn splat(answer: bool) -> Self {
        Self([if answer { YES } else { NO }; LANES])
    }

    /// The first answer.
    #[cfg(test)]
    pub fn first(self) -> bool {
        self.0[0] == YES
    }

    /// Where the base is resin.
    #[inline(always)]
    pub fn resin(bases: &[Base; LANES]) -> Self {
        Self(bases.map(|base| if base == Base::None { YES } else { NO }))
    }

    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(u64, u64) -> u64) -> Self {
        Self(std::array::from_fn(|lane| operation(self.0[lane], other.0[lane])))
    }

    /// Both.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }

    /// Either.
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| a | b)
    }

    /// The opposite.
    #[inline(always)]
    #[expect(clippy::should_implement_trait, reason = "a mask is no boolean, and the other words read alike")]
    pub fn not(self) -> Self {
        Self(self.0.map(|answer| !answer))
    }

    /// The first but not the second.
    #[inline(always)]
    pub fn and_not(self, other: Self) -> Self {
        self.zip(other, |a, b| a & !b)
    }

    /// `yes` where this holds, else `no`.
    #[inline(always)]
    pub fn select(self, yes: Lanes, no: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|lane| {
            f64::from_bits((self.0[lane] & yes.0[lane].to_bits()) | (!self.0[lane] & no.0[lane].to_bits()))
        }))
    }
}
