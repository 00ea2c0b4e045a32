//! Synthetic heights: random fields on the mesh with a given autocorrelation or spectrum and given moments.
//!
//! x is the arc length at the mean radius, y the radius. A Gaussian field g of unit variance is made from white noise,
//! and its heights are given the distribution of Johnson's system with the skewness and kurtosis asked for, z = T(g).
//! As that changes the autocorrelation, g is made with the one that becomes the right one (see [`translation`]).

mod johnson;
pub(super) mod planar;
pub(super) mod translation;

use johnson::Johnson;
use planar::Grid;
use translation::Translation;

use super::Body;
use super::error::SynthesisError;
use super::random::{Random, Stream};
use crate::model::mesh::Mesh;

/// A random field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightSynthesis {
    /// Seed of the random stream.
    pub seed: u64,
    /// Realised rms height, m.
    pub rms_height: f64,
    /// Autocorrelation or spectrum of the heights.
    pub texture: Texture,
    /// Skewness of the distribution of heights, 0 for a symmetric one.
    pub skewness: f64,
    /// Kurtosis of the distribution of heights, 3 for a normal one.
    pub kurtosis: f64,
    /// Keeps only the harmonics that repeat round the ring a whole number of times nearest to this length, m.
    pub patch: Option<f64>,
}

/// Autocorrelation or spectrum of a random field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Texture {
    /// Autocorrelation exp(−(x/ℓx)² − (y/ℓy)²).
    Correlation {
        /// ℓx, along the sliding direction, m.
        along: f64,
        /// ℓy, across it, m.
        across: f64,
    },
    /// Isotropic power spectrum C(q), constant for q < q_r and falling as q^(−2 − 2H) from there on: a self-affine surface
    /// (Jacobs, Junge and Pastewka 2017, doi:10.1088/2051-672X/aa51f8).
    PowerLaw {
        /// Hurst exponent H.
        hurst: f64,
        /// Wavelength 2π/q_r, m.
        roll_off: f64,
        /// Shortest wavelength that is kept, m.
        short_cutoff: Option<f64>,
    },
}

impl Texture {
    /// The length that says most about the texture, and its key in a scene.
    fn length(self) -> (&'static str, f64) {
        match self {
            Self::Correlation { along, .. } => ("correlation_length", along),
            Self::PowerLaw { roll_off, .. } => ("roll_off", roll_off),
        }
    }
}

/// Autocorrelation exp(−(ρ/ℓ)²) beyond this many ℓ is taken as zero: exp(−16) = 1e-7.
const REACH: f64 = 4.0;
/// Autocorrelation of a power law beyond this many roll-off wavelengths is taken as zero; it is a few hundredths there.
const POWER_LAW_REACH: f64 = 2.0;
/// Longest correlation length or roll-off in cells.
const LONGEST: f64 = (1 << 20) as f64;
/// Smallest rms height, relative to the largest height before the mean is removed, that is more than rounding.
const SMALLEST_RMS: f64 = 1e-9;

impl HeightSynthesis {
    /// Normal heights with autocorrelation exp(−(ρ/ℓ)²).
    pub const fn gaussian(seed: u64, rms_height: f64, correlation_length: f64) -> Self {
        let texture = Texture::Correlation { along: correlation_length, across: correlation_length };
        Self { seed, rms_height, texture, skewness: 0.0, kurtosis: 3.0, patch: None }
    }

    /// Heights of every cell of `body`, m, column by column: mean 0 and rms height as asked (both over the cells that are
    /// there, up to rounding), on the disc periodic round the ring.
    ///
    /// Autocorrelation, skewness and kurtosis are those of the population from which a seed draws one field: those of
    /// a single field differ from them by its sampling error.
    ///
    /// The same seed gives unrelated fields on disc and pin, and the same bits on every machine.
    ///
    /// # Errors
    /// [`SynthesisError`] when a length is not positive and finite, the field could not vary on this mesh, no
    /// distribution has the moments, or `patch` is set for the pin.
    pub fn field(&self, body: Body, mesh: &Mesh) -> Result<Vec<f64>, SynthesisError> {
        let repeats = self.check(body, mesh)?;
        let distribution = Johnson::with_moments(self.skewness, self.kurtosis)?;
        if self.rms_height == 0.0 {
            return Ok(vec![0.0; body.columns(mesh) * mesh.rows()]);
        }
        let reach = match self.texture {
            Texture::Correlation { along, across } => [REACH * along, REACH * across],
            Texture::PowerLaw { roll_off, .. } => [POWER_LAW_REACH * roll_off; 2],
        };
        let grid = Grid::new(body, mesh, reach, repeats);
        let stream = if body == Body::Disc { Stream::DiscHeight } else { Stream::PinHeight };
        let mut random = Random::new(self.seed, stream);
        let translation = (distribution != Johnson::Normal).then(|| Translation::new(distribution));
        let mut field = match (self.texture, &translation) {
            (Texture::Correlation { along, across }, None) => {
                planar::separable_field(&grid, along / grid.column_width, across / grid.row_height, &mut random)
            }
            (texture, translation) => {
                if grid.is_too_large() {
                    return Err(SynthesisError::TooLarge { columns: grid.padded_columns, rows: grid.padded_rows });
                }
                let power = match texture {
                    Texture::Correlation { along, across } => {
                        planar::gaussian_on(&grid, along / grid.column_width, across / grid.row_height)
                    }
                    Texture::PowerLaw { hurst, roll_off, short_cutoff } => {
                        planar::power_law_on(&grid, hurst, roll_off, short_cutoff)
                    }
                };
                planar::field(&grid, power, translation.as_ref(), &mut random)
            }
        };
        let (key, length) = self.texture.length();
        let only_mean = SynthesisError::OnlyMean { columns: grid.columns, rows: grid.rows, key, length };
        let is_there = |cell: usize| body == Body::Disc || mesh.is_present(cell);
        if translation.is_some() {
            normalise(&mut field, 1.0, is_there).ok_or_else(|| only_mean.clone())?;
            field.iter_mut().for_each(|value| *value = distribution.height(*value));
        }
        normalise(&mut field, self.rms_height, is_there).ok_or(only_mean)?;
        Ok(field)
    }

