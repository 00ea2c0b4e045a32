//! What is gathered while the surfaces of a scene are made: files that were read, and what was done.

use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::Body;

use super::super::error::FileError;
use super::super::loaded::Patches;
use crate::regular::digested;
use crate::scene::Scene;

/// Makes the surfaces of a scene, and notes what it reads and does.
pub(super) struct Loader<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) inputs: Inputs,
    pub(super) report: Vec<String>,
    /// Bodies with heights that a run recorded.
    pub(super) recorded: Vec<Body>,
    /// The patches from which heights come, where they are asked for.
    pub(super) patches: Option<Patches>,
}

impl<'a> Loader<'a> {
    /// Nothing is read yet, and patches are not asked for.
    pub(super) fn new(scene: &'a Scene) -> Self {
        Self {
            mesh: &scene.parameters.mesh,
            inputs: Inputs::default(),
            report: Vec::new(),
            recorded: Vec::new(),
            patches: None,
        }
    }
}

/// Every surface file with the SHA-256 of what was read of it, in hexadecimal digits, each once.
#[derive(Debug, Default)]
pub(super) struct Inputs(pub(super) Vec<(PathBuf, String)>);

impl Inputs {
    /// Reads a file, and adds it with the digest of what was read. A file that disc and pin have in common, and that changed in between, is
    /// there twice.
    pub(super) fn read<T>(&mut self, path: &Path, read: impl FnMut() -> Result<T, FileError>) -> Result<T, FileError> {
        let (content, digest) = digested(path, read, FileError::from)?;
        let input = (path.to_owned(), digest);
        if !self.0.contains(&input) {
            self.0.push(input);
        }
        Ok(content)
    }
}
