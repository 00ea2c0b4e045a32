//! Maps at the moments that figures show: the first and the last that were recorded.

use plateau_core::observe::{Map, MapValues};
use plateau_io::run_file::{ReadError, RunFile};

use crate::quantity::{MapLook, Unit};
use plateau_io::number;

/// Indices of the first and the last moment of the maps; one of them if it is both.
pub fn ends(run: &RunFile) -> Vec<usize> {
    match run.map_time().len() {
        0 => Vec::new(),
        1 => vec![0],
        count => vec![0, count - 1],
    }
}

/// The moment, in words.
pub fn moment(run: &RunFile, index: usize) -> String {
    let seconds = run.map_time().get(index).copied().unwrap_or(f64::NAN);
    let unit = if seconds > 0.0 { Unit::for_size("s", seconds) } else { Unit::usual("s") };
    unit.with_symbol(&number::rounded(unit.value(seconds), 4))
}

/// Heights or pressures of a map, column by column; nothing if there are none.
pub fn floats(run: &RunFile, map: Map, index: usize) -> Result<Vec<f64>, ReadError> {
    match run.map(map, index)? {
        Some(MapValues::Float(values)) => Ok(values),
        _ => Ok(Vec::new()),
    }
}

/// Gives the cells beyond the pin's outline the colour of what is no cell.
pub fn leave_blank(run: &RunFile, map: Map, cells: &mut [u8], ground: u8) {
    if !map.on_disc() && cells.len() == run.mesh().pin_cells() {
        run.mesh().absent_cells().for_each(|cell| cells[cell] = ground);
    }
}

/// Statuses of a map, column by column; nothing if there are none.
pub fn statuses(run: &RunFile, map: Map, index: usize) -> Result<Vec<u8>, ReadError> {
    match run.map(map, index)? {
        Some(MapValues::Status(values)) => Ok(values),
        _ => Ok(Vec::new()),
    }
}

/// Heights of a map as they are shown, and what they are counted from, m.
pub fn heights(run: &RunFile, map: Map, index: usize) -> Result<(Vec<f64>, f64), ReadError> {
    let mut heights = floats(run, map, index)?;
    let zero = MapLook::of(map).zero(&heights);
    heights.iter_mut().for_each(|height| *height -= zero);
    Ok((heights, zero))
}
