//! The open run file: how it is made and what is appended to it.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

use hdf5::File;
use plateau_core::acceleration::Chosen;
use plateau_core::observe::event::EventRecord;
use plateau_core::observe::{Sample, Snapshot};

use super::creation::lay_out;
use super::datasets::Datasets;
use super::dimension::EMPTY_FILE;
use super::error::{failed, hdf5_reason, not_anew};
use super::image::{Image, MARK, Values};
use super::place::Place;
use super::restored::Restored;
use super::seal::Seal;
use super::{Earlier, End, Header, RunFileError};
use crate::hdf5_file::writing::{open_for_writing, write_text};
use crate::random;

/// A run file while it is written. Only one thread uses it.
pub(super) struct Store {
    path: PathBuf,
    /// Device and inode, from before the file got its name: the path may come to mean another one at any time.
    identity: Option<(u64, u64)>,
    header: Header,
    start_time: SystemTime,
    started: Instant,
    file: File,
    datasets: Datasets,
    /// What tells this file from others.
    mark: String,
    values: Values,
}

/// How much a run file holds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Written {
    pub(super) samples: usize,
    pub(super) snapshots: usize,
    pub(super) bytes: u64,
}

impl Store {
    /// Makes the file, complete but for samples and maps, and lets readers in.
    pub(super) fn create(path: &Path, overwrite: bool, header: &Header) -> Result<Self, RunFileError> {
        header.check()?;
        let (started, start_time) = (Instant::now(), SystemTime::now());
        let place = Place::prepare(path, overwrite, EMPTY_FILE)?;
        let mark = random::word();
        let set_up = set_up(&place, header, start_time, &mark);
        let (file, datasets) = set_up.map_err(|error| RunFileError::not_made(path.to_owned(), hdf5_reason(&error)))?;
        let identity = identity(place.temporary());
        let path = place.publish()?;
        let values = Values::default();
        Ok(Self { identity, path, header: header.clone(), start_time, started, file, datasets, mark, values })
    }

    /// Makes the file anew with the first samples and maps of the one that is there, of a run that was stopped, and takes
    /// its place. Before it does, `keep` is given its image, if there is one.
    pub(super) fn resume(
        path: &Path,
        header: &Header,
        earlier: Earlier,
        images: &[Image],
        keep: impl FnOnce(Image),
    ) -> Result<Self, RunFileError> {
        header.check()?;
        let started = Instant::now().checked_sub(earlier.wall_time).unwrap_or_else(Instant::now);
        let place = Place::prepare(path, true, EMPTY_FILE)?;
        let restored = Restored::to_go_on(path, images)?;
        let old = &restored.run;
        let there = [old.time().len(), old.map_time().len()];
        if there[0] < earlier.samples || there[1] < earlier.snapshots {
            let reason = format!(
                "it holds {} samples and {} maps, expected {} and {}",
                there[0], there[1], earlier.samples, earlier.snapshots
            );
            return Err(RunFileError::Earlier { path: path.into(), reason });
        }
        let start_time = old.start_time().unwrap_or_else(SystemTime::now);
        let (mark, mut values) = (random::word(), Values::default());
        let (file, mut datasets) = set_up(&place, header, start_time, &mark).map_err(not_anew(path))?;
        datasets.copy(&file, old, earlier)?;
        drop(restored);
        // What is there may be all that there is of a long run.
        file.flush().map_err(not_anew(path))?;
        values.add_new_of(datasets.all());
        let image = Image::of(place.temporary(), &values, &mark);
        let image = image.map_err(|error| RunFileError::Anew { path: path.into(), reason: error.to_string() })?;
        if let Some(image) = image {
            keep(image);
        }
        let identity = identity(place.temporary());
        let path = place.publish_durably()?;
        Ok(Self { identity, path, header: header.clone(), start_time, started, file, datasets, mark, values })
    }

    /// Hands all that was appended to the disk, and takes an image of the file as it is there. A run whose file was replaced must
    /// not leave a checkpoint beside the other.
    pub(super) fn sync(&mut self) -> Result<Option<Image>, RunFileError> {
        self.check_identity()?;
        self.file.flush().map_err(failed(&self.path))?;
        self.values.add_new_of(self.datasets.all());
        let synced = fs::File::open(&self.path).and_then(|file| {
            file.sync_all()?;
            Image::of(&self.path, &self.values, &self.mark)
        });
        synced.map_err(|error| match self.check_identity() {
            // It may have gone just now.
            Err(moved) => moved,
            Ok(()) => RunFileError::Write { path: self.path.clone(), reason: error.to_string() },
        })
    }

    /// Whether the path still means this file.
    fn check_identity(&self) -> Result<(), RunFileError> {
        if identity(&self.path) == self.identity {
            Ok(())
        } else {
            Err(RunFileError::Moved { path: self.path.clone() })
        }
    }

    /// Appends samples and makes them visible to readers.
    pub(super) fn append_samples(&mut self, batch: &[Sample]) -> Result<(), RunFileError> {
        self.datasets.append_samples(&self.file, batch).map_err(failed(&self.path))
    }

    /// Appends the maps of one moment and makes them visible to readers.
    pub(super) fn append_snapshot(&mut self, snapshot: &Snapshot) -> Result<(), RunFileError> {
        self.datasets.append_snapshot(&self.file, snapshot).map_err(failed(&self.path))
    }

    /// Lets go of a file that can no longer be written, as the end of the process would.
    ///
    /// Closing it would make HDF5 try once more to write what it could not, and leave the file marked in a way in which
    /// nobody reads it. Not closed, it is what a killed writer leaves: readable up to the last complete sample.
    pub(super) fn abandon(self) {
        std::mem::forget(self);
    }

    /// Closes the file for good and states how the run ended.
    pub(super) fn seal(
        self,
        end: &End,
        events: &[EventRecord],
        acceleration: Option<Chosen>,
    ) -> Result<Written, RunFileError> {
        self.check_identity()?;
        let Self { path, header, start_time, started, file, datasets, .. } = self;
        let (samples, snapshots) = (datasets.samples, datasets.snapshots);
        let (end_time, wall_time) = (SystemTime::now(), started.elapsed());
        let header = &header;
        let digests = datasets.into_digests();
        let seal = Seal { header, start_time, end, end_time, wall_time, digests, events, acceleration };
        file.close().map_err(failed(&path))?;
        seal.put_on(&path)?;
        let bytes = fs::metadata(&path).map_or(0, |metadata| metadata.len());
        Ok(Written { samples, snapshots, bytes })
    }
}

/// Makes a file at a place, complete but for samples and maps, which readers can follow.
pub(super) fn set_up(place: &Place, header: &Header, start: SystemTime, mark: &str) -> hdf5::Result<(File, Datasets)> {
    let file = open_for_writing(place.temporary())?;
    write_text(&file, MARK, mark)?;
    lay_out(&file, header, start, None)?;
    file.start_swmr()?;
    let datasets = Datasets::open(&file, header)?;
    file.flush()?;
    Ok((file, datasets))
}

fn identity(path: &Path) -> Option<(u64, u64)> {
    fs::metadata(path).ok().map(|metadata| (metadata.dev(), metadata.ino()))
}
