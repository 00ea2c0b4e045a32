//! Run files of runs that were killed, made such that every program reads them.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use plateau_core::observe::quantities;
use thiserror::Error;

use super::dimension::EMPTY_FILE;
use super::error::not_anew;
use super::place::{Place, resolve};
use super::seal::Seal;
use super::store::set_up;
use super::{Earlier, End, Header, ReadError, RunFile, RunFileError, State};
use crate::claim::{Claim, ClaimError};
use crate::hdf5_file;
use crate::temporary::Temporary;

/// What became of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Repair {
    /// It was closed in good order; nothing was done.
    Healthy,
    /// It is closed now, with all samples and maps that were complete.
    Repaired {
        /// What was there before.
        copy: PathBuf,
        /// Samples.
        samples: usize,
        /// Moments of which there are maps.
        moments: usize,
    },
}

/// Why a file is not repaired; it is as it was.
#[derive(Debug, Error)]
pub enum RepairError {
    /// It cannot be read.
    #[error(transparent)]
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
        /// What wrote it.
        program: String,
    },
    /// The repaired file cannot be written.
    #[error(transparent)]
    Write(#[from] RunFileError),
    /// What is there cannot be kept.
    #[error("cannot keep a copy of {} as {}: {error}; nothing was changed", path.display(), copy.display())]
    Copy {
        /// The file.
        path: PathBuf,
        /// Its copy.
        copy: PathBuf,
        /// What the system said.
        error: io::Error,
    },
}

/// Whether a run file was closed in good order.
///
/// # Errors
/// [`ReadError`].
pub fn is_healthy(path: &Path) -> Result<bool, ReadError> {
    let run = RunFile::open(path)?;
    let marked = hdf5_file::is_marked(path);
    let marked = marked.map_err(|error| ReadError::System { path: path.into(), reason: error.to_string() })?;
    Ok(run.state() != State::Running && !marked)
}

/// Makes the file of a run that was killed anew: closed, `interrupted`, with all samples and maps that are complete, and
/// with their digests. What was there is kept beside it, as `NAME.before-repair`.
///
/// The file is claimed meanwhile.
///
/// # Errors
/// [`RepairError`]; the file is then as it was.
pub fn repair(path: &Path) -> Result<Repair, RepairError> {
    if is_healthy(path)? {
        return Ok(Repair::Healthy);
    }
    let _claim = Claim::of(path)?;
    if is_healthy(path)? {
        return Ok(Repair::Healthy);
    }
    Temporary::remove_abandoned(&resolve(path, true)?);
    let old = RunFile::open(path)?;
    let header = Header::of(&old)?;
    let known = |name: &str| quantities(&header.extras).any(|quantity| quantity.name == name);
    if let Some(unknown) = old.series().iter().find(|series| !known(&series.name)) {
        let program = old.attribute("program").unwrap_or_default();
        return Err(RepairError::Unknown { path: path.into(), name: unknown.name.clone(), program });
    }
    let place = Place::prepare(path, true, EMPTY_FILE)?;
    // The run ended when it was last heard of.
    let end_time = fs::metadata(path).and_then(|file| file.modified()).unwrap_or_else(|_| SystemTime::now());
    let start_time = old.start_time().unwrap_or(end_time);
    let wall_time = end_time.duration_since(start_time).unwrap_or_default();
    let (samples, moments) = (old.whole_samples(), old.whole_moments());
    let (file, mut datasets) = set_up(&place, &header, start_time).map_err(not_anew(path))?;
    datasets.copy(&file, &old, Earlier { samples, snapshots: moments, wall_time })?;
    file.flush().map_err(not_anew(path))?;
    let digests = datasets.into_digests();
    let seal = Seal { header: &header, start_time, end: &End::Interrupted, end_time, wall_time, digests, events: &[] };
    let sealed = Place::prepare(path, true, EMPTY_FILE)?;
    let closed = file.close().and_then(|()| seal.make(place.temporary(), &sealed));
    closed.map_err(not_anew(path))?;
    drop(old);
    let copy = keep(sealed.path())?;
    sealed.publish_durably()?;
    Ok(Repair::Repaired { copy, samples, moments })
}

/// Gives a file a second name, or where there are no links, copies it.
fn keep(path: &Path) -> Result<PathBuf, RepairError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let names = (1..).map(|number| match number {
        1 => format!("{name}.before-repair"),
        number => format!("{name}.before-repair-{number}"),
    });
    for copy in names.map(|name| path.with_file_name(name)) {
        match fs::hard_link(path, &copy) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Ok(()) => return Ok(copy),
            Err(_) => {
                let made = File::create_new(&copy);
                if made.as_ref().is_err_and(|error| error.kind() == ErrorKind::AlreadyExists) {
                    continue;
                }
                let copied = made.and_then(|mut made| io::copy(&mut File::open(path)?, &mut made));
                return copied.map(|_| copy.clone()).map_err(|error| RepairError::Copy {
                    path: path.into(),
                    copy,
                    error,
                });
            }
        }
    }
    unreachable!("there is always another number")
}
