//! Errors of run files, when they are written and when they are read.

use std::path::{Path, PathBuf};
use std::{fmt, io};

use thiserror::Error;

use super::checkpoint;
use super::layout::FORMAT_VERSION;
use crate::text::shown_problem;

/// Reason why a run file cannot be made or written.
///
/// The errors of [`RunWriter::create`](super::RunWriter::create) but for [`RunFileError::Failed`] and [`RunFileError::Write`] mean that an
/// input is wrong and that nothing was touched; these mean that the run failed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RunFileError {
    /// File at the output path that was not asked to be replaced.
    #[error("the output file {} exists; give --force to replace it, or write elsewhere with -o FILE", .0.display())]
    Exists(PathBuf),
    /// The path cannot be written, what is to be written does not fit the mesh, or the file was moved while the run went on.
    #[error("{0}")]
    Refused(String),
    /// The file of a run that was stopped cannot be gone on with, for this reason; it is as it was.
    #[error("cannot go on with {}: {}", .0.display(), .1)]
    Earlier(PathBuf, String),
    /// The file could not be made; what there was before is as it was.
    #[error("{0}")]
    Failed(String),
    /// Writing failed, for this reason of the HDF5 library or the system; what was written before can be read.
    #[error("writing {} failed: {}; its complete samples and maps are safe{}", .0.display(), .1, what_else_is_safe(.0))]
    Write(PathBuf, String),
    /// The system gives no more file handles, as it says.
    #[error(
        "cannot write {}: no file handle is left ({}); close files of this process, or allow more of them, as with ulimit -n 64",
        .0.display(), .1
    )]
    NoHandle(PathBuf, String),
}

impl RunFileError {
    /// A new file could not be made at `path`; one that is there stays.
    pub(super) fn not_made(path: &Path, reason: &str) -> Self {
        if path.exists() {
            return Self::not_anew(path, reason);
        }
        let path = path.display();
        Self::Failed(format!(
            "setting up the run file {path} failed: {reason}; nothing is left of it: free space or write elsewhere"
        ))
    }

    /// A file that was to take the place of another could not be made; that one is as it was.
    pub(super) fn not_anew(path: &Path, reason: impl fmt::Display) -> Self {
        let path = path.display();
        Self::Failed(format!(
            "writing {path} anew failed: {reason}; it is as it was; free space or make its folder writable"
        ))
    }

    /// The writer ended without saying why: a defect of the program.
    pub(super) fn stopped() -> Self {
        Self::Refused(
            "the writer of the run file stopped; this is a defect of the program, please report it".to_owned(),
        )
    }

    /// A field does not have the size that the mesh asks for.
    pub(super) fn size(name: &str, found: usize, expected: usize) -> Self {
        Self::Refused(format!("{name} has {found} values, expected {expected} for this mesh"))
    }
}

/// Remainder of a run that could not write its file, and what to do. Before the first checkpoint there is none.
fn what_else_is_safe(path: &Path) -> &'static str {
    if checkpoint::paths(path).iter().any(|checkpoint| checkpoint.is_file()) {
        ", and so is the last checkpoint: free space and go on with --resume, or close the file with `plateau repair`"
    } else {
        ", there is no checkpoint yet: close the file with `plateau repair`; free space and begin again, --resume keeps these samples aside"
    }
}

pub(super) fn failed(path: &Path) -> impl Fn(hdf5::Error) -> RunFileError {
    move |error| RunFileError::Write(path.into(), hdf5_reason(&error))
}

/// Makes an HDF5 error one of a file that was to take the place of this one.
pub(super) fn not_anew(path: &Path) -> impl Fn(hdf5::Error) -> RunFileError {
    move |error| RunFileError::not_anew(path, hdf5_reason(&error))
}

impl ReadError {
    /// Error of a damaged file, with what the library says.
    pub(super) fn of_library(path: &Path, reason: impl Into<String>) -> Self {
        Self::Damaged(path.to_owned(), shown_problem(&reason.into()).into_owned())
    }

    /// Error of a file that the system does not give.
    pub(super) fn of_system(path: &Path, error: &io::Error) -> Self {
        let path = path.to_owned();
        match error.raw_os_error() {
            // Too many open files of this process, or of all: 24 and 23 on Linux.
            Some(number @ (23 | 24)) => Self::Handles(path, format!("os error {number}")),
            number => Self::System(path, error.to_string(), number),
        }
    }
}

/// The part of an HDF5 message that a user can act on: what the system said, where it is in there.
pub(super) fn hdf5_reason(error: &hdf5::Error) -> String {
    let message = error.to_string();
    let system = message.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\''));
    system.map_or(message.as_str(), |(system, _)| system).to_owned()
}

/// Reason why a run file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ReadError {
    /// The system does not give the file: its message and the number of its error.
    #[error("cannot read {}: {}", .0.display(), .1)]
    System(PathBuf, String, Option<i32>),
    /// File that is not HDF5; with what is expected in its place, and which command makes that.
    #[error("{} is not an HDF5 file, {}", .0.display(), .1)]
    NotHdf5(PathBuf, String),
    /// HDF5 file that no run wrote; with the part that it lacks.
    #[error("{} is not a run file of plateau: it has no {}", .0.display(), .1)]
    Foreign(PathBuf, String),
    /// File of a later program, with its version of the format.
    #[error(
        "{} has format_version {}, expected at most {}; read it with the program that wrote it", .0.display(), .1, FORMAT_VERSION
    )]
    Newer(PathBuf, i64),
    /// File of which some is in other files: the parts, and their files.
    #[error("{} is not a run file of plateau: {}; such a file is read only when all of it is in it", .0.display(), .1)]
    Elsewhere(PathBuf, String),
    /// The system gives no more file handles, as it says.
    #[error(
        "cannot read {}: no file handle is left ({}); close files of this process, or allow more of them, as with ulimit -n 64",
        .0.display(), .1
    )]
    Handles(PathBuf, String),
    /// File of which a part is missing, cut off or changed; with the problem.
    #[error("{} is damaged: {}; if it is being written or copied try again, else run its scene again", .0.display(), .1)]
    Damaged(PathBuf, String),
}
