//! Σ f(x, y) f(x + s, y + t) over all pairs of points of a grid, for all lags (s, t) up to half its size.

use std::sync::Arc;

use rayon::prelude::*;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// Harmonics along y that are kept together, so that both passes move along the memory.
const BAND: usize = 16;
/// Columns that are transformed along y at a time.
const BATCH: usize = 64;

/// The lags 0 ≤ s ≤ columns/2, |t| ≤ rows/2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lags {
    /// Largest lag along x, in points.
    pub x: usize,
    /// Largest lag along y, in points.
    pub y: usize,
}

impl Lags {
    pub(super) fn of(columns: usize, rows: usize) -> Self {
        Self { x: columns / 2, y: rows / 2 }
    }

    /// Number of lags along y.
    pub(super) fn height(self) -> usize {
        2 * self.y + 1
    }

    /// Place of a lag in the field that [`correlate`] gives.
    pub(super) fn place(self, x: usize, y: isize) -> usize {
        x * self.height() + self.y.saturating_add_signed(y)
    }
}

/// The sums for all [`Lags`], column by column (a lag s along x has all lags t along y, the most negative first), each
/// brought into the wanted form by `finish`. `value` makes f of what the grid holds.
///
/// Zeros round the grid, half as many as there are points, keep the transforms from closing it on itself (Wiener and
/// Khinchin).
pub(super) fn correlate<T: Copy + Default + Send + Sync>(
    columns: &[&[f64]],
    value: impl Fn(f64) -> f64 + Sync,
    finish: impl Fn(f64) -> T + Sync,
) -> Vec<T> {
    let rows = columns.first().map_or(0, |column| column.len());
    let lags = Lags::of(columns.len(), rows);
    let (height, width) = (fast_length(rows + lags.y), fast_length(columns.len() + lags.x));
    let mut harmonics = transform_along_y(columns, height, value);
    square_along_x(&mut harmonics, columns.len(), width, lags.x);
    let scale = 1.0 / (height as f64 * width as f64);
    transform_back_along_y(&harmonics, height, lags, |sum| finish(sum * scale))
}

/// Bytes that [`correlate`] takes for a grid of that size, at most, with its result.
pub(super) fn memory_needed<T>(columns: usize, rows: usize) -> u64 {
    let lags = Lags::of(columns, rows);
    let harmonics = (fast_length(rows + lags.y) / 2 + 1).next_multiple_of(BAND);
    let kept = |columns: usize| (columns as u64).saturating_mul((harmonics * size_of::<Complex<f64>>()) as u64);
    let field = ((lags.x as u64 + 1) * lags.height() as u64).saturating_mul(size_of::<T>() as u64);
    // The field is made when the lags along x are left of the columns.
    kept(columns).saturating_add(kept(BATCH.min(columns))).max(kept(lags.x + 1).saturating_add(field))
}

/// Harmonics of every column, band by band; in a band, column by column.
fn transform_along_y(columns: &[&[f64]], height: usize, value: impl Fn(f64) -> f64 + Sync) -> Vec<Complex<f64>> {
    let plan = RealFftPlanner::new().plan_fft_forward(height);
    let count = plan.complex_len().next_multiple_of(BAND);
    let mut harmonics = vec![Complex::default(); columns.len() * count];
    let mut lines = vec![Complex::default(); BATCH.min(columns.len()) * count];
    for (batch, part) in columns.chunks(BATCH).enumerate() {
        lines.par_chunks_mut(count).zip(part).for_each_init(
            || (plan.make_input_vec(), plan.make_scratch_vec()),
            |(input, scratch), (line, column)| {
                input.fill(0.0);
                input.iter_mut().zip(*column).for_each(|(place, height)| *place = value(*height));
                // It fails for lengths other than the plan's, of which all are.
                let _ = plan.process_with_scratch(input, &mut line[..plan.complex_len()], scratch);
            },
        );
        harmonics.par_chunks_mut(columns.len() * BAND).enumerate().for_each(|(band, kept)| {
            let kept = kept.chunks_exact_mut(BAND).skip(batch * BATCH);
            for (kept, line) in kept.zip(lines.chunks_exact(count).take(part.len())) {
                kept.copy_from_slice(&line[band * BAND..(band + 1) * BAND]);
            }
        });
    }
    harmonics
}

