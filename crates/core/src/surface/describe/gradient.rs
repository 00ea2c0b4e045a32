//! Slopes and developed area: hybrid parameters (ISO 25178-2:2021, 4.4).

use rayon::prelude::*;

use super::Grid;
use super::grid::added;

/// Hybrid parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradient {
    /// Sdq = √(⟨(Δx z/dx)²⟩ + ⟨(Δy z/dy)²⟩): root-mean-square slope from the differences of neighbouring points, each
    /// difference counted once.
    pub root_mean_square_slope: f64,
    /// Sdr: developed area over the area of the grid, less 1.
    pub developed_area_ratio: f64,
}

/// Σ (Δx z/dx)², their number, Σ (Δy z/dy)², their number, Σ excess area per cell, cells.
type Sums = [f64; 6];

impl Gradient {
    /// Those of a grid of known pitch. Differences and cells with a missing point are left out; NaN where none is left.
    ///
    /// The developed area is that of the triangles between neighbouring points: a cell of four points is divided along
    /// either diagonal, and the mean of the two is taken, so that no direction is preferred.
    pub fn of(grid: &Grid) -> Option<Self> {
        let pitch = grid.pitch?;
        let columns: Vec<&[f64]> = grid.column_slices().collect();
        let sums: Vec<Sums> = (0..columns.len())
            .into_par_iter()
            .map(|index| column(columns[index], columns.get(index + 1).copied().unwrap_or(&[]), pitch))
            .collect();
        let [squares_x, count_x, squares_y, count_y, excess, cells] = sums.into_iter().fold([0.0; 6], added);
        Some(Self {
            root_mean_square_slope: (squares_x / count_x + squares_y / count_y).sqrt(),
            developed_area_ratio: excess / cells,
        })
    }
}

/// Sums over a column and the cells to the next one.
fn column(here: &[f64], next: &[f64], [pitch_x, pitch_y]: [f64; 2]) -> Sums {
    let [mut x, mut y, mut area] = [[0.0; 2]; 3];
    for (one, other) in here.iter().zip(next) {
        x = added(x, measured((other - one) / pitch_x, |slope| slope * slope));
    }
    for pair in here.windows(2) {
        y = added(y, measured((pair[1] - pair[0]) / pitch_y, |slope| slope * slope));
    }
    for (left, right) in here.windows(2).zip(next.windows(2)) {
        let squares = |one: f64, other: f64, pitch: f64| ((other - one) / pitch) * ((other - one) / pitch);
        let along = [squares(left[0], right[0], pitch_x), squares(left[1], right[1], pitch_x)];
        let across = [squares(left[0], left[1], pitch_y), squares(right[0], right[1], pitch_y)];
        let excess = along.map(|along| across.map(|across| excess_area(along + across)));
        area = added(area, measured(excess.as_flattened().iter().sum::<f64>(), |sum| 0.25 * sum));
    }
    [x[0], x[1], y[0], y[1], area[0], area[1]]
}

/// √(1 + s) − 1 without the loss of digits where the squared slope s is small.
fn excess_area(squared_slope: f64) -> f64 {
    squared_slope / (1.0 + (1.0 + squared_slope).sqrt())
}

/// A term and that it is one; nothing where a point is missing.
fn measured(value: f64, term: impl Fn(f64) -> f64) -> [f64; 2] {
    if value.is_nan() { [0.0; 2] } else { [term(value), 1.0] }
}
