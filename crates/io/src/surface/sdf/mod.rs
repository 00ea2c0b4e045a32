//! Surface data files, SDF: ISO-1.0 and ISO-2.0 (ISO 25178-71) and their predecessor BCR-1.0, ASCII and binary.
//!
//! A file has three records: header, data, and a trailer of free text, which is not read. The data are `NumProfiles`
//! profiles, y growing with their number (falling in BCR-1.0), of `NumPoints` points, x growing; a height is the stored
//! number times `Zscale`, in m. A point that was not measured is `BAD` in ASCII and the smallest number of the data
//! type in binary; in BCR-1.0 it is the largest number of the data type in both.

mod header;
mod read;

pub(super) use header::without_margin;
pub use header::{Dialect, Encoding, Position, SdfError, SdfKind, Surface};

use std::io::{self, BufRead, Write};

use plateau_core::surface::Patch;

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

/// Heights of an ASCII file in one line.
const PER_LINE: usize = 8;

/// Writes heights as binary64 numbers with the scale 1, so that none is rounded: binary, ISO-1.0, or ISO-2.0 where a side has more
/// points than two bytes count; where points are missing ISO-1.0 ASCII, for every program knows the word for them, while some take
/// their mark in binary64 for a height (SurfaceTopography 1.27.1 does). `date` is `DDMMYYYYhhmm`.
pub(super) fn write(mut out: impl Write, patch: &Patch, date: &str) -> io::Result<()> {
    let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
    let profiles = (0..rows).map(|row| heights[row..].iter().step_by(rows));
    // The mark of a missing point is no height of a binary file.
    if heights.iter().any(|height| height.is_nan() || *height == f64::MIN) {
        write!(
            out,
            "aISO-1.0\r\nManufacID = Plateau\r\nCreateDate = {date}\r\nModDate = {date}\r\nNumPoints = {columns}\r\n\
             NumProfiles = {rows}\r\nXscale = {column_pitch:e}\r\nYscale = {row_pitch:e}\r\nZscale = 1\r\n\
             Zresolution = -1\r\nCompression = 0\r\nDataType = 7\r\nCheckType = 0\r\n*\r\n"
        )?;
        // `e` gives as many digits as the number needs to be read back exactly.
        let word = |height: &f64| if height.is_nan() { "BAD".to_owned() } else { format!("{height:e}") };
        for profile in profiles {
            for line in profile.map(word).collect::<Vec<_>>().chunks(PER_LINE) {
                write!(out, "{}\r\n", line.join(" "))?;
            }
        }
        return out.write_all(b"*\r\n*\r\n");
    }
    let (magic, size) = if columns.max(rows) > u16::MAX.into() { ("bISO-2.0", 4) } else { ("bISO-1.0", 2) };
    write!(out, "{magic}{:10}{date:12}{date:12}", "Plateau")?;
    for count in [columns, rows] {
        out.write_all(&(count as u64).to_le_bytes()[..size])?;
    }
    // Zscale, and a negative Zresolution: not known.
    for real in [column_pitch, row_pitch, 1.0, -1.0] {
        out.write_all(&real.to_le_bytes())?;
    }
    // Compression, DataType, CheckType.
    out.write_all(&[0, 7, 0])?;
    profiles.flatten().try_for_each(|height| out.write_all(&height.to_le_bytes()))
}
