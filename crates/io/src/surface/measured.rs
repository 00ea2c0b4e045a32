//! What a surface file is, told by how it starts, and what it holds.

use std::fs::File;
use std::io::{BufReader, Read};
use std::ops::RangeInclusive;
use std::path::Path;

use plateau_core::surface::{Length, Patch};
use zip::ZipArchive;

use super::error::FileError;
use super::format::Format;
use super::instrument::{PLUX, recognise};
use super::options::{ReadOptions, agreed_pitch};
use super::sdf::{SdfKind, without_margin};
use super::stylus_profile::{Lay, ProfileError, StylusProfile};
use super::text::is_utf16;
use super::{hdf5, image, npy, sdf, text, x3p};
use crate::{limits, regular};

/// Pitches that are read, m; measured ones are between 1e-11 and 1e-3.
const PITCHES: RangeInclusive<f64> = 1e-15..=1e3;
/// Largest height or depth that is read, m; instruments with a far zero give up to 0.1.
const HIGHEST: f64 = 1e3;

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
    /// The file does not say in which unit its distances are, and they were taken in that of its heights.
    pub is_pitch_assumed: bool,
    /// Heights, m, column by column: the point (column x, row y) is at `x * rows + y`; NaN where there is none.
    pub heights: Vec<f64>,
    /// Peaks are positive whatever the body, as an instrument gives them; else heights are those of the model.
    pub instrument: bool,
    /// The heights are a profile, in one row, and its lay has this direction.
    pub profile_lay: Option<Lay>,
    /// What the file says of itself that a user may want to see, one fact a line.
    pub notes: Vec<String>,
    /// What is wrong with the file but does not change its heights, as a checksum that does not fit.
    pub warnings: Vec<String>,
}

