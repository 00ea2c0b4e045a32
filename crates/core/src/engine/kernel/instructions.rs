//! Instruction sets of the kernels.
//!
//! Every kernel is one body, compiled several times for wider vectors. A wider vector holds more cells and rounds none
//! differently, so the results are the same to the bit.

/// An instruction set that the kernels are compiled for and that this processor has; there is no value for another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InstructionSet(Width);

/// Instructions that a kernel may ask of the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Width {
    /// Instructions that the compiler chooses for arrays, on any architecture.
    Portable,
    /// SSE2, which every x86-64 processor has.
    #[cfg(target_arch = "x86_64")]
    Sse2,
    /// x86-64 with AVX2, BMI1 and POPCNT.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// x86-64 with these and AVX-512 F, VL, DQ and BW.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Width {
    const ALL: &[Self] = &[
        Self::Portable,
        #[cfg(target_arch = "x86_64")]
        Self::Sse2,
        #[cfg(target_arch = "x86_64")]
        Self::Avx2,
        #[cfg(target_arch = "x86_64")]
        Self::Avx512,
    ];

    fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => {
                is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("bmi1")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
        }
    }
}

impl InstructionSet {
    /// Instruction set that any processor has.
    pub const PORTABLE: Self = Self(Width::Portable);

    /// Instruction sets that this processor has, the plainest first.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        Width::ALL.iter().copied().filter(|width| width.is_available()).map(Self)
    }

    /// Widest instruction set that this processor has.
    pub fn best() -> Self {
        Self::available().next_back().unwrap_or(Self::PORTABLE)
    }

    /// Name, as on the command line and in a run file.
    pub fn name(self) -> &'static str {
        match self.0 {
            Width::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Width::Sse2 => "sse2",
            #[cfg(target_arch = "x86_64")]
            Width::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Width::Avx512 => "avx512",
        }
    }

    pub(super) fn width(self) -> Width {
        self.0
    }
}

/// Defines a kernel: `$name` runs the body `$body` compiled for an instruction set.
macro_rules! kernel {
    (
        $(#[$attribute:meta])*
        pub fn $name:ident<$(const $flag:ident: $type:ty),*>($($argument:ident: $kind:ty),* $(,)?) = $body:ident
    ) => {
        $(#[$attribute])*
        #[allow(clippy::too_many_arguments, reason = "the body's own")]
        pub fn $name<$(const $flag: $type),*>(set: $crate::engine::kernel::InstructionSet, $($argument: $kind),*) {
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2,bmi1,popcnt")]
            #[allow(clippy::too_many_arguments, reason = "the body's own")]
            fn avx2<$(const $flag: $type),*>($($argument: $kind),*) {
                $body::<$crate::engine::lanes::Avx2, $($flag),*>($($argument),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,bmi1,popcnt")]
            #[allow(clippy::too_many_arguments, reason = "the body's own")]
            fn avx512<$(const $flag: $type),*>($($argument: $kind),*) {
                $body::<$crate::engine::lanes::Avx512, $($flag),*>($($argument),*)
            }
            match set.width() {
                $crate::engine::kernel::instructions::Width::Portable => {
                    $body::<$crate::engine::lanes::Portable, $($flag),*>($($argument),*)
                }
                #[cfg(target_arch = "x86_64")]
                $crate::engine::kernel::instructions::Width::Sse2 => {
                    $body::<$crate::engine::lanes::Sse2, $($flag),*>($($argument),*)
                }
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code, reason = "a call of code for another instruction set")]
                // SAFETY: there is an instruction set of this width only where the processor has AVX2, BMI1 and
                // POPCNT, and the function asks for nothing else.
                $crate::engine::kernel::instructions::Width::Avx2 => unsafe { avx2::<$($flag),*>($($argument),*) },
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code, reason = "a call of code for another instruction set")]
                // SAFETY: there is an instruction set of this width only where the processor has these parts of
                // AVX-512, BMI1 and POPCNT, and the function asks for nothing else.
                $crate::engine::kernel::instructions::Width::Avx512 => unsafe { avx512::<$($flag),*>($($argument),*) },
            }
        }
    };
}
pub(super) use kernel;

/// Picks the instance of a function that does what a scene in which plateaus form needs and nothing else.
macro_rules! with_build_up {
    ($needs:expr, $function:ident $(, $flag:literal)?) => {
        match ($needs.build_up(), $needs.disc_wears) {
            (build_up::DISTINCT, false) => $function::<{ build_up::DISTINCT }, false $(, $flag)?>,
            (build_up::DISTINCT, true) => $function::<{ build_up::DISTINCT }, true $(, $flag)?>,
            (build_up::BRITTLE, false) => $function::<{ build_up::BRITTLE }, false $(, $flag)?>,
            (build_up::BRITTLE, true) => $function::<{ build_up::BRITTLE }, true $(, $flag)?>,
            (_, false) => $function::<{ build_up::ALIKE }, false $(, $flag)?>,
            (_, true) => $function::<{ build_up::ALIKE }, true $(, $flag)?>,
        }
    };
}
pub(super) use with_build_up;
