//! Initial surfaces: from what a scene asks for to heights and bases of every cell.

mod error;
mod format;
pub mod hdf5;
mod image;
mod inputs;
mod instrument;
mod limits;
mod load;
mod measured;
pub mod npy;
mod profiles;
pub mod sdf;
mod stated;
mod text;
mod writing;
pub mod x3p;

pub use error::{FileError, SurfaceError};
pub use format::Format;
pub use hdf5::Hdf5Error;
pub use image::ImageError;
pub use instrument::Instrument;
pub use load::{Loaded, load, micrograph};
pub use measured::{Measured, ReadOptions, read};
pub use npy::NpyError;
pub use stated::Disagreement;
pub use text::TextError;
pub use writing::{WriteError, WriteOptions, write};
