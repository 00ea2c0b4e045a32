//! What a surface file holds, whatever its format.

use std::fs::File;
use std::io::BufReader;
use std::ops::RangeInclusive;
use std::path::Path;

use plateau_core::surface::{Length, Patch};

use super::error::FileError;
use super::format::{Format, detect};
use super::stated::agreed_pitch;
use super::{hdf5, image, npy, sdf, text, x3p};

/// Pitches that are read, m; measured ones are between 1e-11 and 1e-3.
const PITCHES: RangeInclusive<f64> = 1e-15..=1e3;
/// Largest height or depth that is read, m; instruments with a far zero give up to 0.1.
const HIGHEST: f64 = 1e3;

/// What a user says of a file that the file itself does not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// Dataset in an HDF5 file, or array in an .npz archive.
    pub dataset: Option<String>,
    /// What the number 1 stands for, m; for text that does not state its unit, for NumPy arrays in another unit than m
    /// and for images of decimal heights.
    pub unit: Option<f64>,
    /// Distance of neighbouring points along x and y, m; for files that do not state it.
    pub pitch: Option<[f64; 2]>,
    /// Heights of black and white of an image, m.
    pub height_range: Option<[f64; 2]>,
}

/// Heights as a file has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// What the file is.
    pub format: Format,
    /// Points along x, the sliding direction.
    pub columns: usize,
    /// Points along y, outward.
    pub rows: usize,
    /// Distance of neighbouring points along x and y, m; none if neither file nor user tell it.
    pub pitch: Option<[f64; 2]>,
    /// Heights, m, column by column: the point (column x, row y) is at `x * rows + y`; NaN where there is none.
    pub heights: Vec<f64>,
    /// Peaks are positive whatever the body, as an instrument gives them; else heights are those of the model.
    pub instrument: bool,
    /// What the file says of itself that a user may want to see, one fact a line.
    pub notes: Vec<String>,
    /// What is wrong with the file but does not change its heights, as a checksum that does not fit.
    pub warnings: Vec<String>,
}

impl Measured {
    /// The heights with their pitch, if that is known.
    pub fn into_patch(self) -> Option<Patch> {
        let Self { columns, rows, heights, .. } = self;
        let [column_pitch, row_pitch] = self.pitch?;
        Some(Patch { columns, rows, column_pitch, row_pitch, heights })
    }

    /// Refuses what is far from any surface: a damaged file, or numbers of another unit.
    fn check(&self) -> Result<(), FileError> {
        if let Some(pitch) = self.pitch.iter().flatten().find(|pitch| !PITCHES.contains(pitch)) {
            let expected = format!("{:e} to {:e} m", PITCHES.start(), PITCHES.end());
            return Err(FileError::Absurd { found: format!("a pitch of {pitch:e} m"), expected });
        }
        match self.heights.iter().find(|height| height.abs() > HIGHEST) {
            None => Ok(()),
            Some(height) => Err(FileError::Absurd {
                found: format!("a height of {height:e} m"),
                expected: format!("{:e} to {HIGHEST:e} m", -HIGHEST),
            }),
        }
    }

    /// Size and pitch in words.
    pub fn describe(&self) -> String {
        let pitch = match self.pitch {
            None => "pitch unknown".to_owned(),
            Some([x, y]) if x == y => format!("{} pitch", Length(x)),
            Some([x, y]) => format!("{} by {} pitch", Length(x), Length(y)),
        };
        format!("{} x {} points, {pitch}", self.columns, self.rows)
    }
}

/// Reads a surface file; what it is, is told by its content.
///
/// # Errors
/// [`FileError`] when the file cannot be read exactly, or holds what no surface has.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Measured, FileError> {
    let measured = read_format(path, options)?;
    measured.check()?;
    Ok(measured)
}

