//! The pin in strips: heights, and a bit for what each of its cells is.

use std::ops::Range;

use crate::engine::lanes::{Chunk, LANES};
use crate::engine::parts::Needs;
use crate::engine::presence::Presence;
use crate::engine::strips::{OUT_OF_REACH, Strips, strips};
use crate::model::mesh::Mesh;
use crate::model::state::Base;

/// The pin, with a column of resin behind its last, which has nothing before it (model section 1).
///
/// A worker's pin is as wide as the whole pin, but only the columns over its own sectors are up to date.
#[derive(Debug, Clone, PartialEq)]
pub struct PinStrips {
    /// z_p, m.
    pub height: Strips,
    /// b_p, m; without formation a pin has no build-up, and b_p = z_p is not kept.
    pub substrate: Option<Strips>,
    /// Which rows of a strip are resin, one bit each.
    resin: Vec<u8>,
    /// Which are plateaus at the start of the coming step: fibre or built up; follows from the heights.
    plateau: Vec<u8>,
    /// Which touch in the coming step; from the last reading.
    touches: Vec<u8>,
    /// Which cells are there; none where all are. The others are resin out of reach.
    presence: Option<Presence>,
    columns: usize,
}

/// Some columns of a strip of the pin, to change.
#[derive(Debug)]
pub struct PinStrip<'a> {
    /// z_p, m.
    pub height: &'a mut [Chunk],
    /// b_p, m; empty where it is not kept.
    pub substrate: &'a mut [Chunk],
    /// Which rows are resin, one bit each.
    pub resin: &'a [u8],
    /// Which rows are plateaus at the start of the coming step, one bit each.
    pub plateau: &'a mut [u8],
    /// Which rows touch in the coming step, one bit each.
    pub touches: &'a mut [u8],
    /// Which rows are there, one bit each; empty where all are.
    pub present: &'a [u8],
}

impl PinStrips {
    /// Some rows of the pin, from the beginning of a strip on, before the first step.
    pub fn new(mesh: &Mesh, own: Range<usize>, heights: &[f64], base: &[Base], needs: Needs) -> Self {
        let (rows, columns) = (own.len(), mesh.pin_columns() + 1);
        let mut height = Strips::new(rows, columns, OUT_OF_REACH);
        let mut resin = vec![0; strips(rows) * columns];
        let presence = Presence::of(mesh, own.clone());
        for column in 0..columns - 1 {
            let cells = mesh.column(column).start + own.start..mesh.column(column).start + own.end;
            height.set_column(column, &heights[cells.clone()]);
            for (row, base) in base[cells].iter().enumerate() {
                let is_absent = presence.as_ref().is_some_and(|presence| !presence.has(row, column));
                resin[row / LANES * columns + column] |= u8::from(base.is_resin() || is_absent) << (row % LANES);
            }
        }
        if let Some(presence) = &presence {
            (0..columns - 1).for_each(|column| put_out_of_reach(presence, &mut height, column));
        }
        for strip in resin.chunks_exact_mut(columns) {
            strip[columns - 1] = u8::MAX;
        }
        let plateau = resin.iter().map(|resin| !resin).collect();
        let touches = vec![0; resin.len()];
        Self { substrate: needs.forms.then(|| height.clone()), height, resin, plateau, touches, presence, columns }
    }

    /// Those of some columns of a strip, counted from their first, outside of which no cell is there.
    #[inline]
    pub fn extent(&self, strip: usize, columns: Range<usize>) -> Range<usize> {
        match &self.presence {
            Some(presence) => presence.extent(strip, &columns),
            None => 0..columns.len(),
        }
    }

    /// Whether a cell is there.
    pub fn is_present(&self, row: usize, column: usize) -> bool {
        self.presence.as_ref().is_none_or(|presence| presence.has(row, column))
    }

    /// Which rows of a strip are resin, column by column.
    #[inline]
    pub fn resin(&self, strip: usize) -> &[u8] {
        &self.resin[strip * self.columns..][..self.columns]
    }

    /// Which rows of a strip touch in the coming step, column by column.
    #[inline]
    pub fn touches(&self, strip: usize) -> &[u8] {
        &self.touches[strip * self.columns..][..self.columns]
    }

    /// Notes that a cell touches in the coming step.
    pub fn note_touch(&mut self, row: usize, column: usize) {
        self.touches[row / LANES * self.columns + column] |= 1 << (row % LANES);
    }

