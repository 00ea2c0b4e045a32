//! Layout of a run file: paths, units and long names of its datasets, statuses as an HDF5 enumeration, chunks, and the largest size of
//! a file.

use hdf5::{Dataset, Datatype, H5Type, Selection};
use ndarray::{ArrayView2, s};
use plateau_core::model::material::Status;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::observe::extra::Extra;
use plateau_core::observe::{ABSENT, Map, quantities};

use crate::hdf5_file::write_text;

pub(super) const FORMAT_VERSION: i32 = 1;
pub(crate) const CONVENTIONS: &str = "CF-1.11";

/// Path of the datasets that say how much of a file is complete.
pub(super) const TIME: &str = "time";
/// A link to [`TIME`] among the series of a run that has ended, which by themselves are a dataset of xarray with its coordinate.
///
/// It is soft: a dataset with two equal names would be known by either, and the scale of the series by the wrong one. While a run
/// goes on there is none: of a dataset that is open twice, readers that follow it see no new values (`H5Drefresh`).
pub(super) const TIME_OF_SERIES: &str = "series/time";
/// See [`TIME`].
pub(super) const MAP_TIME: &str = "map_time";

/// Attribute of the root: what the time acceleration that a run chose was like, as JSON.
pub(super) const ACCELERATION: &str = "time_acceleration";

pub(super) const PIN_BASE: &str = "pin/base";

/// The type of statuses. No variable has its name: xarray writes a type into the group of the variable that has it.
pub(super) const STATUS_TYPE: &str = "cell_status";

/// The group of what is reported of each event of a cycle.
pub(super) const EVENT_GROUP: &str = "event";
/// Path of the numbers of the events.
pub(super) const EVENT: &str = "event/event";

pub(super) fn event_path(name: &str) -> String {
    format!("{EVENT_GROUP}/{name}")
}

pub(super) fn series_path(name: &str) -> String {
    format!("series/{name}")
}

/// Path, SI unit and long name of a map.
fn facts_of(map: Map) -> (&'static str, &'static str, &'static str) {
    match map {
        Map::DiscHeight => ("disc/height", "m", "surface height of the disc, positive toward the pin"),
        Map::DiscSubstrate => ("disc/substrate", "m", "height of the disc below any compacted debris"),
        Map::DiscStatus => ("disc/status", "1", "status of the disc cells"),
        Map::PinHeight => ("pin/height", "m", "surface height of the pin, positive away from the disc"),
        Map::PinSubstrate => {
            ("pin/substrate", "m", "height of the pin below any compacted debris, positive away from the disc")
        }
        Map::PinStatus => ("pin/status", "1", "status of the pin cells"),
        Map::Pressure => ("pin/pressure", "Pa", "contact pressure"),
        Map::Temperature => ("pin/temperature", "K", "temperature of the contact, pressures frozen during the pass"),
    }
}

/// Path of a map.
pub fn map_path(map: Map) -> &'static str {
    facts_of(map).0
}

pub(crate) fn map_unit(map: Map) -> &'static str {
    facts_of(map).1
}

pub(super) fn map_long_name(map: Map) -> &'static str {
    facts_of(map).2
}

/// Times in one chunk of a series, at least and at most.
///
/// Short ones leave less room unused in the file of a run of few samples. Long ones cost less time per sample, 4 µs instead of
/// 10 µs for all series.
const SERIES_CHUNK: (u64, u64) = (64, 512);
/// Chunks of a series that is as long as expected.
const CHUNKS_PER_SERIES: u64 = 64;
/// Bytes in one chunk of a map before compression, at most.
const MAP_CHUNK_BYTES: usize = 512 * 1024;
/// Moments in one chunk of a map that never changes, at most: who reads one of them reads them all.
const MOMENTS_PER_CHUNK: usize = 16;
/// Cells of one moment in such a chunk, at most. Deflate finds what comes again within 32 KiB (RFC 1951), and shuffle makes the
/// first bytes of all values come first, then the second ones, so that a cell comes again after as many bytes as there are cells.
const REPEATED_CELLS: usize = 16 * 1024;

/// Times in one chunk of a series of which so many are expected.
pub(super) fn series_chunk(expected_samples: u64) -> usize {
    let (shortest, longest) = SERIES_CHUNK;
    (expected_samples / CHUNKS_PER_SERIES).clamp(shortest, longest) as usize
}

