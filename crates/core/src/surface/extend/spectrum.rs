//! The areal power spectrum of a patch at the harmonics of a larger grid.
//!
//! The patch is multiplied with a taper before its transform, or its edges would look like steps, whose spectrum hides
//! that of a smooth surface. Sine tapers bias the spectrum least (Riedel and Sidorenko 1995, doi:10.1109/78.365298):
//! v_k(j) = √(2/(n + 1)) sin(πk(j + 1)/(n + 1)), k = 1, 2. The mean of the spectra with the four products of two along and
//! two across uses the patch better than one of them; each is a square, so that no power is negative and what
//! belongs to it is an autocorrelation.

use std::f64::consts::PI;

use super::super::Patch;
use super::super::fft::{Complex, Fft};
use super::super::level::mean;
use super::super::synthesis::grid::Grid;
use super::super::synthesis::planar::Plane;

/// Tapers in either direction.
const TAPERS: usize = 2;

/// The spectrum of a patch.
pub(super) struct Spectrum {
    /// Power at every harmonic of the padded grid, column by column, up to a factor.
    pub(super) power: Vec<f64>,
    /// Share of the patch's mean square height that the tapered patches lack once their mean is taken out. It is in waves
    /// about as long as the patch, and put back there, with the spectrum of the tapers themselves.
    pub(super) long_waves: f64,
}

impl Spectrum {
    /// That of a patch whose points are cells of the grid.
    ///
    /// The transform at the harmonics of the grid of a patch that is longer than the grid is that of the patch wound round
    /// it.
    pub(super) fn of(cells: &Patch, grid: &Grid) -> Self {
        let (columns, rows) = (grid.padded_columns, grid.padded_rows);
        let (along, across) = (tapers(cells.columns), tapers(cells.rows));
        let mut plane = Plane::new(grid);
        let mut power = vec![0.0; columns * rows];
        for first in &along {
            // Two real fields travel as the two parts of a complex one.
            let mut values = vec![Complex::default(); columns * rows];
            let tapered = across.each_ref().map(|second| tapered(cells, first, second));
            for (index, (one, other)) in tapered[0].iter().zip(&tapered[1]).enumerate() {
                let (column, row) = (index / cells.rows % columns, index % cells.rows % rows);
                values[column * rows + row] += Complex { re: *one, im: *other };
            }
            plane.forward(&mut values);
            for column in 0..columns {
                for row in 0..rows {
                    let opposite = (columns - column) % columns * rows + (rows - row) % rows;
                    let here = column * rows + row;
                    power[here] += 0.5 * (values[here].norm_sqr() + values[opposite].norm_sqr());
                }
            }
        }
        let points = (columns * rows) as f64;
        let tapers = (TAPERS * TAPERS) as f64;
        let found = power.iter().sum::<f64>() / (tapers * points);
        let centre = mean(&cells.heights);
        let squares: f64 = cells.heights.iter().map(|height| (height - centre) * (height - centre)).sum();
        let variance = squares / cells.heights.len() as f64;
        let lacking = (variance - found).max(0.0);
        let [along, across] = [window(&along, columns), window(&across, rows)];
        for (column, along) in power.chunks_exact_mut(rows).zip(&along) {
            column.iter_mut().zip(&across).for_each(|(power, across)| *power += lacking * along * across);
        }
        Self { power, long_waves: lacking / variance }
    }
}

/// Sine tapers of so many points, the sum of the squares of each being 1.
fn tapers(points: usize) -> [Vec<f64>; TAPERS] {
    let length = (points + 1) as f64;
    [1.0, 2.0].map(|order| {
        (1..=points).map(|point| (2.0 / length).sqrt() * libm::sin(PI * order * (point as f64 / length))).collect()
    })
}

/// The patch times a taper along and one across, after its mean so weighted was taken out; column by column.
fn tapered(cells: &Patch, along: &[f64], across: &[f64]) -> Vec<f64> {
    let columns = || cells.heights.chunks_exact(cells.rows).zip(along);
    let weighted = |(heights, taper): (&[f64], &f64)| {
        taper * taper * heights.iter().zip(across).map(|(height, other)| height * other * other).sum::<f64>()
    };
    let mean: f64 = columns().map(weighted).sum();
    let product = |(heights, taper): (&[f64], &f64)| -> Vec<f64> {
        heights.iter().zip(across).map(|(height, other)| (height - mean) * taper * other).collect()
    };
    columns().flat_map(product).collect()
}

/// The sum of the tapers' own power spectra at the harmonics of a line of `points` points, round which they are wound.
fn window(tapers: &[Vec<f64>; TAPERS], points: usize) -> Vec<f64> {
    let mut sum = vec![0.0; points];
    let (fft, mut work) = (Fft::new(points), Vec::new());
    for taper in tapers {
        let mut values = vec![Complex::default(); points];
        taper.iter().enumerate().for_each(|(place, value)| values[place % points].re += value);
        fft.forward(&mut values, &mut work);
        sum.iter_mut().zip(&values).for_each(|(sum, value)| *sum += value.norm_sqr());
    }
    sum
}