impl Measured {
    /// Heights of an instrument of which nothing else is to be said: column by column, m, on so many columns and rows.
    pub fn new(format: Format, [columns, rows]: [usize; 2], pitch: Option<[f64; 2]>, heights: Vec<f64>) -> Self {
        Self {
            format,
            columns,
            rows,
            pitch,
            is_pitch_assumed: false,
            heights,
            instrument: true,
            profile_lay: None,
            notes: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The heights with their pitch, if that is known.
    pub fn into_patch(self) -> Option<Patch> {
        let Self { columns, rows, heights, .. } = self;
        let [column_pitch, row_pitch] = self.pitch?;
        Some(Patch { columns, rows, column_pitch, row_pitch, heights })
    }

    /// The heights as a profile; none if they are not taken as one. `pixel` reinterprets the distance of its points, m.
    ///
    /// # Errors
    /// [`ProfileError`] if the distance of its points is unknown.
    pub fn stylus_profile(&self, pixel: Option<f64>) -> Result<Option<StylusProfile>, ProfileError> {
        let Some(lay) = self.profile_lay else { return Ok(None) };
        let pitch = pixel.or(self.pitch.map(|pitch| pitch[0])).ok_or(ProfileError::NoPitch)?;
        Ok(Some(StylusProfile { pitch, heights: self.heights.clone(), lay }))
    }

    /// Takes the heights as a profile: in one row, with one pitch.
    fn take_as_profile(&mut self, lay: Lay) -> Result<(), ProfileError> {
        let size = (self.columns, self.rows);
        let along = match size {
            (2.., 1) => 0,
            (1, 2..) => 1,
            _ => return Err(ProfileError::NotALine { size }),
        };
        self.pitch = self.pitch.map(|pitch| [pitch[along]; 2]);
        (self.columns, self.rows) = (self.heights.len(), 1);
        self.profile_lay = Some(lay);
        Ok(())
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
        if self.profile_lay.is_some() {
            return format!("profile of {} points, {pitch}", self.columns);
        }
        format!("{} x {} points, {pitch}", self.columns, self.rows)
    }
}

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
    refuse_meaningless(options, format)?;
    match format {
        Format::Hdf5 => {
            let hdf5::Heights { dataset, columns, rows, pitch, heights } =
                hdf5::heights(path, options.dataset.as_deref())?;
            let notes = vec![format!("dataset {dataset}")];
            let pitch = agreed_pitch(pitch, options.pitch)?;
            Ok(Measured { notes, instrument: false, ..Measured::new(format, [columns, rows], pitch, heights) })
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
            let image::HeightMap { columns, rows, heights, notes, warnings } =
                image::heights(&regular::read(path, limits::SURFACE)?, format, options)?;
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
    if let (Some(dataset), false) = (&options.dataset, matches!(format, Hdf5 | Npz)) {
        return Err(FileError::NoDatasets { format, dataset: dataset.clone() });
    }
    for (key, given, meaningful) in [
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

/// How far into a file is looked.
const HEAD: u64 = 4096;

/// Tells what a file is.
///
/// # Errors
/// [`FileError`] when it cannot be read, is not a regular file or is none of the known formats.
pub(super) fn detect(path: &Path) -> Result<Format, FileError> {
    // Asked before opening: opening a named pipe would wait for its writer.
    let there = std::fs::metadata(path).map_err(|error| regular::not_there(path, error))?;
    if !there.is_file() {
        return Err(if there.is_dir() { FileError::Folder } else { FileError::NotAFile });
    }
    let mut file = BufReader::new(File::open(path)?);
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head)?;
    if head.starts_with(b"PK\x03\x04") {
        return from_archive(file);
    }
    if is_utf16(&head) {
        return Ok(Format::Text);
    }
    from_head(&head).ok_or_else(|| FileError::Unknown { found: describe(&head) })
}

/// What a zip archive is, told by its entries.
fn from_archive(file: BufReader<File>) -> Result<Format, FileError> {
    let archive = ZipArchive::new(file).map_err(|error| FileError::Zip(error.to_string()))?;
    let has = |name: &[u8]| archive.file_names_raw().any(|entry| entry == name);
    if has(b"main.xml") {
        return Ok(Format::X3p);
    }
    if !archive.is_empty() && archive.file_names_raw().all(|entry| entry.ends_with(b".npy")) {
        return Ok(Format::Npz);
    }
    if has(b"index.xml") && archive.file_names_raw().any(|entry| entry.ends_with(b"recipe.txt")) {
        return Ok(Format::Instrument(PLUX));
    }
    let first = archive.file_names_raw().next().map(|name| name[..name.len().min(40)].escape_ascii());
    let entries = match first {
        None => "an empty zip archive".to_owned(),
        Some(first) => format!("a zip archive of {} entries, the first is \"{first}\"", archive.len()),
    };
    Err(FileError::Unknown { found: entries })
}

fn from_head(head: &[u8]) -> Option<Format> {
    let at = |offset: usize, signature: &[u8]| head.get(offset..).is_some_and(|rest| rest.starts_with(signature));
    // An HDF5 file may have a user block before its signature, of 512 bytes or a power of two times that.
    if [0, 512, 1024, 2048].iter().any(|offset| at(*offset, b"\x89HDF\r\n\x1a\n")) {
        return Some(Format::Hdf5);
    }
    for (signature, format) in [
        (b"\x93NUMPY".as_slice(), Format::Npy),
        (b"\x89PNG\r\n\x1a\n", Format::Png),
        // The second number is that of files beyond 4 GiB.
        (b"II\x2a\0", Format::Tiff),
        (b"MM\0\x2a", Format::Tiff),
        (b"II\x2b\0", Format::Tiff),
        (b"MM\0\x2b", Format::Tiff),
    ] {
        if at(0, signature) {
            return Some(format);
        }
    }
    if let Some(instrument) = recognise(head) {
        return Some(Format::Instrument(instrument));
    }
    let text = without_margin(head);
    // Only text may have blanks in front.
    if let Some(kind) = SdfKind::from_magic(if text.starts_with(b"a") || text.starts_with(b"A") { text } else { head })
    {
        return Some(Format::Sdf(kind));
    }
    let printable = |byte: &u8| !byte.is_ascii_control() || byte.is_ascii_whitespace();
    (text.iter().any(u8::is_ascii_digit) && head.iter().all(printable)).then_some(Format::Text)
}

fn describe(head: &[u8]) -> String {
    match head {
        [] => "it is empty".to_owned(),
        _ => format!("it starts with \"{}\"", head[..head.len().min(8)].escape_ascii()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::sdf::{Dialect, Encoding};

    #[test]
    fn tells_formats_by_their_signatures() {
        let mut user_block = vec![0; 512];
        user_block.extend(b"\x89HDF\r\n\x1a\n");
        let sdf = |dialect, encoding| Some(Format::Sdf(SdfKind { dialect, encoding }));
        for (head, format) in [
            (b"\x89HDF\r\n\x1a\n".as_slice(), Some(Format::Hdf5)),
            (&user_block, Some(Format::Hdf5)),
            (b"aISO-1.0\r\n", sdf(Dialect::Iso1, Encoding::Ascii)),
            (b"\xef\xbb\xbf  aISO-1.0\n", sdf(Dialect::Iso1, Encoding::Ascii)),
            (b"bISO-1.0sdfio", sdf(Dialect::Iso1, Encoding::Binary)),
            (b"bISO-2.0sdfio", sdf(Dialect::Iso2, Encoding::Binary)),
            (b"aBCR-1.0\r\n", sdf(Dialect::Bcr1, Encoding::Ascii)),
            (b"BBCR-1.0", sdf(Dialect::Bcr1, Encoding::Binary)),
            (b"GWYPGWYO", recognise(b"GWYP").map(Format::Instrument)),
            (b"\x93NUMPY\x01", Some(Format::Npy)),
            (b"1.0 2.0\n3.0 4.0\n", Some(Format::Text)),
            (b"", None),
            (b"\x89PNG\r\n\x1a\n\0\0\0", Some(Format::Png)),
            (b"II*\0\x08\0\0\0", Some(Format::Tiff)),
            (b"MM\0*\0\0\0\x08", Some(Format::Tiff)),
            (b"\xff\xd8\xff\xe0\0", None),
            (b"\0\0\0\0", None),
        ] {
            assert_eq!(from_head(head), format, "{}", head.escape_ascii());
        }
    }
}
