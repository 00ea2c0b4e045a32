//! Which instruction set the kernels use.
//!
//! Every kernel is one body, compiled several times for wider vectors. A wider vector holds more cells and rounds none
//! differently, so the results are the same to the bit.

/// An instruction set that the kernels are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InstructionSet {
    /// What every processor of this architecture has.
    Baseline,
    /// x86-64 with AVX2.
    Avx2,
    /// x86-64 with AVX-512 F, VL, DQ and BW.
    Avx512,
}

impl InstructionSet {
    /// Every instruction set, the plainest first.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// The widest that this processor has.
    pub fn best() -> Self {
        Self::ALL.into_iter().rev().find(|set| set.is_available()).unwrap_or(Self::Baseline)
    }

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// Name, as in a run file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => std::env::consts::ARCH,
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// Defines a kernel: `$name` runs the body `$body` compiled for an instruction set.
///
/// # Panics
/// The function made panics when the processor does not have the instruction set.
macro_rules! kernel {
    (
        $(#[$attribute:meta])*
        pub fn $name:ident$(<$(const $flag:ident),*>)?($($argument:ident: $kind:ty),* $(,)?) = $body:ident
    ) => {
        $(#[$attribute])*
        #[inline]
        pub fn $name$(<$(const $flag: bool),*>)?(set: $crate::kernel::InstructionSet, $($argument: $kind),*) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2$(<$(const $flag: bool),*>)?($($argument: $kind),*) {
                    $body$(::<$($flag),*>)?($($argument),*)
                }
                #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
                fn avx512$(<$(const $flag: bool),*>)?($($argument: $kind),*) {
                    $body$(::<$($flag),*>)?($($argument),*)
                }
                match set {
                    $crate::kernel::InstructionSet::Baseline => {}
                    #[allow(unsafe_code, reason = "a call of code for another instruction set")]
                    $crate::kernel::InstructionSet::Avx2 => {
                        assert!(set.is_available());
                        // SAFETY: the processor has AVX2, as just asserted; the function asks for nothing else.
                        return unsafe { avx2$(::<$($flag),*>)?($($argument),*) };
                    }
                    #[allow(unsafe_code, reason = "a call of code for another instruction set")]
                    $crate::kernel::InstructionSet::Avx512 => {
                        assert!(set.is_available());
                        // SAFETY: the processor has these parts of AVX-512, as just asserted; the function asks for
                        // nothing else.
                        return unsafe { avx512$(::<$($flag),*>)?($($argument),*) };
                    }
                }
            }
            $body$(::<$($flag),*>)?($($argument),*)
        }
    };
}
pub(super) use kernel;