    /// Refuses what cannot be made; gives the number of repeats round the ring (1 without `patch`).
    fn check(&self, body: Body, mesh: &Mesh) -> Result<usize, SynthesisError> {
        if !(self.rms_height >= 0.0 && self.rms_height.is_finite()) {
            return Err(SynthesisError::RmsHeight { found: self.rms_height });
        }
        self.check_texture(mesh)?;
        match (self.patch, body) {
            (None, _) => Ok(1),
            (Some(_), Body::Pin) => Err(SynthesisError::PatchOnPin),
            (Some(patch), Body::Disc) => {
                let column_width = mesh.column_width();
                // Written so that NaN is refused too.
                if !(patch >= 2.0 * column_width && patch.is_finite()) {
                    return Err(SynthesisError::Patch { found: patch, column_width });
                }
                Ok(libm::round(Body::Disc.length(mesh) / patch).max(1.0) as usize)
            }
        }
    }

    fn check_texture(&self, mesh: &Mesh) -> Result<(), SynthesisError> {
        let cell = mesh.column_width().min(mesh.row_height());
        let longest = Body::Disc.length(mesh).min(LONGEST * cell);
        match self.texture {
            Texture::Correlation { along, across } => {
                let lengths = [("correlation_length", along), ("correlation_length_across", across)];
                for (key, found) in lengths {
                    if !(found > 0.0 && found.is_finite()) {
                        return Err(SynthesisError::CorrelationLength { key, found });
                    }
                    if found > longest {
                        return Err(SynthesisError::CorrelationTooLong { key, found, longest });
                    }
                }
            }
            Texture::PowerLaw { hurst, roll_off, short_cutoff } => {
                let shortest = 2.0 * cell;
                if !(0.0..=1.0).contains(&hurst) {
                    return Err(SynthesisError::Hurst { found: hurst });
                }
                if !(shortest..=longest).contains(&roll_off) {
                    return Err(SynthesisError::RollOff { found: roll_off, shortest, longest });
                }
                if let Some(found) = short_cutoff.filter(|found| !(shortest..=roll_off).contains(found)) {
                    return Err(SynthesisError::ShortCutoff { found, shortest, roll_off });
                }
            }
        }
        Ok(())
    }
}

/// Takes out the mean and scales to the rms height, both of the cells that are there; `None` when nothing but the mean is.
fn normalise(field: &mut [f64], rms_height: f64, is_there: impl Fn(usize) -> bool) -> Option<()> {
    let largest = there(field, &is_there).fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let count = there(field, &is_there).count() as f64;
    centre(field, count, &is_there);
    let rms = (there(field, &is_there).map(|value| value * value).sum::<f64>() / count).sqrt();
    if rms <= SMALLEST_RMS * largest {
        return None;
    }
    let factor = rms_height / rms;
    field.iter_mut().for_each(|value| *value *= factor);
    // What rounding left of the mean the first time.
    centre(field, count, &is_there);
    Some(())
}

fn centre(field: &mut [f64], count: f64, is_there: impl Fn(usize) -> bool) {
    let mean = there(field, &is_there).sum::<f64>() / count;
    field.iter_mut().for_each(|value| *value -= mean);
}

/// The values of the cells that are there.
fn there<'a>(field: &'a [f64], is_there: &'a impl Fn(usize) -> bool) -> impl Iterator<Item = f64> + 'a {
    field.iter().enumerate().filter(|(cell, _)| is_there(*cell)).map(|(_, value)| *value)
}
