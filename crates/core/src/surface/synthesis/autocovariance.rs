//! The autocorrelation of a measured patch at whole cells.

use std::f64::consts::PI;

use super::SMALLEST_RMS;
use crate::surface::fft::Complex;
use crate::surface::fft2d::Fft2d;

/// Lags up to the first of these parts of the patch keep what was measured; from there the autocorrelation goes to 0 at the
/// second, beyond which few pairs are left.
const KEPT: [f64; 2] = [0.4, 0.75];

/// Part of the patch over which its heights are faded out at either edge. Heights that end abruptly would look as if the surface
/// had steps, and so as if it were rougher.
const FADED: f64 = 0.125;

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
    /// ρ = (Σ w z w′ z′ / Σ w w′) / (the same at lag 0), with weights w that fade out at the edges (a cosine taper, Harris 1978,
    /// doi:10.1109/PROC.1978.10837), times a window that takes long lags to 0.
    pub fn of(grids: &[Vec<f64>], [columns, rows]: [usize; 2]) -> Option<Self> {
        let weights = [Weights::new(columns), Weights::new(rows)];
        let weight = |index: usize| weights[0].values[index / rows] * weights[1].values[index % rows];
        let (mut sum, mut total) = (0.0, 0.0);
        for (index, height) in grids.iter().flat_map(|grid| grid.iter().enumerate()) {
            (sum, total) = (sum + weight(index) * height, total + weight(index));
        }
        let mean = sum / total;
        // Twice the length, so that no lag wraps round.
        let mut plane = Fft2d::new((2 * columns).next_power_of_two(), (2 * rows).next_power_of_two());
        let mut power = vec![0.0; plane.columns() * plane.rows()];
        for grid in grids {
            let mut values = vec![Complex::default(); power.len()];
            for (index, height) in grid.iter().enumerate() {
                values[index / rows * plane.rows() + index % rows].re = weight(index) * (height - mean);
            }
            plane.forward(&mut values);
            power.iter_mut().zip(&values).for_each(|(power, value)| *power += value.norm_sqr());
        }
        let mut sums: Vec<Complex> = power.iter().map(|power| Complex { re: *power, im: 0.0 }).collect();
        plane.forward(&mut sums);
        let at = |x: isize, y: isize| {
            let sum = sums[wrapped(x, plane.columns()) * plane.rows() + wrapped(y, plane.rows())].re;
            sum / (weights[0].overlap[x.unsigned_abs()] * weights[1].overlap[y.unsigned_abs()])
        };
        // The sum over the transform is that over the heights times the points of the plane.
        let variance = at(0, 0);
        let rms = (variance / (power.len() * grids.len()) as f64).sqrt();
        let largest = grids.iter().flatten().fold(0.0_f64, |largest, height| largest.max(height.abs()));
        if !(rms > SMALLEST_RMS * largest && rms.is_finite()) {
            return None;
        }
        let mut values = Vec::with_capacity((2 * columns - 1) * (2 * rows - 1));
        for x in lags(columns) {
            for y in lags(rows) {
                let window = window(x, columns) * window(y, rows);
                values.push(if window == 0.0 { 0.0 } else { (at(x, y) / variance).clamp(-1.0, 1.0) * window });
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

/// Weights of the cells of a line.
struct Weights {
    values: Vec<f64>,
    /// Σ w w′ at every lag from 0 on.
    overlap: Vec<f64>,
}

impl Weights {
    fn new(cells: usize) -> Self {
        let faded = FADED * cells as f64;
        let value = |cell: usize| {
            let from_edge = cell.min(cells - 1 - cell) as f64 + 0.5;
            let part = (from_edge / faded).min(1.0);
            0.5 - 0.5 * libm::cos(PI * part)
        };
        let values: Vec<f64> = (0..cells).map(value).collect();
        let at = |lag: usize| values.iter().zip(&values[lag..]).map(|(one, other)| one * other).sum();
        let overlap = (0..cells).map(at).collect();
        Self { values, overlap }
    }
}

/// 1 up to a part of the patch, then a cosine down to 0.
fn window(lag: isize, cells: usize) -> f64 {
    let [kept, end] = KEPT;
    let part = lag.unsigned_abs() as f64 / cells as f64;
    0.5 + 0.5 * libm::cos(PI * ((part - kept) / (end - kept)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_weighted_mean_product_over_all_pairs() {
        // The definition, lag by lag.
        let (columns, rows) = (9_usize, 7_usize);
        let height = |x: usize, y: usize| ((x * x + 3 * y + x * y) % 11) as f64;
        let fade = |cell: usize, cells: usize| {
            let place = (cell.min(cells - 1 - cell) as f64 + 0.5) / (0.125 * cells as f64);
            (0.5 * PI * place.min(1.0)).sin().powi(2)
        };
        let weight = |x: usize, y: usize| fade(x, 9) * fade(y, 7);
        let places = || (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y)));
        let total: f64 = places().map(|(x, y)| weight(x, y)).sum();
        let mean = places().map(|(x, y)| weight(x, y) * height(x, y)).sum::<f64>() / total;
        let product = |x: isize, y: isize| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for (column, row) in places() {
                let (other, next) = (column as isize + x, row as isize + y);
                if (0..9).contains(&other) && (0..7).contains(&next) {
                    let (other, next) = (other as usize, next as usize);
                    let both = weight(column, row) * weight(other, next);
                    sum += both * (height(column, row) - mean) * (height(other, next) - mean);
                    weights += both;
                }
            }
            sum / weights
        };
        let grid: Vec<f64> = places().map(|(x, y)| height(x, y)).collect();
        let found = Autocovariance::of(std::slice::from_ref(&grid), [columns, rows]).unwrap();
        for ([x, y], value) in found.lags().filter(|([x, y], _)| x.abs() <= 3 && y.abs() <= 2) {
            let expected: f64 = (product(x, y) / product(0, 0)).clamp(-1.0, 1.0);
            assert!((value - expected).abs() < 1e-12, "lag {x}, {y}: {value}, expected {expected}");
        }
        let end = found.lags().filter(|([x, _], _)| x.abs() >= 7);
        assert!(end.map(|(_, value)| value).all(|value| value == 0.0), "long lags have no correlation");
    }

    #[test]
    fn a_plane_of_one_height_has_none() {
        assert!(Autocovariance::of(&[vec![3.0; 12]], [4, 3]).is_none());
    }
}
