//! Surfaces: measured patches and their preparation, synthetic heights, fibre maps, micrographs, and the parameters that
//! describe them.

mod base;
mod body;
mod coverage;
mod crop;
pub mod describe;
mod extend;
mod fft;
mod fft_lines;
mod fibre;
mod flip;
mod gaussian_filter;
mod interpolation;
mod length;
mod level;
pub mod micrograph;
mod mirrored;
mod missing;
mod patch;
mod preparation_error;
mod prepare;
pub(crate) mod random;
mod report;
mod resample;
mod rotate;
mod slope_outliers;
mod spikes;
mod straighten;
mod synthesis;
mod unroll;
mod warnings;

pub use base::{fibre_fraction, set_back_resin};
pub use body::Body;
pub use crop::Crop;
pub use extend::Extension;
pub use fibre::{FibreError, FibreSynthesis};
pub use flip::Flip;
pub use length::Length;
pub use level::{Level, level};
pub use missing::Fill;
pub use patch::Patch;
pub use preparation_error::PreparationError;
pub use prepare::{Preparation, Prepared, RawHeights};
pub use spikes::Spikes;
pub use synthesis::{HeightSynthesis, SynthesisError, Texture};
pub use unroll::Unroll;
