//! Checkpoints on disk: what a run that was stopped or killed goes on from.
//!
//! A run file `run.h5` has two beside it, `run.h5.checkpoint` and the one before, `run.h5.checkpoint-before`. A new one is
//! written to a temporary file that is complete on the disk before it gets its name; so one of them always holds.
//!
//! ```text
//! magic    16 bytes: "plateau state 8\n"
//! length   8 bytes: of what follows but for the digest, the least first
//! content  the state, in the encoding of the crate postcard 1
//! digest   32 bytes: SHA-256 of the content
//! ```

use std::fs::{self, File};
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use plateau_core::acceleration::scout::ScoutCheckpoint;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::Sample;
use plateau_core::observe::event::EventProgress;
use plateau_core::simulation::checkpoint::Checkpoint;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

use super::Image;
use crate::temporary::Temporary;
use crate::{input, memory};

/// Beginning of every checkpoint.
const MAGIC: &[u8; 16] = b"plateau state 8\n";
/// Bytes before the content.
const HEAD: u64 = 16 + 8;
/// Beginning of those of every version.
const OWN: &[u8] = b"plateau state ";
/// Bytes of what is neither of every cell nor of every column, at most: scene and sums.
const BESIDES: u64 = 16 * 1024;
/// More than series of any length take in the file of a state, and more than how a run file is organised, bytes.
const AMPLE: u64 = 1 << 30;
/// Bytes that are read at once: the system takes long over many small parts of a large file.
const BLOCK: usize = 1 << 20;

/// All that a run needs to go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    /// Name and version of the program, and the revision of its source.
    pub program: String,
    /// The whole resolved scene.
    pub scene: String,
    /// The surface files that were read, with their SHA-256.
    pub inputs: Vec<(PathBuf, String)>,
    /// Samples in the run file that belong to the steps done.
    pub samples: usize,
    /// Moments of which there are maps.
    pub snapshots: usize,
    /// The last sample, if there was any.
    pub last: Option<Sample>,
    /// Wall time so far, s.
    pub wall_time: f64,
    /// Tells whether all steps are done.
    pub finished: bool,
    /// Engine that takes the steps.
    pub simulation: SimulationState,
    /// Organisation of the run file, unless it is closed. Of a run that was gone on with there is one of the file before, too.
    pub images: Vec<Image>,
}

/// The state of what takes the steps of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulationState {
    /// The simulation.
    pub run: Checkpoint,
    /// Scout that runs ahead, where the run chooses its acceleration.
    pub scout: Option<ScoutCheckpoint>,
    /// Physical time until which all that was due is reported, s.
    pub reached: f64,
    /// The events of the cycle.
    pub events: EventProgress,
}

/// Reason why there is no checkpoint to go on from.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum CheckpointError {
    #[error("cannot read {}: {error}", path.display())]
    Read {
        path: PathBuf,
        /// Message of the system.
        #[source]
        error: io::Error,
    },
    #[error("{} is not a complete checkpoint: {reason}", path.display())]
    Damaged { path: PathBuf, reason: &'static str },
    #[error("{} is not a checkpoint of plateau, but is where one would be; move it away, or write elsewhere with -o FILE", path.display())]
    Foreign { path: PathBuf },
}

/// Bytes of a checkpoint but for the image of the run file, at most: heights, substrates and statuses of all cells, of a run that chooses its acceleration
/// twice.
pub fn size_estimate(mesh: &Mesh, chooses_acceleration: bool) -> u64 {
    let cells = (mesh.disc_cells() + mesh.pin_cells()) as u64;
    let states = if chooses_acceleration { 2 } else { 1 };
    // In a pause of a cycle the pressures are kept, too.
    let pressures = (mesh.pin_cells() * size_of::<f64>()) as u64;
    // Contact area, friction force and load of the steps of a revolution.
    let revolution = (3 * mesh.disc_columns() * size_of::<f64>()) as u64;
    BESIDES + pressures + revolution + states * (cells * (2 * size_of::<f64>() as u64 + 1) + BESIDES)
}

/// More bytes than any file of a state of a run on this mesh has; to be given to [`read`].
pub fn ample_size(mesh: &Mesh) -> u64 {
    size_estimate(mesh, true).saturating_add(AMPLE)
}

/// Paths of the checkpoints of a run file: the last, and the one before.
pub fn paths(run_file: &Path) -> [PathBuf; 2] {
    ["checkpoint", "checkpoint-before"].map(|ending| run_file.with_added_extension(ending))
}

/// Refuses what has the name of a checkpoint of a run file and is none. Such a file, or link, is replaced only where
/// `replace` says so; a folder, pipe or device never.
pub fn refuse_foreign(run_file: &Path, replace: bool) -> Result<(), CheckpointError> {
    paths(run_file).iter().try_for_each(|path| refuse_one_foreign(path, replace))
}

/// The same for the file of a single state.
pub fn refuse_one_foreign(path: &Path, replace: bool) -> Result<(), CheckpointError> {
    let foreign = || CheckpointError::Foreign { path: path.to_owned() };
    let Ok(there) = fs::symlink_metadata(path) else { return Ok(()) };
    if replace && (there.is_file() || there.is_symlink()) {
        return Ok(());
    }
    if !there.is_file() {
        return Err(foreign());
    }
    let mut start = Vec::new();
    let read = input::open(path).and_then(|file| file.take(OWN.len() as u64).read_to_end(&mut start));
    read.map_err(|error| CheckpointError::Read { path: path.to_owned(), error })?;
    if start == OWN { Ok(()) } else { Err(foreign()) }
}

