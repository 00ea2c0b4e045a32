//! Surfaces: measured patches and their preparation, synthetic heights, fibre maps, micrographs, and the parameters that
//! describe them.

mod base;
mod body;
pub mod describe;
mod fft;
mod fft2d;
mod fibre;
mod length;
mod level;
pub mod micrograph;
mod missing;
mod patch;
mod preparation_error;
mod prepare;
pub(crate) mod random;
mod resample;
mod synthesis;

pub use base::{fibre_fraction, set_back_resin};
pub use body::Body;
pub use fibre::{FibreError, FibreSynthesis};
pub use length::Length;
pub use level::{Level, level};
pub use missing::Fill;
pub use patch::Patch;
pub use preparation_error::PreparationError;
pub use prepare::{Preparation, Prepared, RawHeights};
pub use synthesis::{HeightSynthesis, SynthesisError, Texture};
