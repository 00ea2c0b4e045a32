//! Images (PNG, TIFF): as heights, and as grey levels.
//!
//! The first line of an image is at the top, where y is largest. Stored numbers are taken as they are: colour profiles
//! and gamma are for the eye.

mod error;
mod raster;

pub use error::ImageError;
use plateau_core::surface::micrograph::Picture;
use raster::{Colour, Raster, Samples};

use super::format::Format;
use super::options::ReadOptions;

/// Heights of an image, m, column by column.
#[derive(Debug)]
pub(super) struct HeightMap {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// NaN where a decimal image has no number.
    pub(super) heights: Vec<f64>,
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
}

/// Decodes an image by its format.
fn decode(content: &[u8], format: Format) -> Result<Raster, ImageError> {
    if format == Format::Png { Raster::png(content) } else { Raster::tiff(content) }
}

/// Reads an image as heights: grey levels lie evenly between the heights of black and white, decimal pixels are heights
/// themselves.
///
/// # Errors
/// [`ImageError`] when the image is damaged, has colours or transparency, or its heights are not told.
pub(super) fn heights(content: &[u8], format: Format, options: &ReadOptions) -> Result<HeightMap, ImageError> {
    let Raster { width, height, colour, samples, warnings } = decode(content, format)?;
    let refuse = |found: &str| {
        let expected = "grey pixels without transparency: colours are not heights, save the image as grey levels";
        Err(ImageError::Pixels { found: found.to_owned(), expected })
    };
    match colour {
        Colour::Grey => {}
        Colour::GreyAlpha => return refuse("transparency"),
        Colour::Rgb | Colour::RgbAlpha => return refuse("colours"),
    }
    let place = (width, height);
    let (heights, note) = match &samples {
        Samples::U8(levels) => (graded(levels, place, u8::MAX.into(), options)?, "8 bits"),
        Samples::U16(levels) => (graded(levels, place, u16::MAX.into(), options)?, "16 bits"),
        Samples::F32(pixels) => (decimal(pixels, place, options)?, "decimal heights"),
    };
    let count = heights.iter().filter(|height| height.is_infinite()).count();
    if count > 0 {
        return Err(ImageError::Infinite { count, points: heights.len() });
    }
    Ok(HeightMap { columns: width, rows: height, heights, notes: vec![note.to_owned()], warnings })
}

/// Heights of grey levels up to `white`.
fn graded<T: Copy + Into<f64>>(
    levels: &[T],
    place: (usize, usize),
    white: f64,
    options: &ReadOptions,
) -> Result<Vec<f64>, ImageError> {
    if options.unit.is_some() {
        return Err(ImageError::Unit);
    }
    let [black_height, white_height] = options.height_range.ok_or(ImageError::NoHeightRange)?;
    // Weighted so that black and white have exactly their heights.
    Ok(by_columns(levels, place, |level| {
        let share = level.into() / white;
        black_height * (1.0 - share) + white_height * share
    }))
}

/// Heights that are stored as such.
fn decimal(pixels: &[f32], place: (usize, usize), options: &ReadOptions) -> Result<Vec<f64>, ImageError> {
    match (options.unit, options.height_range) {
        (Some(unit), None) => Ok(by_columns(pixels, place, |pixel| f64::from(pixel) * unit)),
        _ => Err(ImageError::NoUnit),
    }
}

/// Pixels column by column, the lowest line first.
fn by_columns<T: Copy>(pixels: &[T], (width, height): (usize, usize), of: impl Fn(T) -> f64) -> Vec<f64> {
    let places = (0..width).flat_map(|x| (0..height).rev().map(move |line| line * width + x));
    places.map(|at| of(pixels[at])).collect()
}

/// Reads an image as grey levels from black 0 to white 1. Colours become their luma of ITU-R BT.709,
/// 0.2126 R + 0.7152 G + 0.0722 B. Gives besides what the image is, in words.
///
/// # Errors
/// [`ImageError`] when the image is damaged, transparent somewhere, or has decimal pixels beyond 0 and 1.
pub(super) fn grey(content: &[u8], format: Format) -> Result<(Picture<f32>, String), ImageError> {
    let Raster { width, height, colour, samples, warnings } = decode(content, format)?;
    let (pixels, bits) = match &samples {
        Samples::U8(samples) => (levels(samples, colour, u8::MAX.into())?, "8 bits"),
        Samples::U16(samples) => (levels(samples, colour, u16::MAX.into())?, "16 bits"),
        Samples::F32(samples) => (levels(samples, colour, 1.0)?, "decimal levels"),
    };
    if pixels.iter().any(|level| !(0.0..=1.0).contains(level)) {
        let found = "decimal pixels beyond 0 to 1".to_owned();
        return Err(ImageError::Pixels { found, expected: "grey levels from black 0 to white 1" });
    }
    let kind = match colour {
        Colour::Grey | Colour::GreyAlpha => "grey",
        Colour::Rgb | Colour::RgbAlpha => "colours, taken as their luma",
    };
    let warnings: String = warnings.iter().map(|warning| format!(", {warning}")).collect();
    Ok((Picture { width, height, pixels }, format!("{width} x {height} pixels, {kind}, {bits}{warnings}")))
}

/// Grey levels of pixels whose samples go up to `white`.
fn levels<T: Copy + Into<f64>>(samples: &[T], colour: Colour, white: f64) -> Result<Vec<f32>, ImageError> {
    let value = |sample: &T| (*sample).into() / white;
    let luma = |rgb: &[T]| match rgb {
        [red, green, blue, ..] => 0.2126 * value(red) + 0.7152 * value(green) + 0.0722 * value(blue),
        [grey, ..] => value(grey),
        [] => 0.0,
    };
    let pixels = || samples.chunks_exact(colour.samples());
    let transparent = matches!(colour, Colour::GreyAlpha | Colour::RgbAlpha)
        && pixels().any(|pixel| pixel.last().is_some_and(|alpha| value(alpha) < 1.0));
    if transparent {
        let expected = "opaque ones: save the image without transparency";
        return Err(ImageError::Pixels { found: "transparent pixels".to_owned(), expected });
    }
    Ok(pixels().map(|pixel| (luma(pixel) as f32).min(1.0)).collect())
}
