//! Surface data files, SDF: ISO-1.0 and ISO-2.0 (ISO 25178-71) and their predecessor BCR-1.0, ASCII and binary.
//!
//! A file has three records: header, data, and a trailer of free text, which is not read. The data are `NumProfiles`
//! profiles, y growing with their number (falling in BCR-1.0), of `NumPoints` points, x growing; a height is the stored
//! number times `Zscale`, in m. A point that was not measured is `BAD` in ASCII and the smallest number of the data
//! type in binary; in BCR-1.0 it is the largest number of the data type in both.

mod header;
mod read;
mod write;

pub(super) use header::without_margin;
pub use header::{Dialect, Encoding, Position, SdfError, SdfKind, Surface};
pub(super) use write::{check, most_points, write};

use std::io::BufRead;

/// Reads an SDF file of `length` bytes, from its start. Memory beyond the heights is a few profiles.
///
/// # Errors
/// [`SdfError`] with line or byte when the content is truncated, promises more than it holds, or holds what is no
/// number, scale or count.
pub fn read(mut source: impl BufRead, length: u64) -> Result<Surface, SdfError> {
    match source.fill_buf()?.first() {
        Some(b'b' | b'B') => read::binary(source, length),
        _ => read::ascii(source, length),
    }
}
