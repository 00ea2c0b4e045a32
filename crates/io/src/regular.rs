//! Files that are read: regular ones. To open a pipe would wait for whoever writes into it, and a device may have no end.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::limits;

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

/// All of a regular file of at most so many bytes.
///
/// # Errors
/// Those of [`open`], what the system says, and [`ErrorKind::FileTooLarge`] where there are more.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_small(path, most)?.take(most + 1).read_to_end(&mut bytes)?;
    // It may have grown since.
    refuse_large(bytes.len() as u64, most)?;
    Ok(bytes)
}

/// All of a regular file of at most so many bytes, as text.
///
/// # Errors
/// Those of [`read`], and [`ErrorKind::InvalidData`] where it is not UTF-8.
pub fn read_to_string(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        io::Error::new(ErrorKind::InvalidData, format!("it is not UTF-8 text (byte {at})"))
    })
}

/// Opens a regular file of at most so many bytes for reading.
///
/// # Errors
/// Those of [`open`], and [`ErrorKind::FileTooLarge`] where it has more.
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

/// SHA-256 of a file's content, 64 hexadecimal digits.
///
/// # Errors
/// What the system says when the file cannot be read.
pub(crate) fn sha256(path: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    io::copy(&mut open(path)?, &mut hasher)?;
    Ok(format!("{:x}", hasher.finalize()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_larger_than_expected_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, "12345").unwrap();
        assert_eq!(read_to_string(&path, 5).unwrap(), "12345");
        let error = read(&path, 4).unwrap_err();
        assert_eq!(
            (error.kind(), error.to_string().as_str()),
            (ErrorKind::FileTooLarge, "5 bytes, expected at most 4")
        );
        // It takes no room on the disk, and would take all memory.
        File::options().write(true).open(&path).unwrap().set_len(1 << 40).unwrap();
        assert_eq!(read(&path, 1 << 20).unwrap_err().kind(), ErrorKind::FileTooLarge);
    }
}