/// From the harmonics Z(x) of every column to Σ Z̄(x) Z(x + s) for 0 ≤ s ≤ `largest`, which need less memory.
fn square_along_x(harmonics: &mut Vec<Complex<f64>>, columns: usize, width: usize, largest: usize) {
    let mut planner = FftPlanner::new();
    let (forward, backward): (Arc<dyn Fft<f64>>, _) =
        (planner.plan_fft_forward(width), planner.plan_fft_inverse(width));
    let scratch = forward.get_inplace_scratch_len().max(backward.get_inplace_scratch_len());
    harmonics.par_chunks_mut(columns * BAND).for_each_init(
        || (vec![Complex::default(); width], vec![Complex::default(); scratch]),
        |(line, scratch), band| {
            for harmonic in 0..BAND {
                line[columns..].fill(Complex::default());
                line.iter_mut()
                    .zip(band.iter().skip(harmonic).step_by(BAND))
                    .for_each(|(place, value)| *place = *value);
                forward.process_with_scratch(line, scratch);
                line.iter_mut().for_each(|value| *value = value.norm_sqr().into());
                backward.process_with_scratch(line, scratch);
                let lags = band.iter_mut().skip(harmonic).step_by(BAND);
                lags.zip(&line[..=largest]).for_each(|(place, value)| *place = *value);
            }
        },
    );
    let (all, kept) = (columns * BAND, (largest + 1) * BAND);
    let bands = harmonics.len() / all;
    (1..bands).for_each(|band| harmonics.copy_within(band * all..band * all + kept, band * kept));
    harmonics.truncate(bands * kept);
    harmonics.shrink_to_fit();
}

/// From the harmonics of every lag along x to the wanted lags along y.
fn transform_back_along_y<T: Copy + Default + Send + Sync>(
    harmonics: &[Complex<f64>],
    height: usize,
    lags: Lags,
    finish: impl Fn(f64) -> T + Sync,
) -> Vec<T> {
    let plan = RealFftPlanner::new().plan_fft_inverse(height);
    let mut field = vec![T::default(); (lags.x + 1) * lags.height()];
    field.par_chunks_mut(lags.height()).enumerate().for_each_init(
        || (plan.make_input_vec(), plan.make_output_vec(), plan.make_scratch_vec()),
        |(input, output, scratch), (lag, line)| {
            for (band, part) in harmonics.chunks_exact((lags.x + 1) * BAND).zip(input.chunks_mut(BAND)) {
                part.copy_from_slice(&band[lag * BAND..lag * BAND + part.len()]);
            }
            // The first and the last harmonic of real values are real but for rounding, which the transform would refuse.
            if let [first, .., last] = input.as_mut_slice() {
                (first.im, last.im) = (0.0, 0.0);
            }
            let _ = plan.process_with_scratch(input, output, scratch);
            // Negative lags are at the end.
            let around = output[height - lags.y..].iter().chain(&output[..=lags.y]);
            line.iter_mut().zip(around).for_each(|(place, sum)| *place = finish(*sum));
        },
    );
    field
}

/// The smallest even number of at least `length` without prime factors above 5: transforms of such lengths are quick.
fn fast_length(length: usize) -> usize {
    let mut candidate = length.max(2).next_multiple_of(2);
    while !is_fast(candidate) {
        candidate += 2;
    }
    candidate
}

fn is_fast(mut length: usize) -> bool {
    for factor in [2, 3, 5] {
        while length.is_multiple_of(factor) {
            length /= factor;
        }
    }
    length == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_sums_that_define_it() {
        // The direct sums; rounding is a few ε times Σ f², about 40 here.
        for (columns, rows) in [(1, 1), (1, 9), (8, 1), (5, 7), (70, 12), (6, 45)] {
            let f: Vec<f64> = (0..columns * rows).map(|i| ((i * i + 3 * i) % 17) as f64 / 8.0 - 1.0).collect();
            let slices: Vec<&[f64]> = f.chunks(rows).collect();
            let lags = Lags::of(columns, rows);
            let found = correlate(&slices, |height| height, |sum| sum);
            assert_eq!(found.len(), (lags.x + 1) * lags.height());
            for s in 0..=lags.x {
                for t in -(lags.y as isize)..=lags.y as isize {
                    let mut expected = 0.0;
                    for x in 0..columns - s {
                        for y in (0..rows).filter(|y| y.checked_add_signed(t).is_some_and(|other| other < rows)) {
                            expected += slices[x][y] * slices[x + s][y.saturating_add_signed(t)];
                        }
                    }
                    let found = found[lags.place(s, t)];
                    assert!((found - expected).abs() < 1e-11, "{columns} x {rows}, lag {s}, {t}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn lengths_are_quick_ones() {
        for (length, fast) in [(0, 2), (1, 2), (7, 8), (97, 100), (6144, 6144), (6145, 6250)] {
            assert_eq!(fast_length(length), fast);
        }
    }
}
