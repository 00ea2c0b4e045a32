//! What the header of an SDF file says, checked.

use plateau_core::surface::Patch;

use super::error::{Position, SdfError};
use super::kind::Dialect;
use super::number::DataType;
use crate::surface::profiles::Profiles;

/// What an SDF file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The heights.
    pub patch: Patch,
    /// What is odd about the file though its heights could be read.
    pub warnings: Vec<String>,
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
    pub(super) dialect: Dialect,
    pub(super) points: usize,
    pub(super) profiles: usize,
    pub(super) x_scale: f64,
    pub(super) y_scale: f64,
    pub(super) z_scale: f64,
    pub(super) data_type: DataType,
}

impl RawHeader {
    pub(super) fn check(&self, dialect: Dialect) -> Result<Header, SdfError> {
        let data_type = DataType::from_code(self.data_type.0, dialect).ok_or_else(|| SdfError::Field {
            at: self.data_type.1,
            field: "DataType",
            found: self.data_type.0.to_string(),
            expected: DataType::codes(dialect),
        })?;
        zero("Compression", self.compression, "0: compressed data are not read")?;
        zero("CheckType", self.check_type, "0: data with check sums are not read")?;
        Ok(Header {
            dialect,
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
    /// Room for the heights in the order of the file. In BCR-1.0 the first profile has the largest y (so MountainsMap
    /// shows such files, and so sdfio reads them; the document itself does not say), in ISO 25178-71 y is 0 there.
    pub(super) fn room(&self) -> Profiles {
        match self.dialect {
            Dialect::Bcr1 => Profiles::downward(self.points, self.profiles),
            Dialect::Iso1 | Dialect::Iso2 => Profiles::new(self.points, self.profiles),
        }
    }

    pub(super) fn patch(&self, heights: Profiles) -> Patch {
        Patch {
            columns: self.points,
            rows: self.profiles,
            column_pitch: self.x_scale,
            row_pitch: self.y_scale,
            heights: heights.finish(),
        }
    }

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
