//! Storage of heights as the kernels want it, of disc and pin, and a bit for what each cell of the pin is: strips of eight rows, each
//! strip column by column.
//!
//! A strip of a column is one [`Chunk`]; a pass along a strip reads and writes memory from one end to the other. Rows
//! beyond the mesh fill up the last strip: the pin's are so high, and the disc's so low, that they never touch.
//!
//! A pin that is no rectangle (model 1, extension) lacks cells. One that is not there is stored as resin out of reach, so that it never
//! touches, wears or supports. What it must not get is debris: so the kernels know of every column of a strip which of its cells are there.
//! Columns at either end without any such cell are not passed over at all.

use std::ops::Range;

use crate::engine::lanes::{Chunk, LANES, second_cache};
use crate::engine::parts::Needs;
use crate::model::mesh::Mesh;
use crate::model::state::Base;

/// Height of pin cells that are there only to fill up the last strip, m, and depth of disc cells: out of reach of each other
/// at any displacement below [`crate::model::REACH`].
pub(super) const OUT_OF_REACH: f64 = 1e200;

/// Number of strips that hold `rows` rows.
pub fn strips(rows: usize) -> usize {
    rows.div_ceil(LANES)
}

/// Values by row, in chunks; `filler` fills up the last.
pub fn chunks(rows: &[f64], filler: f64) -> Vec<Chunk> {
    let chunk = |values: &[f64]| {
        let mut chunk = Chunk([filler; LANES]);
        chunk.0[..values.len()].copy_from_slice(values);
        chunk
    };
    rows.chunks(LANES).map(chunk).collect()
}

/// A field of heights over some columns, m.
#[derive(Debug, Clone, PartialEq)]
pub struct Strips {
    rows: usize,
    columns: usize,
    chunks: Vec<Chunk>,
}

impl Strips {
    /// Field of the same height (m) everywhere.
    pub fn new(rows: usize, columns: usize, height: f64) -> Self {
        Self { rows, columns, chunks: vec![Chunk([height; LANES]); strips(rows) * columns] }
    }

    /// Some rows of a field given column by column of the mesh; heights out of reach of any pin fill up the last strip.
    pub fn of_columns(mesh: &Mesh, own: Range<usize>, heights: &[f64]) -> Self {
        let mut field = Self::new(own.len(), heights.len() / mesh.rows(), -OUT_OF_REACH);
        for (column, heights) in heights.chunks_exact(mesh.rows()).enumerate() {
            field.set_column(column, &heights[own.clone()]);
        }
        field
    }

    /// Chunk of a strip and a column.
    pub fn chunk(&self, strip: usize, column: usize) -> &Chunk {
        &self.chunks[strip * self.columns + column]
    }

    /// Number of strips.
    pub fn strips(&self) -> usize {
        strips(self.rows)
    }

    /// Chunks from a column of a strip to that of the one that is passed over next: of the first after the last.
    fn to_next(&self, strip: usize) -> isize {
        if strip + 1 < self.strips() { self.columns as isize } else { -((strip * self.columns) as isize) }
    }

    /// A strip, column by column.
    #[inline]
    pub fn strip(&self, strip: usize) -> &[Chunk] {
        &self.chunks[strip * self.columns..][..self.columns]
    }

    /// A strip, column by column, to change.
    #[inline]
    pub fn strip_mut(&mut self, strip: usize) -> &mut [Chunk] {
        &mut self.chunks[strip * self.columns..][..self.columns]
    }

    /// The rows of a column.
    pub fn column(&self, column: usize) -> impl Iterator<Item = f64> + '_ {
        let chunks = self.chunks.iter().skip(column).step_by(self.columns);
        chunks.flat_map(|chunk| chunk.0).take(self.rows)
    }

    /// Has every strip of a column brought near the processor.
    pub fn fetch_column(&self, column: usize) {
        self.chunks.iter().skip(column).step_by(self.columns).for_each(|chunk| chunk.fetch(0));
    }

    /// Changes the rows of a column.
    pub fn set_column(&mut self, column: usize, heights: &[f64]) {
        for (chunk, heights) in self.chunks.iter_mut().skip(column).step_by(self.columns).zip(heights.chunks(LANES)) {
            // −0 becomes 0: the kernels compare bits.
            chunk.0.iter_mut().zip(heights).for_each(|(place, height)| *place = height + 0.0);
        }
    }
}

