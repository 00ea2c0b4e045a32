//! Eight cells at a time: what the kernels ask of a processor.
//!
//! The kernels are written once, in terms of `Lanes`; each implementation does the eight cells in as few instructions
//! as its instruction set allows. Every operation rounds as IEEE 754 says and touches no other lane, so all of them give
//! the same bits.

#[cfg(target_arch = "x86_64")]
mod split;
#[cfg(target_arch = "x86_64")]
mod whole;

use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Mul, Not, Sub};

#[cfg(target_arch = "x86_64")]
pub(crate) use split::{Avx2, Sse2};
#[cfg(target_arch = "x86_64")]
pub(crate) use whole::Avx512;

/// Rows of a strip, which the kernels do at a time.
pub const LANES: usize = 8;

/// Number of bytes in which a processor looks for set bits at a time.
pub const BYTES: usize = 32;

/// Eight numbers of one strip in one column.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Chunk(pub [f64; LANES]);

impl Chunk {
    /// Returns the chunk that the words of a message begin with, and the words behind it.
    pub fn of_words(words: &[u64]) -> (Self, &[u64]) {
        let (chunk, rest) = words.split_at(LANES);
        (Self(from_fn(|lane| f64::from_bits(chunk[lane]))), rest)
    }

    /// Has the chunk so many behind this one brought near the processor. Only a hint: there need not be one.
    #[inline(always)]
    pub fn fetch(&self, distance: isize) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
            let place = std::ptr::from_ref(self).wrapping_offset(distance);
            #[allow(unsafe_code, reason = "an instruction of SSE")]
            // SAFETY: every x86-64 processor has SSE, and a hint reads and writes nothing, wherever it points.
            unsafe {
                _mm_prefetch::<_MM_HINT_T1>(place.cast());
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = distance;
    }
}

/// Bytes of the second cache of this processor's cores; more than any field where that is not known.
pub fn second_cache() -> usize {
    #[cfg(target_arch = "x86_64")]
    {
        // KiB in the upper half, on processors of AMD and Intel.
        let kibibytes = std::arch::x86_64::__cpuid(0x8000_0006).ecx >> 16;
        if kibibytes > 0 {
            return kibibytes as usize * 1024;
        }
    }
    usize::MAX
}

/// Eight integers of one strip.
pub type IntegerChunk = [i64; LANES];

/// Mask that chooses some of eight cells.
pub(crate) trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Tells whether any cell is chosen.
    fn any(self) -> bool;
    /// Returns one bit for each cell, the first row lowest.
    fn byte(self) -> u8;
    /// Makes the mask of one bit for each cell.
    fn of_byte(byte: u8) -> Self;
}

/// Eight 64-bit integers, which wrap.
pub(crate) trait Integers: Copy {
    /// Mask for these integers.
    type Mask;
    /// Repeats a number eight times.
    fn splat(value: i64) -> Self;
    /// Loads the integers from memory.
    fn load(chunk: &IntegerChunk) -> Self;
    /// Stores the integers in memory.
    fn store(self, chunk: &mut IntegerChunk);
    /// Adds, and wraps.
    fn plus(self, other: Self) -> Self;
    /// Subtracts, and wraps.
    fn minus(self, other: Self) -> Self;
    /// Adds where the mask says so, and leaves the others as they are.
    fn plus_where(self, mask: Self::Mask, other: Self) -> Self;
}

/// Eight double-precision numbers.
pub(crate) trait Lanes: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Rows of a strip that these numbers belong to, one bit each.
    const ROWS: u8 = u8::MAX;
    /// First half of the numbers, the others being left alone, where two halves are two registers.
    type First: Lanes;
    /// Second half of the numbers.
    type Second: Lanes;
    /// Mask for these numbers.
    type Mask: Mask;
    /// Integers for the bits of these numbers.
    type Integers: Integers<Mask = Self::Mask>;
    /// Repeats a number eight times.
    fn splat(value: f64) -> Self;
    /// Loads the numbers from memory.
    fn load(chunk: &Chunk) -> Self;
    /// Stores the numbers in memory.
    fn store(self, chunk: &mut Chunk);
    /// Tells where self < other.
    fn below(self, other: Self) -> Self::Mask;
    /// Tells where self ≥ other.
    fn at_least(self, other: Self) -> Self::Mask;
    /// Lesser of each; `other` where they are equal.
    fn lesser(self, other: Self) -> Self;
    /// Greater of each; `other` where they are equal.
    fn greater(self, other: Self) -> Self;
    /// Selects `yes` where the mask says so, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Returns the bits as integers.
    fn bits(self) -> Self::Integers;
    /// Tells which of so many bytes, with a bit for each row, have one of these rows set, the first byte lowest.
    fn some_of(bytes: &[u8; BYTES]) -> u32;

    /// Returns the numbers as they lie in memory.
    #[inline(always)]
    fn chunk(self) -> Chunk {
        let mut chunk = Chunk([0.0; LANES]);
        self.store(&mut chunk);
        chunk
    }

    /// Adds where the mask says so, and leaves the others as they are.
    #[inline(always)]
    fn plus_where(self, mask: Self::Mask, other: Self) -> Self {
        Self::select(mask, self + other, self)
    }

    /// Keeps the numbers where the mask says so, and makes the others 0.
    #[inline(always)]
    fn only(self, mask: Self::Mask) -> Self {
        Self::select(mask, self, Self::splat(0.0))
    }
}

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
    type First = Self;
    type Second = Self;
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

    #[inline(always)]
    fn some_of(bytes: &[u8; BYTES]) -> u32 {
        bytes.iter().rev().fold(0, |some, byte| some << 1 | u32::from(*byte != 0))
    }
}
