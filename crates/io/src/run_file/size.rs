//! How large a run file will be.

use plateau_core::model::mesh::Mesh;
use plateau_core::observe::extra::Extra;
use plateau_core::observe::{Map, quantities};

use super::layout::series_chunk;

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
    let coordinates = (mesh.rows() + mesh.disc_columns() + mesh.pin_columns()) as u64 * float + mesh.pin_cells() as u64;
    let maps = maps.iter().map(map).sum::<u64>().saturating_mul(moments);
    STRUCTURE.saturating_add(coordinates).saturating_add(series).saturating_add(maps)
}
