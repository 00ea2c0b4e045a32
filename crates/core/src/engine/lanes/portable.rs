//! Eight cells on any processor: arrays that the compiler makes vectors of where it can.

use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Mul, Not, Sub};

use super::{Chunk, IntegerChunk, Integers, LANES, Lanes, Mask};

/// Eight numbers.
#[derive(Clone, Copy)]
pub struct Portable([f64; LANES]);

/// Eight answers.
#[derive(Clone, Copy)]
pub struct Answers([bool; LANES]);

/// Eight integers.
#[derive(Clone, Copy)]
pub struct Words([i64; LANES]);

macro_rules! lane_by_lane {
    ($kind:ident, $trait:ident, $method:ident, $operator:tt) => {
        impl $trait for $kind {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|lane| self.0[lane] $operator other.0[lane]))
            }
        }
    };
}
lane_by_lane!(Portable, Add, add, +);
lane_by_lane!(Portable, Sub, sub, -);
lane_by_lane!(Portable, Mul, mul, *);
lane_by_lane!(Answers, BitAnd, bitand, &);
lane_by_lane!(Answers, BitOr, bitor, |);

impl Not for Answers {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|answer| !answer))
    }
}

impl Mask for Answers {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.into_iter().any(|answer| answer)
    }

    #[inline(always)]
    fn byte(self) -> u8 {
        self.0.into_iter().enumerate().fold(0, |byte, (lane, answer)| byte | u8::from(answer) << lane)
    }

    #[inline(always)]
    fn of_byte(byte: u8) -> Self {
        Self(from_fn(|lane| byte >> lane & 1 == 1))
    }
}

impl Integers for Words {
    type Mask = Answers;

    #[inline(always)]
    fn splat(value: i64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(chunk: &IntegerChunk) -> Self {
        Self(*chunk)
    }

    #[inline(always)]
    fn store(self, chunk: &mut IntegerChunk) {
        *chunk = self.0;
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane].wrapping_add(other.0[lane])))
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane].wrapping_sub(other.0[lane])))
    }

    #[inline(always)]
    fn plus_where(self, mask: Answers, other: Self) -> Self {
        Self(from_fn(|lane| if mask.0[lane] { self.0[lane].wrapping_add(other.0[lane]) } else { self.0[lane] }))
    }
}

impl Lanes for Portable {
    type Mask = Answers;
    type Integers = Words;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(chunk: &Chunk) -> Self {
        Self(chunk.0)
    }

    #[inline(always)]
    fn store(self, chunk: &mut Chunk) {
        chunk.0 = self.0;
    }

    #[inline(always)]
    fn below(self, other: Self) -> Answers {
        Answers(from_fn(|lane| self.0[lane] < other.0[lane]))
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> Answers {
        Answers(from_fn(|lane| self.0[lane] >= other.0[lane]))
    }

    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self::select(self.below(other), self, other)
    }

    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self::select(other.below(self), self, other)
    }

    #[inline(always)]
    fn select(mask: Answers, yes: Self, no: Self) -> Self {
        Self(from_fn(|lane| if mask.0[lane] { yes.0[lane] } else { no.0[lane] }))
    }

    #[inline(always)]
    fn bits(self) -> Words {
        Words(self.0.map(|value| value.to_bits() as i64))
    }
}
