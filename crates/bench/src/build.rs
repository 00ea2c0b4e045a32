//! What the benchmarks were built from, with and how.

use serde::{Deserialize, Serialize};

/// A build of this program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Build {
    /// Version of Plateau.
    pub version: String,
    /// Revision of the source; `-modified` where the source differed from it.
    pub revision: String,
    /// Compiler and its version.
    pub compiler: String,
    /// Profile, `release` or `debug`.
    pub profile: String,
    /// Level of optimization.
    pub optimization: String,
    /// What it was built for.
    pub target: String,
    /// Flags of the compiler beside those of the profile.
    pub flags: String,
}

impl Build {
    /// This build.
    pub fn this() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            revision: env!("BENCH_REVISION").into(),
            compiler: env!("BENCH_COMPILER").into(),
            profile: env!("BENCH_PROFILE").into(),
            optimization: env!("BENCH_OPTIMIZATION").into(),
            target: env!("BENCH_TARGET").into(),
            flags: env!("BENCH_FLAGS").into(),
        }
    }
}