/// Shape of the chunks of maps: equal parts by columns of one moment, or of several moments with equal maps, which deflate then
/// stores hardly more than once.
pub(super) fn map_chunk(equal_moments: usize, columns: usize, rows: usize, bytes_per_value: usize) -> [usize; 3] {
    let moments = equal_moments.div_ceil(equal_moments.div_ceil(MOMENTS_PER_CHUNK));
    let most_cells = MAP_CHUNK_BYTES / (moments * bytes_per_value);
    let most_cells = if moments == 1 { most_cells } else { most_cells.min(REPEATED_CELLS) };
    let parts = (columns * rows).div_ceil(most_cells).min(columns);
    [moments, columns.div_ceil(parts), rows]
}

/// Copies the maps of all moments into a dataset of their shape, chunk by chunk. Those in one chunk are equal.
pub(super) fn copy_map<T: H5Type + Clone>(from: &Dataset, to: &Dataset) -> hdf5::Result<()> {
    let (shape, chunk) = (to.shape(), to.chunk().unwrap_or_default());
    let (&[moments, columns, rows], &[in_chunk, columns_in_chunk, _]) = (&shape[..], &chunk[..]) else {
        return Err("a map has no chunks".into());
    };
    for start in (0..moments).step_by(in_chunk) {
        let map = from.read_slice_2d::<T, _>(s![start, .., ..])?;
        let end = moments.min(start + in_chunk);
        for first in (0..columns).step_by(columns_in_chunk) {
            let last = columns.min(first + columns_in_chunk);
            let part = map.slice(s![first..last, ..]);
            let repeated = part.broadcast((end - start, last - first, rows)).map(|repeated| repeated.to_owned());
            let repeated = repeated.ok_or("a map is not of the shape of its dataset")?;
            to.write_slice(&repeated, s![start..end, first..last, ..])?;
        }
    }
    Ok(())
}

/// Bytes of names, attributes and pages that are not full, at most, unless texts are long.
const STRUCTURE: u64 = 128 * 1024;
/// Bytes that the library needs to find a chunk, with what deflate adds to data that it cannot shorten.
const PER_CHUNK: u64 = 64;
/// Bytes of the digest of a map.
const PER_MAP: u64 = 128;

/// Bytes of a run file with so many samples and moments with maps, at most: what they take when nothing can be compressed.
/// Heights and series of a worn pair take about four fifths of that, statuses hardly anything.
pub fn size_estimate(mesh: &Mesh, maps: &[Map], extras: &[&Extra], samples: u64, moments: u64) -> u64 {
    let float = size_of::<f64>() as u64;
    let chunk = series_chunk(samples) as u64;
    let chunks = samples.div_ceil(chunk);
    // The times are one more.
    let series =
        (quantities(extras).count() as u64 + 1).saturating_mul(chunks).saturating_mul(chunk * float + PER_CHUNK);
    let map = |map: &Map| {
        let cells = if map.on_disc() { mesh.disc_cells() } else { mesh.pin_cells() } as u64;
        // Chunks of maps are large: what they need comes on top as a thousandth part.
        let bytes = if map.is_status() { cells } else { cells * float };
        bytes + bytes / 1000 + PER_CHUNK + PER_MAP
    };
    let coordinates = coordinate_bytes(mesh);
    let maps = maps.iter().map(map).sum::<u64>().saturating_mul(moments);
    STRUCTURE.saturating_add(coordinates).saturating_add(series).saturating_add(maps)
}

/// Bytes of all of such a file that is neither a value of a series nor of a map, at most.
pub fn image_estimate(mesh: &Mesh, maps: &[Map], extras: &[&Extra], samples: u64, moments: u64) -> u64 {
    let series = quantities(extras).count() as u64 + 1;
    let chunks = series.saturating_mul(samples.div_ceil(series_chunk(samples) as u64));
    let levels = (maps.len() as u64).saturating_mul(moments);
    STRUCTURE + coordinate_bytes(mesh).saturating_add(chunks.saturating_add(levels).saturating_mul(PER_CHUNK))
}

