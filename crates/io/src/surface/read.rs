//! Reads a surface file of whatever format, and refuses what is said of it that its format has no use for.

use std::io::{BufReader, Read as _};
use std::path::Path;

use plateau_core::surface::Patch;

use super::detect::detect;
use super::error::FileError;
use super::format::Format;
use super::image::ImageError;
use super::measured::Measured;
use super::options::{ReadOptions, agreed_pitch};
use super::stylus_profile::ProfileError;
use super::{hdf5, image, npy, sdf, text, x3p};
use crate::{limits, regular};

/// Reads a surface file; what it is, is told by its content.
///
/// # Errors
/// [`FileError`] when the file cannot be read exactly, or holds what no surface has.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Measured, FileError> {
    if options.profile_lay.is_some() && options.pitch.is_some_and(|[x, y]| x != y) {
        return Err(ProfileError::TwoPitches.into());
    }
    let mut measured = read_format(path, options)?;
    if let Some(lay) = options.profile_lay {
        measured.take_as_profile(lay)?;
    }
    measured.check()?;
    Ok(measured)
}

fn read_format(path: &Path, options: &ReadOptions) -> Result<Measured, FileError> {
    let format = detect(path)?;
    // What is not read is to be converted, whatever is said of it.
    if !matches!(format, Format::Instrument(_)) {
        refuse_meaningless(options, format)?;
    }
    match format {
        Format::Hdf5 => {
            let hdf5::Heights { columns, rows, pitch, heights, body, notes, warnings } =
                hdf5::heights(path, options.dataset.as_deref(), options.at)?;
            let pitch = agreed_pitch(pitch, options.pitch)?;
            let plain = Measured::new(format, [columns, rows], pitch, heights);
            Ok(Measured { notes, warnings, body, instrument: false, ..plain })
        }
        Format::Sdf(_) => {
            let file = regular::open(path)?;
            let length = file.metadata()?.len();
            let sdf::Surface { patch, warnings } = sdf::read(BufReader::new(file), length)?;
            Ok(from_instrument(format, patch, Vec::new(), warnings))
        }
        Format::X3p => {
            let x3p::Surface { patch, notes, warnings } = x3p::read(BufReader::new(regular::open(path)?))?;
            Ok(from_instrument(format, patch, notes, warnings))
        }
        Format::Npy => {
            let mut file = regular::open_small(path, limits::SURFACE)?;
            let mut content = Vec::new();
            file.by_ref().take(npy::HEAD as u64).read_to_end(&mut content)?;
            npy::check_length(&content, file.metadata()?.len())?;
            file.take(limits::SURFACE).read_to_end(&mut content)?;
            Ok(array(format, npy::read(&content, options.unit.unwrap_or(1.0))?, options))
        }
        Format::Npz => {
            let (dataset, unit) = (options.dataset.as_deref(), options.unit.unwrap_or(1.0));
            let (name, read) = npy::read_archive(&regular::read(path, limits::SURFACE)?, dataset, unit)?;
            let mut measured = array(format, read, options);
            measured.notes.insert(0, format!("array {name}"));
            Ok(measured)
        }
        Format::Png | Format::Tiff => {
            let image::HeightMap { columns, rows, heights, notes, warnings } = image::heights(
                &regular::read(path, limits::SURFACE)?,
                format,
                options,
            )
            .map_err(|reason| match reason {
                ImageError::Tiff(_) | ImageError::Pixels { .. } if format == Format::Tiff => FileError::Tiff { reason },
                other => other.into(),
            })?;
            let pitch = options.pitch;
            Ok(Measured { notes, warnings, ..Measured::new(format, [columns, rows], pitch, heights) })
        }
        Format::Text => {
            let xyz = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xyz"));
            let text::Table { columns, rows, pitch, is_pitch_assumed, heights, notes, warnings } =
                text::read(&regular::read(path, limits::SURFACE_TEXT)?, xyz, options)?;
            let plain = Measured::new(format, [columns, rows], pitch, heights);
            Ok(Measured { is_pitch_assumed, notes, warnings, ..plain })
        }
        Format::Instrument(instrument) => Err(FileError::Instrument(instrument)),
    }
}

/// Heights of a file that states its pitch, with peaks positive.
fn from_instrument(format: Format, patch: Patch, notes: Vec<String>, warnings: Vec<String>) -> Measured {
    let Patch { columns, rows, column_pitch, row_pitch, heights } = patch;
    let pitch = Some([column_pitch, row_pitch]);
    Measured { notes, warnings, ..Measured::new(format, [columns, rows], pitch, heights) }
}

/// A NumPy array: heights of the model, as those of an HDF5 file.
fn array(format: Format, array: npy::Array, options: &ReadOptions) -> Measured {
    let npy::Array { columns, rows, heights, descr, integers } = array;
    let mut warnings = Vec::new();
    if integers && options.unit.is_none() {
        warnings.push("integers taken as heights in m: unit = \"nm\" says what 1 stands for".to_owned());
    }
    let notes = vec![format!("type {descr}")];
    Measured { notes, warnings, instrument: false, ..Measured::new(format, [columns, rows], options.pitch, heights) }
}

/// Refuses what would silently not be used.
fn refuse_meaningless(options: &ReadOptions, format: Format) -> Result<(), FileError> {
    use Format::{Hdf5, Npy, Npz, Png, Text, Tiff};
    if let (Some(dataset), false) = (&options.dataset, matches!(format, Hdf5 | Npz | Text)) {
        return Err(FileError::NoDatasets { format, dataset: dataset.clone() });
    }
    for (key, given, meaningful) in [
        ("at", options.at.is_some(), format == Hdf5),
        ("unit", options.unit.is_some(), matches!(format, Text | Npy | Npz | Png | Tiff)),
        ("pitch", options.pitch.is_some(), matches!(format, Text | Npy | Npz | Png | Tiff | Hdf5)),
        ("height_range", options.height_range.is_some(), matches!(format, Png | Tiff)),
        ("decimal", options.decimal.is_some(), format == Text),
        ("skip", options.skip.is_some(), format == Text),
    ] {
        if given && !meaningful {
            return Err(FileError::Meaningless { format, key });
        }
    }
    Ok(())
}
