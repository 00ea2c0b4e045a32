//! What was there before a file is made anew, kept beside it.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file is not made anew.
#[derive(Debug, Error)]
#[error("cannot keep a copy of {} as {}: {error}; nothing was changed", path.display(), copy.display())]
pub struct KeepError {
    /// The file.
    pub path: PathBuf,
    /// Its copy.
    pub copy: PathBuf,
    /// What the system said.
    #[source]
    pub error: io::Error,
}

/// Gives a file a second name, or where there are no links, copies it.
///
/// # Errors
/// [`KeepError`].
pub fn keep(path: &Path) -> Result<PathBuf, KeepError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let names = (1..).map(|number| match number {
        1 => format!("{name}.before-repair"),
        number => format!("{name}.before-repair-{number}"),
    });
    for copy in names.map(|name| path.with_file_name(name)) {
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
