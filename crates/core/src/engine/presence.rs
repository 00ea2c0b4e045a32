//! Which cells of the pin are there, strip by strip: for pins that are no rectangle (model 1, extension).
//!
//! A cell that is not there is stored as resin out of reach, so that it never touches, wears or supports. What it must not
//! get is debris: so the kernels know of every column of a strip which of its cells are there. Columns at either end
//! without any such cell are not swept at all.

use std::ops::Range;

use crate::engine::lanes::LANES;
use crate::engine::strips::strips;
use crate::model::mesh::Mesh;

/// The cells of the pin that are there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Presence {
    /// Which rows of a strip are there, one bit each; rows that only fill up the last strip count as there.
    cells: Vec<u8>,
    /// Of each strip the columns outside of which no cell is there.
    extents: Vec<Range<usize>>,
    columns: usize,
}

impl Presence {
    /// Some rows of the pin, from the beginning of a strip on; none where all cells are there.
    pub fn of(mesh: &Mesh, own: Range<usize>) -> Option<Self> {
        if mesh.is_rectangle() {
            return None;
        }
        let (columns, rows) = (mesh.pin_columns(), own.len());
        let mut cells = vec![u8::MAX; strips(rows) * columns];
        let mut extents = Vec::with_capacity(strips(rows));
        for strip in 0..strips(rows) {
            let chords = (strip * LANES..rows.min((strip + 1) * LANES)).map(|row| mesh.chord(own.start + row));
            let mut some = columns..0;
            for (lane, chord) in chords.enumerate() {
                for column in (0..columns).filter(|column| !chord.contains(column)) {
                    cells[strip * columns + column] &= !(1 << lane);
                }
                if !chord.is_empty() {
                    some = some.start.min(chord.start)..some.end.max(chord.end);
                }
            }
            extents.push(if some.is_empty() { 0..0 } else { some });
        }
        Some(Self { cells, extents, columns })
    }

    /// Which rows of a strip are there, in some of its columns.
    #[inline]
    pub fn cells(&self, strip: usize, columns: &Range<usize>) -> &[u8] {
        &self.cells[strip * self.columns..][..self.columns][columns.clone()]
    }

    /// Those of some columns of a strip, counted from their first, outside of which no cell is there.
    #[inline]
    pub fn extent(&self, strip: usize, columns: &Range<usize>) -> Range<usize> {
        let count = |column: usize| column.clamp(columns.start, columns.end) - columns.start;
        let Range { start, end } = &self.extents[strip];
        count(*start)..count(*end)
    }

    /// Whether a cell is there.
    pub fn has(&self, row: usize, column: usize) -> bool {
        self.cells[row / LANES * self.columns + column] >> (row % LANES) & 1 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::outline::Outline;

    #[test]
    fn the_cells_are_those_of_the_mesh_in_every_band_of_rows() {
        let mesh = Mesh::new(29, 600, 30, 20e-3, 23e-3).unwrap();
        let mesh = mesh.with_outline(Outline::Disc { radius: 1.5e-3 }).unwrap();
        for own in [0..29, 0..16, 16..29] {
            let presence = Presence::of(&mesh, own.clone()).unwrap();
            for (row, of_mesh) in own.clone().enumerate() {
                for column in 0..30 {
                    let is_there = mesh.is_present(column * 29 + of_mesh);
                    assert_eq!(presence.has(row, column), is_there);
                    let some = presence.extent(row / LANES, &(0..30));
                    assert!(some.contains(&column) || !is_there);
                }
            }
            for strip in 0..strips(own.len()) {
                let (some, of_all) = (presence.extent(strip, &(4..25)), presence.extent(strip, &(0..30)));
                assert_eq!([some.start, some.end], [of_all.start, of_all.end].map(|column| column.clamp(4, 25) - 4));
            }
        }
    }

    #[test]
    fn a_rectangle_has_none() {
        let mesh = Mesh::new(29, 600, 30, 20e-3, 23e-3).unwrap();
        assert_eq!(Presence::of(&mesh, 0..29), None);
    }
}
