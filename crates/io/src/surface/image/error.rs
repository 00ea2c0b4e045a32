//! Why an image gives no surface.

use thiserror::Error;

use crate::memory::NoRoom;

/// Why an image gives no surface.
#[derive(Debug, Error)]
pub enum ImageError {
    /// A damaged PNG image.
    #[error("cannot be read as PNG: {0}")]
    Png(#[from] png::DecodingError),
    /// A damaged or unusual TIFF image.
    #[error("cannot be read as TIFF: {0}")]
    Tiff(#[from] tiff::TiffError),
    /// Pixels of a kind that is not read.
    #[error("the image has {found}, expected {expected}")]
    Pixels {
        /// What its pixels are.
        found: String,
        /// What they should be, and what to do.
        expected: &'static str,
    },
    /// More pixels than are read, or than the file can hold.
    #[error(
        "the image has {width} x {height} pixels, which a file of {bytes} bytes does not hold or memory should not"
    )]
    TooLarge {
        /// Pixels of a line.
        width: u64,
        /// Lines.
        height: u64,
        /// Size of the file.
        bytes: usize,
    },
    /// More than memory holds.
    #[error("{width} x {height} pixels need {no_room}")]
    Memory {
        /// Pixels of a line.
        width: u64,
        /// Lines.
        height: u64,
        /// How much is needed, and is there.
        no_room: NoRoom,
    },
    /// The image is to be turned before it is shown.
    #[error("the image is stored turned (TIFF orientation {found}), expected 1, its first line at the top: save it so")]
    Orientation {
        /// The tag's value.
        found: u32,
    },
    /// The heights of black and white are unknown.
    #[error("an image does not say its heights: height_range = [\"0 um\", \"10 um\"] gives those of black and white")]
    NoHeightRange,
    /// The unit of decimal pixels is unknown.
    #[error("the pixels are decimal heights of an unknown unit: unit = \"um\" gives it, in place of height_range")]
    NoUnit,
    /// A unit for pixels that are levels.
    #[error("the pixels are grey levels, so unit has no meaning: leave it out and give height_range")]
    Unit,
    /// Pixels that are infinite.
    #[error("{count} of {points} pixels are not finite heights, expected finite numbers, NaN for a missing point")]
    Infinite {
        /// Infinite pixels.
        count: usize,
        /// All pixels.
        points: usize,
    },
}