/// Columns of a field, from a place on; none where it is not kept.
#[inline(always)]
fn kept(field: &mut Option<Strips>, start: usize, columns: usize) -> &mut [Chunk] {
    match field {
        Some(field) => &mut field.chunks[start..][..columns],
        None => &mut [],
    }
}

/// The strip that is passed over next: a deposit looks at few places of it, too far apart for a processor to foresee.
#[derive(Debug, Clone, Copy)]
pub struct NextStrip {
    /// Distance in chunks to it from the same column of the strip that is passed over, of the pin and of the disc.
    to_pin: isize,
    to_disc: isize,
    /// True if a cell of it touches whose base is resin: then b_p is looked at in all columns.
    pub resin_touches: bool,
}

impl NextStrip {
    /// Columns that are fetched at a time.
    const COLUMNS: usize = 16;

    /// Returns the strip after this one; none where all strips of the pin stay near the processor from step to step.
    #[inline]
    pub fn of(strip: usize, pin: &PinStrips, disc: &DiscSector) -> Option<Self> {
        if pin.stays {
            return None;
        }
        let resin_touches = pin.resin_touches((strip + 1) % pin.height.strips(), 0..pin.columns);
        Some(Self { to_pin: pin.height.to_next(strip), to_disc: disc.height.to_next(strip), resin_touches })
    }

    /// Has columns of it from one on, up to an end, brought near the processor, and returns where those end: of these fields of the pin and
    /// of the disc, which are given for the strip that is passed over, as far as they are kept. All columns where it need not be fetched.
    #[inline(always)]
    pub fn fetch(next: Option<Self>, column: usize, end: usize, pin: [&[Chunk]; 2], disc: [&[Chunk]; 2]) -> usize {
        let Some(Self { to_pin, to_disc, .. }) = next else { return end };
        let end = end.min(column + Self::COLUMNS);
        for (distance, fields) in [(to_pin, pin), (to_disc, disc)] {
            let chunks = fields.into_iter().filter_map(|field| field.get(column..end)).flatten();
            chunks.for_each(|chunk| chunk.fetch(distance));
        }
        end
    }
}

/// A sector of the disc: the columns from `first` on.
#[derive(Debug, Clone, PartialEq)]
pub struct DiscSector {
    /// First column on the ring.
    pub first: usize,
    /// Number of columns.
    pub columns: usize,
    /// Surface height z_d, m.
    pub height: Strips,
    /// Substrate height b_d, m; where neither build-up nor wear ever parts them, b_d = z_d is not kept.
    pub substrate: Option<Strips>,
}

impl DiscSector {
    /// Some rows of a sector, which begins with column `first`, before the first step; `builds_up` tells whether the disc
    /// can.
    pub fn new(mesh: &Mesh, own: Range<usize>, first: usize, heights: &[f64], builds_up: bool) -> Self {
        let height = Strips::of_columns(mesh, own, heights);
        Self { first, columns: height.columns, substrate: builds_up.then(|| height.clone()), height }
    }

    /// Changes a column between two steps.
    pub fn set_column(&mut self, column: usize, heights: &[f64], substrates: &[f64]) {
        self.height.set_column(column, heights);
        if let Some(substrate) = &mut self.substrate {
            substrate.set_column(column, substrates);
        }
    }

    /// z_d and b_d (none where it is not kept) of so many columns of a strip, from one on.
    #[inline(always)]
    pub fn strip_mut(&mut self, strip: usize, first: usize, columns: usize) -> (&mut [Chunk], &mut [Chunk]) {
        let start = strip * self.columns + first;
        // One field is enough to see that the strip has these columns.
        (&mut self.height.strip_mut(strip)[first..][..columns], kept(&mut self.substrate, start, columns))
    }

    /// Substrate height b_d, m, kept or not.
    pub fn substrate(&self) -> &Strips {
        self.substrate.as_ref().unwrap_or(&self.height)
    }
}

