//! Writing surfaces: the format by the ending, the file whole or not at all.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use plateau_core::surface::Patch;
use thiserror::Error;

use super::{hdf5, npy, sdf};
use crate::temporary::Temporary;
use crate::timestamp;

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
/// pitch. An existing file is replaced only with `replace`. The file appears at `path` when it is complete; whatever goes wrong, a file that was there before stays as it was.
///
/// # Errors
/// [`WriteError`] when the ending is another, the file exists and is not to be replaced, the pitch is no positive number,
/// a height is infinite, the format has no room for the heights, or the system refuses.
pub fn write(path: &Path, patch: &Patch, replace: bool) -> Result<(), WriteError> {
    check(patch).map_err(|reason| WriteError::Unsuitable { path: path.into(), reason })?;
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase();
    match ending.as_str() {
        "sdf" => place(path, replace, |temporary| {
            let mut out = BufWriter::new(File::create(temporary)?);
            sdf::write(&mut out, patch, &timestamp::day_month_year(SystemTime::now()))?;
            out.flush()
        }),
        "npy" => place(path, replace, |temporary| npy::write(temporary, patch)),
        "h5" => place(path, replace, |temporary| hdf5::write(temporary, patch).map_err(io::Error::other)),
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
