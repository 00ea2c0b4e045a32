//! Surfaces: measured patches and their preparation, synthetic heights, fibre maps, micrographs, and the parameters that
//! describe them.

mod body;
pub mod describe;
mod fft;
mod fibre;
mod fill;
mod length;
mod level;
pub mod micrograph;
mod outliers;
mod patch;
mod preparation_error;
mod prepare;
pub(crate) mod random;
mod resample;
mod synthesis;

pub use body::Body;
pub use fibre::{FibreError, FibreSynthesis, fibre_fraction};
pub use fill::Fill;
pub use length::Length;
pub use level::{Level, level};
pub use patch::Patch;
pub use preparation_error::PreparationError;
pub use prepare::{Preparation, Prepared, RawHeights};
pub use synthesis::{HeightSynthesis, SynthesisError, Texture};
