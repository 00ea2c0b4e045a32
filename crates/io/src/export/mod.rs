//! Run files for other programs.
//!
//! | what | where |
//! |---|---|
//! | series, and maps, as tables of text | [`csv`] |
//! | everything as NumPy arrays in one archive | [`npz`] |
//! | maps on the cells of ring and pin, for ParaView | [`vtk`] |
//!
//! Every number is written so that it reads back as the same number, to the bit. One map at a time is in memory, but for
//! the tables of [`csv`], which hold the maps of one body and moment.

pub mod csv;
mod error;
pub mod npz;
pub mod vtk;

use std::io::{self, Write};

use plateau_core::observe::Map;
use plateau_core::surface::Body;

pub use error::ExportError;

use crate::run_file::{RunFile, map_path};

/// The maps of a body that were recorded.
pub fn maps_of(run: &RunFile, body: Body) -> impl Iterator<Item = Map> + '_ {
    Map::ALL.into_iter().filter(move |map| map.on_disc() == (body == Body::Disc) && run.has_map(*map))
}

/// Name of a map among those of its body, such as `height`.
fn name(map: Map) -> &'static str {
    let path = map_path(map);
    path.rsplit_once('/').map_or(path, |(_, name)| name)
}

/// Writes numbers with their lowest byte first, some thousands at once.
fn write_floats(out: &mut impl Write, values: &[f64]) -> io::Result<()> {
    for block in values.chunks(8192) {
        let bytes: Vec<u8> = block.iter().flat_map(|value| value.to_le_bytes()).collect();
        out.write_all(&bytes)?;
    }
    Ok(())
}
