//! Run file that is open for writing: datasets that grow, its start, its continuation from a checkpoint, and its end.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use hdf5::{Dataset, File};
use ndarray::{ArrayView2, s};
use plateau_core::acceleration::Chosen;
use plateau_core::observe::event::EventRecord;
use plateau_core::observe::{Map, MapValues, Quantity, Sample, Snapshot, quantities};

use super::creation::{Seal, lay_out};
use super::digest::{self, Digests};
use super::error::{failed, hdf5_reason, not_anew};
use super::image::{Image, MARK, Values};
use super::layout::{MAP_TIME, Statuses, TIME, map_path, series_path};
use super::output::Output;
use super::{Earlier, End, Header, ReadError, RunFile, RunFileError, State};
use crate::hdf5_file::{EMPTY_FILE, open_for_writing, write_text};
use crate::input::sha256_of;
use crate::process::written_here;
use crate::temporary::{self, Temporary};

/// Content of a finished run file, and the cost of writing it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriterReport {
    /// Time for which the simulation waited for the queue, in all.
    pub waited: Duration,
    /// Samples in the file.
    pub samples: usize,
    /// Moments of which there are maps in the file.
    pub snapshots: usize,
    /// Size of the file, bytes.
    pub bytes: u64,
}

/// The datasets that grow, and the digests of what they hold.
pub(super) struct Datasets {
    time: Dataset,
    series: Vec<(&'static Quantity, Dataset)>,
    /// Times of the maps; none where there are no maps.
    map_time: Option<Dataset>,
    maps: Vec<(Map, Dataset)>,
    rows: usize,
    statuses: Statuses,
    digests: Digests,
    pub(super) samples: usize,
    pub(super) snapshots: usize,
}

impl Datasets {
    pub(super) fn open(file: &File, header: &Header) -> hdf5::Result<Self> {
        let mut digests = Digests::default();
        for quantity in quantities(&header.extras) {
            digests.append(&series_path(quantity.name), &[]);
        }
        for path in [TIME, MAP_TIME].into_iter().take(if header.maps.is_empty() { 1 } else { 2 }) {
            digests.append(path, &[]);
        }
        let maps = Map::ALL.into_iter().filter(|map| header.maps.contains(map));
        Ok(Self {
            time: file.dataset(TIME)?,
            series: quantities(&header.extras)
                .map(|quantity| Ok((quantity, file.dataset(&series_path(quantity.name))?)))
                .collect::<hdf5::Result<_>>()?,
            map_time: if header.maps.is_empty() { None } else { Some(file.dataset(MAP_TIME)?) },
            maps: maps.map(|map| Ok((map, file.dataset(map_path(map))?))).collect::<hdf5::Result<_>>()?,
            rows: header.mesh.rows(),
            statuses: Statuses::of(&header.mesh),
            digests,
            samples: 0,
            snapshots: 0,
        })
    }

