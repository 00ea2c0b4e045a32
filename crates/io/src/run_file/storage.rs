//! Storage of series and maps: their chunks, and how large a run file becomes with them at most.

use hdf5::{Dataset, H5Type};
use ndarray::s;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::extra::Extra;
use plateau_core::observe::{Map, quantities};

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
