//! Initial surfaces: from what a scene asks for to heights and bases of every cell.

mod detect;
mod error;
mod format;
pub mod hdf5;
mod image;
mod instrument;
mod load;
mod loaded;
mod measured;
pub mod npy;
mod options;
mod profiles;
mod read;
pub mod sdf;
mod stylus_profile;
mod text;
mod writing;
pub mod x3p;

pub use crate::delimited::Decimal;
pub use error::{FileError, SurfaceError};
pub use format::Format;
pub use hdf5::Hdf5Error;
pub use image::ImageError;
pub use instrument::Instrument;
pub use load::{load, load_with_patches, micrograph};
pub use loaded::{Loaded, Patches};
pub use measured::Measured;
pub use npy::NpyError;
pub use options::{Disagreement, ReadOptions};
pub use read::read;
pub use stylus_profile::{Lay, ProfileError, StylusProfile};
pub use text::TextError;
pub use writing::{WriteError, WriteOptions, write};
