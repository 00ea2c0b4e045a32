//! Synthetic heights: a Gaussian random field on the mesh.
//!
//! White noise is filtered by the square root of the spectrum of the wanted autocorrelation
//! exp(−(ρ/ℓ)²) = exp(−(x/ℓ)²) exp(−(y/ℓ)²). As that is a product, the filter runs along the columns and then along the
//! rows, one line at a time, with x the arc length at the mean radius and y the radius.

use std::f64::consts::TAU;

use thiserror::Error;

use super::fft::{Complex, Fft};
use super::random::{Random, Stream};
use super::{Body, Length};
use crate::mesh::Mesh;

/// A Gaussian random field with autocorrelation exp(−(ρ/ℓ)²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightSynthesis {
    /// Seed of the random stream.
    pub seed: u64,
    /// Realised rms height, m.
    pub rms_height: f64,
    /// ℓ, m.
    pub correlation_length: f64,
    /// Keeps only the harmonics that repeat round the ring a whole number of times nearest to this length, m.
    pub patch: Option<f64>,
}

/// Why a synthetic surface cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SynthesisError {
    /// The rms height is no height.
    #[error("rms_height is {found} m, expected 0 or more and finite")]
    RmsHeight {
        /// What was asked for.
        found: f64,
    },
    /// The correlation length is no length.
    #[error("correlation_length is {found} m, expected more than 0 and finite")]
    CorrelationLength {
        /// What was asked for.
        found: f64,
    },
    /// The field would hardly vary, and the filter would need endless lines.
    #[error(
        "correlation_length is {}, expected at most {} here (the ring's circumference, or 2^20 cells): \
         a surface that varies so slowly is flat on this mesh, use flat = true",
        Length(*found), Length(*longest)
    )]
    CorrelationTooLong {
        /// What was asked for, m.
        found: f64,
        /// The longest accepted, m.
        longest: f64,
    },
    /// The field cannot repeat in that length.
    #[error("patch is {}, expected at least two columns of {} and a finite length", Length(*found), Length(*column_width))]
    Patch {
        /// What was asked for, m.
        found: f64,
        /// Arc length of a column, m.
        column_width: f64,
    },
    /// A pin is no ring.
    #[error("patch repeats the heights round the ring, which a pin does not close: leave it out")]
    PatchOnPin,
    /// Only the mean was left, which is removed.
    #[error(
        "nothing but the mean is left of a field of {columns} columns and {rows} rows with correlation_length {}: \
         use a shorter correlation_length, a longer patch or flat = true",
        Length(*correlation_length)
    )]
    OnlyMean {
        /// Columns of the field.
        columns: usize,
        /// Rows of the field.
        rows: usize,
        /// ℓ, m.
        correlation_length: f64,
    },
}

/// Autocorrelation beyond this many ℓ is taken as zero: exp(−16) = 1e-7.
const REACH: f64 = 4.0;
/// Longest correlation length in cells.
const LONGEST: f64 = (1 << 20) as f64;
/// Smallest rms height, relative to the largest height before the mean is removed, that is more than rounding.
const SMALLEST_RMS: f64 = 1e-9;

impl HeightSynthesis {
    /// Heights of every cell of `body`, m, column by column: mean 0 and rms height as asked (both over the cells, up to
    /// rounding), autocorrelation exp(−(ρ/ℓ)²), on the disc periodic round the ring.
    ///
    /// The same seed gives unrelated fields on disc and pin, and the same bits on every machine.
    ///
    /// # Errors
    /// [`SynthesisError`] when a length is not positive and finite, the field could not vary on this mesh, or `patch`
    /// is set for the pin.
    pub fn field(&self, body: Body, mesh: &Mesh) -> Result<Vec<f64>, SynthesisError> {
        let (columns, rows) = (body.columns(mesh), mesh.rows());
        let repeats = self.check(body, mesh)?;
        if self.rms_height == 0.0 {
            return Ok(vec![0.0; columns * rows]);
        }
        let (width, height) = (mesh.column_width(), mesh.row_height());
        let length = self.correlation_length;
        let padded_columns = if body == Body::Disc { columns } else { padded(columns, length / width) };
        let mut along_y = Filter::new(padded(rows, length / height), length / height, 1);
        let mut along_x = Filter::new(padded_columns, length / width, repeats);
        let stream = if body == Body::Disc { Stream::DiscHeight } else { Stream::PinHeight };
        let mut random = Random::new(self.seed, stream);

        // Column by column, two at a time: the filter is real, so they travel as the two parts of complex numbers.
        let mut noise = vec![0.0; padded_columns * rows];
        let mut line = vec![Complex::default(); along_y.len()];
        for pair in noise.chunks_mut(2 * rows) {
            line.iter_mut().for_each(|value| *value = Complex { re: random.normal(), im: random.normal() });
            along_y.apply(&mut line);
            let (first, second) = pair.split_at_mut(rows);
            first.iter_mut().zip(&line).for_each(|(cell, value)| *cell = value.re);
            second.iter_mut().zip(&line).for_each(|(cell, value)| *cell = value.im);
        }
        // Row by row, likewise.
        let mut field = vec![0.0; columns * rows];
        let mut line = vec![Complex::default(); padded_columns];
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
        normalise(&mut field, self.rms_height).ok_or(SynthesisError::OnlyMean {
            columns,
            rows,
            correlation_length: length,
        })?;
        Ok(field)
    }

