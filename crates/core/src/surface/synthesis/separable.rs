//! Gaussian heights whose autocorrelation is a product of one along and one across the sliding direction.
//!
//! White noise is filtered by the square root of the spectrum of exp(−(x/ℓx)²) exp(−(y/ℓy)²). As that is a product, the
//! filter runs along the columns and then along the rows, one line at a time.

use super::spectrum::{Grid, gaussian};
use crate::surface::fft::{Complex, Fft};
use crate::surface::random::Random;

/// Field of unit variance on the grid's cells that belong to the body, column by column; ℓ in cells.
pub(super) fn field(grid: &Grid, along: f64, across: f64, random: &mut Random) -> Vec<f64> {
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
