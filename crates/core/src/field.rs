//! A value for every cell of disc or pin, laid out for the kernels.

use crate::kernel::LANES;
use crate::mesh::Mesh;

/// One value per cell, column by column; the rows of a column are kept in groups of [`LANES`].
///
/// Where the rows do not fill the last group, its other lanes hold a value that no kernel takes for a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Field<T> {
    rows: usize,
    groups: Vec<[T; LANES]>,
}

impl<T: Copy> Field<T> {
    /// Lays out values given column by column, cell (row i, column c) at `c * rows + i`; `rest` fills the last groups.
    pub fn new(mesh: &Mesh, values: &[T], rest: T) -> Self {
        let rows = mesh.rows();
        let mut groups = Vec::with_capacity(values.len() / rows * rows.div_ceil(LANES));
        for column in values.chunks_exact(rows) {
            for part in column.chunks(LANES) {
                let mut group = [rest; LANES];
                group[..part.len()].copy_from_slice(part);
                groups.push(group);
            }
        }
        Self { rows, groups }
    }

    /// Groups of a column.
    fn groups_per_column(&self) -> usize {
        self.rows.div_ceil(LANES)
    }

    /// The groups of one column.
    #[inline]
    pub fn column(&self, column: usize) -> &[[T; LANES]] {
        let groups = self.groups_per_column();
        &self.groups[column * groups..(column + 1) * groups]
    }

    /// The groups of one column, to change.
    #[inline]
    pub fn column_mut(&mut self, column: usize) -> &mut [[T; LANES]] {
        let groups = self.groups_per_column();
        &mut self.groups[column * groups..(column + 1) * groups]
    }

    /// The groups of one column, to change, and those of the next one if there is one.
    #[inline]
    pub fn column_and_next(&mut self, column: usize) -> (&mut [[T; LANES]], Option<&[[T; LANES]]>) {
        let groups = self.groups_per_column();
        let (here, after) = self.groups[column * groups..].split_at_mut(groups);
        (here, after.get(..groups))
    }

    /// The values of the cells of one column.
    pub fn cells_of(&self, column: usize) -> &[T] {
        &self.column(column).as_flattened()[..self.rows]
    }

    /// The values of all cells, column by column.
    pub fn cells(&self) -> impl Iterator<Item = T> + '_ {
        self.groups
            .chunks_exact(self.groups_per_column())
            .flat_map(|column| &column.as_flattened()[..self.rows])
            .copied()
    }

    /// The values of all cells, column by column.
    pub fn to_vec(&self) -> Vec<T> {
        self.cells().collect()
    }
}

/// One number for every row of the mesh, in groups as in a [`Field`]; what fills the last group is of no account.
pub type Rows = Vec<[f64; LANES]>;

/// 0 for every row.
pub fn zero_rows(rows: usize) -> Rows {
    vec![[0.0; LANES]; rows.div_ceil(LANES)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_every_cell_whatever_the_rows() {
        for rows in [1, 7, 8, 9, 17] {
            let mesh = Mesh::new(rows, 5, 3, 1.0, 2.0).unwrap();
            let values: Vec<usize> = (0..mesh.disc_cells()).collect();
            let field = Field::new(&mesh, &values, usize::MAX);
            assert_eq!(field.to_vec(), values);
            assert_eq!(field.cells_of(2), &values[2 * rows..3 * rows]);
            assert_eq!(field.column(4).as_flattened().len(), rows.next_multiple_of(LANES));
        }
    }
}
