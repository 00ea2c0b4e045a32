//! Initial surfaces: from what a scene asks for to heights and bases of every cell.

mod error;
mod format;
mod hdf5;
mod inputs;
mod load;
mod measured;
pub mod sdf;
mod writing;

pub use error::{FileError, SurfaceError};
pub use format::Format;
pub use hdf5::Hdf5Error;
pub use load::{Loaded, load};
pub use measured::{Measured, ReadOptions, read};
pub use writing::{WriteError, WriteOptions, write};
