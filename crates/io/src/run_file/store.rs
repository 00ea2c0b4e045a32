//! The open run file: what is appended to it and how it is closed.

use std::fs;
use std::io::{self, Write as _};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

use hdf5::file::{File, FileBuilder};
use hdf5::{Dataset, H5Type};
use ndarray::{ArrayView2, s};
use plateau_core::observe::{Map, MapValues, Quantity, Sample, Snapshot, quantities};

use super::dimension::EMPTY_FILE;
use super::layout::{self, MAP_TIME, TIME};
use super::place::Place;
use super::status::StoredStatus;
use super::{Earlier, End, Header, ReadError, RunFile, RunFileError};
use crate::timestamp::iso_8601;

/// Chunk cache of a dataset: slots, bytes, and 1 for "a chunk that is full goes first".
///
/// Nothing is read back, so it need hold no more than the chunk that is being filled.
const CHUNK_CACHE: (usize, usize, f64) = (521, 1024 * 1024, 1.0);

/// More bytes than the attributes of the end take.
const ROOM: usize = 128 * 1024;

/// A run file while it is written. Only one thread uses it.
pub(super) struct Store {
    path: PathBuf,
    /// Device and inode: the path may come to mean another file while a run goes on.
    identity: Option<(u64, u64)>,
    started: Instant,
    file: File,
    datasets: Datasets,
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
        let started = Instant::now();
        let place = Place::claim(path, overwrite, EMPTY_FILE)?;
        let set_up = || {
            let file = open(place.temporary())?;
            layout::lay_out(&file, header, SystemTime::now())?;
            file.start_swmr()?;
            let datasets = Datasets::open(&file, header)?;
            file.flush()?;
            Ok((file, datasets))
        };
        let (file, datasets) = set_up().map_err(|error: hdf5::Error| RunFileError::SetUp {
            path: path.into(),
            reason: reason(&error.to_string()),
        })?;
        let path = place.publish()?;
        Ok(Self { identity: identity(&path), path, started, file, datasets })
    }

    /// Makes the file anew with the first samples and maps of the one that is there, of a run that was stopped, and takes
    /// its place.
    pub(super) fn resume(path: &Path, header: &Header, earlier: Earlier) -> Result<Self, RunFileError> {
        header.check()?;
        let started = Instant::now().checked_sub(earlier.wall_time).unwrap_or_else(Instant::now);
        let place = Place::claim(path, true, EMPTY_FILE)?;
        let unreadable = |error: ReadError| RunFileError::Earlier { path: path.into(), reason: error.to_string() };
        let old = RunFile::open(path).map_err(unreadable)?;
        let there = [old.time().len(), old.map_time().len()];
        if there[0] < earlier.samples || there[1] < earlier.snapshots {
            let reason = format!(
                "it holds {} samples and {} maps, expected {} and {}",
                there[0], there[1], earlier.samples, earlier.snapshots
            );
            return Err(RunFileError::Earlier { path: path.into(), reason });
        }
        let failed = |error: hdf5::Error| RunFileError::SetUp { path: path.into(), reason: reason(&error.to_string()) };
        let set_up = || {
            let file = open(place.temporary())?;
            layout::lay_out(&file, header, old.start_time().unwrap_or_else(SystemTime::now))?;
            file.start_swmr()?;
            let datasets = Datasets::open(&file, header)?;
            Ok((file, datasets))
        };
        let (file, mut datasets) = set_up().map_err(failed)?;
        let mut columns = Vec::new();
        for (quantity, _) in &datasets.series {
            let values = old.values(quantity.name).map_err(unreadable)?;
            let missing =
                || RunFileError::Earlier { path: path.into(), reason: format!("it has no {}", quantity.name) };
            columns.push(values.ok_or_else(missing)?);
        }
        datasets.append_columns(&file, earlier.samples, &columns, old.time()).map_err(failed)?;
        for level in 0..earlier.snapshots {
            let maps = header.maps.iter().map(|map| {
                let missing = || RunFileError::Map { name: map.name() };
                Ok((*map, old.map(*map, level).map_err(unreadable)?.ok_or_else(missing)?))
            });
            let snapshot = Snapshot { time: old.map_time()[level], maps: maps.collect::<Result<_, _>>()? };
            datasets.append_snapshot(&file, &snapshot).map_err(failed)?;
        }
        drop(old);
        let path = place.publish()?;
        Ok(Self { identity: identity(&path), path, started, file, datasets })
    }

    /// Hands all that was appended to the disk.
    pub(super) fn sync(&self) -> Result<(), RunFileError> {
        self.file.flush().map_err(failed(&self.path))?;
        let synced = fs::File::open(&self.path).and_then(|file| file.sync_all());
        synced.map_err(|error| RunFileError::Write { path: self.path.clone(), reason: error.to_string() })
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

    /// States how the run ended and closes the file for good; `state` is the last thing that is written.
    pub(super) fn seal(self, end: &End) -> Result<Written, RunFileError> {
        let Self { path, identity: written_to, started, file, datasets } = self;
        let (samples, snapshots) = (datasets.samples, datasets.snapshots);
        drop(datasets);
        file.close().map_err(failed(&path))?;
        if identity(&path) != written_to {
            return Err(RunFileError::Moved { path });
        }
        check_room(&path).map_err(|error| RunFileError::Write { path: path.clone(), reason: error.to_string() })?;
        // A file that readers follow takes no new attributes, so it is opened once more without them.
        let state_end = || {
            let file = open(&path)?;
            layout::write_text(&file, "end_time", &iso_8601(SystemTime::now()))?;
            layout::write_number(&file, "wall_time", started.elapsed().as_secs_f64())?;
            if let End::Failed(message) = end {
                layout::write_text(&file, "error", message)?;
            }
            layout::write_text(&file, "state", end.state())?;
            file.close()
        };
        state_end().map_err(failed(&path))?;
        let bytes = fs::metadata(&path).map_or(0, |metadata| metadata.len());
        Ok(Written { samples, snapshots, bytes })
    }
}

