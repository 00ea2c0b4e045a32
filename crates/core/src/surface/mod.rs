//! Initial surfaces: measured patches and their preparation, synthetic heights and fibre maps.

mod fibre;
mod patch;
mod prepare;
mod synthesis;

pub use fibre::FibreSynthesis;
pub use patch::Patch;
pub use prepare::{Level, Preparation};
pub use synthesis::HeightSynthesis;
