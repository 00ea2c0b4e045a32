//! The grid on which a field is made: the body's cells and a margin.

use crate::model::mesh::Mesh;
use crate::surface::Body;

/// Cells of a body, and those of the periodic field from which they are taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) padded_columns: usize,
    pub(super) padded_rows: usize,
    /// Arc length of a column, m.
    pub(super) column_width: f64,
    /// Height of a row, m.
    pub(super) row_height: f64,
    /// How many times the field repeats along the padded columns.
    pub(super) repeats: usize,
}

impl Grid {
    /// A grid so large that cells of the body that lie further apart than `reach` (along and across, m) round its edges
    /// do not feel each other. The ring closes and needs no margin along its columns.
    pub(super) fn new(body: Body, mesh: &Mesh, reach: [f64; 2], repeats: usize) -> Self {
        let (columns, rows) = (body.columns(mesh), mesh.rows());
        let (column_width, row_height) = (mesh.column_width(), mesh.row_height());
        let padded_columns = if body == Body::Disc { columns } else { padded(columns, reach[0] / column_width) };
        let padded_rows = padded(rows, reach[1] / row_height);
        Self { columns, rows, padded_columns, padded_rows, column_width, row_height, repeats }
    }
}

/// Points of a line of `cells` cells with a margin.
fn padded(cells: usize, margin: f64) -> usize {
    (cells + libm::ceil(margin) as usize).next_power_of_two()
}
