//! Gaussian fields of any spectrum, by filtering white noise in the plane.

use rayon::prelude::*;

use super::spectrum::Grid;
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
    let mut plane = Plane::new(grid);
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
    pub(in crate::surface) fn new(grid: &Grid) -> Self {
        let (columns, rows) = (grid.padded_columns, grid.padded_rows);
        Self { columns, rows, repeats: grid.repeats, along_y: Fft::new(rows), along_x: Fft::new(columns) }
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
