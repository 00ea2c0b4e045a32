//! Eight cells at a time: what the kernels ask of a processor.
//!
//! The kernels are written once, in terms of `Lanes`; each implementation does the eight cells in as few instructions
//! as its instruction set allows. Every operation rounds as IEEE 754 says and touches no other lane, so all of them give
//! the same bits.

mod portable;
#[cfg(target_arch = "x86_64")]
mod split;
#[cfg(target_arch = "x86_64")]
mod whole;

use std::ops::{Add, BitAnd, BitOr, Mul, Not, Sub};

pub(crate) use portable::Portable;
#[cfg(target_arch = "x86_64")]
pub(crate) use split::{Avx2, Sse2};
#[cfg(target_arch = "x86_64")]
pub(crate) use whole::Avx512;

/// Rows of a strip, which the kernels do at a time.
pub const LANES: usize = 8;

/// Eight numbers of one strip in one column.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Chunk(pub [f64; LANES]);

/// Eight integers of one strip.
pub type IntegerChunk = [i64; LANES];

/// Which of eight cells are meant.
pub(crate) trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether any is.
    fn any(self) -> bool;
    /// One bit for each, the first row lowest.
    fn byte(self) -> u8;
    /// From one bit for each.
    fn of_byte(byte: u8) -> Self;
}

/// Eight 64-bit integers, which wrap.
pub(crate) trait Integers: Copy {
    /// What goes with which of them.
    type Mask;
    /// The same number eight times.
    fn splat(value: i64) -> Self;
    /// From memory.
    fn load(chunk: &IntegerChunk) -> Self;
    /// To memory.
    fn store(self, chunk: &mut IntegerChunk);
    /// Sums.
    fn plus(self, other: Self) -> Self;
    /// Differences.
    fn minus(self, other: Self) -> Self;
    /// Sums where the mask says so, else as they are.
    fn plus_where(self, mask: Self::Mask, other: Self) -> Self;
}

/// Eight double-precision numbers.
pub(crate) trait Lanes: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Which of them are meant.
    type Mask: Mask;
    /// Their bits.
    type Integers: Integers<Mask = Self::Mask>;
    /// The same number eight times.
    fn splat(value: f64) -> Self;
    /// From memory.
    fn load(chunk: &Chunk) -> Self;
    /// To memory.
    fn store(self, chunk: &mut Chunk);
    /// self < other.
    fn below(self, other: Self) -> Self::Mask;
    /// self ≥ other.
    fn at_least(self, other: Self) -> Self::Mask;
    /// The lesser of each; `other` where they are equal.
    fn lesser(self, other: Self) -> Self;
    /// The greater of each; `other` where they are equal.
    fn greater(self, other: Self) -> Self;
    /// `yes` where the mask says so, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Their bits as integers.
    fn bits(self) -> Self::Integers;

    /// Sums where the mask says so, else as they are.
    #[inline(always)]
    fn plus_where(self, mask: Self::Mask, other: Self) -> Self {
        Self::select(mask, self + other, self)
    }

    /// As they are where the mask says so, else 0.
    #[inline(always)]
    fn only(self, mask: Self::Mask) -> Self {
        Self::select(mask, self, Self::splat(0.0))
    }
}
