//! The grid on which a field is made: the body's cells and a margin.

use crate::model::mesh::Mesh;
use crate::surface::Body;

/// Cells of a body, and those of the periodic field from which they are taken.
#[derive(Debug, Clone, Copy)]
pub(in crate::surface) struct Grid {
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
    pub(in crate::surface) padded_columns: usize,
    pub(in crate::surface) padded_rows: usize,
    /// Arc length of a column, m.
    pub(in crate::surface) column_width: f64,
    /// Height of a row, m.
    pub(in crate::surface) row_height: f64,
    /// How many times the field repeats along the padded columns.
    pub(in crate::surface) repeats: usize,
}

impl Grid {
    /// Largest padded field, unless the body is larger than an eighth of it.
    pub(in crate::surface) const MOST_CELLS: usize = 1 << 26;

    /// A grid so large that cells of the body that lie further apart than `reach` (along and across, m) round its edges
    /// do not feel each other. The ring closes and needs no margin along its columns.
    pub(in crate::surface) fn new(body: Body, mesh: &Mesh, reach: [f64; 2], repeats: usize) -> Self {
        let (columns, rows) = (body.columns(mesh), mesh.rows());
        let (column_width, row_height) = (mesh.column_width(), mesh.row_height());
        let padded_columns = if body == Body::Disc { columns } else { padded(columns, reach[0] / column_width) };
        let padded_rows = padded(rows, reach[1] / row_height);
        Self { columns, rows, padded_columns, padded_rows, column_width, row_height, repeats }
    }

    /// Whether the field would be far larger than the body.
    pub(in crate::surface) fn is_too_large(&self) -> bool {
        let most = Self::MOST_CELLS.max(8 * self.columns * self.rows);
        self.padded_columns.checked_mul(self.padded_rows).is_none_or(|cells| cells > most)
    }
}

/// Points of a line of `cells` cells with a margin.
fn padded(cells: usize, margin: f64) -> usize {
    (cells + libm::ceil(margin) as usize).next_power_of_two()
}
