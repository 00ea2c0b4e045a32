//! Reads a surface file of whatever format, told by how it starts, and refuses what is said of it that its format has no use for.
//! Writes one in the format of its ending, whole or not at all.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, ErrorKind, Read as _, Write};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use plateau_core::surface::Patch;
use thiserror::Error;
use zip::ZipArchive;

use super::error::FileError;
use super::format::{Format, PLUX, WORKBOOK, X3P, by_ending, recognise};
use super::image::{self, ImageError};
use super::measured::{Measured, ProfileError, ReadOptions, agreed_pitch};
use super::sdf::{SdfKind, without_margin};
use super::{hdf5, npy, sdf, text};
use crate::delimited::{is_utf16, workbook};
use crate::temporary::Temporary;
use crate::{input, limits, timestamp};

/// Reads a surface file; what it is, is told by its content.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Measured, FileError> {
    if options.profile_lay.is_some() && options.pitch.is_some_and(|[x, y]| x != y) {
        return Err(ProfileError::TwoPitches.into());
    }
    let mut measured = read_format(path, options)?;
    if let Some(lay) = options.profile_lay {
        measured.take_as_profile(lay)?;
    }
    refuse_absurd(&measured)?;
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
            let measured = hdf5::heights(path, options.dataset.as_deref(), options.at)?;
            Ok(Measured { pitch: agreed_pitch(measured.pitch, options.pitch)?, ..measured })
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
            (&mut file).take(npy::HEAD as u64).read_to_end(&mut content)?;
            npy::check_length(&content, file.metadata()?.len())?;
            file.take(limits::SURFACE).read_to_end(&mut content)?;
            Ok(npy::read(&content, options)?)
        }
        Format::Npz => Ok(npy::read_archive(&input::read(path, limits::SURFACE)?, options)?),
        Format::Png | Format::Tiff | Format::Jpeg => {
            image::heights(&input::read(path, limits::SURFACE)?, format, options).map_err(|reason| match reason {
                ImageError::Tiff(_) | ImageError::Pixels { .. } if format == Format::Tiff => FileError::Tiff { reason },
                other => other.into(),
            })
        }
        Format::Text => {
            let xyz = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xyz"));
            Ok(text::read(&input::read(path, limits::SURFACE_TEXT)?, xyz, options)?)
        }
        Format::Instrument(instrument) => Err(FileError::Instrument(instrument)),
    }
}

/// Pitches that are read, m; measured ones are between 1e-11 and 1e-3.
const PITCHES: RangeInclusive<f64> = 1e-15..=1e3;
/// Largest height or depth that is read, m; instruments with a far zero give up to 0.1.
const HIGHEST: f64 = 1e3;

/// Refuses what is far from any surface: a damaged file, or numbers of another unit.
fn refuse_absurd(measured: &Measured) -> Result<(), FileError> {
    if let Some(pitch) = measured.pitch.iter().flatten().find(|pitch| !PITCHES.contains(pitch)) {
        let expected = format!("{:e} to {:e} m", PITCHES.start(), PITCHES.end());
        return Err(FileError::Absurd { found: format!("a pitch of {pitch:e} m"), expected });
    }
    match measured.heights.iter().find(|height| height.abs() > HIGHEST) {
        None => Ok(()),
        Some(height) => Err(FileError::Absurd {
            found: format!("a height of {height:e} m"),
            expected: format!("{:e} to {HIGHEST:e} m", -HIGHEST),
        }),
    }
}

