//! What a patch tells of a larger body: the distribution of its heights, their areal power spectrum at the harmonics of a larger grid,
//! and, in numbers, what it cannot tell.

use std::f64::consts::{PI, SQRT_2};

use super::super::fft::{Complex, Fft};
use super::super::level::mean;
use super::super::synthesis::planar::Plane;
use super::super::synthesis::spectrum::Grid;
use super::super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// The quantile function of heights: linear between the heights in their order, the i-th of n at the probability (i + ½)/n
/// (Hyndman and Fan 1996, definition 5, doi:10.1080/00031305.1996.10473566), constant beyond the first and the last.
#[derive(Debug)]
pub(super) struct Quantiles {
    ascending: Vec<f64>,
}

impl Quantiles {
    /// Those of at least one height.
    pub(super) fn of(heights: &[f64]) -> Self {
        let mut ascending = heights.to_vec();
        ascending.sort_unstable_by(f64::total_cmp);
        Self { ascending }
    }

    /// Whether there is one height only.
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
        let mut plane = Plane::of(grid);
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

/// How far heights of a patch are related, and how much it has of them.
#[derive(Debug)]
pub(super) struct Reach {
    /// Distance along and across sliding at which the autocorrelation falls to 0.2, m; none where it does not within the
    /// patch.
    lengths: [Option<f64>; 2],
    /// Relative standard error of the patch's rms height.
    error: f64,
}

impl Reach {
    /// From the autocorrelation at every lag of the grid, column by column.
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

    /// What is to be said of it. That longer waves are missing is a warning where those as long as the patch have much of the height.
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
        for (axis, direction) in ["along", "across"].into_iter().enumerate() {
            let few = match self.lengths[axis].filter(|length| *length < WHOLE * sizes[axis]) {
                None => format!("{direction} sliding, heights are related over a third of the patch or more"),
                Some(length) if sizes[axis] < FEW * length => {
                    let times = sizes[axis] / length;
                    format!(
                        "{direction} sliding, the patch is only {times:.1} times its correlation length of {}",
                        Length(length)
                    )
                }
                Some(_) => continue,
            };
            remarks.push(format!(
                "warning: {few}, expected some {FEW} correlation lengths: its rms height is known to {:.0} %, its texture less",
                100.0 * self.error
            ));
        }
        remarks
    }
}

/// The place at which values first fall to the threshold, linear between them.
fn crossing(values: impl Iterator<Item = f64>) -> Option<f64> {
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
