//! The description of a surface, where there is memory for it.

use plateau_core::surface::describe::{Description, Grid};
use plateau_io::memory::refuse_beyond;

use crate::failure::Failure;

/// Describes the heights of a surface of that name; none if no point has one.
///
/// # Errors
/// [`Failure`] where that needs more memory than there is.
pub(super) fn describe(name: &str, grid: &Grid) -> Result<Option<Description>, Failure> {
    let Grid { columns, rows, .. } = *grid;
    refuse_beyond(Description::memory_needed(columns, rows)).map_err(|no_room| {
        Failure::input(format!(
            "{name}: its {columns} x {rows} points can be read, but to describe them needs {no_room}; give a coarser surface, or a part of it"
        ))
    })?;
    Ok(Description::of(grid))
}
