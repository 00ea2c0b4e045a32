//! `plateau sweep`: studies of many runs.

pub mod collect;
pub mod plan;
pub mod run;
