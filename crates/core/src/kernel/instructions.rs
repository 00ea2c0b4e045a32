//! Which instruction set the kernels use.
//!
//! Every kernel is one body, compiled several times for wider vectors. A wider vector holds more cells and rounds none
//! differently, so the results are the same to the bit.

/// An instruction set that the kernels are compiled for and that this processor has; there is no value for another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InstructionSet(Width);

/// How much a kernel may ask of the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Width {
    /// What every processor of this architecture has.
    Baseline,
    /// x86-64 with AVX2.
    Avx2,
    /// x86-64 with AVX-512 F, VL, DQ and BW.
    Avx512,
}

impl Width {
    fn is_available(self) -> bool {
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
}

impl InstructionSet {
    /// What every processor of this architecture has.
    pub const BASELINE: Self = Self(Width::Baseline);

    /// Those that this processor has, the plainest first.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        [Width::Baseline, Width::Avx2, Width::Avx512].into_iter().filter(|width| width.is_available()).map(Self)
    }

    /// The widest that this processor has.
    pub fn best() -> Self {
        Self::available().next_back().unwrap_or(Self::BASELINE)
    }

    /// Name, as in a run file.
    pub fn name(self) -> &'static str {
        match self.0 {
            Width::Baseline => std::env::consts::ARCH,
            Width::Avx2 => "avx2",
            Width::Avx512 => "avx512",
        }
    }

    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "there is only one width"))]
    pub(super) fn width(self) -> Width {
        self.0
    }
}

/// Defines a kernel: `$name` runs the body `$body` compiled for an instruction set.
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
                match set.width() {
                    $crate::kernel::instructions::Width::Baseline => {}
                    #[allow(unsafe_code, reason = "a call of code for another instruction set")]
                    $crate::kernel::instructions::Width::Avx2 => {
                        // SAFETY: there is an instruction set of this width only where the processor has AVX2, and the
                        // function asks for nothing else.
                        return unsafe { avx2$(::<$($flag),*>)?($($argument),*) };
                    }
                    #[allow(unsafe_code, reason = "a call of code for another instruction set")]
                    $crate::kernel::instructions::Width::Avx512 => {
                        // SAFETY: there is an instruction set of this width only where the processor has these parts
                        // of AVX-512, and the function asks for nothing else.
                        return unsafe { avx512$(::<$($flag),*>)?($($argument),*) };
                    }
                }
            }
            $body$(::<$($flag),*>)?($($argument),*)
        }
    };
}
pub(super) use kernel;
