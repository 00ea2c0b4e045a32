//! Eight cells in several registers: AVX2, and SSE2, which every x86-64 processor has.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Mul, Not, Sub};

use super::{BYTES, Chunk, IntegerChunk, Integers, Lanes, Mask};

/// A call of an instruction of AVX2 or SSE2.
macro_rules! call {
    ($call:expr) => {{
        #[allow(unsafe_code, reason = "an instruction of AVX2 or SSE2")]
        // SAFETY: only kernels compiled for the instruction set use these types, and they run only where the processor
        // has it; what is read or written in memory lies within a chunk behind a reference.
        unsafe {
            $call
        }
    }};
}

/// Implements [`Lanes`] by registers of `$lanes` lanes each, from row `$from` on.
///
/// Every operation is written out for each register: a closure would be compiled without the instruction set.
macro_rules! split {
    (
        $name:ident, $mask:ident, $integers:ident: $count:literal registers [$($part:literal),*] of $lanes:literal lanes from $from:literal,
        halves $first_half:ty, $second_half:ty,
        floats $register:ident, words $words:ident,
        add $add:ident, sub $sub:ident, mul $mul:ident, min $min:ident, max $max:ident, below $below:ident, at_least $at_least:ident,
        and $and:ident, andnot $andnot:ident, or $or:ident, select $select:ident, movemask $movemask:ident,
        splat $splat:ident, load $load:ident, store $store:ident,
        to_words $to_words:ident, to_floats $to_floats:ident, splat_words $splat_words:ident, splat_32 $splat_32:ident, splat_byte $splat_byte:ident,
        equal_32 $equal_32:ident, add_words $add_words:ident, sub_words $sub_words:ident, and_words $and_words:ident,
        load_words $load_words:ident, store_words $store_words:ident, some_of $some_of:ident
    ) => {
        /// Eight numbers.
        #[derive(Clone, Copy)]
        pub struct $name([$register; $count]);

        /// Eight answers, each all ones or all zeros.
        #[derive(Clone, Copy)]
        pub struct $mask([$register; $count]);

        /// Eight integers.
        #[derive(Clone, Copy)]
        pub struct $integers([$words; $count]);

        split!(@operator $name, Add, add, $add, [$($part),*]);
        split!(@operator $name, Sub, sub, $sub, [$($part),*]);
        split!(@operator $name, Mul, mul, $mul, [$($part),*]);
        split!(@operator $mask, BitAnd, bitand, $and, [$($part),*]);
        split!(@operator $mask, BitOr, bitor, $or, [$($part),*]);

        impl Not for $mask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                let ones = call!($to_floats($splat_32(-1)));
                Self([$(call!($andnot(self.0[$part], ones))),*])
            }
        }

        impl Mask for $mask {
            #[inline(always)]
            fn any(self) -> bool {
                let either = call!($splat(0.0));
                $(let either = call!($or(either, self.0[$part]));)*
                call!($movemask(either)) != 0
            }

            #[inline(always)]
            fn byte(self) -> u8 {
                0 $(| (call!($movemask(self.0[$part])) as u8) << ($from + $part * $lanes))*
            }

            #[inline(always)]
            fn of_byte(byte: u8) -> Self {
                // One bit for each lane, in the lowest byte of both halves of its 64 bits.
                const BITS: [i32; 16] = [1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 32, 32, 64, 64, 128, 128];
                let byte = call!($splat_byte(byte));
                $mask([$({
                    let bits = call!($load_words(BITS[($from + $part * $lanes) * 2..][..$lanes * 2].as_ptr().cast()));
                    call!($to_floats($equal_32($and_words(byte, bits), bits)))
                }),*])
            }
        }

        impl Integers for $integers {
            type Mask = $mask;

            #[inline(always)]
            fn splat(value: i64) -> Self {
                Self([call!($splat_words(value)); $count])
            }

            #[inline(always)]
            fn load(chunk: &IntegerChunk) -> Self {
                Self([$(call!($load_words(chunk[$from + $part * $lanes..][..$lanes].as_ptr().cast()))),*])
            }

            #[inline(always)]
            fn store(self, chunk: &mut IntegerChunk) {
                $(call!($store_words(chunk[$from + $part * $lanes..][..$lanes].as_mut_ptr().cast(), self.0[$part]));)*
            }

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                Self([$(call!($add_words(self.0[$part], other.0[$part]))),*])
            }

            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                Self([$(call!($sub_words(self.0[$part], other.0[$part]))),*])
            }

            #[inline(always)]
            fn plus_where(self, mask: $mask, other: Self) -> Self {
                Self([$(call!($add_words(
                    self.0[$part],
                    $and_words($to_words(mask.0[$part]), other.0[$part])
                ))),*])
            }
        }

        impl Lanes for $name {
            const ROWS: u8 = (((1_u16 << ($count * $lanes)) - 1) << $from) as u8;
            type First = $first_half;
            type Second = $second_half;
            type Mask = $mask;
            type Integers = $integers;

            #[inline(always)]
            fn splat(value: f64) -> Self {
                Self([call!($splat(value)); $count])
            }

            #[inline(always)]
            fn load(chunk: &Chunk) -> Self {
                Self([$(call!($load(chunk.0[$from + $part * $lanes..][..$lanes].as_ptr()))),*])
            }

            #[inline(always)]
            fn store(self, chunk: &mut Chunk) {
                $(call!($store(chunk.0[$from + $part * $lanes..][..$lanes].as_mut_ptr(), self.0[$part]));)*
            }

            #[inline(always)]
            fn below(self, other: Self) -> $mask {
                $mask([$(call!($below(self.0[$part], other.0[$part]))),*])
            }

            #[inline(always)]
            fn at_least(self, other: Self) -> $mask {
                $mask([$(call!($at_least(self.0[$part], other.0[$part]))),*])
            }

            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                Self([$(call!($min(self.0[$part], other.0[$part]))),*])
            }

            #[inline(always)]
            fn greater(self, other: Self) -> Self {
                Self([$(call!($max(self.0[$part], other.0[$part]))),*])
            }

            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                Self([$(call!($select(no.0[$part], yes.0[$part], mask.0[$part]))),*])
            }

            #[inline(always)]
            fn only(self, mask: $mask) -> Self {
                Self([$(call!($and(self.0[$part], mask.0[$part]))),*])
            }

            #[inline(always)]
            fn bits(self) -> $integers {
                $integers([$(call!($to_words(self.0[$part]))),*])
            }

            #[inline(always)]
            fn some_of(bytes: &[u8; BYTES]) -> u32 {
                call!($some_of(bytes, Self::ROWS))
            }
        }
    };
    (@operator $kind:ident, $trait:ident, $method:ident, $instruction:ident, [$($part:literal),*]) => {
        impl $trait for $kind {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self([$(call!($instruction(self.0[$part], other.0[$part]))),*])
            }
        }
    };
}

