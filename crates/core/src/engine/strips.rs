//! Storage of heights as the kernels want it, and the disc in it: strips of eight rows, each strip column by column.
//!
//! A strip of a column is one [`Chunk`]; a sweep along a strip reads and writes memory from one end to the other. Rows
//! beyond the mesh fill up the last strip: the pin's are so high, and the disc's so low, that they never touch.

use std::ops::Range;

use crate::engine::lanes::{Chunk, LANES};
use crate::model::mesh::Mesh;

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
    /// The same height everywhere.
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

    /// A chunk.
    pub fn chunk(&self, strip: usize, column: usize) -> &Chunk {
        &self.chunks[strip * self.columns + column]
    }

    /// Number of strips.
    pub fn strips(&self) -> usize {
        strips(self.rows)
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

    /// Looks at every strip of a column, which brings it near the processor.
    pub fn fetch_column(&self, column: usize) {
        for chunk in self.chunks.iter().skip(column).step_by(self.columns) {
            std::hint::black_box(chunk.0[0]);
        }
    }

    /// Changes the rows of a column.
    pub fn set_column(&mut self, column: usize, heights: &[f64]) {
        for (chunk, heights) in self.chunks.iter_mut().skip(column).step_by(self.columns).zip(heights.chunks(LANES)) {
            // −0 becomes 0: the kernels compare bits.
            chunk.0.iter_mut().zip(heights).for_each(|(place, height)| *place = height + 0.0);
        }
    }
}

/// A sector of the disc: the columns from `first` on.
#[derive(Debug, Clone, PartialEq)]
pub struct DiscSector {
    /// Its first column on the ring.
    pub first: usize,
    /// Its columns.
    pub columns: usize,
    /// z_d, m.
    pub height: Strips,
    /// b_d, m; where neither build-up nor wear ever parts them, b_d = z_d is not kept.
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

    /// A strip of z_d and of b_d (none where it is not kept).
    #[inline]
    pub fn strip_mut(&mut self, strip: usize) -> (&mut [Chunk], &mut [Chunk]) {
        let substrate = match &mut self.substrate {
            Some(substrate) => substrate.strip_mut(strip),
            None => &mut [],
        };
        (self.height.strip_mut(strip), substrate)
    }

    /// b_d, m, kept or not.
    pub fn substrate(&self) -> &Strips {
        self.substrate.as_ref().unwrap_or(&self.height)
    }
}