    /// Lets go of the datasets, which have to be closed before their file is, and keeps the digests.
    pub(super) fn into_digests(self) -> Digests {
        self.digests
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Dataset> {
        let series = self.series.iter().map(|(_, dataset)| dataset);
        let maps = self.maps.iter().map(|(_, dataset)| dataset);
        [&self.time].into_iter().chain(series).chain(&self.map_time).chain(maps)
    }

    /// Appends samples and makes them visible to readers.
    pub(super) fn append_samples(&mut self, file: &File, batch: &[Sample]) -> hdf5::Result<()> {
        let column = |(quantity, _): &(&Quantity, _)| batch.iter().map(|sample| quantity.value(sample)).collect();
        self.append(file, self.series.iter().map(column).collect(), batch.iter().map(|sample| sample.time).collect())
    }

    /// Appends the first samples and maps of another run file, of which it is known that it has them.
    pub(super) fn copy(&mut self, file: &File, other: &RunFile, earlier: Earlier) -> Result<(), RunFileError> {
        let path = other.path();
        let unreadable = |error: ReadError| RunFileError::Earlier(path.into(), error.to_string());
        let missing = |name: &str| RunFileError::Earlier(path.into(), format!("it has no {name}"));
        let columns = self.series.iter().map(|(quantity, _)| {
            let values = other.first_values(quantity.name, earlier.samples).map_err(unreadable)?;
            values.ok_or_else(|| missing(quantity.name))
        });
        let columns = columns.collect::<Result<_, RunFileError>>()?;
        self.append(file, columns, other.time()[..earlier.samples].to_vec()).map_err(not_anew(path))?;
        for (level, &time) in other.map_time()[..earlier.snapshots].iter().enumerate() {
            let maps = self.maps.iter().map(|(map, _)| {
                let values = other.map(*map, level).map_err(unreadable)?;
                Ok((*map, values.ok_or_else(|| missing(map.name()))?))
            });
            let maps = maps.collect::<Result<_, RunFileError>>()?;
            self.append_snapshot(file, &Snapshot { time, maps }).map_err(not_anew(path))?;
        }
        Ok(())
    }

    /// Appends one column for each series; the times after the flush tell readers that they are there.
    fn append(&mut self, file: &File, columns: Vec<Vec<f64>>, time: Vec<f64>) -> hdf5::Result<()> {
        let (old, new) = (self.samples, self.samples + time.len());
        let append = |dataset: &Dataset, values: &[f64]| {
            dataset.resize(new)?;
            dataset.write_slice(values, s![old..new])
        };
        for ((quantity, series), values) in self.series.iter().zip(&columns) {
            append(series, values)?;
            self.digests.append(&series_path(quantity.name), values);
        }
        file.flush()?;
        append(&self.time, &time)?;
        self.digests.append(TIME, &time);
        publish(&self.time, file)?;
        self.samples = new;
        Ok(())
    }

    /// Appends the maps of one moment and makes them visible to readers.
    pub(super) fn append_snapshot(&mut self, file: &File, snapshot: &Snapshot) -> hdf5::Result<()> {
        let Some(map_time) = &self.map_time else { return Ok(()) };
        let level = self.snapshots;
        for (map, dataset) in &self.maps {
            let resize = |cells: usize| dataset.resize((level + 1, cells / self.rows, self.rows));
            let digest = match snapshot.maps.iter().find(|(name, _)| name == map) {
                Some((_, MapValues::Float(values))) => {
                    resize(values.len())?;
                    let columns = ArrayView2::from_shape((values.len() / self.rows, self.rows), values)?;
                    dataset.write_slice(columns, s![level, .., ..])?;
                    digest::of_floats(values)
                }
                Some((_, MapValues::Status(values))) => {
                    resize(values.len())?;
                    self.statuses.write(dataset, s![level, .., ..].try_into()?, values, self.rows)?;
                    sha256_of(values)
                }
                None => return Err(format!("the snapshot lacks {}", map.name()).into()),
            };
            self.digests.append_map(map_path(*map), digest);
        }
        file.flush()?;
        map_time.resize(level + 1)?;
        map_time.write_slice(&[snapshot.time], s![level..=level])?;
        self.digests.append(MAP_TIME, &[snapshot.time]);
        publish(map_time, file)?;
        self.snapshots = level + 1;
        Ok(())
    }
}

/// Shows readers times that were appended. The times themselves come first: a flush of the file goes on to say that there are
/// more of them when it could not write them.
fn publish(times: &Dataset, file: &File) -> hdf5::Result<()> {
    times.flush()?;
    file.flush()
}

/// A run file that is read, or a copy of it as it was at a checkpoint.
pub(super) struct Restored {
    pub(super) run: RunFile,
    /// Copy that `run` reads, if it reads one; the copy is removed with it.
    _copy: Option<Temporary>,
}

impl Restored {
    pub(super) fn as_it_is(path: &Path) -> Result<Self, ReadError> {
        Ok(Self { run: RunFile::open(path)?, _copy: None })
    }

    /// Opens a file as it was when an image of it was taken.
    pub(super) fn as_it_was(path: &Path, image: &Image) -> Result<Self, RunFileError> {
        let copy = image.restore(path).map_err(|error| RunFileError::not_anew(path, error))?;
        let run = RunFile::open(copy.path()).map_err(|error| RunFileError::Earlier(path.into(), error.to_string()))?;
        Ok(Self { run: run.known_as(path), _copy: Some(copy) })
    }

