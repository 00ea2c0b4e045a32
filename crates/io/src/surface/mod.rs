//! Initial surfaces: from what a scene asks for to heights and bases of every cell.

mod error;
mod format;
pub mod hdf5;
mod image;
mod load;
mod measured;
pub mod npy;
mod options;
mod read;
pub mod sdf;
mod stored;
mod text;
mod writing;

pub use crate::delimited::Decimal;
pub use error::{FileError, SurfaceError};
pub use format::{Format, Instrument};
pub use hdf5::Hdf5Error;
pub use image::ImageError;
pub use load::{Loaded, Patches, load, load_with_patches, micrograph};
pub use measured::Measured;
pub use npy::NpyError;
pub use options::{Disagreement, Lay, ProfileError, ReadOptions, StylusProfile};
pub use read::read;
pub use text::TextError;
pub use writing::{WriteError, write};
