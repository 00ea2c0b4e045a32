//! Images (PNG, TIFF, JPEG): as heights, and as grey levels.
//!
//! The first line of an image is at the top, where y is largest. Stored numbers are taken as they are: colour profiles
//! and gamma are for the eye.

use std::io::Cursor;

use plateau_core::surface::micrograph::Picture;
use png::{BitDepth, ColorType, Transformations};
use thiserror::Error;
use tiff::decoder::ifd::Value;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::format::Format;
use super::measured::{MOST_POINTS, Measured, ReadOptions, inflated};
use crate::memory::{NoRoom, refuse_beyond};

/// Reason why an image gives no surface.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum ImageError {
    #[error("cannot be read as PNG: {0}")]
    Png(#[from] png::DecodingError),
    #[error("cannot be read as TIFF: {0}")]
    Tiff(#[from] tiff::TiffError),
    #[error("cannot be read as JPEG: {0}")]
    Jpeg(String),
    #[error(
        "JPEG alters levels to save room, and so the heights: have the image saved as PNG or TIFF by what measured it"
    )]
    Lossy,
    #[error("the image has {found}, expected {expected}")]
    Pixels { found: String, expected: &'static str },
    #[error(
        "the image has {width} x {height} pixels, which a file of {bytes} bytes does not hold or memory should not"
    )]
    TooLarge { width: u64, height: u64, bytes: usize },
    #[error("the image has a tag of {values} values, which a file of {bytes} bytes does not hold")]
    Tag { values: u64, bytes: usize },
    #[error("{width} x {height} pixels need {no_room}")]
    Memory { width: u64, height: u64, no_room: NoRoom },
    #[error(
        "the image is stored turned ({kind} orientation {found}), expected 1, its first line at the top: save it so"
    )]
    Orientation { kind: &'static str, found: u32 },
    #[error("an image does not say its heights: height_range = [\"0 um\", \"10 um\"] gives those of black and white")]
    NoHeightRange,
    #[error("the pixels are decimal heights of an unknown unit: unit = \"um\" gives it, in place of height_range")]
    NoUnit,
    #[error("the pixels are grey levels, so unit has no meaning: leave it out and give height_range")]
    Unit,
    #[error("{count} of {points} pixels are not finite heights, expected finite numbers, NaN for a missing point")]
    Infinite { count: usize, points: usize },
}

impl From<DecodeErrors> for ImageError {
    fn from(error: DecodeErrors) -> Self {
        Self::Jpeg(error.to_string().trim_matches('"').to_owned())
    }
}

/// Pixels line by line, the first line at the top.
#[derive(Debug, PartialEq)]
struct Raster {
    width: usize,
    height: usize,
    colour: Colour,
    /// Samples, as many a pixel as the colour has.
    samples: Samples,
    /// Distance of the pixels along x and y, m, that the file states.
    pixel: Option<[f64; 2]>,
    /// Warnings about what is left out of the file.
    warnings: Vec<String>,
}

/// Samples that make a pixel, and how many they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Colour {
    Grey = 1,
    GreyAlpha,
    Rgb,
    RgbAlpha,
}

