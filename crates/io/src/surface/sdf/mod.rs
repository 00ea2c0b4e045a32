//! Surface data files, SDF ISO-1.0 (ISO 25178-71), ASCII and binary.
//!
//! A file has three records: header, data, and a trailer of free text, which is not read. The data are `NumProfiles`
//! profiles, y growing with their number, of `NumPoints` points, x growing; a height is the stored number times
//! `Zscale`, in m. A point that was not measured is `BAD` in ASCII and the smallest number of the data type in binary.

mod ascii;
mod binary;
mod error;
mod header;
mod kind;

pub use error::{Position, SdfError};
pub use kind::{Dialect, Encoding, SdfKind};

use plateau_core::surface::Patch;

use header::Header;

/// Reads the whole content of an SDF ISO-1.0 file.
///
/// # Errors
/// [`SdfError`] with line or byte when the content is truncated, promises more than it holds, or holds what is no
/// number, scale or count.
pub fn read(content: &[u8]) -> Result<Patch, SdfError> {
    if content.first() == Some(&b'b') { binary::read(content) } else { ascii::read(content) }
}

/// Heights in the order of the file, profile by profile, as a patch.
fn patch(header: &Header, profiles: &[f64]) -> Patch {
    let (columns, rows) = (header.points, header.profiles);
    let mut heights = vec![f64::NAN; profiles.len()];
    for (row, profile) in profiles.chunks_exact(columns).enumerate() {
        for (column, height) in profile.iter().enumerate() {
            heights[column * rows + row] = *height;
        }
    }
    Patch { columns, rows, column_pitch: header.x_scale, row_pitch: header.y_scale, heights }
}
