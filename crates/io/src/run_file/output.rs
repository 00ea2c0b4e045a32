//! Output path of a run file: a new file appears there complete, or not at all, and the file before it can be kept beside it.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::RunFileError;
use crate::temporary::{Temporary, folder};

/// An output path and the temporary file beside it that becomes the output once it is set up.
pub(super) struct Output {
    path: PathBuf,
    temporary: Temporary,
    overwrite: bool,
}

impl Output {
    /// Checks that a file may be written at `path` and starts the temporary with the given bytes.
    pub(super) fn prepare(path: &Path, overwrite: bool, start: &[u8]) -> Result<Self, RunFileError> {
        let path = resolve(path, overwrite)?;
        let started = Temporary::create(&path).and_then(|(temporary, mut file)| {
            file.write_all(start)?;
            Ok(temporary)
        });
        let temporary = started.map_err(|error| match error.kind() {
            // That is not the user's mistake, and nothing that writing elsewhere in the folder would mend.
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
                RunFileError::not_made(&path, &error.to_string())
            }
            _ => refused_in(&path)(error),
        })?;
        Ok(Self { path, temporary, overwrite })
    }

    /// Path that the file will have.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the file until it is published.
    pub(super) fn temporary(&self) -> &Path {
        self.temporary.path()
    }

    /// Replaces the file that is there, so that one of both is whole even if the power fails.
    pub(super) fn publish_durably(self) -> Result<PathBuf, RunFileError> {
        let Self { path, temporary, .. } = self;
        temporary.publish_durably().map_err(refused_in(&path))?;
        Ok(path)
    }

    /// Gives the temporary its final name; replaces an existing file only where that was asked for.
    pub(super) fn publish(self) -> Result<PathBuf, RunFileError> {
        let Self { path, temporary, overwrite } = self;
        match temporary.publish(overwrite) {
            Err(error) if !overwrite && error.kind() == ErrorKind::AlreadyExists => Err(RunFileError::Exists(path)),
            published => published.map_err(refused_in(&path)).map(|()| path),
        }
    }
}

/// Says whether a run file may be written at `path`, before any work is done for it; touches nothing.
pub fn check_output(path: &Path, overwrite: bool) -> Result<(), RunFileError> {
    resolve(path, overwrite).map(|_| ())
}

/// The file that is meant by an output path: absolute, so that a change of the working directory does no harm, and
/// where a symbolic link is to be replaced, the file that it points to.
pub fn resolve(path: &Path, overwrite: bool) -> Result<PathBuf, RunFileError> {
    let shown = path.display();
    let not_a_file = || {
        RunFileError::Refused(format!(
            "the output {shown} is a folder or another thing that is not a regular file, and is not replaced; name a file with -o FILE"
        ))
    };
    let (parent, Some(name)) = (folder(path), path.file_name()) else { return Err(not_a_file()) };
    let names_a_folder = path.as_os_str().as_encoded_bytes().ends_with(b"/");
    if names_a_folder || fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        return Err(not_a_file());
    }
    if !parent.is_dir() {
        let directory = parent.display();
        return Err(RunFileError::Refused(format!(
            "cannot write {shown}: {directory} is not a directory; make it, or write elsewhere with -o FILE"
        )));
    }
    let mut resolved = fs::canonicalize(parent).map_err(|error| no_file_in(parent, &error))?.join(name);
    if fs::symlink_metadata(&resolved).is_ok() {
        resolved = fs::canonicalize(&resolved).map_err(|_| {
            let to = fs::read_link(path).unwrap_or_default();
            let to = to.display();
            RunFileError::Refused(format!(
                "the output {shown} is a link to {to}, which is not there; remove it, or write elsewhere with -o FILE"
            ))
        })?;
        if !overwrite {
            return Err(RunFileError::Exists(path.into()));
        }
    }
    if resolved.to_str().is_none() {
        // The HDF5 library takes no other names.
        let message = format!("the output path {shown} is not valid UTF-8; choose another name with -o FILE");
        return Err(RunFileError::Refused(message));
    }
    Ok(resolved)
}

/// The system's numbers of the error of too many open files, in all and of one process.
const ENFILE: i32 = 23;
const EMFILE: i32 = 24;

/// An error of the directory in which `path` is.
fn refused_in(path: &Path) -> impl Fn(io::Error) -> RunFileError + '_ {
    move |error| match error.raw_os_error() {
        // Of the system, and of this process.
        Some(ENFILE | EMFILE) => RunFileError::NoHandle(path.into(), error.to_string()),
        _ => no_file_in(path.parent().unwrap_or(path), &error),
    }
}

fn no_file_in(directory: &Path, error: &io::Error) -> RunFileError {
    let directory = directory.display();
    RunFileError::Refused(format!(
        "cannot make a file in {directory}: {error}; make the directory writable, or write elsewhere with -o FILE"
    ))
}

/// Reason why a file is not made anew.
#[derive(Debug, Error)]
#[error("cannot keep a copy of {} as {}: {error}; nothing was changed", path.display(), copy.display())]
pub struct KeepError {
    /// The file.
    pub path: PathBuf,
    /// Its copy.
    pub copy: PathBuf,
    /// Message of the system.
    #[source]
    pub error: io::Error,
}

/// Names beside a file: its own with an ending, such as `run.h5.before-repair`, then `run.h5.before-repair-2` and so on.
pub fn names_beside(path: &Path, ending: &str) -> impl Iterator<Item = PathBuf> {
    let first = path.with_added_extension(ending);
    let others = (2..).map(move |number| path.with_added_extension(format!("{ending}-{number}")));
    std::iter::once(first).chain(others)
}

/// Gives a file a second name, or where there are no links, copies it.
pub fn keep(path: &Path) -> Result<PathBuf, KeepError> {
    for copy in names_beside(path, "before-repair") {
        match fs::hard_link(path, &copy) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Ok(()) => return Ok(copy),
            Err(_) => {
                let made = File::create_new(&copy);
                if made.as_ref().is_err_and(|error| error.kind() == ErrorKind::AlreadyExists) {
                    continue;
                }
                let copied = made.and_then(|mut made| io::copy(&mut File::open(path)?, &mut made));
                return copied.map(|_| copy.clone()).map_err(|error| KeepError { path: path.into(), copy, error });
            }
        }
    }
    unreachable!("there is always another number")
}