/// Bytes of radius and angles and of the base of the pin.
fn coordinate_bytes(mesh: &Mesh) -> u64 {
    let places = mesh.rows() + mesh.disc_columns() + mesh.pin_columns();
    (places * size_of::<f64>() + mesh.pin_cells()) as u64
}

/// A status with the member names that run files use: its place in the list is its number, as [`Status`] and [`ABSENT`] have it.
trait Stored: H5Type + Copy + 'static {
    const ALL: &[Self];

    fn all(values: &[u8]) -> hdf5::Result<Vec<Self>> {
        let all: Option<Vec<Self>> = values.iter().map(|value| Self::ALL.get(usize::from(*value)).copied()).collect();
        all.ok_or_else(|| "a value is not a status".into())
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, H5Type)]
#[repr(u8)]
#[allow(non_camel_case_types)]
enum StoredStatus {
    none = Status::Resin as u8,
    primary = Status::Primary as u8,
    secondary = Status::Secondary as u8,
}

impl Stored for StoredStatus {
    const ALL: &[Self] = &[Self::none, Self::primary, Self::secondary];
}

/// The same with cells beyond the pin's outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, H5Type)]
#[repr(u8)]
#[allow(non_camel_case_types)]
enum OutlinedStatus {
    none = Status::Resin as u8,
    primary = Status::Primary as u8,
    secondary = Status::Secondary as u8,
    absent = ABSENT,
}

impl Stored for OutlinedStatus {
    const ALL: &[Self] = &[Self::none, Self::primary, Self::secondary, Self::absent];
}

/// The statuses of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Statuses {
    /// Tells whether there may be cells beyond the pin's outline.
    outlined: bool,
}

impl Statuses {
    /// Those of a file of this mesh.
    pub(super) fn of(mesh: &Mesh) -> Self {
        Self { outlined: !mesh.is_rectangle() }
    }

    /// The enumeration.
    pub(super) fn datatype(self) -> hdf5::Result<Datatype> {
        if self.outlined { Datatype::from_type::<OutlinedStatus>() } else { Datatype::from_type::<StoredStatus>() }
    }

    /// CF `flag_values` and `flag_meanings` of disc or pin.
    fn flags(self, on_disc: bool) -> (&'static [u8], &'static str) {
        const VALUES: [u8; 4] = [Status::Resin as u8, Status::Primary as u8, Status::Secondary as u8, ABSENT];
        if self.outlined && !on_disc {
            (&VALUES, "none primary secondary absent")
        } else {
            (&VALUES[..3], "none primary secondary")
        }
    }

    /// The CF way to say what a status means, for readers that do not show enumerations.
    pub(super) fn write_flags(self, dataset: &Dataset, on_disc: bool) -> hdf5::Result<()> {
        let (values, meanings) = self.flags(on_disc);
        dataset.new_attr_builder().with_data(values).create("flag_values")?;
        write_text(dataset, "flag_meanings", meanings)
    }

    /// The largest value that a map of statuses may have.
    pub(super) fn largest(self, map: Map) -> u8 {
        self.flags(map.on_disc()).0.last().copied().unwrap_or_default()
    }

    /// Writes values, given column by column, into a part of a dataset, which has it already.
    pub(super) fn write(self, dataset: &Dataset, part: Selection, values: &[u8], rows: usize) -> hdf5::Result<()> {
        fn write<T: Stored>(dataset: &Dataset, part: Selection, values: &[u8], rows: usize) -> hdf5::Result<()> {
            let values = T::all(values)?;
            dataset.write_slice(ArrayView2::from_shape((values.len() / rows, rows), &values)?, part)
        }
        let write = if self.outlined { write::<OutlinedStatus> } else { write::<StoredStatus> };
        write(dataset, part, values, rows)
    }

    /// Copies the maps of all moments into a dataset of their shape.
    pub(super) fn copy(self, from: &Dataset, to: &Dataset) -> hdf5::Result<()> {
        let copy = if self.outlined { copy_map::<OutlinedStatus> } else { copy_map::<StoredStatus> };
        copy(from, to)
    }
}

/// The bases of a pin as a file has them.
pub(super) fn stored_base(mesh: &Mesh, base: &[Base]) -> Vec<u8> {
    let mut stored: Vec<u8> = base.iter().map(|base| *base as u8).collect();
    mesh.absent_cells().for_each(|cell| stored[cell] = ABSENT);
    stored
}
