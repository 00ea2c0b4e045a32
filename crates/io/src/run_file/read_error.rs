//! What can go wrong when a run file is read.

use std::path::PathBuf;

use thiserror::Error;

/// Why a run file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ReadError {
    /// The system does not give the file.
    #[error("cannot read {}: {reason}", path.display())]
    System {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// It is no HDF5 file.
    #[error("{} is no HDF5 file, expected a run file of plateau, which `plateau run` writes", path.display())]
    NotHdf5 {
        /// The file.
        path: PathBuf,
    },
    /// It is an HDF5 file that no run wrote.
    #[error("{} is no run file of plateau: it has no {missing}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What every run file has.
        missing: String,
    },
    /// It was written by a later program.
    #[error(
        "{} has format_version {found}, expected at most {expected}; read it with the program that wrote it", path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: i64,
        /// The version of this program.
        expected: i32,
    },
    /// Some of it is in other files.
    #[error("{} is no run file of plateau: {reason}; such a file is read only when all of it is in it", path.display())]
    Elsewhere {
        /// The file.
        path: PathBuf,
        /// What is where.
        reason: String,
    },
    /// A part of it is missing, cut off or changed.
    #[error("{} is damaged: {reason}; if it is being written or copied try again, else run its scene again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}
