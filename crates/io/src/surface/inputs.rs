//! Which files were read, and their digests.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Every surface file with its SHA-256 in hexadecimal digits, each file once.
#[derive(Debug, Default)]
pub(super) struct Inputs(pub(super) Vec<(PathBuf, String)>);

impl Inputs {
    pub(super) fn add(&mut self, path: &Path) -> io::Result<()> {
        if !self.0.iter().any(|(known, _)| known == path) {
            self.0.push((path.to_owned(), sha256(path)?));
        }
        Ok(())
    }
}

fn sha256(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let mut digest = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok(format!("{:x}", digest.finalize())),
            Ok(count) => digest.update(&buffer[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}
