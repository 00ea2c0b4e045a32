//! Writing surfaces: the format by the ending.

use std::path::{Path, PathBuf};

use plateau_core::surface::Patch;
use thiserror::Error;

/// How a surface is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// An existing file is replaced.
    pub replace: bool,
}

/// Why a surface cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The ending names no format that is written.
    #[error("{}: this version writes no surfaces with this ending", path.display())]
    UnknownEnding {
        /// The output path.
        path: PathBuf,
    },
}

/// Writes heights in the format of the ending.
///
/// # Errors
/// [`WriteError`] when the ending names no format that is written.
pub fn write(path: &Path, _patch: &Patch, _options: &WriteOptions) -> Result<(), WriteError> {
    Err(WriteError::UnknownEnding { path: path.into() })
}
