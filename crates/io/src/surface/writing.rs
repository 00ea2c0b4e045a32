//! Writing surfaces: the format by the ending, the file whole or not at all.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use plateau_core::surface::Patch;
use thiserror::Error;

use super::sdf::{self, Dialect, Encoding, SdfKind};
use super::{hdf5, npy};
use crate::temporary::Temporary;
use crate::timestamp;

/// How a surface is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// An existing file is replaced.
    pub replace: bool,
    /// Dialect and encoding of SDF. Without it ISO-1.0, or ISO-2.0 where a side has more than 65535 points; binary, or
    /// ISO-1.0 ASCII where points are missing: every program knows the word for them, while some take their mark in
    /// binary64 for a height (SurfaceTopography 1.27.1 does).
    pub sdf: Option<SdfKind>,
}

/// Why a surface cannot be written.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum WriteError {
    #[error("{}: {found}, expected the ending {ENDINGS}", path.display())]
    UnknownEnding { path: PathBuf, found: String },
    #[error("{} exists; give --force to replace it, or write elsewhere", path.display())]
    Exists { path: PathBuf },
    #[error("{} is not a regular file and is not replaced", path.display())]
    NotAFile { path: PathBuf },
    #[error("{}: {reason}", path.display())]
    Unsuitable { path: PathBuf, reason: String },
    #[error("writing {} failed: {reason}", path.display())]
    System { path: PathBuf, reason: io::Error },
}

/// Endings that are written.
const ENDINGS: &str = ".sdf, .npy or .h5";

/// Writes heights so that reading the file gives the same heights, bit for bit, missing points as missing points.
///
/// The format is that of the ending, .sdf, .npy or .h5 in small or large letters. An .npy file has no place for the
/// pitch. The file appears at `path` when it is complete; whatever goes wrong, a file that was there before stays as it was.
///
/// # Errors
/// [`WriteError`] when the ending is another, the file exists and is not to be replaced, the pitch is no positive number,
/// a height is infinite, the format has no room for the heights, or the system refuses.
pub fn write(path: &Path, patch: &Patch, options: &WriteOptions) -> Result<(), WriteError> {
    check(patch).map_err(|reason| WriteError::Unsuitable { path: path.into(), reason })?;
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase();
    let now = SystemTime::now();
    match ending.as_str() {
        "sdf" => {
            let kind = options.sdf.unwrap_or_else(|| default_kind(patch));
            sdf::check(kind, patch)
                .map_err(|reason| WriteError::Unsuitable { path: path.into(), reason: reason.to_string() })?;
            let date = timestamp::day_month_year(now);
            place(path, options.replace, |temporary| {
                let mut out = BufWriter::new(File::create(temporary)?);
                sdf::write(&mut out, kind, patch, &date)?;
                out.flush()
            })
        }
        "npy" => place(path, options.replace, |temporary| npy::write(temporary, patch)),
        "h5" => place(path, options.replace, |temporary| hdf5::write(temporary, patch).map_err(io::Error::other)),
        other => {
            let found = if other.is_empty() { "no ending".to_owned() } else { format!("ending .{other}") };
            Err(WriteError::UnknownEnding { path: path.into(), found })
        }
    }
}

fn check(patch: &Patch) -> Result<(), String> {
    let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
    if columns == 0 || rows == 0 || columns.checked_mul(rows) != Some(heights.len()) {
        return Err(format!("{} heights are not {columns} x {rows} points", heights.len()));
    }
    for pitch in [column_pitch, row_pitch] {
        if !(pitch > 0.0 && pitch.is_finite()) {
            return Err(format!("the pitch is {pitch} m, expected a positive, finite number"));
        }
    }
    match heights.iter().position(|height| height.is_infinite()) {
        None => Ok(()),
        Some(index) => Err(format!("the height at (column {}, row {}) is infinite", index / rows, index % rows)),
    }
}

fn default_kind(patch: &Patch) -> SdfKind {
    if patch.missing() > 0 {
        return SdfKind { dialect: Dialect::Iso1, encoding: Encoding::Ascii };
    }
    let kind = |dialect| SdfKind { dialect, encoding: Encoding::Binary };
    let fits = patch.columns.max(patch.rows) as u64 <= sdf::most_points(kind(Dialect::Iso1));
    kind(if fits { Dialect::Iso1 } else { Dialect::Iso2 })
}

/// Lets `fill` write a temporary file beside `path`, which is there and empty, and gives it its name when that is done.
fn place(path: &Path, replace: bool, fill: impl FnOnce(&Path) -> io::Result<()>) -> Result<(), WriteError> {
    let exists = || WriteError::Exists { path: path.into() };
    let system = |reason| WriteError::System { path: path.into(), reason };
    if path.file_name().is_none() {
        return Err(WriteError::NotAFile { path: path.into() });
    }
    // A symbolic link stays one: the file that it points to is replaced.
    let target = match fs::symlink_metadata(path) {
        Ok(_) if !replace => return Err(exists()),
        Ok(_) => fs::canonicalize(path).map_err(system)?,
        Err(_) => path.to_owned(),
    };
    if fs::metadata(&target).is_ok_and(|there| !there.is_file()) {
        return Err(WriteError::NotAFile { path: path.into() });
    }
    let (temporary, _) = Temporary::create(&target).map_err(system)?;
    fill(temporary.path()).map_err(system)?;
    temporary.publish(replace).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists if !replace => exists(),
        _ => system(error),
    })
}
