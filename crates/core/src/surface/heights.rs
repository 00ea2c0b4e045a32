//! Moments of heights: height parameters of ISO 25178-2:2021, 4.2. The Python package has the others.

use rayon::prelude::*;

use super::Length;

/// Terms that are summed one after the other.
const BLOCK: usize = 1 << 14;

/// Moments of the heights above their mean: every measured point counts alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightParameters {
    /// z̄, m: the mean that the others are measured from.
    pub mean: f64,
    /// Sq = √⟨(z − z̄)²⟩, m.
    pub root_mean_square_height: f64,
    /// Ssk = ⟨(z − z̄)³⟩/Sq³; NaN where all heights are equal.
    pub skewness: f64,
    /// Sku = ⟨(z − z̄)⁴⟩/Sq⁴; NaN where all heights are equal.
    pub kurtosis: f64,
}

impl HeightParameters {
    /// Moments of the heights that are there, not NaN; none if there are none.
    pub fn of(heights: &[f64]) -> Option<Self> {
        let [count, sum, _] = sums(heights, |z| [1.0, z, 0.0]);
        if count == 0.0 {
            return None;
        }
        // What rounding left of a large offset is taken out by the mean of the differences; added to the first mean for
        // those who need one number, but not here, for that rounds it again.
        let first = sum / count;
        let rest = sums(heights, |z| [z - first, 0.0, 0.0])[0] / count;
        let moments = sums(heights, |z| {
            let height = (z - first) - rest;
            let square = height * height;
            [square, square * height, square * square]
        });
        let mut measured = heights.iter().filter(|height| !height.is_nan());
        let flat = measured.next().is_none_or(|first| measured.all(|height| height == first));
        let [square, cube, fourth] = moments.map(|moment| moment / count);
        let rms = square.sqrt();
        Some(Self {
            mean: first + rest,
            root_mean_square_height: rms,
            skewness: if flat { f64::NAN } else { cube / (square * rms) },
            kurtosis: if flat { f64::NAN } else { fourth / (square * square) },
        })
    }
}

/// Sums of three terms of every measured value.
///
/// Blocks of fixed length are summed by themselves and then in their order: the sums do not depend on the number of
/// threads, and rounding grows with the length of a block and the number of blocks only.
fn sums(values: &[f64], terms: impl Fn(f64) -> [f64; 3] + Sync) -> [f64; 3] {
    let added = |sum: [f64; 3], terms: [f64; 3]| [sum[0] + terms[0], sum[1] + terms[1], sum[2] + terms[2]];
    let of_block = |block: &[f64]| {
        let measured = block.iter().filter(|value| !value.is_nan());
        measured.fold([0.0; 3], |sum, value| added(sum, terms(*value)))
    };
    let blocks: Vec<[f64; 3]> = values.par_chunks(BLOCK).map(of_block).collect();
    blocks.into_iter().fold([0.0; 3], added)
}

/// Mean of the points that are there; NaN without any.
pub(super) fn mean(heights: &[f64]) -> f64 {
    let valid = || heights.iter().filter(|height| !height.is_nan());
    let count = valid().count() as f64;
    let first = valid().sum::<f64>() / count;
    // Rounding of a large offset is taken out by the mean of what is left.
    first + valid().map(|height| height - first).sum::<f64>() / count
}

/// Root-mean-square deviation from the mean of the points that are there; NaN without any.
pub(super) fn rms(heights: &[f64]) -> f64 {
    let mean = mean(heights);
    let valid = || heights.iter().filter(|height| !height.is_nan()).map(|height| height - mean);
    (valid().map(|height| height * height).sum::<f64>() / valid().count() as f64).sqrt()
}

/// Says how a step changed the rms height.
pub(super) fn change(before: f64, heights: &[f64]) -> String {
    format!("rms {} -> {}", Length(before), Length(rms(heights)))
}