/// Refuses what would silently not be used.
fn refuse_meaningless(options: &ReadOptions, format: Format) -> Result<(), FileError> {
    use Format::{Hdf5, Jpeg, Npy, Npz, Png, Text, Tiff};
    if let (Some(dataset), false) = (&options.dataset, matches!(format, Hdf5 | Npz | Text)) {
        return Err(FileError::NoDatasets { format, dataset: dataset.clone() });
    }
    for (key, given, meaningful) in [
        ("at", options.at.is_some(), format == Hdf5),
        ("unit", options.unit.is_some(), matches!(format, Text | Npy | Npz | Png | Tiff | Jpeg)),
        ("pitch", options.pitch.is_some(), matches!(format, Text | Npy | Npz | Png | Tiff | Jpeg | Hdf5)),
        ("height_range", options.height_range.is_some(), matches!(format, Png | Tiff | Jpeg)),
        ("decimal", options.decimal.is_some(), format == Text),
        ("skip", options.skip.is_some(), format == Text),
    ] {
        if given && !meaningful {
            return Err(FileError::Meaningless { format, key });
        }
    }
    Ok(())
}

/// Bytes at the beginning of a file that are looked at.
const HEAD: u64 = 4096;

pub(super) fn detect(path: &Path) -> Result<Format, FileError> {
    // Asked before opening: opening a named pipe would wait for its writer.
    let there = std::fs::metadata(path).map_err(|error| input::not_there(path, error))?;
    if !there.is_file() {
        return Err(if there.is_dir() { FileError::Folder } else { FileError::NotAFile });
    }
    let mut file = BufReader::new(File::open(path)?);
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head)?;
    if head.starts_with(b"PK\x03\x04") {
        return from_archive(file);
    }
    if is_utf16(&head) && recognise(&head).is_none() {
        return Ok(Format::Text);
    }
    let format = from_head(&head).or_else(|| by_ending(path).filter(|_| !head.is_empty()).map(Format::Instrument));
    format.ok_or_else(|| FileError::Unknown { found: describe(&head), is_binary: !head.iter().all(is_printable) })
}

/// Tells the format of a zip archive by its entries.
fn from_archive(file: BufReader<File>) -> Result<Format, FileError> {
    let archive = ZipArchive::new(file).map_err(|error| FileError::Zip(error.to_string()))?;
    let has = |name: &[u8]| archive.file_names_raw().any(|entry| entry == name);
    // Some archives have the folder itself in them.
    if has(b"main.xml") || archive.file_names_raw().any(|entry| entry.ends_with(b"/main.xml")) {
        return Ok(Format::Instrument(X3P));
    }
    if !archive.is_empty() && archive.file_names_raw().all(|entry| entry.ends_with(b".npy")) {
        return Ok(Format::Npz);
    }
    if has(b"index.xml") && archive.file_names_raw().any(|entry| entry.ends_with(b"recipe.txt")) {
        return Ok(Format::Instrument(PLUX));
    }
    if has(b"xl/workbook.xml") {
        return Ok(Format::Instrument(WORKBOOK));
    }
    if let Some(book) = workbook(archive.file_names_raw()) {
        return Err(FileError::Workbook(book));
    }
    let first = archive.file_names_raw().next().map(|name| name[..name.len().min(40)].escape_ascii());
    let entries = match first {
        None => "an empty zip archive".to_owned(),
        Some(first) => format!("a zip archive of {} entries, the first is \"{first}\"", archive.len()),
    };
    Err(FileError::Unknown { found: entries, is_binary: !archive.is_empty() })
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
        (b"\xff\xd8\xff", Format::Jpeg),
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
    (text.iter().any(u8::is_ascii_digit) && head.iter().all(is_printable)).then_some(Format::Text)
}

fn is_printable(byte: &u8) -> bool {
    !byte.is_ascii_control() || byte.is_ascii_whitespace()
}

fn describe(head: &[u8]) -> String {
    match head {
        [] => "it is empty".to_owned(),
        _ => format!("it starts with \"{}\"", head[..head.len().min(8)].escape_ascii()),
    }
}

/// Reason why a surface cannot be written.
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

const ENDINGS: &str = ".sdf, .npy or .h5";

/// Writes heights so that reading the file gives the same heights, bit for bit, missing points as missing points.
///
/// The format is that of the ending, .sdf, .npy or .h5 in small or large letters. An .npy file has no place for the pitch. An existing
/// file is replaced only with `replace`. The file appears at `path` when it is complete; if anything fails, one that was there stays.
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
