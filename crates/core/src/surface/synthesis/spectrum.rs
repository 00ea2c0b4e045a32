//! The grid on which a field is made, the body's cells and a margin, and power spectra at its harmonics.

use std::f64::consts::{PI, TAU};

use crate::model::mesh::Mesh;
use crate::surface::Body;

/// Cells of a body, and those of the periodic field from which they are taken.
#[derive(Debug, Clone, Copy)]
pub(in crate::surface) struct Grid {
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
    pub(in crate::surface) padded_columns: usize,
    pub(in crate::surface) padded_rows: usize,
    /// Arc length of a column, m.
    pub(in crate::surface) column_width: f64,
    /// Height of a row, m.
    pub(in crate::surface) row_height: f64,
    /// How many times the field repeats along the padded columns.
    pub(in crate::surface) repeats: usize,
}

impl Grid {
    /// Largest padded field, unless the body is larger than an eighth of it.
    pub(in crate::surface) const MOST_CELLS: usize = 1 << 26;

    /// A grid so large that cells of the body that lie further apart than `reach` (along and across, m) round its edges
    /// do not feel each other. The ring closes and needs no margin along its columns.
    pub(in crate::surface) fn new(body: Body, mesh: &Mesh, reach: [f64; 2], repeats: usize) -> Self {
        let (columns, rows) = (body.columns(mesh), mesh.rows());
        let (column_width, row_height) = (mesh.column_width(), mesh.row_height());
        let padded_columns = if body == Body::Disc { columns } else { padded(columns, reach[0] / column_width) };
        let padded_rows = padded(rows, reach[1] / row_height);
        Self { columns, rows, padded_columns, padded_rows, column_width, row_height, repeats }
    }

    /// Whether the field would be far larger than the body.
    pub(in crate::surface) fn is_too_large(&self) -> bool {
        let most = Self::MOST_CELLS.max(8 * self.columns * self.rows);
        self.padded_columns.checked_mul(self.padded_rows).is_none_or(|cells| cells > most)
    }
}

/// Points of a line of `cells` cells with a margin.
fn padded(cells: usize, margin: f64) -> usize {
    (cells + libm::ceil(margin) as usize).next_power_of_two()
}

/// Harmonic of an index of a transform of `points` points, without its sign.
fn harmonic(index: usize, points: usize) -> usize {
    index.min(points - index)
}

/// Spectrum of exp(−(x/ℓ)²), ℓ in points, at every index of a line of `points` points; 0 where the harmonic is no
/// multiple of `repeats`.
pub(super) fn gaussian(points: usize, length: f64, repeats: usize) -> impl Iterator<Item = f64> {
    (0..points).map(move |index| match harmonic(index, points) {
        harmonic if harmonic.is_multiple_of(repeats) => spectrum(TAU * harmonic as f64 / points as f64, length),
        _ => 0.0,
    })
}

/// Spectrum of exp(−(x/ℓx)² − (y/ℓy)²), ℓ in cells, at every harmonic of the padded grid, column by column.
pub(super) fn gaussian_on(grid: &Grid, along: f64, across: f64) -> Vec<f64> {
    let along_y: Vec<f64> = gaussian(grid.padded_rows, across, 1).collect();
    gaussian(grid.padded_columns, along, grid.repeats)
        .flat_map(|power| along_y.iter().map(move |other| power * other))
        .collect()
}

/// A spectrum that is constant up to the wave number of `roll_off`, falls as q^(−2 − 2 hurst) from there on, and ends at
/// that of `short_cutoff`; at every harmonic of the padded grid, column by column. Up to a factor.
pub(super) fn power_law_on(grid: &Grid, hurst: f64, roll_off: f64, short_cutoff: Option<f64>) -> Vec<f64> {
    // Wave numbers as multiples of that of the roll-off.
    let last = short_cutoff.map_or(f64::INFINITY, |wavelength| roll_off / wavelength);
    let numbers = |points: usize, cell: f64| -> Vec<f64> {
        let fundamental = roll_off / (points as f64 * cell);
        (0..points).map(|index| harmonic(index, points) as f64 * fundamental).collect()
    };
    let along_x = numbers(grid.padded_columns, grid.column_width);
    let along_y = numbers(grid.padded_rows, grid.row_height);
    let mut spectrum = Vec::with_capacity(along_x.len() * along_y.len());
    for (column, x) in along_x.iter().enumerate() {
        let kept = harmonic(column, along_x.len()).is_multiple_of(grid.repeats);
        spectrum.extend(along_y.iter().map(|y| {
            let number = (x * x + y * y).sqrt();
            if !kept || number > last { 0.0 } else { libm::pow(number.max(1.0), -2.0 - 2.0 * hurst) }
        }));
    }
    spectrum
}

/// Spectrum Σ_n exp(−(n/ℓ)²) exp(−ikn) of the autocorrelation at whole points, with ℓ in points and 0 ≤ k ≤ π.
///
/// By Poisson's sum formula it equals √π ℓ Σ_m exp(−((k + 2πm) ℓ/2)²): of the two sums the one that converges at once
/// is taken, the neglected terms being below 1e-15 of the total.
fn spectrum(k: f64, length: f64) -> f64 {
    if length < 1.0 {
        let term = |n: f64| 2.0 * libm::exp(-(n / length) * (n / length)) * libm::cos(n * k);
        1.0 + (1..=6).map(|n| term(f64::from(n))).sum::<f64>()
    } else {
        let term = |m: f64| {
            let phase = 0.5 * (k + TAU * m) * length;
            libm::exp(-phase * phase)
        };
        PI.sqrt() * length * (-2..=2).map(|m| term(f64::from(m))).sum::<f64>()
    }
}
