//! Heights with their shape.

use crate::surface::Patch;

/// Heights on a rectangular grid, of which the pitch may be unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid<'a> {
    /// Points along x, the sliding direction.
    pub columns: usize,
    /// Points along y, outward.
    pub rows: usize,
    /// Distance of neighbouring points along x and y, m.
    pub pitch: Option<[f64; 2]>,
    /// Heights, m, column by column; NaN where there is none.
    pub heights: &'a [f64],
}

impl<'a> Grid<'a> {
    /// The heights of a patch.
    pub fn of(patch: &'a Patch) -> Self {
        let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
        Self { columns, rows, pitch: Some([column_pitch, row_pitch]), heights }
    }

    /// The heights of every column.
    pub(super) fn column_slices(&self) -> std::slice::ChunksExact<'a, f64> {
        self.heights.chunks_exact(self.rows.max(1))
    }
}
