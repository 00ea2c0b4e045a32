//! Writing SDF so that reading it gives the same heights, bit for bit.

use std::io::{self, Write};

use plateau_core::surface::Patch;
use thiserror::Error;

use super::header::{BCR_MISSING_64, Dialect, Encoding, SdfKind};
use crate::surface::profiles::for_each_profile;

/// Heights of an ASCII file in one line.
const PER_LINE: usize = 8;

/// Why heights cannot be an SDF file of some kind.
#[derive(Debug, Clone, PartialEq, Error)]
pub(in crate::surface) enum Unwritable {
    #[error("SDF {kind} holds up to {most} points along each side, there are {columns} by {rows}")]
    TooMany { kind: SdfKind, most: u64, columns: usize, rows: usize },
    #[error("SDF {kind} reads the height {height} m as a missing point")]
    Missing { kind: SdfKind, height: f64 },
}

/// The most points along a side of a file of this kind.
pub(in crate::surface) fn most_points(kind: SdfKind) -> u64 {
    match kind {
        SdfKind { encoding: Encoding::Ascii, .. } => u64::MAX,
        SdfKind { dialect: Dialect::Iso2, .. } => u32::MAX.into(),
        SdfKind { .. } => u16::MAX.into(),
    }
}

/// Whether the heights, of which none is infinite, fit in a file of this kind.
///
/// # Errors
/// [`Unwritable`] when there are too many or one of them is the mark of a missing point.
pub(in crate::surface) fn check(kind: SdfKind, patch: &Patch) -> Result<(), Unwritable> {
    let Patch { columns, rows, .. } = *patch;
    let most = most_points(kind);
    if columns.max(rows) as u64 > most {
        return Err(Unwritable::TooMany { kind, most, columns, rows });
    }
    let missing = |height: &f64| match kind {
        SdfKind { dialect: Dialect::Bcr1, .. } => *height >= BCR_MISSING_64,
        SdfKind { encoding: Encoding::Binary, .. } => *height == f64::MIN,
        SdfKind { encoding: Encoding::Ascii, .. } => false,
    };
    match patch.heights.iter().copied().find(missing) {
        Some(height) => Err(Unwritable::Missing { kind, height }),
        None => Ok(()),
    }
}

/// Writes heights that [`check`] has found to fit: type binary64, scale 1, so that none is rounded. `date` is
/// `DDMMYYYYhhmm`.
pub(in crate::surface) fn write(mut out: impl Write, kind: SdfKind, patch: &Patch, date: &str) -> io::Result<()> {
    match kind.encoding {
        Encoding::Ascii => ascii(&mut out, kind, patch, date),
        Encoding::Binary => binary(&mut out, kind, patch, date),
    }
}

fn binary(out: &mut impl Write, kind: SdfKind, patch: &Patch, date: &str) -> io::Result<()> {
    write!(out, "{}{:10}{date:12}{date:12}", kind.magic(), "Plateau")?;
    for count in [patch.columns, patch.rows] {
        let count = count as u64;
        let size = if kind.dialect == Dialect::Iso2 { 4 } else { 2 };
        out.write_all(&count.to_le_bytes()[..size])?;
    }
    // Zscale, and a negative Zresolution: not known.
    for real in [patch.column_pitch, patch.row_pitch, 1.0, -1.0] {
        out.write_all(&f64::to_le_bytes(real))?;
    }
    // Compression, DataType, CheckType.
    out.write_all(&[0, 7, 0])?;
    let missing = if kind.dialect == Dialect::Bcr1 { f64::MAX } else { f64::MIN };
    let mut bytes = Vec::new();
    for_each_profile(patch, kind.dialect == Dialect::Bcr1, |profile| {
        bytes.clear();
        let stored = profile.iter().map(|height| if height.is_nan() { missing } else { *height });
        bytes.extend(stored.flat_map(f64::to_le_bytes));
        out.write_all(&bytes)
    })
}

fn ascii(out: &mut impl Write, kind: SdfKind, patch: &Patch, date: &str) -> io::Result<()> {
    let Patch { columns, rows, column_pitch, row_pitch, .. } = patch;
    write!(
        out,
        "{}\r\nManufacID = Plateau\r\nCreateDate = {date}\r\nModDate = {date}\r\nNumPoints = {columns}\r\n\
         NumProfiles = {rows}\r\nXscale = {column_pitch:e}\r\nYscale = {row_pitch:e}\r\nZscale = 1\r\n\
         Zresolution = -1\r\nCompression = 0\r\nDataType = 7\r\nCheckType = 0\r\n*\r\n",
        kind.magic()
    )?;
    let bcr = kind.dialect == Dialect::Bcr1;
    for_each_profile(patch, bcr, |profile| {
        for line in profile.chunks(PER_LINE) {
            for (index, height) in line.iter().enumerate() {
                let blank = if index == 0 { "" } else { " " };
                // `e` gives as many digits as the number needs to be read back exactly.
                match height {
                    height if !height.is_nan() => write!(out, "{blank}{height:e}")?,
                    _ if bcr => write!(out, "{blank}{BCR_MISSING_64:e}")?,
                    _ => write!(out, "{blank}BAD")?,
                }
            }
            out.write_all(b"\r\n")?;
        }
        Ok(())
    })?;
    out.write_all(b"*\r\n*\r\n")
}
