//! The pin's fibre map from a micrograph of its face.

mod cells;
mod picture;

use thiserror::Error;

use super::Length;
use crate::model::mesh::Mesh;
use crate::model::state::Base;

pub use cells::PinPlane;
pub use picture::Picture;
use picture::{despeckle, otsu, smooth};

/// How a picture becomes a fibre map; the steps are done in the order of the fields.
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
    /// Which side of the threshold is fibre.
    pub fibres: Fibres,
    /// Area of the smallest region that stays, m²; first specks of fibre are removed, then holes in fibre.
    pub despeckle: Option<f64>,
}

/// The grey level that parts fibre and resin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threshold {
    /// The level at which the variance between the two classes is largest.
    Otsu,
    /// This level, from black 0 to white 1.
    Level(f64),
}

/// Which pixels are fibre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fibres {
    /// Those brighter than the threshold.
    Bright,
    /// Those not brighter than the threshold.
    Dark,
}

/// A fibre map and what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct FibreMap {
    /// Base of every pin cell, column by column: fibre if that covers at least half of the cell's area.
    pub base: Vec<Base>,
    /// The picture's grey levels, turned.
    pub grey: Picture<f32>,
    /// Where the turned picture shows fibre.
    pub fibre: Picture<bool>,
    /// What was done, one step a line, for people.
    pub report: Vec<String>,
}

/// Why a picture gives no fibre map.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum MicrographError {
    #[error(
        "a picture of {width} x {height} with {pixels} pixels, expected width times height grey levels from 0 to 1, at \
         least one"
    )]
    Picture { width: usize, height: usize, pixels: usize },
    #[error("{key} is {found}, expected {expected}")]
    Value { key: &'static str, found: f64, expected: &'static str },
    #[error(
        "smooth = {} is {sigma:.1} pixels, expected at most a quarter of the picture's shorter side of {side} pixels",
        Length(*smooth)
    )]
    Smooth { smooth: f64, sigma: f64, side: usize },
    #[error("all pixels have the same grey level, so there is no threshold between fibre and resin; use uniform")]
    Uniform,
    #[error(
        "the picture is {} by {}, the pin {} by {}: a pixel of at least {} lets the picture cover it",
        Length(*width), Length(*height), Length(pin.0), Length(pin.1), Length(*pixel)
    )]
    Small { width: f64, height: f64, pin: (f64, f64), pixel: f64 },
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
        let fractions = cells::fractions(&fibre, self.pixel, mesh)?;
        let covered: f64 = fractions.iter().zip(mesh.pin_areas()).map(|(fraction, area)| fraction * area).sum();
        report.push(format!("fibre fraction of the picture on the pin {:.4}", covered / mesh.pin_area()));
        let base =
            fractions.iter().map(|fraction| if *fraction >= 0.5 { Base::Primary } else { Base::Resin }).collect();
        Ok(FibreMap { base, grey, fibre, report })
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
        let refuse = |key, found, expected| Err(MicrographError::Value { key, found, expected });
        if !(self.pixel > 0.0 && self.pixel.is_finite()) {
            return refuse("pixel", self.pixel, "a positive, finite length in m");
        }
        if let Threshold::Level(level) = self.threshold
            && !(0.0..=1.0).contains(&level)
        {
            return refuse("threshold", level, "a grey level from 0 to 1");
        }
        if let Some(area) = self.despeckle
            && !(area >= 0.0 && area.is_finite())
        {
            return refuse("despeckle", area, "a finite area in m^2, not negative");
        }
        let side = width.min(height);
        match self.smooth {
            Some(smooth) if !(smooth >= 0.0 && smooth.is_finite()) => {
                refuse("smooth", smooth, "a finite length in m, not negative")
            }
            Some(smooth) if smooth / self.pixel > 0.25 * side as f64 => {
                Err(MicrographError::Smooth { smooth, sigma: smooth / self.pixel, side })
            }
            _ => Ok(()),
        }
    }
}
