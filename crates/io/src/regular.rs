//! Files that are read: regular ones. To open a pipe would wait for whoever writes into it, and a device may have no end.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

/// Opens a regular file for reading.
///
/// # Errors
/// What the system says, and a message where something else has the name.
pub fn open(path: &Path) -> io::Result<File> {
    let there = fs::metadata(path)?;
    if there.is_dir() {
        // To open it succeeds; to read from it does not.
        File::open(path)?.read_exact(&mut [0])?;
    }
    if !there.is_file() {
        let message = "it is a pipe, a device or the like, expected a regular file";
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    File::open(path)
}

/// All of a regular file.
///
/// # Errors
/// Those of [`open`], and what the system says.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// All of a regular file, as text.
///
/// # Errors
/// Those of [`open`], and what the system says.
pub fn read_to_string(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    open(path)?.read_to_string(&mut text)?;
    Ok(text)
}

/// SHA-256 of a file's content, 64 hexadecimal digits.
///
/// # Errors
/// What the system says when the file cannot be read.
pub(crate) fn sha256(path: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    io::copy(&mut open(path)?, &mut hasher)?;
    Ok(format!("{:x}", hasher.finalize()))
}
