//! The pin's fibre map from a micrograph of its face.

mod picture;
mod plane;
mod statistics;

pub use picture::{MicrographError, Picture};
pub use plane::PinPlane;
use plane::fractions;

use super::Length;
use super::gaussian_filter::mirrored;
use super::patch::neighbours;
use crate::model::mesh::Mesh;
use crate::model::state::Base;

/// Steps from a picture to a fibre map, done in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Micrograph {
    /// Distance of neighbouring pixels, m.
    pub pixel: f64,
    /// Quarters of a turn, counterclockwise, that bring the sliding direction to the right and outward to the top.
    pub quarters: u8,
    /// Standard deviation of the Gaussian that smooths the grey levels, m.
    pub smooth: Option<f64>,
    /// The grey level that parts fibre and resin.
    pub threshold: Threshold,
    /// Side of the threshold that is fibre.
    pub fibres: Fibres,
    /// Area of the smallest region that stays, m²; first specks of fibre are removed, then holes in fibre.
    pub despeckle: Option<f64>,
    /// Enlargement of a picture that is smaller than the pin; none where it is refused.
    pub enlargement: Option<Enlargement>,
}

/// Enlargement of a picture that is smaller than the pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Enlargement {
    /// The picture again and again, mirrored at the seams.
    Tiles,
    /// Random fibres with the area fraction and the two-point correlation of the picture, in place of it.
    Statistics {
        /// Seed of the random stream.
        seed: u64,
    },
}

/// The grey level that parts fibre and resin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threshold {
    /// The level at which the variance between the two classes is largest.
    Otsu,
    /// This level, from black 0 to white 1.
    Level(f64),
}

/// Pixels that are fibre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fibres {
    /// Pixels brighter than the threshold.
    Bright,
    /// Pixels not brighter than the threshold.
    Dark,
}

/// A fibre map and what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct FibreMap {
    /// Base of every pin cell, column by column: fibre if that covers at least half of the cell's area.
    pub base: Vec<Base>,
    /// The picture's grey levels, turned.
    pub grey: Picture<f32>,
    /// True where the turned picture shows fibre.
    pub fibre: Picture<bool>,
    /// Report of the steps, one a line, for people.
    pub report: Vec<String>,
}

impl Micrograph {
    /// Makes the fibre map of grey levels from black 0 to white 1. [`PinPlane`] tells how the picture lies on the pin.
    ///
    /// # Errors
    /// [`MicrographError`] when picture or parameters make no sense or the picture does not cover the pin.
    pub fn fibre_map(&self, grey: Picture<f32>, mesh: &Mesh) -> Result<FibreMap, MicrographError> {
        self.check(&grey)?;
        let mut report = Vec::new();
        let grey = grey.turned(self.quarters);
        if !self.quarters.is_multiple_of(4) {
            report.push(format!("turned counterclockwise by {} deg", 90 * u16::from(self.quarters % 4)));
        }
        let smoothed = self.smooth.filter(|sigma| *sigma > 0.0).map(|sigma| {
            report.push(format!("smoothed by a Gaussian of standard deviation {}", Length(sigma)));
            smooth(&grey, sigma / self.pixel)
        });
        let mut fibre = self.part(smoothed.as_ref().unwrap_or(&grey), &mut report)?;
        drop(smoothed);
        report.push(format!("fibre fraction of the picture {:.4}", fibre.fraction()));
        if let Some(area) = self.despeckle {
            self.remove_specks(&mut fibre, area, &mut report);
        }
        let base = match self.enlargement {
            Some(Enlargement::Statistics { seed }) => statistics::base(&fibre, self.pixel, seed, mesh, &mut report)?,
            Some(Enlargement::Tiles) | None => self.laid(&fibre, mesh, &mut report)?,
        };
        Ok(FibreMap { base, grey, fibre, report })
    }