fn read_format(path: &Path, options: &ReadOptions) -> Result<Measured, FileError> {
    let format = detect(path)?;
    options.refuse_meaningless(format)?;
    match format {
        Format::Hdf5 => {
            let hdf5::Heights { dataset, columns, rows, pitch, heights } =
                hdf5::heights(path, options.dataset.as_deref())?;
            let notes = vec![format!("dataset {dataset}")];
            let pitch = agreed_pitch(pitch, options.pitch)?;
            Ok(Measured { format, columns, rows, pitch, heights, instrument: false, notes, warnings: Vec::new() })
        }
        Format::Sdf(_) => {
            let file = File::open(path)?;
            let length = file.metadata()?.len();
            let sdf::Surface { patch, warnings } = sdf::read(BufReader::new(file), length)?;
            Ok(from_instrument(format, patch, Vec::new(), warnings))
        }
        Format::X3p => {
            let x3p::Surface { patch, notes, warnings } = x3p::read(BufReader::new(File::open(path)?))?;
            Ok(from_instrument(format, patch, notes, warnings))
        }
        Format::Npy => Ok(array(format, npy::read(&std::fs::read(path)?, options.unit.unwrap_or(1.0))?, options)),
        Format::Npz => {
            let (dataset, unit) = (options.dataset.as_deref(), options.unit.unwrap_or(1.0));
            let (name, read) = npy::read_archive(&std::fs::read(path)?, dataset, unit)?;
            let mut measured = array(format, read, options);
            measured.notes.insert(0, format!("array {name}"));
            Ok(measured)
        }
        Format::Png | Format::Tiff => {
            let image::HeightMap { columns, rows, heights, notes, warnings } =
                image::heights(&std::fs::read(path)?, format, options)?;
            let pitch = options.pitch;
            Ok(Measured { format, columns, rows, pitch, heights, instrument: true, notes, warnings })
        }
        Format::Text => {
            let xyz = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xyz"));
            let text::Table { columns, rows, pitch, heights, notes, warnings } =
                text::read(&std::fs::read(path)?, xyz, options)?;
            Ok(Measured { format, columns, rows, pitch, heights, instrument: true, notes, warnings })
        }
        Format::Instrument(instrument) => Err(FileError::Instrument(instrument)),
    }
}

/// Heights of a file that states its pitch, with peaks positive.
fn from_instrument(format: Format, patch: Patch, notes: Vec<String>, warnings: Vec<String>) -> Measured {
    let Patch { columns, rows, column_pitch, row_pitch, heights } = patch;
    let pitch = Some([column_pitch, row_pitch]);
    Measured { format, columns, rows, pitch, heights, instrument: true, notes, warnings }
}

/// A NumPy array: heights of the model, as those of an HDF5 file.
fn array(format: Format, array: npy::Array, options: &ReadOptions) -> Measured {
    let npy::Array { columns, rows, heights, descr, integers } = array;
    let mut warnings = Vec::new();
    if integers && options.unit.is_none() {
        warnings.push("integers taken as heights in m: unit = \"nm\" says what 1 stands for".to_owned());
    }
    let (pitch, notes) = (options.pitch, vec![format!("type {descr}")]);
    Measured { format, columns, rows, pitch, heights, instrument: false, notes, warnings }
}

impl ReadOptions {
    /// Refuses what would silently not be used.
    fn refuse_meaningless(&self, format: Format) -> Result<(), FileError> {
        use Format::{Hdf5, Npy, Npz, Png, Text, Tiff};
        if let (Some(dataset), false) = (&self.dataset, matches!(format, Hdf5 | Npz)) {
            return Err(FileError::NoDatasets { format, dataset: dataset.clone() });
        }
        for (key, given, meaningful) in [
            ("unit", self.unit.is_some(), matches!(format, Text | Npy | Npz | Png | Tiff)),
            ("pitch", self.pitch.is_some(), matches!(format, Text | Npy | Npz | Png | Tiff | Hdf5)),
            ("height_range", self.height_range.is_some(), matches!(format, Png | Tiff)),
        ] {
            if given && !meaningful {
                return Err(FileError::Meaningless { format, key });
            }
        }
        Ok(())
    }
}
