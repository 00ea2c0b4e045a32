//! State of a run, and the header of its file: what is known before the first step, and how the run ended.

use std::io;
use std::path::Path;
use std::time::Duration;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::observe::Map;
use plateau_core::observe::extra::Extra;
use serde::{Deserialize, Serialize};

use super::RunFileError;
use crate::input::sha256;

/// State of a run, as its file says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// The run goes on, or it was killed.
    Running,
    /// All steps are done.
    Finished,
    /// The user stopped the run.
    Interrupted,
    /// The run failed; the attribute `error` says why.
    Failed,
}

impl State {
    /// Name of the state in run files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        }
    }

    pub(super) const ALL: [Self; 4] = [Self::Running, Self::Finished, Self::Interrupted, Self::Failed];

    pub(super) fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|state| state.name() == name)
    }
}

/// Header of a run: all that is fixed before its first step: its mesh, the maps it records, and where it comes from.
#[derive(Debug, Clone)]
pub struct Header {
    /// Title of the scene.
    pub title: String,
    /// The ring mesh.
    pub mesh: Mesh,
    /// Base of every pin cell, column by column.
    pub pin_base: Vec<Base>,
    /// The maps to be recorded; no others exist in the file.
    pub maps: Vec<Map>,
    /// Series besides those that every run has.
    pub extras: Vec<&'static Extra>,
    /// Number of samples that will be sent, about; any number will do, a good one makes the file small and quick to write.
    pub expected_samples: u64,
    /// The whole resolved scene, TOML.
    pub scene: String,
    /// Name and version of the program.
    pub program: String,
    /// Revision of its source.
    pub source_revision: String,
    /// Name of the machine.
    pub host: String,
    /// Threads that share the ring.
    pub workers: usize,
    /// Part of the mesh that each worker has, in words.
    pub decomposition: String,
    /// The instruction set that the kernel uses.
    pub instruction_set: String,
    /// Seeds as (key path in the scene, seed).
    pub seeds: Vec<(String, u64)>,
    /// Every file that was read.
    pub inputs: Vec<InputFile>,
    /// Steps of reading and making the initial surfaces, one a line.
    pub surfaces: Vec<String>,
}

impl Header {
    /// Tells whether the fields fit the mesh.
    pub(super) fn check(&self) -> Result<(), RunFileError> {
        let (found, expected) = (self.pin_base.len(), self.mesh.pin_cells());
        if found == expected { Ok(()) } else { Err(RunFileError::size("pin base", found, expected)) }
    }
}

/// A file that was read for a run, with what it held.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputFile {
    /// Path as the run used it; characters that are no Unicode are replaced.
    pub path: String,
    /// SHA-256 of the content, 64 hexadecimal digits.
    pub sha256: String,
}

impl InputFile {
    /// Reads a file and notes its digest.
    pub fn read(path: &Path) -> io::Result<Self> {
        Ok(Self { path: path.to_string_lossy().into_owned(), sha256: sha256(path)? })
    }
}

/// Content of the run file of a run that is continued.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Earlier {
    /// Number of samples.
    pub samples: usize,
    /// Number of moments of which there are maps.
    pub snapshots: usize,
    /// Wall time of the run so far.
    pub wall_time: Duration,
}

/// End of a run: the `state` of its run file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// All steps are done.
    Finished,
    /// The user stopped the run; what was done is written.
    Interrupted,
    /// The run failed; the message goes to the attribute `error`.
    Failed(String),
}

impl End {
    pub(super) fn state(&self) -> State {
        match self {
            Self::Finished => State::Finished,
            Self::Interrupted => State::Interrupted,
            Self::Failed(_) => State::Failed,
        }
    }
}