    /// Base of the cells on which the picture lies, or the picture and its mirror images.
    fn laid(&self, fibre: &Picture<bool>, mesh: &Mesh, report: &mut Vec<String>) -> Result<Vec<Base>, MicrographError> {
        let repeats = self.enlargement == Some(Enlargement::Tiles);
        let fractions = fractions(fibre, self.pixel, repeats, mesh)?;
        let (size, plane) = (fibre.size(self.pixel), PinPlane::new(mesh));
        if !plane.is_covered_by(size) {
            let (across, up) = plane.half_extent();
            report.push(format!(
                "the picture of {} by {} repeated {:.2} times along and {:.2} times across sliding, mirrored at the seams",
                Length(size[0]),
                Length(size[1]),
                2.0 * across / size[0],
                2.0 * up / size[1]
            ));
        }
        let covered: f64 = fractions.iter().zip(mesh.pin_areas()).map(|(fraction, area)| fraction * area).sum();
        report.push(format!("fibre fraction of the picture on the pin {:.4}", covered / mesh.pin_area()));
        Ok(fractions.iter().map(|fraction| if *fraction >= 0.5 { Base::Primary } else { Base::Resin }).collect())
    }

    fn part(&self, grey: &Picture<f32>, report: &mut Vec<String>) -> Result<Picture<bool>, MicrographError> {
        let (threshold, from) = match self.threshold {
            Threshold::Otsu => (otsu(&grey.pixels).ok_or(MicrographError::Uniform)?, " (Otsu)"),
            Threshold::Level(level) => (level, ""),
        };
        let side = match self.fibres {
            Fibres::Bright => "brighter",
            Fibres::Dark => "darker",
        };
        report.push(format!("fibre is what is {side} than the grey level {threshold:.4}{from}"));
        let bright = self.fibres == Fibres::Bright;
        let pixels = grey.pixels.iter().map(|level| (f64::from(*level) > threshold) == bright).collect();
        Ok(Picture { width: grey.width, height: grey.height, pixels })
    }

    fn remove_specks(&self, fibre: &mut Picture<bool>, area: f64, report: &mut Vec<String>) {
        // Rounding must not make a speck of as many pixels as fit into the area.
        let smallest = libm::ceil(area / (self.pixel * self.pixel) * (1.0 - 1e-9)) as usize;
        let specks = despeckle(fibre, true, smallest);
        let holes = despeckle(fibre, false, smallest);
        report.push(format!(
            "{specks} specks of fibre and {holes} holes of fewer than {smallest} pixels removed, fibre fraction of the \
             picture then {:.4}",
            fibre.fraction()
        ));
    }

    fn check(&self, grey: &Picture<f32>) -> Result<(), MicrographError> {
        let Picture { width, height, ref pixels } = *grey;
        let levels = pixels.iter().all(|level| (0.0..=1.0).contains(level));
        if pixels.is_empty() || width.checked_mul(height) != Some(pixels.len()) || !levels {
            return Err(MicrographError::Picture { width, height, pixels: pixels.len() });
        }
        let level = if let Threshold::Level(level) = self.threshold { level } else { 0.0 };
        let is_size = |size: f64| size >= 0.0 && size.is_finite();
        let (area, smooth) = (self.despeckle.unwrap_or(0.0), self.smooth.unwrap_or(0.0));
        let checks = [
            ("pixel", self.pixel, self.pixel > 0.0 && self.pixel.is_finite(), "a positive, finite length in m"),
            ("threshold", level, (0.0..=1.0).contains(&level), "a grey level from 0 to 1"),
            ("despeckle", area, is_size(area), "a finite area in m^2, not negative"),
            ("smooth", smooth, is_size(smooth), "a finite length in m, not negative"),
        ];
        if let Some((key, found, _, expected)) = checks.into_iter().find(|(_, _, good, _)| !good) {
            return Err(MicrographError::Value { key, found, expected });
        }
        let (sigma, side) = (smooth / self.pixel, width.min(height));
        if sigma > 0.25 * side as f64 { Err(MicrographError::Smooth { smooth, sigma, side }) } else { Ok(()) }
    }
}

/// The kernel ends after this many standard deviations.
const REACH: f64 = 4.0;

/// Pixels that a kernel of this standard deviation (pixels) reaches to either side.
fn reach(sigma: f64) -> usize {
    (REACH * sigma).round() as usize
}

