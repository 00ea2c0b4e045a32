//! The areal linear Gaussian filter, and lines continued by their mirror image.

use std::f64::consts::{LN_2, PI};

use rayon::prelude::*;

use super::error::PreparationError;
use super::heights::{change, rms};
use super::{Length, Patch};

/// Index of the point that lies `at` - `reach` points after the first of `count`, mirrored at either end: the end points
/// come twice, so that the mirror stands half a pitch beyond them.
pub(super) fn mirrored(at: usize, reach: usize, count: usize) -> usize {
    // A whole number of periods is added so that the difference is not negative.
    let period = 2 * count;
    let place = (at + reach.div_ceil(period) * period - reach) % period;
    place.min(period - 1 - place)
}

/// Weights smaller than this, by the one in the middle, are left out.
const SMALLEST_WEIGHT: f64 = 1e-16;
/// Fewest pitches in a nesting index: half of what a wave of it needs to be seen in the points.
const FEWEST_PITCHES: f64 = 2.0;
/// Lengths that differ by less than this are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// Filters a patch without missing points: the S-filter keeps the waves longer than its nesting index, m, the L-filter
/// then takes out those longer than its own. Gives what was done, one step a line.
///
/// With `closed` the columns run round the ring.
pub(super) fn filter(
    patch: &mut Patch,
    s_filter: Option<f64>,
    l_filter: Option<f64>,
    closed: bool,
) -> Result<Vec<String>, PreparationError> {
    let mut report = Vec::new();
    let ends = if closed { "closed round the ring, mirrored at its edges" } else { "mirrored at the edges" };
    for (key, nesting_index) in [("s_filter", s_filter), ("l_filter", l_filter)] {
        let Some(nesting_index) = nesting_index else { continue };
        check(patch, key, nesting_index)?;
        let before = rms(&patch.heights);
        let long = long_waves(patch, nesting_index, closed);
        let out = if key == "s_filter" {
            patch.heights = long;
            "S-filter: waves shorter"
        } else {
            patch.heights.iter_mut().zip(long).for_each(|(height, long)| *height -= long);
            "L-filter: waves longer"
        };
        report.push(format!(
            "{out} than {} taken out by an areal Gaussian filter, {ends}: {}",
            Length(nesting_index),
            change(before, &patch.heights)
        ));
    }
    Ok(report)
}

/// Refuses a nesting index, m, that is shorter than two pitches of the patch or longer than its shorter side; `key` names
/// it in the error.
fn check(patch: &Patch, key: &'static str, nesting_index: f64) -> Result<(), PreparationError> {
    let shortest = FEWEST_PITCHES * patch.column_pitch.max(patch.row_pitch);
    let longest = patch.length().min(patch.height());
    if nesting_index >= shortest * (1.0 - SAME_LENGTH) && nesting_index <= longest * (1.0 + SAME_LENGTH) {
        Ok(())
    } else {
        Err(PreparationError::NestingIndex { key, found: nesting_index, shortest, longest })
    }
}

/// The long waves of a patch without missing points: the areal linear Gaussian filter of ISO 16610-61:2015 with this nesting
/// index λ, m, one height for every point.
///
/// Each height becomes the mean of those round it with the weights exp(−π (x² + y²)/(αλ)²), α² = ln 2/π, so that half of a
/// wave of length λ is left. The weights are the product of one for x and one for y and are applied one after the other;
/// where they are less than 1e-16 of the largest they end. Beyond its edges the patch is continued by its mirror image (line
/// symmetrical reflection in ISO 16610-28:2016): this keeps the mean of the heights, and is how a patch is repeated round
/// the ring. With `closed` the columns run round the ring and are continued by themselves.
fn long_waves(patch: &Patch, nesting_index: f64, closed: bool) -> Vec<f64> {
    let across = weights(nesting_index / patch.row_pitch);
    let along = weights(nesting_index / patch.column_pitch);
    let smooth = filtered(&patch.heights, patch.rows, &across, false);
    let smooth = filtered(&transposed(&smooth, patch.rows), patch.columns, &along, closed);
    transposed(&smooth, patch.columns)
}

/// Weights of the points 0, 1, 2, … away on either side, together 1, of a nesting index in pitches.
fn weights(nesting_index: f64) -> Vec<f64> {
    // π (k/(αλ))² = (πk/λ)²/ln 2.
    let reach = libm::floor(nesting_index * (-libm::log(SMALLEST_WEIGHT) * LN_2).sqrt() / PI) as usize;
    let weight = |away: usize| {
        let place = PI * away as f64 / nesting_index;
        libm::exp(-place * place / LN_2)
    };
    let weights: Vec<f64> = (0..=reach).map(weight).collect();
    // The small ones first.
    let sum = 2.0 * weights.iter().skip(1).rev().sum::<f64>() + weights[0];
    weights.iter().map(|weight| weight / sum).collect()
}

/// Every line of so many points filtered.
fn filtered(heights: &[f64], length: usize, weights: &[f64], closed: bool) -> Vec<f64> {
    let reach = weights.len() - 1;
    let old = |at: usize| {
        if closed { (at + reach.div_ceil(length) * length - reach) % length } else { mirrored(at, reach, length) }
    };
    let places: Vec<usize> = (0..length + 2 * reach).map(old).collect();
    let mut smooth = vec![0.0; heights.len()];
    smooth.par_chunks_exact_mut(length).zip(heights.par_chunks_exact(length)).for_each(|(smooth, line)| {
        let line: Vec<f64> = places.iter().map(|place| line[*place]).collect();
        for (away, weight) in weights.iter().enumerate().skip(1).rev() {
            let (before, behind) = (&line[reach - away..], &line[reach + away..]);
            let pairs = before.iter().zip(behind);
            smooth.iter_mut().zip(pairs).for_each(|(sum, (before, behind))| *sum += weight * (before + behind));
        }
        smooth.iter_mut().zip(&line[reach..]).for_each(|(sum, height)| *sum += weights[0] * height);
    });
    smooth
}

/// Lines of so many points exchanged with what stands across them.
fn transposed(heights: &[f64], length: usize) -> Vec<f64> {
    (0..length).flat_map(|at| heights.iter().skip(at).step_by(length)).copied().collect()
}
