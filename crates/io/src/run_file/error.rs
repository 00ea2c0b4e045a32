//! Errors of run files, when they are written and when they are read.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::checkpoint;
use crate::text::shown_problem;

/// Reason why a run file cannot be made or written.
///
/// The errors of [`RunWriter::create`](super::RunWriter::create) but for [`RunFileError::SetUp`], [`RunFileError::NoThread`] and
/// [`RunFileError::Write`] mean that an input is wrong and that nothing was touched; these mean that the run failed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RunFileError {
    /// There is something at the output path and it was not asked to be replaced.
    #[error("the output file {} exists; give --force to replace it, or write elsewhere with -o FILE", path.display())]
    Exists {
        /// The output path.
        path: PathBuf,
    },
    /// The output path is a directory, a device or the like.
    #[error("the output {} is a folder or another thing that is not a regular file, and is not replaced; name a file with -o FILE", path.display())]
    NotAFile {
        /// The output path.
        path: PathBuf,
    },
    /// The output path is a link to nothing: whether that is to be made, or the link to be replaced, nobody knows.
    #[error("the output {} is a link to {}, which is not there; remove it, or write elsewhere with -o FILE", path.display(), to.display())]
    LinkToNothing {
        /// The output path.
        path: PathBuf,
        /// Target of the link.
        to: PathBuf,
    },
    /// The directory of the output file does not exist or is no directory.
    #[error("cannot write {}: {} is not a directory; make it, or write elsewhere with -o FILE", path.display(), directory.display())]
    NoDirectory {
        /// The output path.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
    },
    /// The HDF5 library takes names in UTF-8 only.
    #[error("the output path {} is not valid UTF-8; choose another name with -o FILE", path.display())]
    NotUtf8 {
        /// The output path.
        path: PathBuf,
    },
    /// No file can be made in the directory of the output file.
    #[error(
        "cannot make a file in {}: {reason}; make the directory writable, or write elsewhere with -o FILE",
        directory.display()
    )]
    Directory {
        /// The directory.
        directory: PathBuf,
        /// Message of the system.
        reason: String,
    },
    /// A field does not have the size that the mesh asks for.
    #[error("{name} has {found} values, expected {expected} for this mesh")]
    Size {
        /// The field.
        name: &'static str,
        /// Values it has.
        found: usize,
        /// Values it should have.
        expected: usize,
    },
    /// A snapshot does not hold the maps that the header names.
    #[error("a snapshot lacks the map {name}, or has it as another type, though the run file was made for it")]
    Map {
        /// The map.
        name: &'static str,
    },
    /// The file could not be set up; there is none.
    #[error("setting up the run file {} failed: {reason}; nothing is left of it: free space or write elsewhere", path.display())]
    SetUp {
        /// The run file.
        path: PathBuf,
        /// Message of the HDF5 library or of the system.
        reason: String,
    },
    /// A file that was to take the place of another could not be made; that one is as it was.
    #[error("writing {} anew failed: {reason}; it is as it was; free space or make its folder writable", path.display())]
    Anew {
        /// The run file.
        path: PathBuf,
        /// Message of the HDF5 library or of the system.
        reason: String,
    },
    /// The file of a run that was stopped cannot be gone on with; it is as it was.
    #[error("cannot go on with {}: {reason}", path.display())]
    Earlier {
        /// The run file.
        path: PathBuf,
        /// Its problem.
        reason: String,
    },
    /// Writing failed; what was written before can be read.
    #[error("writing {} failed: {reason}; its complete samples and maps are safe{}", path.display(), what_else_is_safe(path))]
    Write {
        /// The run file.
        path: PathBuf,
        /// Message of the HDF5 library or of the system.
        reason: String,
    },
    /// The system gives no more file handles.
    #[error(
        "cannot write {}: no file handle is left ({reason}); close files of this process, or allow more of them, as with ulimit -n 64",
        path.display()
    )]
    NoHandle {
        /// The file.
        path: PathBuf,
        /// Message of the system.
        reason: String,
    },
    /// The system gives no more threads.
    #[error(
        "cannot write {}: the system gives no more threads ({reason}); allow more of them, as with ulimit -u 64, or in the container",
        path.display()
    )]
    NoThread {
        /// The file.
        path: PathBuf,
        /// Message of the system.
        reason: String,
    },
    /// The writer ended without saying why: a defect of the program.
    #[error("the writer of the run file stopped; this is a defect of the program, please report it")]
    Stopped,
    /// The run file was moved or replaced by another program while the run went on.
    #[error("{} was moved, removed or replaced while the run went on, which ends it; what is there now is not touched", path.display())]
    Moved {
        /// Path that the run file should have.
        path: PathBuf,
    },
}

impl RunFileError {
    /// A new file could not be made at `path`; one that is there stays.
    pub(super) fn not_made(path: PathBuf, reason: String) -> Self {
        if path.exists() { Self::Anew { path, reason } } else { Self::SetUp { path, reason } }
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

/// Makes an HDF5 error one of this run file.
pub(super) fn failed(path: &Path) -> impl Fn(hdf5::Error) -> RunFileError {
    move |error| RunFileError::Write { path: path.into(), reason: hdf5_reason(&error) }
}

/// Makes an HDF5 error one of a file that was to take the place of this one.
pub(super) fn not_anew(path: &Path) -> impl Fn(hdf5::Error) -> RunFileError {
    move |error| RunFileError::Anew { path: path.into(), reason: hdf5_reason(&error) }
}

impl ReadError {
    /// Of a file of which the library says this: damaged.
    pub(super) fn of_library(path: &Path, reason: impl Into<String>) -> Self {
        Self::Damaged { path: path.to_owned(), reason: shown_problem(&reason.into()).into_owned() }
    }

    /// Of a file that the system does not give.
    pub(super) fn of_system(path: &Path, error: &io::Error) -> Self {
        let path = path.to_owned();
        match error.raw_os_error() {
            // Too many open files of this process, or of all: 24 and 23 on Linux.
            Some(number @ (23 | 24)) => Self::Handles { path, reason: format!("os error {number}") },
            number => Self::System { path, reason: error.to_string(), number },
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
    /// The system does not give the file.
    #[error("cannot read {}: {reason}", path.display())]
    System {
        /// The file.
        path: PathBuf,
        /// Message of the system.
        reason: String,
        /// Its number of the error.
        number: Option<i32>,
    },
    /// It is no HDF5 file.
    #[error("{} is not an HDF5 file, {expected}", path.display())]
    NotHdf5 {
        /// The file.
        path: PathBuf,
        /// Content that is expected in its place, and which command makes it.
        expected: String,
    },
    /// It is an HDF5 file that no run wrote.
    #[error("{} is not a run file of plateau: it has no {missing}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Part that every run file has.
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
    #[error("{} is not a run file of plateau: {reason}; such a file is read only when all of it is in it", path.display())]
    Elsewhere {
        /// The file.
        path: PathBuf,
        /// The parts that are elsewhere, and their files.
        reason: String,
    },
    /// The system gives no more file handles.
    #[error(
        "cannot read {}: no file handle is left ({reason}); close files of this process, or allow more of them, as with ulimit -n 64",
        path.display()
    )]
    Handles {
        /// The file.
        path: PathBuf,
        /// Message of the system.
        reason: String,
    },
    /// A part of it is missing, cut off or changed.
    #[error("{} is damaged: {reason}; if it is being written or copied try again, else run its scene again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The problem.
        reason: String,
    },
}
