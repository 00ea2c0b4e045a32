//! Run files of runs that were killed, made such that every program reads them.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use plateau_core::observe::quantities;
use thiserror::Error;

use super::checkpoint::{self, RunState};
use super::creation::Seal;
use super::error::not_anew;
use super::output::{KeepError, Output, keep, resolve};
use super::store::{Restored, set_up};
use super::{Earlier, End, Header, Image, ReadError, RunFile, RunFileError, State};
use crate::claim::{Claim, ClaimError};
use crate::hdf5_file::EMPTY_FILE;
use crate::process::Process;
use crate::temporary::Temporary;
use crate::text::short;
use crate::{hdf5_file, input, temporary};

/// Outcome of a repair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Repair {
    /// File that was closed in good order; nothing was done.
    Healthy,
    /// File that is closed now, with all samples and maps that were complete.
    Repaired {
        /// Copy of the file of before.
        copy: PathBuf,
        /// Number of samples.
        samples: usize,
        /// Number of moments of which there are maps.
        moments: usize,
        /// Parts that it does not hold, or may hold and should not.
        left_out: LeftOut,
    },
}

/// Part that may be missing in a file that was repaired.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeftOut {
    /// Nothing: the machine that wrote it goes on, or another one did.
    Nothing,
    /// The part after the last checkpoint, for the file could not be read: it is as it was then.
    Unreadable,
    /// The part after the last checkpoint, for the machine was started anew since and not all of it may have come to the disk.
    NotOnDisk,
    /// Nothing, though the machine was started anew since: there is no checkpoint that tells what had come to the disk.
    Doubtful,
}

/// Reason why a file is not repaired; it is as it was.
#[derive(Debug, Error)]
pub enum RepairError {
    /// File that cannot be read.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// Another process writes it.
    #[error(transparent)]
    Claimed(#[from] ClaimError),
    /// Something in it would be lost.
    #[error("{} has /series/{name}, which this program does not know; repair it with the program that wrote it, {program}", path.display())]
    Unknown {
        /// The file.
        path: PathBuf,
        /// The series.
        name: String,
        /// Program that wrote it.
        program: String,
    },
    /// The repaired file cannot be written.
    #[error(transparent)]
    Write(#[from] RunFileError),
    /// The file that is there cannot be kept.
    #[error(transparent)]
    Keep(#[from] KeepError),
}

/// Tells whether a run file was closed in good order.
pub fn is_healthy(path: &Path) -> Result<bool, ReadError> {
    let run = RunFile::open(path)?;
    let marked = input::open(path).and_then(|file| hdf5_file::is_being_written(&file));
    let marked = marked.map_err(|error| ReadError::of_system(path, &error))?;
    Ok(run.state() != State::Running && !marked)
}

/// Process that wrote a file that was not closed, and the scene of its run, as the checkpoint beside it says; nothing if there is none.
pub fn last_writer(path: &Path) -> Option<(Process, String)> {
    checkpoint_of(path).map(|(state, image)| (image.writer, state.scene))
}

/// The newest checkpoint that knows how a file was organised.
fn checkpoint_of(path: &Path) -> Option<(RunState, Image)> {
    let states =
        checkpoint::paths(path).into_iter().filter_map(|path| checkpoint::read::<RunState>(&path, None).ok()?);
    states.into_iter().find_map(|mut state| {
        let place = state.images.iter().position(|image| image.is_of(path))?;
        let image = state.images.swap_remove(place);
        Some((state, image))
    })
}

/// Makes the file of a run that was killed anew: closed, `interrupted`, with all samples and maps that are complete, and
/// with their digests. What was there is kept beside it, as `NAME.before-repair`.
///
/// Where the file cannot be read, or the machine was started anew since it was written, it is what it was at the newest checkpoint
/// beside it, if there is one.
///
/// The file is claimed meanwhile.
///
/// # Errors
/// [`RepairError`]; the file is then as it was.
pub fn repair(path: &Path) -> Result<Repair, RepairError> {
    if is_healthy(path).is_ok_and(|is_healthy| is_healthy) {
        return Ok(Repair::Healthy);
    }
    let claim = Claim::of(path)?;
    if is_healthy(path).is_ok_and(|is_healthy| is_healthy) {
        return Ok(Repair::Healthy);
    }
    Temporary::remove_abandoned(&resolve(path, true)?);
    let checkpoint = checkpoint_of(path);
    if let Some((state, image)) =
        checkpoint.as_ref().filter(|(_, image)| image.writer.machine.may_be_of_earlier_start())
    {
        return from_checkpoint(path, state, image, LeftOut::NotOnDisk);
    }
    let is_doubtful = claim.before().is_some_and(|writer| writer.machine.may_be_of_earlier_start());
    match (from_file(path, if is_doubtful { LeftOut::Doubtful } else { LeftOut::Nothing }), checkpoint) {
        (Err(RepairError::Read(_) | RepairError::Write(RunFileError::Earlier { .. })), Some((state, image))) => {
            from_checkpoint(path, &state, &image, LeftOut::Unreadable)
        }
        (repaired, _) => repaired,
    }
}

/// Makes a file anew with all that is complete in it.
fn from_file(path: &Path, left_out: LeftOut) -> Result<Repair, RepairError> {
    let old = Restored::as_it_is(path)?;
    let (samples, moments) = (old.run.whole_samples(), old.run.whole_moments());
    make(path, old, [samples, moments], left_out)
}

/// Makes a file anew with what it had at a checkpoint.
fn from_checkpoint(path: &Path, state: &RunState, image: &Image, left_out: LeftOut) -> Result<Repair, RepairError> {
    make(path, Restored::as_it_was(path, image)?, [state.samples, state.snapshots], left_out)
}

fn make(path: &Path, old: Restored, holds: [usize; 2], left_out: LeftOut) -> Result<Repair, RepairError> {
    let run = &old.run;
    let [samples, moments] = [(holds[0], run.time().len()), (holds[1], run.map_time().len())].map(|(a, b)| a.min(b));
    let header = Header::of(run)?;
    let known = |name: &str| quantities(&header.extras).any(|quantity| quantity.name == name);
    if let Some(unknown) = run.series().iter().find(|series| !known(&series.name)) {
        let program = short(&run.attribute("program").unwrap_or_default()).into_owned();
        return Err(RepairError::Unknown { path: path.into(), name: short(&unknown.name).into_owned(), program });
    }
    let place = Output::prepare(path, true, EMPTY_FILE)?;
    // The run ended when it was last heard of.
    let end_time = fs::metadata(path).and_then(|file| file.modified()).unwrap_or_else(|_| SystemTime::now());
    let start_time = run.start_time().unwrap_or(end_time);
    let wall_time = end_time.duration_since(start_time).unwrap_or_default();
    let (file, mut datasets) =
        set_up(&place, &header, start_time, &temporary::unique_word()).map_err(not_anew(path))?;
    datasets.copy(&file, run, Earlier { samples, snapshots: moments, wall_time })?;
    file.flush().map_err(not_anew(path))?;
    let digests = datasets.into_digests();
    let seal = Seal {
        header: &header,
        start_time,
        end: &End::Interrupted,
        end_time,
        wall_time,
        digests,
        events: &[],
        acceleration: None,
    };
    let sealed = Output::prepare(path, true, EMPTY_FILE)?;
    let closed = file.close().and_then(|()| seal.make(place.temporary(), &sealed));
    closed.map_err(not_anew(path))?;
    drop(old);
    let copy = keep(sealed.path())?;
    sealed.publish_durably()?;
    Ok(Repair::Repaired { copy, samples, moments, left_out })
}