/// Writes the state beside its run file. When this returns, it is on the disk under its name.
///
/// # Errors
/// What the system says; the checkpoints that were there before still are.
pub fn write(run_file: &Path, state: &RunState) -> io::Result<()> {
    let [last, before] = paths(run_file);
    let temporary = fill(&last, state)?;
    // Who may not read the run file may not read what it is made of.
    temporary.permit_as(if last.exists() { &last } else { run_file });
    // A damaged one does not take the place of one that may hold.
    if matches!(open_whole(&last, None), Ok(Some(_))) {
        fs::rename(&last, &before)?;
    }
    temporary.publish_durably()
}

/// Writes any state to a file of its own. When this returns, it is on the disk.
///
/// # Errors
/// What the system says; what was there before still is.
pub fn keep(path: &Path, state: &impl Serialize) -> io::Result<()> {
    fill(path, state)?.publish_durably()
}

/// A temporary file beside `path` with a state in it, on the disk: what it replaces may go only then.
fn fill(path: &Path, state: &impl Serialize) -> io::Result<Temporary> {
    let content = postcard::to_stdvec(state).map_err(io::Error::other)?;
    let (temporary, mut file) = Temporary::create(path)?;
    file.write_all(MAGIC)?;
    file.write_all(&(content.len() as u64).to_le_bytes())?;
    file.write_all(&content)?;
    file.write_all(&Sha256::digest(&content))?;
    file.sync_all()?;
    Ok(temporary)
}

/// Reads a state, such as a checkpoint; none if there is no such file. One that is larger than `most` bytes is refused before it
/// is read, and one that is larger than the memory of the machine always.
pub fn read<T: DeserializeOwned>(path: &Path, most: Option<u64>) -> Result<Option<T>, CheckpointError> {
    let Some((mut file, length)) = open_whole(path, most)? else { return Ok(None) };
    // A file with holes takes no room on the disk. Memory for all of it is taken only now, as it is known to be what was written.
    let mut content = vec![0; length as usize];
    let there = file.seek(SeekFrom::Start(HEAD)).and_then(|_| file.read_exact(&mut content));
    there.map_err(|error| CheckpointError::Read { path: path.into(), error })?;
    let holds_other = |_| CheckpointError::Damaged { path: path.into(), reason: "it holds something else" };
    postcard::from_bytes(&content).map(Some).map_err(holds_other)
}

/// Opens the file of a state whose digest holds, and tells how many bytes the state has; none if there is no such file.
fn open_whole(path: &Path, most: Option<u64>) -> Result<Option<(File, u64)>, CheckpointError> {
    let mut file = match input::open_own(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        file => file.map_err(|error| CheckpointError::Read { path: path.into(), error })?,
    };
    let damaged = |reason| CheckpointError::Damaged { path: path.into(), reason };
    let failed = |error: io::Error| match error.kind() {
        ErrorKind::UnexpectedEof => damaged("it ends too early"),
        _ => CheckpointError::Read { path: path.into(), error },
    };
    let (mut magic, mut length, mut digest) = ([0; 16], [0; 8], [0; 32]);
    file.read_exact(&mut magic).map_err(failed)?;
    if &magic != MAGIC {
        return Err(damaged("it does not begin like one of this version"));
    }
    file.read_exact(&mut length).map_err(failed)?;
    let length = u64::from_le_bytes(length);
    let there = file.metadata().map_err(failed)?.len();
    if Some(there) != length.checked_add(HEAD + digest.len() as u64) {
        return Err(damaged("its length is not what it says"));
    }
    if most.is_some_and(|most| there > most) {
        return Err(damaged("it is larger than any of this run"));
    }
    if memory::of_machine().is_some_and(|memory| length > memory) {
        return Err(damaged("it is larger than the memory of this machine"));
    }
    let mut hasher = Sha256::new();
    let mut content = BufReader::with_capacity(BLOCK, Read::by_ref(&mut file).take(length));
    io::copy(&mut content, &mut hasher).map_err(failed)?;
    file.read_exact(&mut digest).map_err(failed)?;
    if hasher.finalize().as_slice() != digest {
        return Err(damaged("its digest does not hold"));
    }
    Ok(Some((file, length)))
}

/// Checkpoints that are out of the way while a new run takes their place; they come back unless they are discarded.
#[derive(Debug)]
pub struct Aside {
    moved: Vec<(PathBuf, Temporary)>,
}

/// Moves the checkpoints of a run file out of the way.
///
/// # Errors
/// What the system says; they are then where they were.
pub fn set_aside(run_file: &Path) -> io::Result<Aside> {
    let mut aside = Aside { moved: Vec::new() };
    for path in paths(run_file).into_iter().filter(|path| path.is_file() || path.is_symlink()) {
        let (temporary, _) = Temporary::create(&path)?;
        match fs::rename(&path, temporary.path()) {
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error),
            Ok(()) => aside.moved.push((path, temporary)),
        }
    }
    Ok(aside)
}

impl Aside {
    /// Removes them.
    pub fn discard(mut self) {
        self.moved.clear();
    }
}

impl Drop for Aside {
    fn drop(&mut self) {
        for (path, temporary) in &self.moved {
            // Nobody is left to tell.
            let _ = fs::rename(temporary.path(), path);
        }
    }
}