#[derive(Debug, PartialEq)]
enum Samples {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// Bytes of pixels that a byte of a JPEG file holds at most: blocks of 8 by 8 samples of less than a bit each, and colours that a quarter
/// of the pixels share along and across.
const JPEG_INFLATED: usize = 4096;
/// Largest width and height that a JPEG file can state.
const JPEG_LARGEST: usize = u16::MAX as usize;

const EXPECTED: &str = "grey or RGB pixels of 8 or 16 bits, or grey ones of 32 bits float: save it so";

impl Raster {
    /// Decodes a PNG image; palettes and less than 8 bits are expanded.
    fn png(content: &[u8]) -> Result<Self, ImageError> {
        let bytes = content.len();
        // What is not the picture (texts, profiles) is left out.
        let limits = png::Limits { bytes: inflated(bytes).saturating_add(1 << 20) };
        let mut decoder = png::Decoder::new_with_limits(Cursor::new(content), limits);
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        decoder.set_transformations(Transformations::EXPAND);
        let header = decoder.read_header_info()?;
        let (width, height) = (u64::from(header.width), u64::from(header.height));
        let bits = header.bits_per_pixel() as u64;
        let line = width.saturating_mul(bits).div_ceil(8);
        refuse_promise(width, height, line.saturating_mul(height), inflated(bytes), bytes)?;
        let mut reader = decoder.read_info()?;
        let size = reader.output_buffer_size().ok_or(ImageError::TooLarge { width, height, bytes })?;
        let mut buffer = vec![0; size];
        let info = reader.next_frame(&mut buffer)?;
        // The checksum of the last part, and that the file ends where it should.
        reader.finish()?;
        let colour = match info.color_type {
            ColorType::Grayscale => Colour::Grey,
            ColorType::GrayscaleAlpha => Colour::GreyAlpha,
            ColorType::Rgb | ColorType::Indexed => Colour::Rgb,
            ColorType::Rgba => Colour::RgbAlpha,
        };
        buffer.truncate(info.buffer_size());
        let samples = match info.bit_depth {
            BitDepth::Sixteen => {
                Samples::U16(buffer.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
            }
            _ => Samples::U8(buffer),
        };
        let dimensions = reader.info().pixel_dims.filter(|dimensions| dimensions.unit == png::Unit::Meter);
        let pixel = dimensions.and_then(|size| per_metre([size.xppu, size.yppu].map(f64::from)));
        let [width, height] = [info.width, info.height].map(|count| count as usize);
        Self { width, height, colour, samples, pixel, warnings: Vec::new() }.checked()
    }

    /// Decodes the first image of a TIFF file.
    fn tiff(content: &[u8]) -> Result<Self, ImageError> {
        let bytes = content.len();
        refuse_tags(content)?;
        let mut limits = Limits::default();
        limits.ifd_value_size = bytes;
        let mut decoder = Decoder::new(Cursor::new(content))?.with_limits(limits.clone());
        let (width, height) = decoder.dimensions()?;
        let kind = decoder.colortype()?;
        let (colour, sample_bytes) = match kind {
            tiff::ColorType::Gray(bits @ (8 | 16 | 32)) => (Colour::Grey, u64::from(bits) / 8),
            tiff::ColorType::GrayA(bits @ (8 | 16)) => (Colour::GreyAlpha, u64::from(bits) / 4),
            tiff::ColorType::RGB(bits @ (8 | 16)) => (Colour::Rgb, u64::from(bits) / 8 * 3),
            tiff::ColorType::RGBA(bits @ (8 | 16)) => (Colour::RgbAlpha, u64::from(bits) / 8 * 4),
            other => return Err(ImageError::Pixels { found: format!("{other:?} pixels"), expected: EXPECTED }),
        };
        if let Some(found) = decoder.find_tag_unsigned(Tag::Orientation)?.filter(|orientation| *orientation != 1) {
            return Err(ImageError::Orientation { kind: "TIFF", found });
        }
        let (width, height) = (u64::from(width), u64::from(height));
        let needed = width.saturating_mul(height).saturating_mul(sample_bytes);
        // LZW makes strings of up to 4096 bytes of a code of 12 bits at most.
        refuse_promise(width, height, needed, bytes.saturating_mul(4096), bytes)?;
        limits.decoding_buffer_size = needed as usize;
        limits.intermediate_buffer_size = (needed as usize).saturating_add(bytes).saturating_add(1 << 16);
        let mut decoder = decoder.with_limits(limits);
        if decoder.image_buffer_layout()?.planes > 1 {
            return Err(ImageError::Pixels { found: "a plane for every colour".to_owned(), expected: EXPECTED });
        }
        let samples = match decoder.read_image()? {
            DecodingResult::U8(samples) => Samples::U8(samples),
            DecodingResult::U16(samples) => Samples::U16(samples),
            DecodingResult::F32(samples) => Samples::F32(samples),
            _ => return Err(ImageError::Pixels { found: "signed or wide integers".to_owned(), expected: EXPECTED }),
        };
        let mut warnings = Vec::new();
        if decoder.more_images() {
            warnings.push("the file has several images: the first is read".to_owned());
        }
        let pixel = resolution(&mut decoder);
        Self { width: width as usize, height: height as usize, colour, samples, pixel, warnings }.checked()
    }

    /// Decodes a JPEG image, which has to be complete: what is missing of one would be a grey area.
    fn jpeg(content: &[u8]) -> Result<Self, ImageError> {
        let bytes = content.len();
        let options =
            DecoderOptions::default().set_strict_mode(true).set_max_width(JPEG_LARGEST).set_max_height(JPEG_LARGEST);
        let mut decoder = JpegDecoder::new_with_options(Cursor::new(content), options);
        decoder.decode_headers()?;
        let (width, height) = decoder.dimensions().unwrap_or_default();
        let (space, colour) = match decoder.input_colorspace() {
            Some(ColorSpace::Luma) => (ColorSpace::Luma, Colour::Grey),
            Some(ColorSpace::YCbCr | ColorSpace::RGB) => (ColorSpace::RGB, Colour::Rgb),
            other => {
                let found = other.map_or("no colours".to_owned(), |space| format!("{space:?} pixels"));
                return Err(ImageError::Pixels { found, expected: "grey or RGB pixels: save it so" });
            }
        };
        if let Some(found) = decoder.exif().and_then(|exif| orientation(exif)).filter(|found| *found != 1) {
            return Err(ImageError::Orientation { kind: "EXIF", found });
        }
        let [width_64, height_64] = [width, height].map(|count| count as u64);
        let needed = width_64.saturating_mul(height_64).saturating_mul(colour as u64);
        refuse_promise(width_64, height_64, needed, bytes.saturating_mul(JPEG_INFLATED), bytes)?;
        decoder.set_options(options.jpeg_set_out_colorspace(space));
        let samples = Samples::U8(decoder.decode()?);
        // The decoder makes up the rest of an image that ends early.
        if !content.ends_with(b"\xff\xd9") && !has_end(content) {
            return Err(ImageError::Jpeg("its end is missing".to_owned()));
        }
        Self { width, height, colour, samples, pixel: density(content), warnings: Vec::new() }.checked()
    }

    /// Refuses pixels that do not fill the image, whatever a decoder did.
    fn checked(self) -> Result<Self, ImageError> {
        let found = match &self.samples {
            Samples::U8(samples) => samples.len(),
            Samples::U16(samples) => samples.len(),
            Samples::F32(samples) => samples.len(),
        };
        if found == self.width * self.height * self.colour as usize && found > 0 {
            Ok(self)
        } else {
            Err(ImageError::Pixels { found: format!("{found} samples"), expected: "as many as its size says" })
        }
    }
}

/// Refuses a first image of a TIFF file with a tag of more values than the file has bytes: the decoder would ask for their memory,
/// and does not come back where there is none. What else is wrong, it tells itself.
fn refuse_tags(content: &[u8]) -> Result<(), ImageError> {
    let number = |at: u64, count: usize| {
        let digits = content.get(usize::try_from(at).ok()?..)?.get(..count)?.iter();
        let joined = |number: u64, digit: &u8| number << 8 | u64::from(*digit);
        Some(if content.starts_with(b"MM") { digits.fold(0, joined) } else { digits.rev().fold(0, joined) })
    };
    // BigTIFF has wider numbers.
    let (directory, tags_bytes, tag_bytes, count_bytes) =
        if number(2, 2) == Some(43) { (number(8, 8), 8, 20, 8) } else { (number(4, 4), 2, 12, 4) };
    let Some((directory, tags)) = directory.and_then(|at| Some((at, number(at, tags_bytes)?))) else {
        return Ok(());
    };
    let counts = (0..tags).map_while(|tag| number(directory + tags_bytes as u64 + tag * tag_bytes + 4, count_bytes));
    match counts.max() {
        Some(values) if values > content.len() as u64 => Err(ImageError::Tag { values, bytes: content.len() }),
        _ => Ok(()),
    }
}

/// Distance of the pixels along x and y, m, that the tags of a TIFF file state.
fn resolution(decoder: &mut Decoder<Cursor<&[u8]>>) -> Option<[f64; 2]> {
    let unit = match decoder.find_tag_unsigned::<u16>(Tag::ResolutionUnit).ok()? {
        Some(3) => 0.01,
        Some(2) | None => 0.0254,
        _ => return None,
    };
    let mut pixels = |tag| match decoder.get_tag(tag).ok()? {
        Value::Rational(pixels, units) => Some(f64::from(pixels) / f64::from(units) / unit),
        _ => None,
    };
    per_metre([pixels(Tag::XResolution)?, pixels(Tag::YResolution)?])
}

/// The distances of pixels of which there are so many in a metre.
fn per_metre(pixels: [f64; 2]) -> Option<[f64; 2]> {
    let distances = pixels.map(f64::recip);
    distances.iter().all(|distance| *distance > 0.0 && distance.is_finite()).then_some(distances)
}

/// Refuses an image that promises more than its file can hold, than is read, or than memory holds. `needed` are the bytes of its
/// pixels.
fn refuse_promise(width: u64, height: u64, needed: u64, most: usize, bytes: usize) -> Result<(), ImageError> {
    let points = width.checked_mul(height).filter(|points| *points <= MOST_POINTS as u64);
    if points.is_none() || needed > most as u64 {
        return Err(ImageError::TooLarge { width, height, bytes });
    }
    // The pixels as they are stored and as numbers, and a height of each.
    let heights = width.saturating_mul(height).saturating_mul(size_of::<f64>() as u64);
    refuse_beyond(needed.saturating_mul(2).saturating_add(heights)).map_err(|no_room| ImageError::Memory {
        width,
        height,
        no_room,
    })
}

/// Tells whether there is an end-of-image marker behind the first scan: cameras write more behind it.
fn has_end(content: &[u8]) -> bool {
    let scan = segments(content).find(|(marker, _)| *marker == 0xda);
    scan.is_some_and(|(_, at)| content[at..].windows(2).any(|pair| pair == b"\xff\xd9"))
}

/// Markers of the segments of a file up to its first scan, and where their contents begin.
fn segments(content: &[u8]) -> impl Iterator<Item = (u8, usize)> {
    let mut at = 2;
    std::iter::from_fn(move || {
        let [0xff, marker, high, low] = *content.get(at..at + 4)? else { return None };
        let begin = at + 4;
        at += 2 + usize::from(u16::from_be_bytes([high, low]));
        Some((marker, begin))
    })
}

/// Distance of the pixels along x and y, m, that a JFIF header states.
fn density(content: &[u8]) -> Option<[f64; 2]> {
    let (_, at) = segments(content).next().filter(|(marker, _)| *marker == 0xe0)?;
    let [b'J', b'F', b'I', b'F', 0, _, _, unit, x_high, x_low, y_high, y_low] = *content.get(at..at + 12)? else {
        return None;
    };
    let unit = match unit {
        1 => 0.0254,
        2 => 0.01,
        _ => return None,
    };
    let pixels = [[x_high, x_low], [y_high, y_low]].map(|pair| f64::from(u16::from_be_bytes(pair)));
    per_metre(pixels.map(|pixels| pixels / unit))
}

/// The orientation that EXIF data state.
fn orientation(exif: &[u8]) -> Option<u32> {
    const TAG: u16 = 0x0112;
    let is_little = exif.starts_with(b"II");
    let number = |at: usize| {
        let pair = [*exif.get(at)?, *exif.get(at + 1)?];
        Some(if is_little { u16::from_le_bytes(pair) } else { u16::from_be_bytes(pair) })
    };
    let [low, high] = if is_little { [4, 6] } else { [6, 4] };
    let begin = usize::from(number(high)?) << 16 | usize::from(number(low)?);
    let mut entries = (0..usize::from(number(begin)?)).map(|entry| begin + 2 + 12 * entry);
    let entry = entries.find(|entry| number(*entry) == Some(TAG))?;
    number(entry + 8).map(u32::from)
}

fn decode(content: &[u8], format: Format) -> Result<Raster, ImageError> {
    match format {
        Format::Png => Raster::png(content),
        Format::Jpeg => Raster::jpeg(content),
        _ => Raster::tiff(content),
    }
}

/// Reads an image as heights: grey levels lie evenly between the heights of black and white, decimal pixels are heights
/// themselves.
pub(super) fn heights(content: &[u8], format: Format, options: &ReadOptions) -> Result<Measured, ImageError> {
    if format == Format::Jpeg {
        return Err(ImageError::Lossy);
    }
    let Raster { width, height, colour, samples, warnings, .. } = decode(content, format)?;
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
    let plain = Measured::new(format, [width, height], options.pitch, heights);
    Ok(Measured { notes: vec![note.to_owned()], warnings, ..plain })
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

pub(super) struct Grey {
    /// Levels from black 0 to white 1.
    pub(super) picture: Picture<f32>,
    /// Distance of the pixels along x and y, m, that the file states.
    pub(super) pixel: Option<[f64; 2]>,
    /// Kind of the image, in words.
    pub(super) told: String,
}

/// Reads an image as grey levels from black 0 to white 1. Colours become their luma of ITU-R BT.709,
/// 0.2126 R + 0.7152 G + 0.0722 B.
pub(super) fn grey(content: &[u8], format: Format) -> Result<Grey, ImageError> {
    let Raster { width, height, colour, samples, pixel, warnings } = decode(content, format)?;
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
    let told = format!("{width} x {height} pixels, {kind}, {bits}{warnings}");
    Ok(Grey { picture: Picture { width, height, pixels }, pixel, told })
}

/// Grey levels of pixels whose samples go up to `white`.
fn levels<T: Copy + Into<f64>>(samples: &[T], colour: Colour, white: f64) -> Result<Vec<f32>, ImageError> {
    let value = |sample: &T| (*sample).into() / white;
    let luma = |rgb: &[T]| match rgb {
        [red, green, blue, ..] => 0.2126 * value(red) + 0.7152 * value(green) + 0.0722 * value(blue),
        [grey, ..] => value(grey),
        [] => 0.0,
    };
    let pixels = || samples.chunks_exact(colour as usize);
    let transparent = matches!(colour, Colour::GreyAlpha | Colour::RgbAlpha)
        && pixels().any(|pixel| pixel.last().is_some_and(|alpha| value(alpha) < 1.0));
    if transparent {
        let expected = "opaque ones: save the image without transparency";
        return Err(ImageError::Pixels { found: "transparent pixels".to_owned(), expected });
    }
    Ok(pixels().map(|pixel| (luma(pixel) as f32).min(1.0)).collect())
}
