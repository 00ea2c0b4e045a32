//! What is gathered while the surfaces of a scene are made: files that were read, and what was done.

use std::io;
use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;

use super::super::loaded::Patches;
use crate::regular::sha256;
use crate::scene::Scene;

/// Makes the surfaces of a scene, and notes what it reads and does.
pub(super) struct Loader<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) inputs: Inputs,
    pub(super) report: Vec<String>,
    /// The patches from which heights come, where they are asked for.
    pub(super) patches: Option<Patches>,
}

impl<'a> Loader<'a> {
    /// Nothing is read yet, and patches are not asked for.
    pub(super) fn new(scene: &'a Scene) -> Self {
        Self { mesh: &scene.parameters.mesh, inputs: Inputs::default(), report: Vec::new(), patches: None }
    }
}

/// Every surface file with its SHA-256 in hexadecimal digits, each file once.
#[derive(Debug, Default)]
pub(super) struct Inputs(pub(super) Vec<(PathBuf, String)>);

impl Inputs {
    /// Adds a file that was read.
    pub(super) fn add(&mut self, path: &Path) -> io::Result<()> {
        if !self.0.iter().any(|(known, _)| known == path) {
            self.0.push((path.to_owned(), sha256(path)?));
        }
        Ok(())
    }
}
