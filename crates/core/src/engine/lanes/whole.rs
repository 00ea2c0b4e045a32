//! Eight cells in one register: AVX-512.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Mul, Not, Sub};

use super::{BYTES, Chunk, IntegerChunk, Integers, Lanes, Mask};

/// A call of an instruction of AVX-512.
macro_rules! call {
    ($call:expr) => {{
        #[allow(unsafe_code, reason = "an instruction of AVX-512")]
        // SAFETY: only kernels compiled for AVX-512 use these types, and they run only where the processor has it; what
        // is read or written in memory is a whole chunk behind a reference.
        unsafe {
            $call
        }
    }};
}

/// Eight numbers.
#[derive(Clone, Copy)]
pub struct Avx512(__m512d);

/// Eight answers, one bit each.
#[derive(Clone, Copy)]
pub struct Mask512(__mmask8);

/// Eight integers.
#[derive(Clone, Copy)]
pub struct Integers512(__m512i);

macro_rules! operator {
    ($trait:ident, $method:ident, $instruction:ident) => {
        impl $trait for Avx512 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(call!($instruction(self.0, other.0)))
            }
        }
    };
}
operator!(Add, add, _mm512_add_pd);
operator!(Sub, sub, _mm512_sub_pd);
operator!(Mul, mul, _mm512_mul_pd);

impl BitAnd for Mask512 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Mask512 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Mask512 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Mask for Mask512 {
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }

    #[inline(always)]
    fn byte(self) -> u8 {
        self.0
    }

    #[inline(always)]
    fn of_byte(byte: u8) -> Self {
        Self(byte)
    }
}

impl Integers for Integers512 {
    type Mask = Mask512;

    #[inline(always)]
    fn splat(value: i64) -> Self {
        Self(call!(_mm512_set1_epi64(value)))
    }

    #[inline(always)]
    fn load(chunk: &IntegerChunk) -> Self {
        Self(call!(_mm512_loadu_si512(chunk.as_ptr().cast())))
    }

    #[inline(always)]
    fn store(self, chunk: &mut IntegerChunk) {
        call!(_mm512_storeu_si512(chunk.as_mut_ptr().cast(), self.0));
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(call!(_mm512_add_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(call!(_mm512_sub_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn plus_where(self, mask: Mask512, other: Self) -> Self {
        Self(call!(_mm512_mask_add_epi64(self.0, mask.0, self.0, other.0)))
    }
}

impl Lanes for Avx512 {
    type First = Self;
    type Second = Self;
    type Mask = Mask512;
    type Integers = Integers512;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(call!(_mm512_set1_pd(value)))
    }

    #[inline(always)]
    fn load(chunk: &Chunk) -> Self {
        Self(call!(_mm512_load_pd(chunk.0.as_ptr())))
    }

    #[inline(always)]
    fn store(self, chunk: &mut Chunk) {
        call!(_mm512_store_pd(chunk.0.as_mut_ptr(), self.0));
    }

    #[inline(always)]
    fn below(self, other: Self) -> Mask512 {
        Mask512(call!(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0)))
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> Mask512 {
        Mask512(call!(_mm512_cmp_pd_mask::<_CMP_GE_OQ>(self.0, other.0)))
    }

    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self(call!(_mm512_min_pd(self.0, other.0)))
    }

    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self(call!(_mm512_max_pd(self.0, other.0)))
    }

    #[inline(always)]
    fn select(mask: Mask512, yes: Self, no: Self) -> Self {
        Self(call!(_mm512_mask_blend_pd(mask.0, no.0, yes.0)))
    }

    #[inline(always)]
    fn bits(self) -> Integers512 {
        Integers512(call!(_mm512_castpd_si512(self.0)))
    }

    #[inline(always)]
    fn some_of(bytes: &[u8; BYTES]) -> u32 {
        call!({
            let bytes = _mm256_loadu_si256(bytes.as_ptr().cast());
            _mm256_test_epi8_mask(bytes, bytes)
        })
    }
}
