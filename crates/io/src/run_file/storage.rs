//! Storage of series and maps: their chunks, and how large a run file becomes with them at most.

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
pub(super) const MAP_CHUNK_BYTES: usize = 512 * 1024;

/// Times in one chunk of a series of which so many are expected.
pub(super) fn series_chunk(expected_samples: u64) -> usize {
    let (shortest, longest) = SERIES_CHUNK;
    (expected_samples / CHUNKS_PER_SERIES).clamp(shortest, longest) as usize
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
