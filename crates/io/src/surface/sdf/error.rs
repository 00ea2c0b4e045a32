//! Why an SDF file cannot be read.

use std::fmt;
use std::io;

use thiserror::Error;

/// Where in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// Line of a text, counted from 1.
    Line(usize),
    /// Byte, counted from 0.
    Byte(usize),
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Why an SDF file cannot be read.
#[derive(Debug, Error)]
pub enum SdfError {
    /// The operating system refused.
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
    /// It does not start as an SDF file does.
    #[error(
        "this is not an SDF file: starts with \"{found}\", expected \"aISO-1.0\", \"aISO-2.0\", \"aBCR-1.0\" or the same \
         with \"b\""
    )]
    Magic {
        /// First bytes.
        found: String,
    },
    /// It ends too early.
    #[error("the file is truncated: ends at byte {found}, expected {needed} bytes for {what}")]
    Truncated {
        /// Bytes that are there.
        found: u64,
        /// Bytes that are needed.
        needed: u128,
        /// What they are needed for.
        what: String,
    },
    /// A record of an ASCII file does not end.
    #[error("the file is truncated: the {record} ends at {at} without the line \"*\" that closes it")]
    Unclosed {
        /// Header or data.
        record: &'static str,
        /// Last line.
        at: Position,
    },
    /// A line of the header is no field.
    #[error("{at}: found \"{found}\", expected a header field \"Name = Value\", one of up to 100, or the line \"*\"")]
    NotAField {
        /// Where.
        at: Position,
        /// The line.
        found: String,
    },
    /// A field of the header is missing.
    #[error("{at}: the header ends without the field {field}")]
    MissingField {
        /// Where the header ends.
        at: Position,
        /// Which field.
        field: &'static str,
    },
    /// A field of the header stands twice.
    #[error("{at}: the field {field} stands twice")]
    Twice {
        /// Where the second stands.
        at: Position,
        /// Which field.
        field: String,
    },
    /// A field of the header has a value that cannot be.
    #[error("{at}: {field} is {found}, expected {expected}")]
    Field {
        /// Where.
        at: Position,
        /// Which field.
        field: &'static str,
        /// Its value.
        found: String,
        /// What can be.
        expected: &'static str,
    },
    /// A height is none.
    #[error("{at}: found the height \"{found}\", expected {expected}")]
    Height {
        /// Where.
        at: Position,
        /// The number as it stands in the file.
        found: String,
        /// What can be.
        expected: &'static str,
    },
    /// Fewer heights than promised.
    #[error("{at}: the data end after {found} heights, expected NumPoints x NumProfiles = {points} x {profiles}")]
    Count {
        /// Where the data end.
        at: Position,
        /// Heights found.
        found: usize,
        /// Points of a profile.
        points: usize,
        /// Profiles.
        profiles: usize,
    },
    /// More heights than promised.
    #[error("{at}: more heights than NumPoints x NumProfiles = {points} x {profiles}")]
    TooMany {
        /// Where the first height too many stands.
        at: Position,
        /// Points of a profile.
        points: usize,
        /// Profiles.
        profiles: usize,
    },
}
