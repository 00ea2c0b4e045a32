//! Surfaces: measured patches and their preparation, synthetic heights, fibre maps, micrographs.

mod condition;
mod error;
mod extend;
mod fft;
mod fibre;
mod gaussian_filter;
mod heights;
pub mod implausible;
mod level;
pub mod micrograph;
mod missing;
mod patch;
mod prepare;
pub(crate) mod random;
mod resample;
mod rotate;
mod straighten;
mod synthesis;
mod unroll;

pub use condition::{Condition, Spikes};
pub use error::{PreparationError, SynthesisError};
pub use extend::Extension;
pub use fibre::{FibreError, FibreSynthesis, fibre_fraction, set_back_resin};
pub use heights::HeightParameters;
pub use level::{Level, level};
pub use missing::Fill;
pub use patch::{Body, Length, Patch};
pub use prepare::{Preparation, Prepared, RawHeights};
pub use straighten::{Crop, Flip};
pub use synthesis::{HeightSynthesis, Texture};
pub use unroll::Unroll;
