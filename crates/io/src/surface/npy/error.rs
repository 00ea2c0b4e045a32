//! Why a NumPy file gives no surface.

use thiserror::Error;

use crate::memory::NoRoom;
use crate::text::short;

/// Why a NumPy file gives no surface.
#[derive(Debug, Error)]
pub enum NpyError {
    /// The header is damaged.
    #[error("the header is damaged: found {found}, expected {expected}")]
    Header {
        /// What stands there.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// The array holds something else.
    #[error("the array has type {found}, expected floating-point numbers or integers")]
    Type {
        /// Its type as NumPy writes it.
        found: String,
    },
    /// The array has other than two dimensions, or no points.
    #[error("the array has shape {found}, expected 2 dimensions (columns, rows), none of them 0")]
    Shape {
        /// Its shape.
        found: String,
    },
    /// More points than are read, or than the file can hold.
    #[error("the array has shape ({}, {}), which is more than the {most} points that are read of a file of this size", shape.0, shape.1)]
    TooLarge {
        /// Its shape.
        shape: (u64, u64),
        /// The most that are read.
        most: usize,
    },
    /// More than memory holds.
    #[error("its heights need {0}")]
    Memory(NoRoom),
    /// The data end too early, or too late.
    #[error("the data have {found} bytes, expected {expected} for shape ({}, {})", shape.0, shape.1)]
    Length {
        /// Bytes of data.
        found: u64,
        /// Bytes that the shape needs.
        expected: usize,
        /// The shape.
        shape: (u64, u64),
    },
    /// Infinite heights.
    #[error("{count} of {points} heights are infinite, expected heights in m, NaN for a missing point")]
    Infinite {
        /// Infinite heights.
        count: usize,
        /// All heights.
        points: usize,
    },
    /// The archive is damaged.
    #[error("cannot be read as a zip archive: {0}")]
    Zip(#[from] zip::result::ZipError),
    /// A member of the archive cannot be decompressed.
    #[error("cannot be decompressed: {0}")]
    Inflate(std::io::Error),
    /// The array asked for is not there, or there is not one with two dimensions.
    #[error("{problem}; {present}")]
    Choice {
        /// What is wrong.
        problem: String,
        /// The arrays of the archive.
        present: String,
    },
    /// What is wrong with one array of an archive.
    #[error("array \"{}\": {reason}", short(name))]
    Member {
        /// Name of the array.
        name: String,
        /// What is wrong.
        reason: Box<NpyError>,
    },
}

impl NpyError {
    /// No one array is that of this name, or the only one with two dimensions.
    pub(super) fn choice(name: Option<&str>, present: impl Iterator<Item = String>) -> Self {
        const NAMED: usize = 12;
        let mut present: Vec<String> = present.collect();
        let more = present.len().saturating_sub(NAMED);
        present.truncate(NAMED);
        if more > 0 {
            present.push(format!("and {more} more"));
        }
        Self::Choice {
            problem: match name {
                Some(name) => format!("the archive has no one array \"{}\"", short(name).escape_debug()),
                None => "expected one array of two dimensions: name it with dataset = \"...\"".to_owned(),
            },
            present: match present.as_slice() {
                [] => "the archive has no arrays".to_owned(),
                names => format!("it has {}", names.join(", ")),
            },
        }
    }
}
