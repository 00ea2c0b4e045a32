//! Initial surfaces: from what a scene asks for to heights and bases of every cell.

mod error;
mod files;
mod format;
pub mod hdf5;
mod image;
mod load;
mod measured;
pub mod npy;
pub mod sdf;
mod stored;
mod text;

pub use crate::delimited::Decimal;
pub use error::{Fault, FileError, Hdf5Error, SurfaceError, TextError};
pub use files::{WriteError, read, write};
pub use format::{Format, Instrument};
pub use image::ImageError;
pub use load::{Loaded, Patches, load, load_with_patches, micrograph, stated_pixel};
pub use measured::{Disagreement, Lay, Measured, ProfileError, ReadOptions};
pub use npy::NpyError;
