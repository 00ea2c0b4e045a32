//! Initial surfaces: measured patches and their preparation, synthetic heights and fibre maps.

mod patch;

pub use patch::Patch;