/// Pin as a worker stores it.
///
/// A worker's pin is as wide as the whole pin, but only the columns over its own sectors are up to date.
#[derive(Debug, Clone, PartialEq)]
pub struct PinStrips {
    /// Surface height z_p, m.
    pub height: Strips,
    /// Substrate height b_p, m; without formation a pin has no build-up, and b_p = z_p is not kept.
    pub substrate: Option<Strips>,
    /// Rows of a strip that are resin, column by column, one bit each.
    resin: Vec<u8>,
    /// Rows that are plateaus at the start of the coming step, one bit each: fibre or built up; follows from the heights.
    plateau: Vec<u8>,
    /// Rows that touch in the coming step, one bit each; from the last reading.
    touches: Vec<u8>,
    /// Cells that are there; none where all are. The others are resin out of reach.
    presence: Option<Presence>,
    columns: usize,
    /// True if z_p, b_p and z_d below them stay in a core's cache from step to step.
    stays: bool,
}

/// Some columns of a strip of the pin, to change.
#[derive(Debug)]
pub struct PinStrip<'a> {
    /// Surface height z_p, m.
    pub height: &'a mut [Chunk],
    /// Substrate height b_p, m; empty where it is not kept.
    pub substrate: &'a mut [Chunk],
    /// Rows that are resin, one bit each.
    pub resin: &'a [u8],
    /// Rows that are plateaus at the start of the coming step, one bit each.
    pub plateau: &'a mut [u8],
    /// Rows that touch in the coming step, one bit each.
    pub touches: &'a mut [u8],
    /// Rows that are there, one bit each; empty where all are.
    pub present: &'a [u8],
}

impl PinStrips {
    /// Some rows of the pin, from the beginning of a strip on, before the first step.
    pub fn new(mesh: &Mesh, own: Range<usize>, heights: &[f64], base: &[Base], needs: Needs) -> Self {
        let (rows, columns) = (own.len(), mesh.pin_columns());
        let mut height = Strips::new(rows, columns, OUT_OF_REACH);
        let mut resin = vec![0; strips(rows) * columns];
        let presence = Presence::of(mesh, own.clone());
        for column in 0..columns {
            let cells = mesh.column(column).start + own.start..mesh.column(column).start + own.end;
            height.set_column(column, &heights[cells.clone()]);
            for (row, base) in base[cells].iter().enumerate() {
                let is_absent = presence.as_ref().is_some_and(|presence| !presence.has(row, column));
                resin[row / LANES * columns + column] |= u8::from(base.is_resin() || is_absent) << (row % LANES);
            }
        }
        if let Some(presence) = &presence {
            (0..columns).for_each(|column| put_out_of_reach(presence, &mut height, column));
        }
        let plateau = resin.iter().map(|resin| !resin).collect();
        let touches = vec![0; resin.len()];
        let substrate = needs.forms.then(|| height.clone());
        let stays = 3 * size_of_val(&*height.chunks) <= second_cache();
        Self { height, substrate, resin, plateau, touches, presence, columns, stays }
    }

    /// Range of some columns of a strip, counted from their first, outside of which no cell is there.
    #[inline]
    pub fn extent(&self, strip: usize, columns: Range<usize>) -> Range<usize> {
        match &self.presence {
            Some(presence) => presence.extent(strip, &columns),
            None => 0..columns.len(),
        }
    }

    /// Tells whether a cell is there.
    pub fn is_present(&self, row: usize, column: usize) -> bool {
        self.presence.as_ref().is_none_or(|presence| presence.has(row, column))
    }

    /// Rows of a strip that are resin, column by column, one bit each.
    #[inline]
    pub fn resin(&self, strip: usize) -> &[u8] {
        &self.resin[strip * self.columns..][..self.columns]
    }

    /// Tells whether a cell of some columns of a strip touches in the coming step whose base is resin.
    #[inline(always)]
    pub fn resin_touches(&self, strip: usize, columns: Range<usize>) -> bool {
        let [resin, touches] =
            [&self.resin, &self.touches].map(|field| &field[strip * self.columns..][columns.clone()]);
        // A compiler makes a wide loop of this.
        resin.iter().zip(touches).fold(0, |any, (resin, touches)| any | resin & touches) != 0
    }

    /// Notes that a cell touches in the coming step.
    pub fn note_touch(&mut self, row: usize, column: usize) {
        self.touches[row / LANES * self.columns + column] |= 1 << (row % LANES);
    }

