//! A few numbers side by side.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use crate::state::Base;

/// Cells that are worked on side by side; fixed, so that results do not depend on the machine.
pub(super) const LANES: usize = 8;

/// `count` rounded up to whole groups of lanes.
pub fn padded(count: usize) -> usize {
    count.next_multiple_of(LANES)
}

/// [`LANES`] numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes(pub [f64; LANES]);

/// [`LANES`] yes-or-no answers.
#[derive(Debug, Clone, Copy)]
pub struct Mask(pub [bool; LANES]);

impl Lanes {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// The numbers at the start of a slice; where it is shorter, `rest`.
    #[inline(always)]
    pub fn load(numbers: &[f64], rest: f64) -> Self {
        match numbers.first_chunk() {
            Some(lanes) => Self(*lanes),
            None => {
                let mut lanes = [rest; LANES];
                lanes[..numbers.len()].copy_from_slice(numbers);
                Self(lanes)
            }
        }
    }

    /// Puts the numbers at the start of a slice; those beyond its end are dropped.
    #[inline(always)]
    pub fn store(self, numbers: &mut [f64]) {
        match numbers.first_chunk_mut() {
            Some(lanes) => *lanes = self.0,
            None => {
                let count = numbers.len();
                numbers.copy_from_slice(&self.0[..count]);
            }
        }
    }

    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        let mut lanes = self.0;
        for lane in 0..LANES {
            lanes[lane] = operation(lanes[lane], other.0[lane]);
        }
        Self(lanes)
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
        let mut mask = [false; LANES];
        for lane in 0..LANES {
            mask[lane] = self.0[lane] > other.0[lane];
        }
        Mask(mask)
    }

    /// Adds the numbers to those at the start of a slice, which holds at least as many.
    #[inline(always)]
    pub fn add_to(self, sums: &mut [f64]) {
        (Self::load(sums, 0.0) + self).store(sums);
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
        Self([answer; LANES])
    }

    /// The first answer.
    #[cfg(test)]
    pub fn first(self) -> bool {
        self.0[0]
    }

    /// Where the base is resin; beyond the end of the bases it is not.
    #[inline(always)]
    pub fn resin(bases: &[Base]) -> Self {
        let mut padded = [Base::Primary; LANES];
        match bases.first_chunk::<LANES>() {
            Some(bases) => padded = *bases,
            None => padded[..bases.len()].copy_from_slice(bases),
        }
        Self(padded.map(|base| base == Base::None))
    }

    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(bool, bool) -> bool) -> Self {
        let mut lanes = self.0;
        for lane in 0..LANES {
            lanes[lane] = operation(lanes[lane], other.0[lane]);
        }
        Self(lanes)
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
        let mut lanes = no.0;
        for lane in 0..LANES {
            lanes[lane] = if self.0[lane] { yes.0[lane] } else { no.0[lane] };
        }
        Lanes(lanes)
    }
}
