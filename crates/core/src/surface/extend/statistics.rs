//! Statistics of a patch for a larger body: the distribution of its heights, their areal power spectrum at the harmonics of a larger grid,
//! and, in numbers, what it cannot tell.
//!
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

use std::f64::consts::{PI, SQRT_2};

use super::super::fft::{Complex, Fft};
use super::super::heights::{mean, rms};
use super::super::synthesis::planar::{Grid, Plane};
use super::super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// The quantile function of heights: linear between the heights in their order, the i-th of n at the probability (i + ½)/n
/// (Hyndman and Fan 1996, definition 5, doi:10.1080/00031305.1996.10473566), constant beyond the first and the last.
#[derive(Debug)]
pub(super) struct Quantiles {
    ascending: Vec<f64>,
}

impl Quantiles {
    /// Quantiles of at least one height.
    pub(super) fn of(heights: &[f64]) -> Self {
        let mut ascending = heights.to_vec();
        ascending.sort_unstable_by(f64::total_cmp);
        Self { ascending }
    }

    /// Tells whether there is one height only.
    pub(super) fn are_equal(&self) -> bool {
        self.ascending.first() == self.ascending.last()
    }

    /// The height that the fraction `probability` of the heights lies below.
    pub(super) fn at(&self, probability: f64) -> f64 {
        let last = self.ascending.len() - 1;
        let place = (probability * self.ascending.len() as f64 - 0.5).clamp(0.0, last as f64);
        let below = place as usize;
        let (low, high) = (self.ascending[below], self.ascending[(below + 1).min(last)]);
        low + (place - below as f64) * (high - low)
    }

    /// The height T(x) that has the place in the distribution that x has in the standard normal one.
    pub(super) fn normal(&self, x: f64) -> f64 {
        self.at(0.5 * libm::erfc(-x / SQRT_2))
    }

    /// Heights in the order of the values of a field: of N values the one of rank r gets the height at (r + ½)/N. Equal values
    /// rank as they stand in the field.
    pub(super) fn by_rank(&self, field: &[f64]) -> Vec<f64> {
        let mut order: Vec<usize> = (0..field.len()).collect();
        order.sort_unstable_by(|one, other| field[*one].total_cmp(&field[*other]).then(one.cmp(other)));
        let mut heights = vec![0.0; field.len()];
        for (rank, cell) in order.into_iter().enumerate() {
            heights[cell] = self.at((rank as f64 + 0.5) / field.len() as f64);
        }
        heights
    }
}

/// Tapers in either direction.
const TAPERS: usize = 2;

pub(super) struct Spectrum {
    /// Power at every harmonic of the padded grid, column by column, up to a factor.
    pub(super) power: Vec<f64>,
    /// Share of the patch's mean square height that the tapered patches lack once their mean is taken out. It is in waves
    /// about as long as the patch, and put back there, with the spectrum of the tapers themselves.
    pub(super) long_waves: f64,
}

