//! Pixels of an image as they are stored.

use std::io::Cursor;

use png::{BitDepth, ColorType, Transformations};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::error::ImageError;
use crate::memory::refuse_beyond;
use crate::surface::options::{MOST_POINTS, inflated};

/// Pixels line by line, the first line at the top.
#[derive(Debug, PartialEq)]
pub(super) struct Raster {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) colour: Colour,
    /// As many samples a pixel as the colour has.
    pub(super) samples: Samples,
    /// What is left out of the file.
    pub(super) warnings: Vec<String>,
}

/// What a pixel is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colour {
    Grey,
    GreyAlpha,
    Rgb,
    RgbAlpha,
}

/// The numbers of an image.
#[derive(Debug, PartialEq)]
pub(super) enum Samples {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

const EXPECTED: &str = "grey or RGB pixels of 8 or 16 bits, or grey ones of 32 bits float: save it so";

impl Raster {
    /// Decodes a PNG image; palettes and less than 8 bits are expanded.
    pub(super) fn png(content: &[u8]) -> Result<Self, ImageError> {
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
        let raster =
            Self { width: info.width as usize, height: info.height as usize, colour, samples, warnings: Vec::new() };
        raster.checked()
    }

    /// Decodes the first image of a TIFF file.
    pub(super) fn tiff(content: &[u8]) -> Result<Self, ImageError> {
        let bytes = content.len();
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
            return Err(ImageError::Orientation { found });
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
        Self { width: width as usize, height: height as usize, colour, samples, warnings }.checked()
    }

    /// Refuses pixels that do not fill the image, whatever a decoder did.
    fn checked(self) -> Result<Self, ImageError> {
        let found = match &self.samples {
            Samples::U8(samples) => samples.len(),
            Samples::U16(samples) => samples.len(),
            Samples::F32(samples) => samples.len(),
        };
        if found == self.width * self.height * self.colour.samples() && found > 0 {
            Ok(self)
        } else {
            Err(ImageError::Pixels { found: format!("{found} samples"), expected: "as many as its size says" })
        }
    }
}

impl Colour {
    /// Numbers of a pixel.
    pub(super) fn samples(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::GreyAlpha => 2,
            Self::Rgb => 3,
            Self::RgbAlpha => 4,
        }
    }
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
