//! The steps of the preparation chain of a surface, and what each is done with.

use std::ops::RangeInclusive;

use super::crop::Crop;
use super::extend::Extension;
use super::flip::Flip;
use super::level::Level;
use super::missing::Fill;
use super::preparation_error::PreparationError;
use super::unroll::Unroll;

/// Distances of points that are taken, m, as of files; measured ones are between 1e-11 and 1e-3.
const PIXELS: RangeInclusive<f64> = 1e-15..=1e3;

/// The preparation chain; a step that is absent is not done. Applied in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preparation {
    /// The part of the patch that is kept.
    pub crop: Option<Crop>,
    /// Takes the patch as a sector of a ring measured in x and y, and makes arc length and radius of it.
    pub unroll: Option<Unroll>,
    /// Turns the patch counterclockwise, x to the right and y up, rad. Quarters of a turn are exact, else it is interpolated.
    pub rotate: f64,
    /// Reverses the patch.
    pub flip: Option<Flip>,
    /// Levelling; missing points do not take part.
    pub level: Level,
    /// Takes out points of spikes and pits with slopes beyond this; what is left is levelled once more.
    pub outlier_slope: Option<f64>,
    /// Takes out points further than this many robust standard deviations from the median of the levelled surface,
    /// which then is levelled once more without them.
    pub outliers: Option<f64>,
    /// What missing points and outliers get; without it they are an error.
    pub fill: Option<Fill>,
    /// Reinterprets the distance of the points, m.
    pub pixel: Option<f64>,
    /// Takes out waves that are shorter: nesting index of an areal Gaussian filter, m (S-filter).
    pub s_filter: Option<f64>,
    /// Takes out waves that are longer, in the same way, m (L-filter).
    pub l_filter: Option<f64>,
    /// Cuts what stands higher than this above the mean, m (along the Abbott-Firestone curve).
    pub cutoff: Option<f64>,
    /// Tiles the patch along and across the sliding direction without a step at the seams.
    pub repeat: bool,
    /// Makes random heights with the statistics of the patch, in place of it; `repeat` then has no meaning.
    pub extend: Option<Extension>,
    /// Multiplies the heights.
    pub scale: f64,
}

impl Preparation {
    /// Nothing is done.
    pub const NONE: Self = Self {
        crop: None,
        unroll: None,
        rotate: 0.0,
        flip: None,
        level: Level::None,
        outlier_slope: None,
        outliers: None,
        fill: None,
        pixel: None,
        s_filter: None,
        l_filter: None,
        cutoff: None,
        repeat: false,
        extend: None,
        scale: 1.0,
    };
}

impl Default for Preparation {
    /// [`Preparation::NONE`].
    fn default() -> Self {
        Self::NONE
    }
}

impl Preparation {
    /// Refuses numbers that make no sense.
    pub(super) fn check(&self) -> Result<(), PreparationError> {
        let positive = |number: f64| number > 0.0 && number.is_finite();
        let checks = [
            ("rotate", Some(self.rotate), self.rotate.is_finite(), "a finite angle in rad"),
            ("outlier_slope", self.outlier_slope, self.outlier_slope.is_none_or(positive), "a positive, finite number"),
            ("s_filter", self.s_filter, self.s_filter.is_none_or(positive), "a positive, finite length in m"),
            ("l_filter", self.l_filter, self.l_filter.is_none_or(positive), "a positive, finite length in m"),
            ("outliers", self.outliers, self.outliers.is_none_or(positive), "a positive, finite number"),
            ("pixel", self.pixel, self.pixel.is_none_or(|pixel| PIXELS.contains(&pixel)), "from 1e-15 to 1e3, in m"),
            ("cutoff", self.cutoff, self.cutoff.is_none_or(f64::is_finite), "a finite length in m"),
            ("scale", Some(self.scale), self.scale.is_finite(), "a finite number"),
        ];
        if let Some((key, Some(found), _, expected)) = checks.into_iter().find(|(_, _, good, _)| !good) {
            return Err(PreparationError::Value { key, found, expected });
        }
        match (self.s_filter, self.l_filter) {
            (Some(s_filter), Some(l_filter)) if s_filter >= l_filter => {
                Err(PreparationError::Filters { s_filter, l_filter })
            }
            _ => Ok(()),
        }
    }
}