    /// Returns so many columns of a strip, from one on.
    #[inline(always)]
    pub fn strip_mut(&mut self, strip: usize, first: usize, columns: usize) -> PinStrip<'_> {
        let start = strip * self.columns + first;
        PinStrip {
            // One field is enough to see that the strip has these columns.
            height: &mut self.height.strip_mut(strip)[first..][..columns],
            substrate: kept(&mut self.substrate, start, columns),
            resin: &self.resin[start..][..columns],
            plateau: &mut self.plateau[start..][..columns],
            touches: &mut self.touches[start..][..columns],
            present: match &self.presence {
                Some(presence) => &presence.cells[start..][..columns],
                None => &[],
            },
        }
    }

    /// Tells whether a cell's base is resin.
    pub fn is_resin(&self, row: usize, column: usize) -> bool {
        self.resin(row / LANES)[column] >> (row % LANES) & 1 == 1
    }

    /// Substrate height b_p, m, kept or not; lower than z_p where a cell wears and no debris has come upon it since.
    pub fn substrate(&self) -> &Strips {
        self.substrate.as_ref().unwrap_or(&self.height)
    }

    /// Substrate height b_p of a column, m.
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

    /// Most words of a column of so many rows on its way to another worker: see [`PinStrips::write_crossing`].
    pub fn crossing_words(rows: usize) -> usize {
        (1 + 2 * LANES) * strips(rows)
    }

    /// Writes a column that crosses to another worker: of each strip which cells are plateaus, z_p, and b_p where there is build-up;
    /// elsewhere b_p has no meaning but z_p.
    pub fn write_crossing(&self, column: usize, words: &mut Vec<u64>) {
        let substrate = self.substrate();
        for strip in 0..self.height.strips() {
            let (height, substrate) = (self.height.chunk(strip, column).0, substrate.chunk(strip, column).0);
            let plateau = self.plateau[strip * self.columns + column];
            let builds_up = height.iter().zip(&substrate).any(|(height, substrate)| height < substrate);
            words.push(u64::from(plateau) | u64::from(builds_up) << 8);
            words.extend_from_slice(&height.map(f64::to_bits));
            if builds_up {
                words.extend_from_slice(&substrate.map(f64::to_bits));
            }
        }
    }

    /// Takes over a column that another worker wrote with [`PinStrips::write_crossing`].
    pub fn read_crossing(&mut self, column: usize, mut words: &[u64]) {
        for strip in 0..self.height.strips() {
            let Some((first, rest)) = words.split_first() else { return };
            let (height, rest) = Chunk::of_words(rest);
            let (substrate, rest) = if first >> 8 == 1 { Chunk::of_words(rest) } else { (height, rest) };
            self.height.strip_mut(strip)[column] = height;
            if let Some(field) = &mut self.substrate {
                field.strip_mut(strip)[column] = substrate;
            }
            self.plateau[strip * self.columns + column] = *first as u8;
            words = rest;
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

/// The cells of the pin that are there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Presence {
    /// Rows of a strip that are there, column by column, one bit each; rows that only fill up the last strip count as there.
    cells: Vec<u8>,
    /// Columns of each strip outside of which no cell is there.
    extents: Vec<Range<usize>>,
    columns: usize,
}

impl Presence {
    /// Presence of some rows of the pin, from the beginning of a strip on; none where all cells are there.
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

    /// Rows of a strip that are there in some of its columns, one bit each.
    #[inline]
    pub fn cells(&self, strip: usize, columns: &Range<usize>) -> &[u8] {
        &self.cells[strip * self.columns..][..self.columns][columns.clone()]
    }

    /// Range of some columns of a strip, counted from their first, outside of which no cell is there.
    #[inline]
    pub fn extent(&self, strip: usize, columns: &Range<usize>) -> Range<usize> {
        let count = |column: usize| column.clamp(columns.start, columns.end) - columns.start;
        let Range { start, end } = &self.extents[strip];
        count(*start)..count(*end)
    }

    /// Tells whether a cell is there.
    pub fn has(&self, row: usize, column: usize) -> bool {
        self.cells[row / LANES * self.columns + column] >> (row % LANES) & 1 == 1
    }
}

#[cfg(test)]
#[path = "../../tests/unit/engine/strips.rs"]
mod tests;
