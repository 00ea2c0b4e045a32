//! Files that are read: regular ones. To open a pipe would wait for whoever writes into it, and a device may have no end.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::temporary::folder;
use crate::text::nearest;

/// Opens a regular file for reading.
pub fn open(path: &Path) -> io::Result<File> {
    open_own(path).map_err(|error| not_there(path, error))
}

/// The same for a file of the program's own, which nobody has named: it may well not be there, and no other one is meant.
pub(crate) fn open_own(path: &Path) -> io::Result<File> {
    let there = fs::metadata(path)?;
    if there.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "it is a folder, expected a file"));
    }
    if !there.is_file() {
        let message = "it is a pipe, a device or the like, expected a regular file";
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    File::open(path)
}

/// Tells whether a path leads to one of some files, links and `..` resolved.
pub fn is_one_of(path: &Path, files: &[PathBuf]) -> bool {
    let real = path.canonicalize().ok();
    real.is_some() && files.iter().any(|file| file.canonicalize().ok() == real)
}

/// Names in a folder that are looked at for one that may be meant.
const LOOKED_AT: usize = 10_000;

/// The error of a file that is not there, with the name beside it that is most like its own.
pub(crate) fn not_there(path: &Path, error: io::Error) -> io::Error {
    if error.kind() != ErrorKind::NotFound {
        return error;
    }
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else { return error };
    let entries = fs::read_dir(folder(path)).into_iter().flatten().flatten().take(LOOKED_AT);
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok()).filter(|other| is_like(name, other));
    let names: Vec<String> = names.collect();
    match nearest(name, names.iter().map(String::as_str)).or(names.first().map(String::as_str)) {
        Some(like) => io::Error::new(
            ErrorKind::NotFound,
            format!("{error}; did you mean {}?", path.with_file_name(like).display()),
        ),
        // Who gave a relative path may be somewhere else than it was meant from.
        None if path.is_relative() => match std::path::absolute(path) {
            Ok(absolute) => io::Error::new(ErrorKind::NotFound, format!("{error}; looked for {}", absolute.display())),
            Err(_) => error,
        },
        None => error,
    }
}

/// Tells whether two names are alike before their ending, and have like endings; an ending may have been left out.
fn is_like(name: &str, other: &str) -> bool {
    let parts = |name: &str| {
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        (part(Path::new(name).file_stem()), part(Path::new(name).extension()))
    };
    let ((stem, ending), (other_stem, other_ending)) = (parts(name), parts(other));
    let are_like = |one: &str, other: &str| one == other || nearest(one, [other]).is_some();
    let ended = are_like(&ending, &other_ending) || ending.is_empty() && stem == other_stem;
    name != other && are_like(&stem, &other_stem) && ended
}

/// All of a regular file of at most so many bytes.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_small(path, most)?.take(most + 1).read_to_end(&mut bytes)?;
    // It may have grown since.
    refuse_large(bytes.len() as u64, most)?;
    Ok(bytes)
}

/// All of a regular file of at most so many bytes, as text.
pub fn read_to_string(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        io::Error::new(ErrorKind::InvalidData, format!("it is not UTF-8 text (byte {at})"))
    })
}

/// Opens a regular file of at most so many bytes for reading.
pub fn open_small(path: &Path, most: u64) -> io::Result<File> {
    let file = open(path)?;
    refuse_large(file.metadata()?.len(), most)?;
    Ok(file)
}

fn refuse_large(bytes: u64, most: u64) -> io::Result<()> {
    if bytes <= most {
        return Ok(());
    }
    Err(io::Error::new(ErrorKind::FileTooLarge, limits::more(bytes, most, "bytes")))
}

/// Number of times that a file is read that changes meanwhile.
const READINGS: usize = 5;

/// Result of `read` of a file, and the SHA-256 of the content that it read: a file that is replaced or written meanwhile is read again.
pub(crate) fn digested<T, E>(
    path: &Path,
    mut read: impl FnMut() -> Result<T, E>,
    failed: impl Fn(io::Error) -> E,
) -> Result<(T, String), E> {
    let state = || {
        let there = fs::metadata(path)?;
        let times = [there.mtime(), there.mtime_nsec(), there.ctime(), there.ctime_nsec()];
        Ok((there.dev(), there.ino(), there.len(), times))
    };
    for _ in 0..READINGS {
        // Of what is not there `read` says so, and what is too large it does not read.
        let before = state();
        let content = read()?;
        let digest = sha256(path).map_err(&failed)?;
        if before.map_err(&failed)? == state().map_err(&failed)? {
            return Ok((content, digest));
        }
    }
    let message = "it changes while it is read; try again when it is written";
    Err(failed(io::Error::new(ErrorKind::InvalidData, message)))
}

/// SHA-256 of bytes, 64 hexadecimal digits.
pub fn sha256_of(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// SHA-256 of a file's content, 64 hexadecimal digits.
pub(crate) fn sha256(path: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    io::copy(&mut open(path)?, &mut hasher)?;
    Ok(format!("{:x}", hasher.finalize()))
}

pub mod limits {
    //! Limits for files that anybody may have made. What is larger is refused, with both numbers in the message.
    //!
    //! Surfaces have bounds of their own besides: points of a grid, and what deflate can make of the bytes that are there.

    /// Bytes of a study: brackets take fifty times their size while they are read.
    pub const STUDY: u64 = 4 << 20;
    /// Bytes of a table of load and speed, or of the points of a design.
    pub const TABLE: u64 = 64 << 20;
    /// Rows of such a table.
    pub const ROWS: usize = 1_000_000;
    /// Values of the points of a design, rows times columns.
    pub const CELLS: usize = 10_000_000;
    /// Bytes of heights as text: what becomes of them needs several times that.
    pub const SURFACE_TEXT: u64 = 1 << 30;
    /// Bytes of heights as an array or an image.
    pub const SURFACE: u64 = 4 << 30;
    /// Bytes of a line of a journal, which holds the series of a run.
    pub const RECORD: u64 = 256 << 20;
    /// Numbers in a line of a journal.
    pub const RECORD_NUMBERS: usize = 1 << 27;
    /// Scenes that extend each other.
    pub const LAYERS: usize = 64;

    /// Says that there is more of something than is read.
    pub(crate) fn more(found: impl std::fmt::Display, most: impl std::fmt::Display, what: &str) -> String {
        format!("{found} {what}, expected at most {most}")
    }
}

#[cfg(test)]
#[path = "../tests/unit/input.rs"]
mod tests;
