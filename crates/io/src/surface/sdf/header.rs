//! What the header of an SDF file says, checked.

use super::error::{Position, SdfError};

/// Type of the stored numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DataType {
    Binary32,
    Int8,
    Int16,
    Int32,
    Binary64,
}

impl DataType {
    /// ISO-1.0 itself has the codes 5 to 7; 3 and 4, which ISO-2.0 adds, mean the same wherever they occur. 0 to 2 are
    /// the unsigned types of BCR-1.0, for which ISO-1.0 says nothing about points that were not measured.
    fn from_code(code: i64) -> Option<Self> {
        Some(match code {
            3 => Self::Binary32,
            4 => Self::Int8,
            5 => Self::Int16,
            6 => Self::Int32,
            7 => Self::Binary64,
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Int8 => 1,
            Self::Int16 => 2,
            Self::Binary32 | Self::Int32 => 4,
            Self::Binary64 => 8,
        }
    }

    /// Smallest and largest number of an integer type.
    pub(super) fn integers(self) -> Option<(i64, i64)> {
        match self {
            Self::Int8 => Some((i8::MIN.into(), i8::MAX.into())),
            Self::Int16 => Some((i16::MIN.into(), i16::MAX.into())),
            Self::Int32 => Some((i32::MIN.into(), i32::MAX.into())),
            Self::Binary32 | Self::Binary64 => None,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Binary32 => "a binary32 number",
            Self::Int8 => "an int8 number",
            Self::Int16 => "an int16 number",
            Self::Int32 => "an int32 number",
            Self::Binary64 => "a binary64 number",
        }
    }
}

/// The numbers of a header as they stand in the file, with where they stand.
pub(super) struct RawHeader {
    pub(super) points: (i64, Position),
    pub(super) profiles: (i64, Position),
    pub(super) x_scale: (f64, Position),
    pub(super) y_scale: (f64, Position),
    pub(super) z_scale: (f64, Position),
    pub(super) compression: (i64, Position),
    pub(super) data_type: (i64, Position),
    pub(super) check_type: (i64, Position),
}

/// A header that can be.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) points: usize,
    pub(super) profiles: usize,
    pub(super) x_scale: f64,
    pub(super) y_scale: f64,
    pub(super) z_scale: f64,
    pub(super) data_type: DataType,
}

impl RawHeader {
    pub(super) fn check(&self) -> Result<Header, SdfError> {
        let data_type = DataType::from_code(self.data_type.0).ok_or_else(|| SdfError::Field {
            at: self.data_type.1,
            field: "DataType",
            found: self.data_type.0.to_string(),
            expected: "3 (binary32), 4 (int8), 5 (int16), 6 (int32) or 7 (binary64)",
        })?;
        zero("Compression", self.compression, "0: compressed data are not read")?;
        zero("CheckType", self.check_type, "0: data with check sums are not read")?;
        Ok(Header {
            points: count("NumPoints", self.points)?,
            profiles: count("NumProfiles", self.profiles)?,
            x_scale: scale("Xscale", self.x_scale)?,
            y_scale: scale("Yscale", self.y_scale)?,
            z_scale: scale("Zscale", self.z_scale)?,
            data_type,
        })
    }
}

impl Header {
    /// Heights that the header promises.
    pub(super) fn heights(&self) -> u128 {
        self.points as u128 * self.profiles as u128
    }
}

fn count(field: &'static str, (found, at): (i64, Position)) -> Result<usize, SdfError> {
    match usize::try_from(found) {
        Ok(count) if count > 0 => Ok(count),
        _ => Err(SdfError::Field { at, field, found: found.to_string(), expected: "at least 1" }),
    }
}

fn scale(field: &'static str, (found, at): (f64, Position)) -> Result<f64, SdfError> {
    if found > 0.0 && found.is_finite() {
        Ok(found)
    } else {
        Err(SdfError::Field { at, field, found: found.to_string(), expected: "a positive, finite number" })
    }
}

fn zero(field: &'static str, (found, at): (i64, Position), expected: &'static str) -> Result<(), SdfError> {
    if found == 0 { Ok(()) } else { Err(SdfError::Field { at, field, found: found.to_string(), expected }) }
}
