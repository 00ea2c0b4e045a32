//! Discrete Fourier transform in the plane, column by column and then row by row.

use super::fft::{Complex, Fft};

/// Plan of the transform of a plane that is stored column by column.
pub(crate) struct Fft2d {
    along_x: Fft,
    along_y: Fft,
    columns: usize,
    rows: usize,
}

impl Fft2d {
    /// # Panics
    /// When the plane has no points.
    pub(crate) fn new(columns: usize, rows: usize) -> Self {
        Self { along_x: Fft::new(columns), along_y: Fft::new(rows), columns, rows }
    }

    /// Points along x.
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// Points along y.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Transforms in place.
    pub(crate) fn forward(&mut self, values: &mut [Complex]) {
        values.chunks_exact_mut(self.rows).for_each(|column| self.along_y.forward(column));
        let mut line = vec![Complex::default(); self.columns];
        for row in 0..self.rows {
            let places = || (row..values.len()).step_by(self.rows);
            line.iter_mut().zip(places()).for_each(|(value, place)| *value = values[place]);
            self.along_x.forward(&mut line);
            line.iter().zip(places()).for_each(|(value, place)| values[place] = *value);
        }
    }

    /// Transforms back in place, times the number of points.
    pub(crate) fn backward(&mut self, values: &mut [Complex]) {
        values.iter_mut().for_each(|value| *value = value.conj());
        self.forward(values);
        values.iter_mut().for_each(|value| *value = value.conj());
    }
}
