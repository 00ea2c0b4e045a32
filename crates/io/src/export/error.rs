//! What can go wrong when a run file is written in another format.

use std::io;

use thiserror::Error;

use crate::run_file::ReadError;

/// Why a run file cannot be written in another format.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The run file cannot be read.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// The system does not take the output.
    #[error(transparent)]
    Write(#[from] io::Error),
}

impl From<csv::Error> for ExportError {
    fn from(error: csv::Error) -> Self {
        Self::Write(error.into())
    }
}

impl From<zip::result::ZipError> for ExportError {
    fn from(error: zip::result::ZipError) -> Self {
        Self::Write(error.into())
    }
}
