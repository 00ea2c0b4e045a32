//! Pictures, and the reasons why one gives no fibre map.

use thiserror::Error;

use super::super::{Extension, Length};

/// A picture; its first line is at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture<T> {
    /// Pixels of a line.
    pub width: usize,
    /// Lines.
    pub height: usize,
    /// Pixels, line by line.
    pub pixels: Vec<T>,
}

impl<T> Picture<T> {
    /// Width and height, m, of a picture whose pixels are this far apart, m.
    pub fn size(&self, pixel: f64) -> [f64; 2] {
        [self.width as f64 * pixel, self.height as f64 * pixel]
    }
}

impl<T: Copy> Picture<T> {
    /// Turns the picture counterclockwise by quarters of a turn.
    pub(super) fn turned(self, quarters: u8) -> Self {
        let Self { width, height, ref pixels } = self;
        let old = |x: usize, y: usize| pixels[y * width + x];
        match quarters % 4 {
            // What was the right edge is the new top.
            1 => Self::from_fn(height, width, |x, y| old(width - 1 - y, x)),
            2 => Self::from_fn(width, height, |x, y| old(width - 1 - x, height - 1 - y)),
            3 => Self::from_fn(height, width, |x, y| old(y, height - 1 - x)),
            _ => self,
        }
    }

    fn from_fn(width: usize, height: usize, pixel: impl Fn(usize, usize) -> T) -> Self {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Self { width, height, pixels }
    }
}

impl Picture<bool> {
    /// Fraction of the pixels that are set.
    pub fn fraction(&self) -> f64 {
        self.pixels.iter().filter(|pixel| **pixel).count() as f64 / self.pixels.len() as f64
    }
}

/// Error of a picture that gives no fibre map.
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
        "the picture is {} by {}, the pin {} by {}: repeat = true repeats it, mirrored at the seams, extend = \"statistics\" makes \
         random fibres with its fraction and correlation; or take a larger picture",
        Length(*width), Length(*height), Length(pin.0), Length(pin.1)
    )]
    Small { width: f64, height: f64, pin: (f64, f64) },
    #[error(
        "{} by {} whole cells lie in the picture of {} by {}, expected at least {least} by {least} for its statistics: take a \
         larger picture or smaller cells, or repeat = true in place of extend",
        cells[0], cells[1], Length(picture[0]), Length(picture[1]), least = Extension::FEWEST_CELLS
    )]
    FewCells { picture: [f64; 2], cells: [usize; 2] },
    #[error(
        "the statistics of the picture of {} by {} ask for a field of {} by {}, more than there is room for: take a part of it, \
         or larger cells",
        Length(picture[0]), Length(picture[1]), field[0], field[1]
    )]
    LargeField { picture: [f64; 2], field: [usize; 2] },
}
