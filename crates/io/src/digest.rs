//! Digests of the files that a run reads.

use std::io;
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::regular;

/// SHA-256 of a file's content, 64 hexadecimal digits.
///
/// # Errors
/// What the system says when the file cannot be read.
pub(crate) fn sha256(path: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    io::copy(&mut regular::open(path)?, &mut hasher)?;
    Ok(format!("{:x}", hasher.finalize()))
}