    /// Refuses what cannot be made; gives the number of repeats round the ring (1 without `patch`).
    fn check(&self, body: Body, mesh: &Mesh) -> Result<usize, SynthesisError> {
        if !(self.rms_height >= 0.0 && self.rms_height.is_finite()) {
            return Err(SynthesisError::RmsHeight { found: self.rms_height });
        }
        let length = self.correlation_length;
        if !(length > 0.0 && length.is_finite()) {
            return Err(SynthesisError::CorrelationLength { found: length });
        }
        let circumference = Body::Disc.length(mesh);
        let longest = circumference.min(LONGEST * mesh.column_width().min(mesh.row_height()));
        if length > longest {
            return Err(SynthesisError::CorrelationTooLong { found: length, longest });
        }
        match (self.patch, body) {
            (None, _) => Ok(1),
            (Some(_), Body::Pin) => Err(SynthesisError::PatchOnPin),
            (Some(patch), Body::Disc) => {
                let column_width = mesh.column_width();
                // Written so that NaN is refused too.
                if !(patch >= 2.0 * column_width && patch.is_finite()) {
                    return Err(SynthesisError::Patch { found: patch, column_width });
                }
                Ok(libm::round(circumference / patch).max(1.0) as usize)
            }
        }
    }
}

/// Points of a line of `cells` cells with a margin so long that its two ends do not feel each other.
fn padded(cells: usize, length_in_cells: f64) -> usize {
    (cells + libm::ceil(REACH * length_in_cells) as usize).next_power_of_two()
}

/// Filter of a periodic line that turns white noise into noise with autocorrelation exp(−(x/ℓ)²).
struct Filter {
    fft: Fft,
    gain: Vec<f64>,
}

impl Filter {
    /// A line of `points` points with ℓ in points; keeps only the harmonics that are multiples of `repeats`.
    fn new(points: usize, length: f64, repeats: usize) -> Self {
        let gain = (0..points)
            .map(|index| {
                let harmonic = index.min(points - index);
                if !harmonic.is_multiple_of(repeats) {
                    return 0.0;
                }
                // The transform back leaves out 1/N.
                spectrum(TAU * harmonic as f64 / points as f64, length).sqrt() / points as f64
            })
            .collect();
        Self { fft: Fft::new(points), gain }
    }

    fn len(&self) -> usize {
        self.gain.len()
    }

    fn apply(&mut self, line: &mut [Complex]) {
        self.fft.forward(line);
        line.iter_mut().zip(&self.gain).for_each(|(value, gain)| *value = value.scaled(*gain));
        self.fft.backward(line);
    }
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
        std::f64::consts::PI.sqrt() * length * (-2..=2).map(|m| term(f64::from(m))).sum::<f64>()
    }
}

/// Takes out the mean and scales to the rms height; `None` when nothing but the mean is there.
fn normalise(field: &mut [f64], rms_height: f64) -> Option<()> {
    let largest = field.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    centre(field);
    let count = field.len() as f64;
    let rms = (field.iter().map(|value| value * value).sum::<f64>() / count).sqrt();
    if rms <= SMALLEST_RMS * largest {
        return None;
    }
    let factor = rms_height / rms;
    field.iter_mut().for_each(|value| *value *= factor);
    // What rounding left of the mean the first time.
    centre(field);
    Some(())
}

fn centre(field: &mut [f64]) {
    let mean = field.iter().sum::<f64>() / field.len() as f64;
    field.iter_mut().for_each(|value| *value -= mean);
}