/// Smooths with a Gaussian kernel of standard deviation `sigma` (pixels), cut off at four of them; beyond its edges the
/// picture is continued by its mirror image.
fn smooth(picture: &Picture<f32>, sigma: f64) -> Picture<f32> {
    let Picture { width, height, ref pixels } = *picture;
    let reach = reach(sigma);
    let kernel = kernel(sigma, reach);
    let mut along = Vec::with_capacity(pixels.len());
    for line in pixels.chunks_exact(width) {
        let padded: Vec<f64> = (0..width + 2 * reach).map(|at| f64::from(line[mirrored(at, reach, width)])).collect();
        along.extend(
            padded.windows(kernel.len()).map(|part| part.iter().zip(&kernel).map(|(p, k)| p * k).sum::<f64>() as f32),
        );
    }
    let mut smoothed = Vec::with_capacity(pixels.len());
    let mut sums = vec![0.0; width];
    for y in 0..height {
        sums.fill(0.0);
        for (offset, weight) in kernel.iter().enumerate() {
            let from = mirrored(y + offset, reach, height) * width;
            sums.iter_mut().zip(&along[from..from + width]).for_each(|(sum, level)| *sum += weight * f64::from(*level));
        }
        smoothed.extend(sums.iter().map(|sum| *sum as f32));
    }
    Picture { width, height, pixels: smoothed }
}

fn kernel(sigma: f64, reach: usize) -> Vec<f64> {
    let weights: Vec<f64> = (0..=2 * reach)
        .map(|at| {
            let place = (at as f64 - reach as f64) / sigma;
            libm::exp(-0.5 * place * place)
        })
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// Grey levels that are told apart: those of 16 bits. Those of 8 bits are every 257th of them.
const LEVELS: usize = 1 << 16;

/// The grey level, 0 to 1, that parts darker pixels from brighter ones so that the variance between the two classes,
/// ω₁ω₂(μ₁ − μ₂)², is largest (Otsu 1979, DOI 10.1109/TSMC.1979.4310076, eq. 14); of several such levels the darkest.
/// It lies half a level of 16 bits above the brightest of the darker class. None if all pixels are alike.
fn otsu(levels: &[f32]) -> Option<f64> {
    let top = (LEVELS - 1) as f64;
    let mut histogram = vec![0.0; LEVELS];
    for level in levels {
        histogram[((f64::from(*level) * top).round() as usize).min(LEVELS - 1)] += 1.0;
    }
    let total = levels.len() as f64;
    let sum: f64 = histogram.iter().enumerate().map(|(level, count)| level as f64 * count).sum();
    let (mut darker, mut darker_sum) = (0.0, 0.0);
    let (mut best, mut threshold) = (0.0, None);
    for (level, count) in histogram.iter().enumerate() {
        darker += count;
        darker_sum += level as f64 * count;
        let brighter = total - darker;
        if darker == 0.0 || brighter == 0.0 {
            continue;
        }
        let distance = darker_sum / darker - (sum - darker_sum) / brighter;
        let variance = darker * brighter * distance * distance;
        if variance > best {
            (best, threshold) = (variance, Some((level as f64 + 0.5) / top));
        }
    }
    threshold
}

/// Turns every region of `value` of fewer than `smallest` pixels into its opposite; gives their number. Pixels belong
/// together that share a side.
fn despeckle(picture: &mut Picture<bool>, value: bool, smallest: usize) -> usize {
    let Picture { width, ref mut pixels, .. } = *picture;
    let mut seen = vec![false; pixels.len()];
    let mut region = Vec::new();
    let mut specks = 0;
    for start in 0..pixels.len() {
        if pixels[start] != value || seen[start] {
            continue;
        }
        seen[start] = true;
        region.clear();
        region.push(start);
        let mut next = 0;
        while let Some(&pixel) = region.get(next) {
            next += 1;
            for neighbour in neighbours(pixel, width, pixels.len()).into_iter().flatten() {
                if pixels[neighbour] == value && !seen[neighbour] {
                    seen[neighbour] = true;
                    region.push(neighbour);
                }
            }
        }
        if region.len() < smallest {
            specks += 1;
            region.iter().for_each(|pixel| pixels[*pixel] = !value);
        }
    }
    specks
}