    /// Some columns of a strip.
    #[inline]
    pub fn strip_mut(&mut self, strip: usize, columns: Range<usize>) -> PinStrip<'_> {
        let bytes = strip * self.columns + columns.start..strip * self.columns + columns.end;
        let there = columns.start..columns.end.min(self.columns - 1);
        PinStrip {
            substrate: match &mut self.substrate {
                Some(substrate) => &mut substrate.strip_mut(strip)[columns.clone()],
                None => &mut [],
            },
            height: &mut self.height.strip_mut(strip)[columns],
            present: self.presence.as_ref().map_or(&[], |presence| presence.cells(strip, &there)),
            resin: &self.resin[bytes.clone()],
            plateau: &mut self.plateau[bytes.clone()],
            touches: &mut self.touches[bytes],
        }
    }

    /// Whether a cell's base is resin.
    pub fn is_resin(&self, row: usize, column: usize) -> bool {
        self.resin(row / LANES)[column] >> (row % LANES) & 1 == 1
    }

    /// b_p, m, kept or not; lower than z_p where a cell wears and no debris has come upon it since.
    pub fn substrate(&self) -> &Strips {
        self.substrate.as_ref().unwrap_or(&self.height)
    }

    /// b_p of a column, m.
    pub fn substrate_column(&self, column: usize) -> impl Iterator<Item = f64> + '_ {
        let cells = self.height.column(column).zip(self.substrate().column(column));
        cells.map(|(height, substrate)| if substrate > height { substrate } else { height })
    }

    /// Changes a column between two steps.
    pub fn set_column(&mut self, column: usize, heights: &[f64], substrates: &[f64]) {
        self.height.set_column(column, heights);
        if let Some(substrate) = &mut self.substrate {
            substrate.set_column(column, substrates);
        }
        if let Some(presence) = &self.presence {
            for field in [Some(&mut self.height), self.substrate.as_mut()].into_iter().flatten() {
                put_out_of_reach(presence, field, column);
            }
        }
        for strip in 0..self.height.strips() {
            let (height, substrate) = (self.height.chunk(strip, column), self.substrate().chunk(strip, column));
            let built_up = (0..LANES).filter(|lane| height.0[*lane] < substrate.0[*lane]);
            let built_up = built_up.fold(0, |bits, lane| bits | 1_u8 << lane);
            let at = strip * self.columns + column;
            self.plateau[at] = !self.resin[at] | built_up;
        }
    }

    /// Words of a column of so many rows on its way to another worker: see [`PinStrips::write_crossing`].
    pub fn crossing_words(rows: usize) -> usize {
        (2 * LANES + 1) * strips(rows)
    }

    /// Writes a column that crosses to another worker, and which cells of it are plateaus.
    pub fn write_crossing(&self, column: usize, words: &mut Vec<u64>) {
        let substrate = self.substrate();
        for strip in 0..self.height.strips() {
            words.extend_from_slice(&self.height.strip(strip)[column].0.map(f64::to_bits));
            words.extend_from_slice(&substrate.strip(strip)[column].0.map(f64::to_bits));
            words.push(u64::from(self.plateau[strip * self.columns + column]));
        }
    }

    /// Takes over a column that another worker wrote with [`PinStrips::write_crossing`].
    pub fn read_crossing(&mut self, column: usize, words: &[u64]) {
        let (words, _) = words.as_chunks::<{ 2 * LANES + 1 }>();
        for (strip, words) in words.iter().enumerate() {
            let heights = |first: usize| Chunk(std::array::from_fn(|lane| f64::from_bits(words[first + lane])));
            self.height.strip_mut(strip)[column] = heights(0);
            if let Some(substrate) = &mut self.substrate {
                substrate.strip_mut(strip)[column] = heights(LANES);
            }
            self.plateau[strip * self.columns + column] = words[2 * LANES] as u8;
        }
    }
}

/// Gives the cells of a column that are not there a height that nothing reaches.
fn put_out_of_reach(presence: &Presence, field: &mut Strips, column: usize) {
    for strip in 0..field.strips() {
        let there = presence.cells(strip, &(column..column + 1))[0];
        let chunk = &mut field.strip_mut(strip)[column].0;
        (0..LANES).filter(|lane| there >> lane & 1 == 0).for_each(|lane| chunk[lane] = OUT_OF_REACH);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_crosses_with_its_status() {
        let mesh = Mesh::new(11, 9, 3, 1.0, 2.0).unwrap();
        let heights: Vec<f64> = (0..33).map(f64::from).collect();
        let base = vec![Base::Resin; 33];
        let needs =
            Needs { distinct: false, breaks: false, disc_wears: false, forms: true, pools: false, transport: None };
        let mut from = PinStrips::new(&mesh, 0..11, &heights, &base, needs);
        let mut to = from.clone();
        let plateau = |row: usize| row.is_multiple_of(3);
        from.height.set_column(1, &[7.0; 11]);
        for row in (0..11).filter(|row| plateau(*row)) {
            from.strip_mut(row / LANES, 1..2).plateau[0] |= 1 << (row % LANES);
        }
        let mut words = Vec::new();
        from.write_crossing(1, &mut words);
        assert_eq!(words.len(), PinStrips::crossing_words(11));
        to.read_crossing(1, &words);
        assert!(to.height.column(1).eq([7.0; 11]));
        assert!(to.substrate().column(1).eq((11..22).map(f64::from)));
        let statuses: Vec<bool> =
            (0..11).map(|row| to.strip_mut(row / LANES, 1..2).plateau[0] >> (row % LANES) & 1 == 1).collect();
        assert_eq!(statuses, (0..11).map(plateau).collect::<Vec<_>>());
    }
}
