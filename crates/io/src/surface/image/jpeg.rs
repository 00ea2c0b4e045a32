//! JPEG images.

use std::io::Cursor;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::{Colour, ImageError, Raster, Samples, per_metre, refuse_promise};

/// Bytes of pixels that a byte of a file holds at most: blocks of 8 by 8 samples of less than a bit each, and colours that a quarter
/// of the pixels share along and across.
const INFLATED: usize = 4096;
/// Largest width and height that a file can state.
const LARGEST: usize = u16::MAX as usize;

impl Raster {
    /// Decodes a JPEG image, which has to be complete: what is missing of one would be a grey area.
    pub(super) fn jpeg(content: &[u8]) -> Result<Self, ImageError> {
        let bytes = content.len();
        let options = DecoderOptions::default().set_strict_mode(true).set_max_width(LARGEST).set_max_height(LARGEST);
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
        let needed = width_64.saturating_mul(height_64).saturating_mul(colour.samples() as u64);
        refuse_promise(width_64, height_64, needed, bytes.saturating_mul(INFLATED), bytes)?;
        decoder.set_options(options.jpeg_set_out_colorspace(space));
        let samples = Samples::U8(decoder.decode()?);
        // The decoder makes up the rest of an image that ends early.
        if !content.ends_with(b"\xff\xd9") && !has_end(content) {
            return Err(ImageError::Jpeg("its end is missing".to_owned()));
        }
        Self { width, height, colour, samples, pixel: density(content), warnings: Vec::new() }.checked()
    }
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
