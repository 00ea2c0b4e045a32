//! Generations of the numbers that this program computes: what tells results that it would compute again, to the bit, from results
//! of an earlier state of the model, the engine or what reads surfaces.
//!
//! Results of studies are known by the generation, not by the version or the revision of the program, so most changes of
//! the program cost no run. Whoever changes a number that a run can have adds a line to [`GENERATIONS`]; `generations` in `crates/run/tests`
//! fails until that is done.

/// A state of the program as far as numbers of runs go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Generation {
    /// Reason why numbers differ from those of the generation before.
    pub reason: &'static str,
    /// SHA-256 of the results of the scenes of that test, 64 hexadecimal digits; the same on every machine.
    pub results: &'static str,
}

/// All generations, the oldest first. The last one is that of this program.
pub const GENERATIONS: &[Generation] = &[
    Generation {
        reason: "the first that is counted; results of before were known by the revision of the program",
        results: "e170421dc7db265dbe1688c3ba7acddcb5d0f6cee5899a11ddd955b97737d9d7",
    },
    Generation {
        reason: "in a cycle, the time before the first step is no time in contact",
        results: "af1543541e0b7cba58f630f643838c91f5de1c292a0a75b63d853314d01598ae",
    },
    Generation {
        reason: "pauses cool at the mean speed of the disc, and pooled debris is computed by the plain model",
        results: "4ab752198c78208fe29ddf81fdf8e8c00e8475cf5dedb75cc0ef65fc821b5a83",
    },
];

/// Number of the generation of this program, from 1.
pub fn current() -> u32 {
    GENERATIONS.len() as u32
}