impl Spectrum {
    /// Spectrum of a patch whose points are cells of the grid.
    ///
    /// The transform at the harmonics of the grid of a patch that is longer than the grid is that of the patch wound round
    /// it.
    pub(super) fn of(cells: &Patch, grid: &Grid) -> Self {
        let (columns, rows) = (grid.padded_columns, grid.padded_rows);
        let (along, across) = (tapers(cells.columns), tapers(cells.rows));
        let plane = Plane::of(grid);
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

/// The autocorrelation at which the correlation length ends, as for Sal of ISO 25178-2.
const THRESHOLD: f64 = 0.2;
/// Fewest correlation lengths in a direction that are not warned of.
const FEW: f64 = 10.0;
/// Part of the patch at which the autocorrelation of the tapers themselves nearly falls to the threshold (it does so at 0.35):
/// a patch of equal heights would seem to be related as far.
const WHOLE: f64 = 0.3;

/// Distances over which heights of a patch are related, and the error of their rms height.
#[derive(Debug)]
pub(super) struct Reach {
    /// Distance along and across sliding at which the autocorrelation falls to 0.2, m; none where it does not within the
    /// patch.
    lengths: [Option<f64>; 2],
    /// Relative standard error of the patch's rms height.
    error: f64,
}

impl Reach {
    /// Reach by the autocorrelation at every lag of the grid, column by column.
    ///
    /// The mean square of N normal heights has the relative variance 2 Σ ρ²/N (Bartlett 1946), their rms half that error.
    pub(super) fn of(correlation: &[f64], grid: &Grid, cells: &Patch) -> Self {
        let rows = grid.padded_rows;
        let along = correlation.iter().step_by(rows).take(cells.columns.min(grid.padded_columns / 2 + 1));
        let across = correlation.iter().take(cells.rows.min(rows / 2 + 1));
        let lengths = [
            crossing(along.copied()).map(|cells| cells * grid.column_width),
            crossing(across.copied()).map(|cells| cells * grid.row_height),
        ];
        let squares: f64 = correlation.iter().map(|value| value * value).sum();
        Self { lengths, error: (0.5 * squares / cells.heights.len() as f64).sqrt() }
    }

    /// Remarks for the report. That longer waves are missing is a warning where those as long as the patch have much of the height.
    pub(super) fn remarks(&self, misses_much: bool, patch: &Patch, body: Body, mesh: &Mesh) -> Vec<String> {
        let mut remarks = Vec::new();
        let sizes = [patch.length(), patch.height()];
        let body_sizes = [body.length(mesh), mesh.rows() as f64 * mesh.row_height()];
        if sizes[0] < body_sizes[0] || sizes[1] < body_sizes[1] {
            let mark = if misses_much { "warning: " } else { "" };
            remarks.push(format!(
                "{mark}waves longer than the patch, {} along and {} across sliding, are not known from it; the {} of \
                 {} by {} gets none",
                Length(sizes[0]),
                Length(sizes[1]),
                body.name(),
                Length(body_sizes[0]),
                Length(body_sizes[1])
            ));
        }
        let known = [0, 1].map(|axis| self.lengths[axis].filter(|length| *length < WHOLE * sizes[axis]));
        remarks.extend(
            few_lengths(known, sizes, ["heights are", "a third", "patch"])
                .map(|few| format!("{few}: its rms height is known to {:.0} %, its texture less", 100.0 * self.error)),
        );
        remarks
    }
}

/// Warnings of directions in which a patch or picture of this size, m, has few correlation lengths, m, or none that is known: what is
/// related over which part of which whole, in words.
pub(in crate::surface) fn few_lengths(
    lengths: [Option<f64>; 2],
    size: [f64; 2],
    [related, part, whole]: [&'static str; 3],
) -> impl Iterator<Item = String> {
    ["along", "across"].into_iter().enumerate().filter_map(move |(axis, direction)| {
        let few = match lengths[axis] {
            None => format!("{related} related over {part} of the {whole} or more"),
            Some(length) if size[axis] < FEW * length => {
                let times = size[axis] / length;
                format!("the {whole} is only {times:.1} times its correlation length of {}", Length(length))
            }
            Some(_) => return None,
        };
        Some(format!("warning: {direction} sliding, {few}, expected some {FEW} correlation lengths"))
    })
}

/// The place at which values first fall to the threshold, linear between them.
pub(in crate::surface) fn crossing(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut before = f64::INFINITY;
    for (place, value) in values.enumerate() {
        if value <= THRESHOLD {
            let part = if place == 0 { 1.0 } else { (before - THRESHOLD) / (before - value) };
            return Some((place as f64 - 1.0 + part).max(0.0));
        }
        before = value;
    }
    None
}

/// Most points of a cell in either direction with which its mean is taken.
const MOST_POINTS: usize = 12;
/// Standard errors below which an autocovariance is none.
const TOLD: f64 = 2.0;
/// Fewest lengths over which heights are related that are not warned of.
const FEW_LENGTHS: f64 = 20.0;

/// A line across a surface.
#[derive(Debug)]
pub(super) struct Line<'a> {
    heights: &'a [f64],
    pitch: f64,
    /// Autocovariance at the lags of the points, m², up to the first that is zero.
    covariance: Vec<f64>,
}

impl<'a> Line<'a> {
    /// Line of the heights of a patch of one row.
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

    pub(super) fn warning(&self) -> Option<String> {
        let length = self.heights.len() as f64 * self.pitch;
        let times = length / self.reach();
        let squares: f64 = self.covariance.iter().map(|value| value * value).sum();
        let shares = 2.0 * squares / (self.covariance[0] * self.covariance[0]) - 1.0;
        let error = (0.5 * shares / self.heights.len() as f64).sqrt();
        (times < FEW_LENGTHS).then(|| {
            format!(
                "warning: heights of the profile are related over {}, and it is only {times:.1} times as long, expected \
                 some {FEW_LENGTHS}: its rms height is known to {:.0} %, its texture less",
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
