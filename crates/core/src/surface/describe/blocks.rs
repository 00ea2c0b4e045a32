//! Sums over many heights, shared among threads.

use rayon::prelude::*;

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