    /// Opens the file of a run that is gone on with. One that was not closed may be torn by a loss of power, which does not always
    /// show; as it was at the checkpoint it is whole.
    fn to_go_on(path: &Path, images: &[Image]) -> Result<Self, RunFileError> {
        match (Self::as_it_is(path), images.iter().find(|image| image.is_of(path))) {
            (Ok(there), _) if there.run.state() != State::Running => Ok(there),
            (_, Some(image)) => Self::as_it_was(path, image),
            (there, None) => there.map_err(|error| RunFileError::Earlier(path.into(), error.to_string())),
        }
    }
}

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
    /// Mark of this file, which no other has.
    mark: String,
    values: Values,
}

impl Store {
    /// Makes the file, complete but for samples and maps, and lets readers in.
    pub(super) fn create(path: &Path, overwrite: bool, header: &Header) -> Result<Self, RunFileError> {
        header.check()?;
        let (started, start_time) = (Instant::now(), SystemTime::now());
        let place = Output::prepare(path, overwrite, EMPTY_FILE)?;
        let mark = temporary::unique_word();
        let set_up = set_up(&place, header, start_time, &mark);
        let (file, datasets) = set_up.map_err(|error| RunFileError::not_made(path, &hdf5_reason(&error)))?;
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
        let place = Output::prepare(path, true, EMPTY_FILE)?;
        let restored = Restored::to_go_on(path, images)?;
        let old = &restored.run;
        let there = [old.time().len(), old.map_time().len()];
        if there[0] < earlier.samples || there[1] < earlier.snapshots {
            let reason = format!(
                "it holds {} samples and {} maps, expected {} and {}",
                there[0], there[1], earlier.samples, earlier.snapshots
            );
            return Err(RunFileError::Earlier(path.into(), reason));
        }
        let start_time = old.start_time().unwrap_or_else(SystemTime::now);
        let (mark, mut values) = (temporary::unique_word(), Values::default());
        let (file, mut datasets) = set_up(&place, header, start_time, &mark).map_err(not_anew(path))?;
        datasets.copy(&file, old, earlier)?;
        drop(restored);
        // What is there may be all that there is of a long run.
        file.flush().map_err(not_anew(path))?;
        values.add_new_of(datasets.all());
        let image = Image::of(place.temporary(), &values, &mark);
        let image = image.map_err(|error| RunFileError::not_anew(path, error))?;
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
            Ok(()) => RunFileError::Write(self.path.clone(), error.to_string()),
        })
    }

    /// Tells whether the path still means this file.
    fn check_identity(&self) -> Result<(), RunFileError> {
        if identity(&self.path) == self.identity {
            Ok(())
        } else {
            let path = self.path.display();
            Err(RunFileError::Refused(format!(
                "{path} was moved, removed or replaced while the run went on, which ends it; what is there now is not touched"
            )))
        }
    }

    pub(super) fn append_samples(&mut self, batch: &[Sample]) -> Result<(), RunFileError> {
        self.datasets.append_samples(&self.file, batch).map_err(failed(&self.path))
    }

    pub(super) fn append_snapshot(&mut self, snapshot: &Snapshot) -> Result<(), RunFileError> {
        self.datasets.append_snapshot(&self.file, snapshot).map_err(failed(&self.path))
    }

    /// Lets go of a file that can no longer be written, as the end of the process would.
    ///
    /// Closing it would make HDF5 try once more to write what it could not, and leave the file marked in a way in which
    /// nobody reads it. Not closed, it is what a killed writer leaves: readable up to the last complete sample.
    pub(super) fn abandon(self) {
        ABANDONED.lock().unwrap_or_else(PoisonError::into_inner).push(self);
    }

    /// Closes the file for good and states how the run ended.
    pub(super) fn seal(
        self,
        end: &End,
        events: &[EventRecord],
        acceleration: Option<Chosen>,
    ) -> Result<WriterReport, RunFileError> {
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
        Ok(WriterReport { samples, snapshots, bytes, waited: Duration::ZERO })
    }
}

/// Makes a file at a place, complete but for samples and maps, which readers can follow.
pub(super) fn set_up(place: &Output, header: &Header, start: SystemTime, mark: &str) -> hdf5::Result<(File, Datasets)> {
    let file = open_for_writing(place.temporary())?;
    write_text(&file, MARK, mark)?;
    lay_out(&file, header, start, None)?;
    file.start_swmr()?;
    let datasets = Datasets::open(&file, header)?;
    file.flush()?;
    Ok((file, datasets))
}

/// Files that could not be written to the end; they stay open.
static ABANDONED: Mutex<Vec<Store>> = Mutex::new(Vec::new());

/// Closes the files that this process could not write to the end, which still have their place on the disk, and are being written for all
/// that others see. `replace` puts another file in the place of the open file of a number, so that nothing more is written to the one
/// that is given up, and tells whether it did. For who goes on with other work after a run that failed.
pub fn close_abandoned(replace: impl Fn(i32) -> bool) {
    let abandoned = std::mem::take(&mut *ABANDONED.lock().unwrap_or_else(PoisonError::into_inner));
    for store in abandoned {
        let numbers = store.identity.map(written_here).unwrap_or_default();
        if numbers.is_empty() || !numbers.into_iter().all(&replace) {
            std::mem::forget(store);
        }
    }
}

fn identity(path: &Path) -> Option<(u64, u64)> {
    fs::metadata(path).ok().map(|metadata| (metadata.dev(), metadata.ino()))
}
