//! Gaussian fields, by filtering white noise: of any spectrum in the plane, of a product of two line by line; the grid on which they are
//! made, the body's cells and a margin, and power spectra at its harmonics.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use super::translation::Translation;
use crate::model::mesh::Mesh;
use crate::surface::Body;
use crate::surface::fft::{Complex, Fft, LINES, Lines};
use crate::surface::random::Random;

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
    /// Number of times that the field repeats along the padded columns.
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

    /// Tells whether the field would be far larger than the body.
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
fn gaussian(points: usize, length: f64, repeats: usize) -> impl Iterator<Item = f64> {
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

/// A harmonic with less than this of the strongest one's power has none: what is left there is rounding.
const WEAKEST: f64 = 1e-12;

/// Field with this power at every harmonic of the padded grid, on the cells that belong to the body, column by column.
/// With a translation it is the field that has the spectrum after the translation.
pub(in crate::surface) fn field(
    grid: &Grid,
    mut power: Vec<f64>,
    translation: Option<&Translation>,
    random: &mut Random,
) -> Vec<f64> {
    let plane = Plane::of(grid);
    if let Some(translation) = translation {
        power = distorted(power, translation, grid, &plane);
    }
    let strongest = power.iter().copied().fold(0.0, f64::max);
    let gain = power.iter().map(|power| if *power > WEAKEST * strongest { power.sqrt() } else { 0.0 });
    let mut values: Vec<Complex> = power.iter().map(|_| Complex { re: random.normal(), im: 0.0 }).collect();
    plane.forward(&mut values);
    values.iter_mut().zip(gain).for_each(|(value, gain)| *value = value.scale(gain));
    plane.backward(&mut values);
    let columns = values.chunks_exact(grid.padded_rows).take(grid.columns);
    columns.flat_map(|column| column.iter().take(grid.rows).map(|value| value.re)).collect()
}

/// Turns the spectrum that the translated field shall have into that of the Gaussian field.
///
/// The inverse of the translation need not be an autocorrelation: where its spectrum is negative, no Gaussian field has
/// it, and the nearest that one has is 0 there.
fn distorted(power: Vec<f64>, translation: &Translation, grid: &Grid, plane: &Plane) -> Vec<f64> {
    let [columns, rows] = plane.size();
    let first = |here: usize| harmonic(here / rows, columns) * rows + harmonic(here % rows, rows);
    let mut power = plane.power_of(plane.autocorrelation(power), first, |value| translation.inverse(value));
    for (column, power) in power.chunks_mut(rows).enumerate() {
        let kept = harmonic(column, columns).is_multiple_of(grid.repeats);
        power.iter_mut().for_each(|power| *power = if kept { power.max(0.0) } else { 0.0 });
    }
    power
}

/// Transform in the plane, column by column and then row by row.
pub(in crate::surface) struct Plane {
    columns: usize,
    rows: usize,
    along_y: Fft,
    along_x: Fft,
}

impl Plane {
    pub(in crate::surface) fn new(columns: usize, rows: usize) -> Self {
        Self { columns, rows, along_y: Fft::new(rows), along_x: Fft::new(columns) }
    }

    pub(in crate::surface) fn of(grid: &Grid) -> Self {
        Self::new(grid.padded_columns, grid.padded_rows)
    }

    pub(in crate::surface) fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Transforms in place, several columns and then several rows at a time.
    pub(in crate::surface) fn forward(&self, values: &mut [Complex]) {
        let rows = self.rows;
        values.par_chunks_mut(LINES * rows).for_each_init(
            || (vec![Lines::default(); rows], Vec::new()),
            |(lines, work), block| {
                for (line, column) in block.chunks_exact(rows).enumerate() {
                    lines.iter_mut().zip(column).for_each(|(lines, value)| lines.put(line, *value));
                }
                self.along_y.forward(lines, work);
                for (line, column) in block.chunks_exact_mut(rows).enumerate() {
                    column.iter_mut().zip(lines.iter()).for_each(|(value, lines)| *value = lines.get(line));
                }
            },
        );
        // Bands of rows, as many at a time as there are threads: each is a copy.
        let bands: Vec<usize> = (0..rows).step_by(LINES).collect();
        for bands in bands.chunks(rayon::current_num_threads()) {
            let transformed: Vec<Vec<Lines>> = bands.par_iter().map(|first| self.band(values, *first)).collect();
            values.par_chunks_exact_mut(rows).enumerate().for_each(|(column, values)| {
                for (first, band) in bands.iter().zip(&transformed) {
                    let values = values[*first..].iter_mut().take(LINES);
                    values.enumerate().for_each(|(line, value)| *value = band[column].get(line));
                }
            });
        }
    }

    /// The transform along x of some rows, from the first one on.
    fn band(&self, values: &[Complex], first: usize) -> Vec<Lines> {
        let gathered = values.chunks_exact(self.rows).map(|column| {
            let mut lines = Lines::default();
            column[first..].iter().take(LINES).enumerate().for_each(|(line, value)| lines.put(line, *value));
            lines
        });
        let mut band: Vec<Lines> = gathered.collect();
        self.along_x.forward(&mut band, &mut Vec::new());
        band
    }

    /// Transform back, times the number of points.
    fn backward(&self, values: &mut [Complex]) {
        values.iter_mut().for_each(|value| *value = value.conj());
        self.forward(values);
        values.iter_mut().for_each(|value| *value = value.conj());
    }

    /// The transform of real values that are symmetric, which is real as well.
    fn of_symmetric(&self, values: Vec<f64>) -> Vec<f64> {
        let mut values: Vec<Complex> = values.into_iter().map(|re| Complex { re, im: 0.0 }).collect();
        self.forward(&mut values);
        values.into_iter().map(|value| value.re).collect()
    }

    /// Turns the power at every harmonic into the autocorrelation at every lag, 1 at none, column by column.
    pub(in crate::surface) fn autocorrelation(&self, power: Vec<f64>) -> Vec<f64> {
        let values = self.of_symmetric(power);
        let variance = values[0];
        values.into_iter().map(|value| value / variance).collect()
    }

    /// The power of a field with this autocorrelation after a map of its values, of which this is the inverse; negative where no field has
    /// it. Of lags that have the same value by symmetry, `first` is the first.
    pub(in crate::surface) fn power_of(
        &self,
        mut values: Vec<f64>,
        first: impl Fn(usize) -> usize + Sync,
        inverse: impl Fn(f64) -> f64 + Sync,
    ) -> Vec<f64> {
        let firsts = values.par_iter_mut().enumerate().filter(|(here, _)| *here == first(*here));
        firsts.for_each(|(_, value)| *value = inverse(*value));
        for here in 0..values.len() {
            values[here] = values[first(here)];
        }
        self.of_symmetric(values)
    }
}

/// Field of unit variance with the autocorrelation exp(−(x/ℓx)²) exp(−(y/ℓy)²) on the cells that belong to the body, column by
/// column; ℓ in cells. As it is a product, the filter runs along the columns and then along the rows, one line at a time.
pub(super) fn separable_field(grid: &Grid, along: f64, across: f64, random: &mut Random) -> Vec<f64> {
    let rows = grid.rows;
    let mut along_y = Filter::new(grid.padded_rows, across, 1);
    let mut along_x = Filter::new(grid.padded_columns, along, grid.repeats);

    // Column by column, two at a time: the filter is real, so they travel as the two parts of complex numbers.
    let mut noise = vec![0.0; grid.padded_columns * rows];
    let mut line = vec![Complex::default(); grid.padded_rows];
    for pair in noise.chunks_mut(2 * rows) {
        line.iter_mut().for_each(|value| *value = Complex { re: random.normal(), im: random.normal() });
        along_y.apply(&mut line);
        let (first, second) = pair.split_at_mut(rows);
        first.iter_mut().zip(&line).for_each(|(cell, value)| *cell = value.re);
        second.iter_mut().zip(&line).for_each(|(cell, value)| *cell = value.im);
    }
    // Row by row, likewise.
    let mut field = vec![0.0; grid.columns * rows];
    let mut line = vec![Complex::default(); grid.padded_columns];
    for row in (0..rows).step_by(2) {
        let second = (row + 1 < rows).then_some(row + 1);
        for (value, column) in line.iter_mut().zip(noise.chunks_exact(rows)) {
            *value = Complex { re: column[row], im: second.map_or(0.0, |second| column[second]) };
        }
        along_x.apply(&mut line);
        for (value, column) in line.iter().zip(field.chunks_exact_mut(rows)) {
            column[row] = value.re;
            if let Some(second) = second {
                column[second] = value.im;
            }
        }
    }
    field
}

/// Filter of a periodic line that turns white noise into noise with autocorrelation exp(−(x/ℓ)²).
struct Filter {
    fft: Fft,
    work: Vec<Complex>,
    gain: Vec<f64>,
}

impl Filter {
    /// Filter of a line of `points` points with ℓ in points; keeps only the harmonics that are multiples of `repeats`.
    fn new(points: usize, length: f64, repeats: usize) -> Self {
        // The transform back leaves out 1/N.
        let gain = gaussian(points, length, repeats).map(|power| power.sqrt() / points as f64).collect();
        Self { fft: Fft::new(points), work: Vec::new(), gain }
    }

    fn apply(&mut self, line: &mut [Complex]) {
        self.fft.forward(line, &mut self.work);
        line.iter_mut().zip(&self.gain).for_each(|(value, gain)| *value = value.scale(*gain));
        self.fft.backward(line, &mut self.work);
    }
}
