//! The datasets of a run file that grow.

use hdf5::{Dataset, File, H5Type};
use ndarray::{ArrayView2, s};
use plateau_core::observe::{Map, MapValues, Quantity, Sample, Snapshot, quantities};

use super::digest::{self, Digests};
use super::error::not_anew;
use super::layout::{MAP_TIME, TIME, map_path, series_path};
use super::status::Statuses;
use super::{Earlier, Header, ReadError, RunFile, RunFileError};

/// The datasets that grow, and the digests of what they hold.
pub(super) struct Datasets {
    time: Dataset,
    series: Vec<(&'static Quantity, Dataset)>,
    /// Present where there are maps.
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

    pub(super) fn into_digests(self) -> Digests {
        self.digests
    }

    /// All of them.
    pub(super) fn all(&self) -> impl Iterator<Item = &Dataset> {
        let series = self.series.iter().map(|(_, dataset)| dataset);
        let maps = self.maps.iter().map(|(_, dataset)| dataset);
        [&self.time].into_iter().chain(series).chain(&self.map_time).chain(maps)
    }

    /// Appends samples and makes them visible to readers.
    pub(super) fn append_samples(&mut self, file: &File, batch: &[Sample]) -> hdf5::Result<()> {
        let columns = self
            .series
            .iter()
            .map(|(quantity, _)| batch.iter().map(|sample| quantity.value(sample)).collect())
            .collect();
        self.append(file, columns, batch.iter().map(|sample| sample.time).collect())
    }

    /// Appends the first samples and maps of another run file, of which it is known that it has them.
    pub(super) fn copy(&mut self, file: &File, other: &RunFile, earlier: Earlier) -> Result<(), RunFileError> {
        let path = other.path();
        let unreadable = |error: ReadError| RunFileError::Earlier { path: path.into(), reason: error.to_string() };
        let missing = |name: &str| RunFileError::Earlier { path: path.into(), reason: format!("it has no {name}") };
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

    /// One column for each series; the times after the flush tell readers that they are there.
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
            let digest = match snapshot.maps.iter().find(|(name, _)| name == map) {
                Some((_, MapValues::Float(values))) => {
                    write_level(dataset, level, values, self.rows)?;
                    digest::of_floats(values)
                }
                Some((_, MapValues::Status(values))) => {
                    dataset.resize((level + 1, values.len() / self.rows, self.rows))?;
                    self.statuses.write_level(dataset, level, values, self.rows)?;
                    digest::of_bytes(values)
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

/// Writes one map, given column by column, as the last level of its dataset.
fn write_level<T: H5Type>(dataset: &Dataset, level: usize, values: &[T], rows: usize) -> hdf5::Result<()> {
    let columns = values.len() / rows;
    let values = ArrayView2::from_shape((columns, rows), values)?;
    dataset.resize((level + 1, columns, rows))?;
    dataset.write_slice(values, s![level, .., ..])
}
