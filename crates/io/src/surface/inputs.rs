//! Which files were read, and their digests.

use std::io;
use std::path::{Path, PathBuf};

use crate::digest::sha256;

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
