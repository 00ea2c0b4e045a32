//! Reads a surface file of whatever format, and refuses what is said of it that its format has no use for.

use std::io::{BufReader, Read as _};
use std::path::Path;

use plateau_core::surface::Patch;

use super::detect::detect;
use super::error::FileError;
use super::format::Format;
use super::image::{self, ImageError};
use super::measured::Measured;
use super::options::{ProfileError, ReadOptions, agreed_pitch};
use super::{hdf5, npy, sdf, text};
use crate::{input, limits};

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
    let format = match detect(path)? {
        // Of which lines are skipped, also none, is a table, whatever its first lines tell.
        Format::Instrument(instrument) if instrument.is_text && options.skip.is_some() => Format::Text,
        found => found,
    };
    // What is not read is to be converted, whatever is said of it.
    if !matches!(format, Format::Instrument(_)) {
        refuse_meaningless(options, format)?;
    }
    match format {
        Format::Hdf5 => {
            let hdf5::Heights { columns, rows, pitch, heights, body, is_converted, notes, warnings } =
                hdf5::heights(path, options.dataset.as_deref(), options.at)?;
            let pitch = agreed_pitch(pitch, options.pitch)?;
            let plain = Measured::new(format, [columns, rows], pitch, heights);
            Ok(Measured { notes, warnings, body, instrument: is_converted, ..plain })
        }
        Format::Sdf(_) => {
            let file = input::open(path)?;
            let length = file.metadata()?.len();
            let sdf::Surface { patch, warnings } = sdf::read(BufReader::new(file), length)?;
            let Patch { columns, rows, column_pitch, row_pitch, heights } = patch;
            let pitch = Some([column_pitch, row_pitch]);
            Ok(Measured { warnings, ..Measured::new(format, [columns, rows], pitch, heights) })
        }
        Format::Npy => {
            let mut file = input::open_small(path, limits::SURFACE)?;
            let mut content = Vec::new();
            file.by_ref().take(npy::HEAD as u64).read_to_end(&mut content)?;
            npy::check_length(&content, file.metadata()?.len())?;
            file.take(limits::SURFACE).read_to_end(&mut content)?;
            Ok(array(format, npy::read(&content, options.unit.unwrap_or(1.0))?, options))
        }
        Format::Npz => {
            let (dataset, unit) = (options.dataset.as_deref(), options.unit.unwrap_or(1.0));
            let (name, read) = npy::read_archive(&input::read(path, limits::SURFACE)?, dataset, unit)?;
            let mut measured = array(format, read, options);
            measured.notes.insert(0, format!("array {name}"));
            Ok(measured)
        }
        Format::Png | Format::Tiff => {
            let image::HeightMap { columns, rows, heights, notes, warnings } = image::heights(
                &input::read(path, limits::SURFACE)?,
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
                text::read(&input::read(path, limits::SURFACE_TEXT)?, xyz, options)?;
            let plain = Measured::new(format, [columns, rows], pitch, heights);
            Ok(Measured { is_pitch_assumed, notes, warnings, ..plain })
        }
        Format::Instrument(instrument) => Err(FileError::Instrument(instrument)),
    }
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