/// The datasets that grow.
struct Datasets {
    time: Dataset,
    series: Vec<(&'static Quantity, Dataset)>,
    /// Present where there are maps.
    map_time: Option<Dataset>,
    maps: Vec<(Map, Dataset)>,
    rows: usize,
    samples: usize,
    snapshots: usize,
}

impl Datasets {
    fn open(file: &File, header: &Header) -> hdf5::Result<Self> {
        let maps = Map::ALL.into_iter().filter(|map| header.maps.contains(map));
        Ok(Self {
            time: file.dataset(TIME)?,
            series: quantities(header.extras)
                .map(|quantity| Ok((quantity, file.dataset(&layout::series_path(quantity.name))?)))
                .collect::<hdf5::Result<_>>()?,
            map_time: if header.maps.is_empty() { None } else { Some(file.dataset(MAP_TIME)?) },
            maps: maps.map(|map| Ok((map, file.dataset(layout::map_path(map))?))).collect::<hdf5::Result<_>>()?,
            rows: header.mesh.rows(),
            samples: 0,
            snapshots: 0,
        })
    }

    fn append_samples(&mut self, file: &File, batch: &[Sample]) -> hdf5::Result<()> {
        let (old, new) = (self.samples, self.samples + batch.len());
        let append = |dataset: &Dataset, value: &dyn Fn(&Sample) -> f64| {
            let values: Vec<f64> = batch.iter().map(value).collect();
            dataset.resize(new)?;
            dataset.write_slice(&values, s![old..new])
        };
        for (quantity, series) in &self.series {
            append(series, &quantity.value)?;
        }
        file.flush()?;
        append(&self.time, &|sample| sample.time)?;
        file.flush()?;
        self.samples = new;
        Ok(())
    }

    /// The first samples of another file, one column for each series.
    fn append_columns(&mut self, file: &File, count: usize, columns: &[Vec<f64>], time: &[f64]) -> hdf5::Result<()> {
        let all = self.series.iter().map(|(_, dataset)| dataset).zip(columns.iter().map(Vec::as_slice));
        for (dataset, values) in all.chain([(&self.time, time)]) {
            dataset.resize(count)?;
            dataset.write_slice(&values[..count], s![..count])?;
        }
        file.flush()?;
        self.samples = count;
        Ok(())
    }

    fn append_snapshot(&mut self, file: &File, snapshot: &Snapshot) -> hdf5::Result<()> {
        let Some(map_time) = &self.map_time else { return Ok(()) };
        let level = self.snapshots;
        for (map, dataset) in &self.maps {
            match snapshot.maps.iter().find(|(name, _)| name == map) {
                Some((_, MapValues::Float(values))) => write_level(dataset, level, values, self.rows)?,
                Some((_, MapValues::Status(values))) => {
                    let statuses: Option<Vec<_>> = values.iter().map(|v| StoredStatus::from_discriminant(*v)).collect();
                    let statuses = statuses.ok_or_else(|| format!("a value of {} is no status", map.name()))?;
                    write_level(dataset, level, &statuses, self.rows)?;
                }
                None => return Err(format!("the snapshot lacks {}", map.name()).into()),
            }
        }
        file.flush()?;
        map_time.resize(level + 1)?;
        map_time.write_slice(&[snapshot.time], s![level..=level])?;
        file.flush()?;
        self.snapshots = level + 1;
        Ok(())
    }
}

/// Writes one map, given column by column, as the last level of its dataset.
fn write_level<T: H5Type>(dataset: &Dataset, level: usize, values: &[T], rows: usize) -> hdf5::Result<()> {
    let columns = values.len() / rows;
    let values = ArrayView2::from_shape((columns, rows), values)?;
    dataset.resize((level + 1, columns, rows))?;
    dataset.write_slice(values, s![level, .., ..])
}

/// Opens a file for writing, in the format that readers can follow.
///
/// Without locks, since many network file systems have none. They would protect nothing: HDF5 gives them up when
/// readers are let in, and marks the file itself as being written.
fn open(path: &Path) -> hdf5::Result<File> {
    let (slots, bytes, preemption) = CHUNK_CACHE;
    FileBuilder::new()
        .with_fapl(|list| list.libver_v110().file_locking(false).chunk_cache(slots, bytes, preemption))
        .open_rw(path)
}

/// Checks that the attributes of the end will find room behind the end of the file.
///
/// A file in which HDF5 could write only half of them would be damaged; like this it stays as it is.
fn check_room(path: &Path) -> io::Result<()> {
    let mut file = fs::OpenOptions::new().append(true).open(path)?;
    let length = file.metadata()?.len();
    let written = file.write_all(&[0; ROOM]);
    file.set_len(length)?;
    written
}

fn identity(path: &Path) -> Option<(u64, u64)> {
    fs::metadata(path).ok().map(|metadata| (metadata.dev(), metadata.ino()))
}

/// Makes an HDF5 error one of this run file.
fn failed(path: &Path) -> impl Fn(hdf5::Error) -> RunFileError {
    move |error| RunFileError::Write { path: path.into(), reason: reason(&error.to_string()) }
}

/// The part of an HDF5 message that a user can act on: what the system said, where it is in there.
fn reason(message: &str) -> String {
    let system = message.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\''));
    system.map_or(message, |(system, _)| system).to_owned()
}