/// Tells where a < b; AVX has one instruction for every comparison.
#[target_feature(enable = "avx2")]
#[inline]
fn below_avx2(a: __m256d, b: __m256d) -> __m256d {
    _mm256_cmp_pd::<_CMP_LT_OQ>(a, b)
}

/// Tells where a ≥ b.
#[target_feature(enable = "avx2")]
#[inline]
fn at_least_avx2(a: __m256d, b: __m256d) -> __m256d {
    _mm256_cmp_pd::<_CMP_GE_OQ>(a, b)
}

/// A byte in the lowest byte of every 32 bits at least: from memory, all bytes take the fewest instructions.
#[target_feature(enable = "avx2")]
#[inline]
fn splat_byte_avx2(byte: u8) -> __m256i {
    _mm256_set1_epi8(byte as i8)
}

/// A byte in the lowest byte of every 32 bits.
#[target_feature(enable = "sse2")]
#[inline]
fn splat_byte_sse2(byte: u8) -> __m128i {
    _mm_set1_epi32(i32::from(byte))
}

/// Tells which bytes have one of these bits set, the first byte lowest.
#[target_feature(enable = "avx2")]
#[inline]
fn some_of_avx2(bytes: &[u8; BYTES], rows: u8) -> u32 {
    let bytes = call!(_mm256_loadu_si256(bytes.as_ptr().cast()));
    let none = _mm256_cmpeq_epi8(_mm256_and_si256(bytes, _mm256_set1_epi8(rows as i8)), _mm256_setzero_si256());
    !_mm256_movemask_epi8(none) as u32
}

