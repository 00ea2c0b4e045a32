//! Parts of an SDF file: dialects, types of numbers, the checked header, errors.

use std::{fmt, io};

use plateau_core::surface::Patch;
use thiserror::Error;

use crate::surface::stored::{Kind, Number};

/// Position in a file.
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

/// Reason why an SDF file cannot be read.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum SdfError {
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
    #[error(
        "this is not an SDF file: starts with \"{found}\", expected \"aISO-1.0\", \"aISO-2.0\", \"aBCR-1.0\" or the same \
         with \"b\""
    )]
    Magic { found: String },
    #[error("the file is truncated: ends at byte {found}, expected {needed} bytes for {what}")]
    Truncated { found: u64, needed: u128, what: String },
    #[error("the file is truncated: the {record} ends at {at} without the line \"*\" that closes it")]
    Unclosed { record: &'static str, at: Position },
    #[error("{at}: found \"{found}\", expected a header field \"Name = Value\", one of up to 100, or the line \"*\"")]
    NotAField { at: Position, found: String },
    #[error("{at}: the header ends without the field {field}")]
    MissingField { at: Position, field: &'static str },
    #[error("{at}: the field {field} stands twice")]
    Twice { at: Position, field: String },
    #[error("{at}: {field} is {found}, expected {expected}")]
    Field { at: Position, field: &'static str, found: String, expected: &'static str },
    #[error("{at}: found the height \"{found}\", expected {expected}")]
    Height { at: Position, found: String, expected: &'static str },
    #[error("{at}: the data end after {found} heights, expected NumPoints x NumProfiles = {points} x {profiles}")]
    Count { at: Position, found: usize, points: usize, profiles: usize },
    #[error("{at}: more heights than NumPoints x NumProfiles = {points} x {profiles}")]
    TooMany { at: Position, points: usize, profiles: usize },
}

impl SdfError {
    /// Error of a field with another value than is expected.
    pub(super) fn field(field: &'static str, found: impl ToString, at: Position, expected: &'static str) -> Self {
        Self::Field { at, field, found: found.to_string(), expected }
    }
}

/// Document that defines a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dialect {
    /// BCR-1.0 (the report of the Community Bureau of Reference), with unsigned integers too.
    Bcr1,
    /// Version 1.0 of ISO 25178-71.
    Iso1,
    /// Version 2.0 of ISO 25178-71:2026: more points a profile, more types of numbers.
    Iso2,
}

/// Encoding of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Numbers as text.
    Ascii,
    /// Numbers as they are in memory, little endian.
    Binary,
}

/// A dialect of SDF and how it stores numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SdfKind {
    /// The dialect.
    pub dialect: Dialect,
    /// Encoding of its numbers.
    pub encoding: Encoding,
}

impl SdfKind {
    /// The kind of a file that starts like this: "aISO-1.0", "bBCR-1.0" and so on, of which the first letter may be large.
    pub(in crate::surface) fn from_magic(head: &[u8]) -> Option<Self> {
        let (first, rest) = head.split_first()?;
        let encoding = match first {
            b'a' | b'A' => Encoding::Ascii,
            b'b' | b'B' => Encoding::Binary,
            _ => return None,
        };
        let dialects = [Dialect::Bcr1, Dialect::Iso1, Dialect::Iso2];
        let dialect = dialects.into_iter().find(|dialect| rest.starts_with(dialect.to_string().as_bytes()))?;
        Some(Self { dialect, encoding })
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bcr1 => "BCR-1.0",
            Self::Iso1 => "ISO-1.0",
            Self::Iso2 => "ISO-2.0",
        })
    }
}

impl fmt::Display for SdfKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let encoding = match self.encoding {
            Encoding::Ascii => "ASCII",
            Encoding::Binary => "binary",
        };
        write!(f, "{} {encoding}", self.dialect)
    }
}

/// Text without a byte order mark and leading blanks.
pub(in crate::surface) fn without_margin(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii_start()
}

/// Type of the stored numbers, by its code.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DataType {
    pub(super) number: Number,
    /// Name with its article.
    pub(super) name: &'static str,
}

const fn data_type(kind: Kind, size: usize, name: &'static str) -> DataType {
    DataType { number: Number { kind, size, is_big_endian: false }, name }
}

const DATA_TYPES: [DataType; 8] = [
    data_type(Kind::Unsigned, 1, "a uint8 number"),
    data_type(Kind::Unsigned, 2, "a uint16 number"),
    data_type(Kind::Unsigned, 4, "a uint32 number"),
    data_type(Kind::Float, 4, "a binary32 number"),
    data_type(Kind::Signed, 1, "an int8 number"),
    data_type(Kind::Signed, 2, "an int16 number"),
    data_type(Kind::Signed, 4, "an int32 number"),
    data_type(Kind::Float, 8, "a binary64 number"),
];

/// Least binary32 and binary64 number of BCR-1.0 that marks a point that was not measured.
const BCR_MISSING_32: f32 = 3.4e38;
const BCR_MISSING_64: f64 = 1.7e308;

impl DataType {
    /// The type with this code. Only BCR-1.0 has unsigned integers: ISO 25178-71 marks missing points by the smallest
    /// number of a type, which for them is a height. ISO-1.0 itself has the codes 5 to 7; 3 and 4, which ISO-2.0
    /// adds, mean the same wherever they occur.
    pub(super) fn from_code(code: i64, dialect: Dialect) -> Option<Self> {
        let known = DATA_TYPES.get(usize::try_from(code).ok()?).copied();
        known.filter(|known| known.number.kind != Kind::Unsigned || dialect == Dialect::Bcr1)
    }

