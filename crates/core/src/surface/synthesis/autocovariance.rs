//! The autocorrelation of a measured patch at whole cells.

use super::SMALLEST_RMS;
use crate::surface::fft::Complex;
use crate::surface::fft2d::Fft2d;

/// Lags up to this part of the patch keep what was measured; beyond it the autocorrelation goes to 0 at the patch's own
/// length.
const KEPT: f64 = 0.5;

/// ρ at lags of whole cells, 1 at lag 0, point-symmetric, 0 from the patch's length on.
#[derive(Debug)]
pub(super) struct Autocovariance {
    /// Cells of the patch along x and y: lags are shorter.
    pub cells: [usize; 2],
    /// ρ(x, y) for x from 1 − cells and y from 1 − cells on, x by x.
    values: Vec<f64>,
}

impl Autocovariance {
    /// Of grids of so many columns and rows, each a sample of the same surface about the same mean; none where all heights are
    /// alike.
    ///
    /// ρ = (Σ z z′ / pairs at that lag) / (the same at lag 0), times a window that is 1 up to half of the patch and goes to 0
    /// as a cosine at its length, where few pairs are left.
    pub fn of(grids: &[Vec<f64>], [columns, rows]: [usize; 2]) -> Option<Self> {
        let points = grids.iter().map(Vec::len).sum::<usize>();
        let mean = grids.iter().flatten().sum::<f64>() / points as f64;
        // Twice the length, so that no lag wraps round.
        let mut plane = Fft2d::new((2 * columns).next_power_of_two(), (2 * rows).next_power_of_two());
        let mut power = vec![0.0; plane.columns() * plane.rows()];
        for grid in grids {
            let mut values = vec![Complex::default(); power.len()];
            for (line, heights) in values.chunks_exact_mut(plane.rows()).zip(grid.chunks_exact(rows)) {
                line.iter_mut().zip(heights).for_each(|(value, height)| value.re = height - mean);
            }
            plane.forward(&mut values);
            power.iter_mut().zip(&values).for_each(|(power, value)| *power += value.norm_sqr());
        }
        let mut sums: Vec<Complex> = power.iter().map(|power| Complex { re: *power, im: 0.0 }).collect();
        plane.forward(&mut sums);
        // The sum over the transform is that over the heights times the points of the plane.
        let variance = sums[0].re / (columns * rows) as f64;
        let rms = (variance / (power.len() * grids.len()) as f64).sqrt();
        let largest = grids.iter().flatten().fold(0.0_f64, |largest, height| largest.max(height.abs()));
        if !(rms > SMALLEST_RMS * largest && rms.is_finite()) {
            return None;
        }
        let mut values = Vec::with_capacity((2 * columns - 1) * (2 * rows - 1));
        for x in lags(columns) {
            for y in lags(rows) {
                let [column, row] = [wrapped(x, plane.columns()), wrapped(y, plane.rows())];
                let pairs = (columns - x.unsigned_abs()) * (rows - y.unsigned_abs());
                let measured = sums[column * plane.rows() + row].re / pairs as f64 / variance;
                values.push(measured.clamp(-1.0, 1.0) * window(x, columns) * window(y, rows));
            }
        }
        Some(Self { cells: [columns, rows], values })
    }

    /// Every lag with its ρ.
    pub fn lags(&self) -> impl Iterator<Item = ([isize; 2], f64)> + '_ {
        let [columns, rows] = self.cells;
        let places = lags(columns).flat_map(move |x| lags(rows).map(move |y| [x, y]));
        places.zip(self.values.iter().copied())
    }

    /// How many independent heights the patch holds where its variance is concerned: cells / Σ ρ² (Bartlett 1946,
    /// doi:10.2307/2983611).
    pub fn independent(&self) -> f64 {
        let [columns, rows] = self.cells;
        (columns * rows) as f64 / self.values.iter().map(|value| value * value).sum::<f64>()
    }
}

/// Lags of a line of so many cells.
fn lags(cells: usize) -> impl Iterator<Item = isize> + Clone {
    1 - cells as isize..cells as isize
}

/// The index of a lag on a periodic line of so many points.
pub(super) fn wrapped(lag: isize, points: usize) -> usize {
    lag.rem_euclid(points as isize) as usize
}

/// 1 up to a part of the patch, then a cosine down to 0.
fn window(lag: isize, cells: usize) -> f64 {
    let part = lag.unsigned_abs() as f64 / cells as f64;
    let beyond = ((part - KEPT) / (1.0 - KEPT)).max(0.0);
    0.5 + 0.5 * libm::cos(std::f64::consts::PI * beyond)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_mean_product_over_all_pairs() {
        // The definition, lag by lag.
        let (columns, rows) = (9, 7);
        let height = |x: usize, y: usize| ((x * x + 3 * y + x * y) % 11) as f64;
        let grid: Vec<f64> = (0..columns).flat_map(|x| (0..rows).map(move |y| height(x, y))).collect();
        let mean = grid.iter().sum::<f64>() / 63.0;
        let variance = grid.iter().map(|z| (z - mean) * (z - mean)).sum::<f64>() / 63.0;
        let found = Autocovariance::of(std::slice::from_ref(&grid), [columns, rows]).unwrap();
        for ([x, y], value) in found.lags().filter(|([x, y], _)| x.abs() <= 4 && y.abs() <= 3) {
            let (mut sum, mut pairs) = (0.0, 0.0);
            for (column, row) in (0..9_isize).flat_map(|column| (0..7_isize).map(move |row| (column, row))) {
                let (other, next) = (column + x, row + y);
                if (0..9).contains(&other) && (0..7).contains(&next) {
                    sum +=
                        (height(column as usize, row as usize) - mean) * (height(other as usize, next as usize) - mean);
                    pairs += 1.0;
                }
            }
            let expected: f64 = (sum / pairs / variance).clamp(-1.0, 1.0);
            assert!((value - expected).abs() < 1e-12, "lag {x}, {y}: {value}, expected {expected}");
        }
    }

    #[test]
    fn a_plane_of_one_height_has_none() {
        assert!(Autocovariance::of(&[vec![3.0; 12]], [4, 3]).is_none());
    }
}