/// Tells which bytes have one of these bits set, the first byte lowest.
#[target_feature(enable = "sse2")]
#[inline]
fn some_of_sse2(bytes: &[u8; BYTES], rows: u8) -> u32 {
    let mut some = 0;
    let mut half = 0;
    while half < 2 {
        let bytes = call!(_mm_loadu_si128(bytes[half * 16..][..16].as_ptr().cast()));
        let none = _mm_cmpeq_epi8(_mm_and_si128(bytes, _mm_set1_epi8(rows as i8)), _mm_setzero_si128());
        some |= (!_mm_movemask_epi8(none) as u32 & 0xffff) << (half * 16);
        half += 1;
    }
    some
}

/// Selects by logical operations: SSE2 has no instruction for it.
#[target_feature(enable = "sse2")]
#[inline]
fn select_sse2(no: __m128d, yes: __m128d, mask: __m128d) -> __m128d {
    _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no))
}

/// Implements [`Lanes`] by instructions of AVX2.
macro_rules! split_avx2 {
    ($($kind:tt)*) => {
        split! {
            $($kind)*
            floats __m256d, words __m256i,
            add _mm256_add_pd, sub _mm256_sub_pd, mul _mm256_mul_pd, min _mm256_min_pd, max _mm256_max_pd, below below_avx2,
            at_least at_least_avx2,
            and _mm256_and_pd, andnot _mm256_andnot_pd, or _mm256_or_pd, select _mm256_blendv_pd, movemask _mm256_movemask_pd,
            splat _mm256_set1_pd, load _mm256_loadu_pd, store _mm256_storeu_pd,
            to_words _mm256_castpd_si256, to_floats _mm256_castsi256_pd, splat_words _mm256_set1_epi64x,
            splat_32 _mm256_set1_epi32, splat_byte splat_byte_avx2, equal_32 _mm256_cmpeq_epi32, add_words _mm256_add_epi64, sub_words _mm256_sub_epi64,
            and_words _mm256_and_si256, load_words _mm256_loadu_si256, store_words _mm256_storeu_si256,
            some_of some_of_avx2
        }
    };
}

split_avx2! { Avx2, Mask256, Integers256: 2 registers [0, 1] of 4 lanes from 0, halves Avx2First, Avx2Second, }
split_avx2! { Avx2First, Mask256First, Integers256First: 1 registers [0] of 4 lanes from 0, halves Self, Self, }
split_avx2! { Avx2Second, Mask256Second, Integers256Second: 1 registers [0] of 4 lanes from 4, halves Self, Self, }

split! {
    Sse2, Mask128, Integers128: 4 registers [0, 1, 2, 3] of 2 lanes from 0, halves Self, Self,
    floats __m128d, words __m128i,
    add _mm_add_pd, sub _mm_sub_pd, mul _mm_mul_pd, min _mm_min_pd, max _mm_max_pd, below _mm_cmplt_pd,
    at_least _mm_cmpge_pd,
    and _mm_and_pd, andnot _mm_andnot_pd, or _mm_or_pd, select select_sse2, movemask _mm_movemask_pd,
    splat _mm_set1_pd, load _mm_loadu_pd, store _mm_storeu_pd,
    to_words _mm_castpd_si128, to_floats _mm_castsi128_pd, splat_words _mm_set1_epi64x,
    splat_32 _mm_set1_epi32, splat_byte splat_byte_sse2, equal_32 _mm_cmpeq_epi32, add_words _mm_add_epi64, sub_words _mm_sub_epi64,
    and_words _mm_and_si128, load_words _mm_loadu_si128, store_words _mm_storeu_si128,
    some_of some_of_sse2
}
