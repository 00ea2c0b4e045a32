//! Heights with their shape, and sums over many of them.

use rayon::prelude::*;

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

/// Terms that are summed one after the other.
const BLOCK: usize = 1 << 14;

/// Sums of `N` terms of every measured value.
///
/// Blocks of fixed length are summed by themselves and then in their order: the sums do not depend on the number of
/// threads, and rounding grows with the length of a block and the number of blocks only.
pub(super) fn sums<const N: usize>(values: &[f64], terms: impl Fn(f64) -> [f64; N] + Sync) -> [f64; N] {
    let blocks: Vec<[f64; N]> = values
        .par_chunks(BLOCK)
        .map(|block| {
            let measured = block.iter().filter(|value| !value.is_nan());
            measured.fold([0.0; N], |sum, value| added(sum, terms(*value)))
        })
        .collect();
    blocks.into_iter().fold([0.0; N], added)
}

/// Sum of both, number by number.
pub(super) fn added<const N: usize>(mut sum: [f64; N], terms: [f64; N]) -> [f64; N] {
    sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    sum
}
