//! Statistics of a surface without a direction, from heights along one line of it.
//!
//! The areal autocorrelation of such a surface depends on the distance alone, and is that of the line,
//! ρ(x, y) = R(√(x² + y²)). What the mesh has are means over cells, b_x by b_y: their autocovariance is that of the points
//! weighted with the triangles that two cells have in common, C(x, y) = ∬ Λ(u/b_x) Λ(v/b_y) R(x + u, y + v) du dv / (b_x b_y),
//! Λ(t) = 1 − |t|.
//!
//! The autocovariance of n points scatters at every lag, which over a surface would add up. It is taken as far as it is told
//! from none: to the first lag at which it is below two of its standard errors, √(Σ ρ²/n) (Bartlett 1946), and falls to zero
//! over as many lags again, by a cosine.

use std::f64::consts::PI;

use super::super::fft::{Complex, Fft};
use super::super::level::{mean, rms};
use super::super::synthesis::spectrum::Grid;
use super::super::{Length, Patch};

/// Most points of a cell in either direction with which its mean is taken.
const MOST_POINTS: usize = 12;
/// Standard errors below which an autocovariance is none.
const TOLD: f64 = 2.0;
/// Fewest lengths over which heights are related that are not warned of.
const FEW: f64 = 20.0;

/// A line across a surface.
#[derive(Debug)]
pub(super) struct Line<'a> {
    heights: &'a [f64],
    pitch: f64,
    /// Autocovariance at the lags of the points, m², up to the first that is zero.
    covariance: Vec<f64>,
}

impl<'a> Line<'a> {
    /// The heights of a patch of one row.
    pub(super) fn of(patch: &'a Patch) -> Self {
        let covariance = told(autocovariance(&patch.heights), patch.heights.len());
        Self { heights: &patch.heights, pitch: patch.column_pitch, covariance }
    }

    /// The distance from which on heights are not related, m.
    pub(super) fn reach(&self) -> f64 {
        (self.covariance.len() - 1) as f64 * self.pitch
    }

    /// Autocovariance at a distance, m²; linear between the lags.
    fn at(&self, distance: f64) -> f64 {
        let place = distance / self.pitch;
        let last = self.covariance.len() - 1;
        if place >= last as f64 {
            return 0.0;
        }
        let below = place as usize;
        let part = place - below as f64;
        self.covariance[below] * (1.0 - part) + self.covariance[below + 1] * part
    }

    /// The autocorrelation of means over cells at every lag of the grid, column by column, and their variance, m².
    pub(super) fn correlation(&self, grid: &Grid) -> (Vec<f64>, f64) {
        let cell = [grid.column_width, grid.row_height];
        let weights = cell.map(|length| triangle(length, self.pitch));
        let covariance = |x: f64, y: f64| -> f64 {
            let across =
                |u: f64| weights[1].iter().map(|(v, weight)| weight * self.at(f64::hypot(x + u, y + v))).sum::<f64>();
            weights[0].iter().map(|(u, weight)| weight * across(*u)).sum()
        };
        let (columns, rows) = (grid.padded_columns, grid.padded_rows);
        // Lags beyond these are of no cells that are related.
        let most = cell.map(|length| ((self.reach() / length) as usize).saturating_add(1));
        let [along, across] = [columns, rows].map(|count| count / 2 + 1);
        let mut quarter = vec![0.0; along * across];
        for column in 0..along.min(most[0] + 1) {
            for row in 0..across.min(most[1] + 1) {
                quarter[column * across + row] = covariance(column as f64 * cell[0], row as f64 * cell[1]);
            }
        }
        let variance = quarter[0];
        let nearest = |lag: usize, count: usize| lag.min(count - lag);
        let value =
            |index: usize| quarter[nearest(index / rows, columns) * across + nearest(index % rows, rows)] / variance;
        ((0..columns * rows).map(value).collect(), variance)
    }

    /// Heights with the distribution of means over cells of this variance, m²: means along the line over the length of a
    /// cell, with their deviations from the mean in proportion.
    pub(super) fn cell_heights(&self, cell: f64, variance: f64) -> Vec<f64> {
        let points = ((cell / self.pitch).round() as usize).clamp(1, self.heights.len());
        let means: Vec<f64> = self.heights.windows(points).map(mean).collect();
        let (centre, spread) = (mean(&means), rms(&means));
        let factor = if spread > 0.0 { variance.sqrt() / spread } else { 0.0 };
        means.into_iter().map(|height| centre + (height - centre) * factor).collect()
    }

    /// What is to be warned of.
    pub(super) fn warning(&self) -> Option<String> {
        let length = self.heights.len() as f64 * self.pitch;
        let times = length / self.reach();
        let squares: f64 = self.covariance.iter().map(|value| value * value).sum();
        let shares = 2.0 * squares / (self.covariance[0] * self.covariance[0]) - 1.0;
        let error = (0.5 * shares / self.heights.len() as f64).sqrt();
        (times < FEW).then(|| {
            format!(
                "warning: heights of the profile are related over {}, and it is only {times:.1} times as long, expected \
                 some {FEW}: its rms height is known to {:.0} %, its texture less",
                Length(self.reach()),
                100.0 * error
            )
        })
    }
}

/// Σ (h_j − h̄)(h_{j+k} − h̄)/(n − k) for every lag k below half of the points.
fn autocovariance(heights: &[f64]) -> Vec<f64> {
    let count = heights.len();
    let centre = mean(heights);
    let mut values = vec![Complex::default(); (2 * count).next_power_of_two()];
    values.iter_mut().zip(heights).for_each(|(value, height)| value.re = height - centre);
    let (fft, mut work) = (Fft::new(values.len()), Vec::new());
    fft.forward(&mut values, &mut work);
    values.iter_mut().for_each(|value| *value = Complex { re: value.norm_sqr(), im: 0.0 });
    fft.backward(&mut values, &mut work);
    let points = values.len() as f64;
    values[..count.div_ceil(2)].iter().enumerate().map(|(lag, sum)| sum.re / points / (count - lag) as f64).collect()
}

/// The autocovariance as far as it is told from none, falling to zero beyond.
fn told(mut covariance: Vec<f64>, count: usize) -> Vec<f64> {
    let variance = covariance[0];
    let mut squares = -variance * variance;
    let last = covariance.iter().position(|value| {
        squares += 2.0 * value * value;
        value * value * count as f64 <= TOLD * TOLD * squares
    });
    let last = last.unwrap_or(covariance.len() - 1).max(1);
    covariance.resize(2 * last + 1, 0.0);
    for (beyond, value) in covariance[last..].iter_mut().enumerate() {
        *value *= 0.5 * (1.0 + libm::cos(PI * (beyond as f64 / last as f64)));
    }
    // The cosine of π is −1 but for rounding.
    covariance[2 * last] = 0.0;
    covariance
}

/// Distances between points of two equal cells that lie on each other, m, with the share that each has.
fn triangle(cell: f64, pitch: f64) -> Vec<(f64, f64)> {
    let points = (libm::ceil(cell / pitch) as usize).clamp(1, MOST_POINTS);
    let all = (points * points) as f64;
    let shift = |step: usize| step as f64 - (points - 1) as f64;
    let share = |step: usize| (points as f64 - shift(step).abs()) / all;
    (0..2 * points - 1).map(|step| (shift(step) * cell / points as f64, share(step))).collect()
}
