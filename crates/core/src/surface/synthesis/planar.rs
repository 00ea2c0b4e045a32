//! Gaussian fields, by filtering white noise: of any spectrum in the plane, of a product of two line by line.

use rayon::prelude::*;

use super::spectrum::{Grid, gaussian};
use super::translation::Translation;
use crate::surface::fft::{Complex, Fft, LINES, Lines};
use crate::surface::random::Random;

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
    let mut plane = Plane::of(grid);
    if let Some(translation) = translation {
        distort(&mut power, translation, &mut plane);
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

/// From the spectrum that the translated field shall have to that of the Gaussian field.
///
/// The inverse of the translation need not be an autocorrelation: where its spectrum is negative, no Gaussian field has
/// it, and the nearest that one has is 0 there.
fn distort(power: &mut [f64], translation: &Translation, plane: &mut Plane) {
    let mut values: Vec<Complex> = power.iter().map(|power| Complex { re: *power, im: 0.0 }).collect();
    plane.forward(&mut values);
    let variance = values.first().map_or(1.0, |value| value.re);
    values.iter_mut().for_each(|value| *value = Complex { re: value.re / variance, im: 0.0 });
    plane.map_symmetric(&mut values, |autocorrelation| translation.inverse(autocorrelation));
    plane.forward(&mut values);
    let repeats = plane.repeats;
    for (column, (power, values)) in power.chunks_mut(plane.rows).zip(values.chunks(plane.rows)).enumerate() {
        let kept = column.min(plane.columns - column).is_multiple_of(repeats);
        power.iter_mut().zip(values).for_each(|(power, value)| *power = if kept { value.re.max(0.0) } else { 0.0 });
    }
}

/// Transform in the plane, column by column and then row by row.
pub(in crate::surface) struct Plane {
    columns: usize,
    rows: usize,
    repeats: usize,
    along_y: Fft,
    along_x: Fft,
}

impl Plane {
    /// That of so many columns and rows, along which the field repeats so many times.
    pub(in crate::surface) fn new(columns: usize, rows: usize, repeats: usize) -> Self {
        Self { columns, rows, repeats, along_y: Fft::new(rows), along_x: Fft::new(columns) }
    }

    pub(in crate::surface) fn of(grid: &Grid) -> Self {
        Self::new(grid.padded_columns, grid.padded_rows, grid.repeats)
    }

    /// Columns and rows of the plane.
    pub(in crate::surface) fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Transforms in place, several columns and then several rows at a time.
    pub(in crate::surface) fn forward(&mut self, values: &mut [Complex]) {
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
    fn backward(&mut self, values: &mut [Complex]) {
        values.iter_mut().for_each(|value| *value = value.conj());
        self.forward(values);
        values.iter_mut().for_each(|value| *value = value.conj());
    }

    /// Maps the real parts of what is symmetric in either direction.
    fn map_symmetric(&self, values: &mut [Complex], map: impl Fn(f64) -> f64) {
        for column in 0..self.columns {
            let mirrored_column = (self.columns - column) % self.columns;
            for row in 0..self.rows {
                let mirrored_row = (self.rows - row) % self.rows;
                let first = column.min(mirrored_column) * self.rows + row.min(mirrored_row);
                let here = column * self.rows + row;
                values[here].re = if here == first { map(values[here].re) } else { values[first].re };
            }
        }
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
    /// A line of `points` points with ℓ in points; keeps only the harmonics that are multiples of `repeats`.
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