    /// The codes of a dialect, in words.
    pub(super) fn codes(dialect: Dialect) -> &'static str {
        match dialect {
            Dialect::Bcr1 => {
                "0 (uint8), 1 (uint16), 2 (uint32), 3 (binary32), 4 (int8), 5 (int16), 6 (int32) or 7 (binary64)"
            }
            Dialect::Iso1 | Dialect::Iso2 => "3 (binary32), 4 (int8), 5 (int16), 6 (int32) or 7 (binary64)",
        }
    }

    /// Tells whether a number says that none was measured: ISO 25178-71 marks that by the smallest number of the type, BCR-1.0 by the
    /// largest.
    pub(super) fn marks(self, dialect: Dialect) -> impl Fn(f64) -> bool {
        let of_floats = match self.number.size {
            4 => [f32::MIN, BCR_MISSING_32].map(f64::from),
            _ => [f64::MIN, BCR_MISSING_64],
        };
        let [smallest, largest] = self.number.integers().unwrap_or(of_floats);
        move |number| if dialect == Dialect::Bcr1 { number >= largest } else { number == smallest }
    }

    /// The number that a text states, NaN if it says that none was measured; nothing if it is no number of this type.
    pub(super) fn parse(self, text: &[u8], dialect: Dialect) -> Option<f64> {
        // NaN is not of the standard, but some programs write it.
        if text.eq_ignore_ascii_case(b"BAD") || text.eq_ignore_ascii_case(b"NaN") {
            return Some(f64::NAN);
        }
        let text = std::str::from_utf8(text).ok()?;
        let number: f64 = match self.number.integers() {
            Some([smallest, largest]) => {
                let integer = text.parse::<i64>().ok()? as f64;
                Some(integer).filter(|integer| (smallest..=largest).contains(integer))?
            }
            None => text.parse().ok()?,
        };
        // In the text of ISO 25178-71 a word says it.
        Some(if dialect == Dialect::Bcr1 && self.marks(dialect)(number) { f64::NAN } else { number })
    }
}

/// Content of an SDF file.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The heights.
    pub patch: Patch,
    /// Oddities of the file, whose heights could be read nevertheless.
    pub warnings: Vec<String>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) dialect: Dialect,
    pub(super) points: usize,
    pub(super) profiles: usize,
    pub(super) x_scale: f64,
    pub(super) y_scale: f64,
    pub(super) z_scale: f64,
    pub(super) data_type: DataType,
}

impl Header {
    /// Checks the numbers of a header as they stand in the file, each with where it stands.
    pub(super) fn checked(
        dialect: Dialect,
        [points, profiles]: [(i64, Position); 2],
        [x_scale, y_scale, z_scale]: [(f64, Position); 3],
        [compression, data_type, check_type]: [(i64, Position); 3],
    ) -> Result<Self, SdfError> {
        let (code, at) = data_type;
        let data_type = DataType::from_code(code, dialect);
        let codes = DataType::codes(dialect);
        let Some(data_type) = data_type else { return Err(SdfError::field("DataType", code, at, codes)) };
        let zero = |field, (found, at): (i64, _), expected| match found {
            0 => Ok(()),
            _ => Err(SdfError::field(field, found, at, expected)),
        };
        zero("Compression", compression, "0: compressed data are not read")?;
        zero("CheckType", check_type, "0: data with check sums are not read")?;
        let count = |field, (found, at): (i64, _)| match usize::try_from(found) {
            Ok(count) if count > 0 => Ok(count),
            _ => Err(SdfError::field(field, found, at, "at least 1")),
        };
        let scale = |field, (found, at): (f64, _)| {
            let is_scale = found > 0.0 && found.is_finite();
            is_scale.then_some(found).ok_or_else(|| SdfError::field(field, found, at, "a positive, finite number"))
        };
        Ok(Self {
            dialect,
            points: count("NumPoints", points)?,
            profiles: count("NumProfiles", profiles)?,
            x_scale: scale("Xscale", x_scale)?,
            y_scale: scale("Yscale", y_scale)?,
            z_scale: scale("Zscale", z_scale)?,
            data_type,
        })
    }

    /// Room for the heights in the order of the file. In BCR-1.0 the first profile has the largest y (so MountainsMap
    /// shows such files, and so sdfio reads them; the document itself does not say), in ISO 25178-71 y is 0 there.
    pub(super) fn room(&self) -> Profiles {
        let Self { points: columns, profiles: rows, x_scale: column_pitch, y_scale: row_pitch, .. } = *self;
        let patch = Patch { columns, rows, column_pitch, row_pitch, heights: vec![f64::NAN; columns * rows] };
        Profiles { patch, downward: self.dialect == Dialect::Bcr1, done: 0 }
    }

    /// Number of heights that the header promises.
    pub(super) fn heights(&self) -> u128 {
        self.points as u128 * self.profiles as u128
    }
}

/// Takes heights in the order of a file, x growing fastest, and stores them column by column.
pub(super) struct Profiles {
    /// The patch that they make, with NaN where a height is still to come.
    pub(super) patch: Patch,
    /// True if the first profile has the largest y.
    downward: bool,
    done: usize,
}

impl Profiles {
    pub(super) fn len(&self) -> usize {
        self.done
    }

    pub(super) fn missing(&self) -> usize {
        self.patch.heights.len() - self.done
    }

    /// Takes the next height, for which there must be room.
    pub(super) fn push(&mut self, height: f64) {
        let Patch { columns, rows, ref mut heights, .. } = self.patch;
        let (profile, column) = (self.done / columns, self.done % columns);
        let row = if self.downward { rows - 1 - profile } else { profile };
        heights[column * rows + row] = height;
        self.done += 1;
    }
}
