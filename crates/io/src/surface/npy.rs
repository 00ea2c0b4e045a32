//! NumPy arrays (.npy) and archives of them (.npz): shape (columns, rows), heights in m.

use std::fs::File;
use std::io::{self, BufWriter, Cursor, Read, Write};
use std::path::Path;

use plateau_core::surface::Patch;
use thiserror::Error;
use zip::ZipArchive;

use super::format::Format;
use super::measured::{MOST_POINTS, Measured, ReadOptions, inflated, present};
use super::stored::{Kind, Number};
use crate::memory::{NoRoom, refuse_beyond};
use crate::text::short;

/// Reason why a NumPy file gives no surface.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum NpyError {
    #[error("the header is damaged: found {found}, expected {expected}")]
    Header { found: String, expected: &'static str },
    #[error("the array has type {found}, expected floating-point numbers or integers")]
    Type { found: String },
    #[error("the array has shape {found}, expected 2 dimensions (columns, rows), none of them 0")]
    Shape { found: String },
    #[error("the array has shape ({}, {}), which is more than the {most} points that are read of a file of this size", shape.0, shape.1)]
    TooLarge { shape: (u64, u64), most: usize },
    #[error("its heights need {0}")]
    Memory(NoRoom),
    #[error("the data have {found} bytes, expected {expected} for shape ({}, {})", shape.0, shape.1)]
    Length { found: u64, expected: usize, shape: (u64, u64) },
    #[error("{count} of {points} heights are infinite, expected heights in m, NaN for a missing point")]
    Infinite { count: usize, points: usize },
    #[error("cannot be read as a zip archive: {0}")]
    Zip(#[from] zip::result::ZipError),
    #[error("cannot be decompressed: {0}")]
    Inflate(std::io::Error),
    #[error("{problem}; {present}")]
    Choice { problem: String, present: String },
    #[error("array \"{}\": {reason}", short(name))]
    Member { name: String, reason: Box<NpyError> },
}

impl NpyError {
    /// Error of an archive in which not just one array has that name or, without a name, two dimensions.
    fn choice(name: Option<&str>, arrays: &[Member]) -> Self {
        let problem = match name {
            Some(name) => format!("the archive has no one array \"{}\"", short(name).escape_debug()),
            None => "expected one array of two dimensions: name it with dataset = \"...\"".to_owned(),
        };
        Self::Choice { problem, present: present(arrays, Member::describe, "the archive has no arrays") }
    }
}

/// The type that NumPy writes as `<f8`, for example.
fn number(descr: &str) -> Result<Number, NpyError> {
    let unknown = || NpyError::Type { found: format!("\"{}\"", short(descr).escape_debug()) };
    let mut characters = descr.chars();
    let (order, kind, size) = (characters.next(), characters.next(), characters.as_str());
    let (kind, sizes) = match kind {
        Some('f') => (Kind::Float, &["2", "4", "8"][..]),
        Some('i') => (Kind::Signed, &["1", "2", "4", "8"][..]),
        Some('u') => (Kind::Unsigned, &["1", "2", "4", "8"][..]),
        _ => return Err(unknown()),
    };
    let size = sizes.iter().find(|known| **known == size).and_then(|size| size.parse().ok()).ok_or_else(unknown)?;
    let is_big_endian = match (order, size) {
        (Some('<'), _) | (Some('|'), 1) => false,
        (Some('>'), _) => true,
        _ => return Err(unknown()),
    };
    Ok(Number { kind, size, is_big_endian })
}

const MAGIC: &[u8] = b"\x93NUMPY";

/// Longest header, bytes: NumPy itself refuses longer ones.
const LONGEST: usize = 10_000;

/// Bytes from which a header can be read, if the file is that long.
pub(super) const HEAD: usize = MAGIC.len() + 2 + 4 + LONGEST;

#[derive(Debug, Clone, PartialEq)]
struct Header {
    /// Type as NumPy writes it, for instance `<f8`.
    descr: String,
    fortran_order: bool,
    shape: Vec<u64>,
    /// Byte at which the data start.
    data: usize,
}

impl Header {
    fn read(content: &[u8]) -> Result<Self, NpyError> {
        let wrong = |found: &[u8], expected| {
            let found = format!("\"{}\"", found[..found.len().min(60)].escape_ascii());
            Err(NpyError::Header { found, expected })
        };
        let Some(rest) = content.strip_prefix(MAGIC) else { return wrong(content, "\"\\x93NUMPY\"") };
        let (length, start) = match *rest {
            [1, 0, a, b, ..] => (usize::from(u16::from_le_bytes([a, b])), 4),
            [2 | 3, 0, a, b, c, d, ..] => (u32::from_le_bytes([a, b, c, d]) as usize, 6),
            [1..=3, 0, ..] => return wrong(rest, "the length of the header"),
            _ => return wrong(&rest[..rest.len().min(2)], "version 1.0, 2.0 or 3.0"),
        };
        if length > LONGEST {
            return wrong(&rest[..start], "a header of at most 10000 bytes");
        }
        let Some(text) = rest.get(start..start + length) else { return wrong(rest, "a header as long as it says") };
        let text = String::from_utf8_lossy(text);
        let mut header = Dictionary { rest: text.trim() }.read()?;
        header.data = MAGIC.len() + start + length;
        Ok(header)
    }

    /// Columns and rows, and how many points they are.
    fn grid(&self) -> Result<(usize, usize, usize), NpyError> {
        let [columns, rows] = self.shape[..] else { return Err(NpyError::Shape { found: self.shown_shape() }) };
        if columns == 0 || rows == 0 {
            return Err(NpyError::Shape { found: self.shown_shape() });
        }
        let points = columns.checked_mul(rows).and_then(|points| usize::try_from(points).ok());
        match points.filter(|points| *points <= MOST_POINTS) {
            Some(points) => Ok((columns as usize, rows as usize, points)),
            None => Err(NpyError::TooLarge { shape: (columns, rows), most: MOST_POINTS }),
        }
    }

    fn shown_shape(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(u64::to_string).collect();
        format!("({})", sizes.join(", "))
    }
}

/// The literal of a dictionary, read from the front.
struct Dictionary<'a> {
    rest: &'a str,
}

impl<'a> Dictionary<'a> {
    fn read(mut self) -> Result<Header, NpyError> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.require('{')?;
        while !self.take('}') {
            let key = self.quoted()?;
            self.require(':')?;
            match key {
                "descr" => descr = Some(self.descr()?),
                "fortran_order" => fortran_order = Some(self.boolean()?),
                "shape" => shape = Some(self.shape()?),
                _ => return self.wrong("the keys descr, fortran_order and shape"),
            }
            if !self.take(',') {
                self.require('}')?;
                break;
            }
        }
        match (descr, fortran_order, shape) {
            (Some(descr), Some(fortran_order), Some(shape)) => Ok(Header { descr, fortran_order, shape, data: 0 }),
            _ => self.wrong("the keys descr, fortran_order and shape"),
        }
    }

    fn wrong<T>(&self, expected: &'static str) -> Result<T, NpyError> {
        let found: String = self.rest.chars().take(40).flat_map(char::escape_debug).collect();
        Err(NpyError::Header { found: format!("\"{found}\""), expected })
    }

    fn take(&mut self, mark: char) -> bool {
        self.rest = self.rest.trim_start();
        let rest = self.rest.strip_prefix(mark);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn require(&mut self, mark: char) -> Result<(), NpyError> {
        if self.take(mark) {
            Ok(())
        } else {
            self.wrong("a dictionary {'descr': ..., 'fortran_order': ..., 'shape': ...}")
        }
    }

    fn quoted(&mut self) -> Result<&'a str, NpyError> {
        for quote in ['\'', '"'] {
            if self.take(quote) {
                let Some((text, rest)) = self.rest.split_once(quote) else { return self.wrong("a string that ends") };
                self.rest = rest;
                return Ok(text);
            }
        }
        self.wrong("a string in quotes")
    }

    /// A type; a list of named fields is one too, but holds no heights.
    fn descr(&mut self) -> Result<String, NpyError> {
        match self.quoted() {
            Err(_) if self.rest.starts_with('[') => Err(NpyError::Type { found: "record".to_owned() }),
            other => other.map(str::to_owned),
        }
    }

    fn boolean(&mut self) -> Result<bool, NpyError> {
        self.rest = self.rest.trim_start();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.rest.strip_prefix(word) {
                self.rest = rest;
                return Ok(value);
            }
        }
        self.wrong("True or False")
    }

    fn shape(&mut self) -> Result<Vec<u64>, NpyError> {
        self.require('(')?;
        let mut shape = Vec::new();
        while !self.take(')') {
            self.rest = self.rest.trim_start();
            let digits = self.rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest.len());
            let (number, rest) = self.rest.split_at(digits);
            let Ok(number) = number.parse() else { return self.wrong("a size of 64 bits") };
            shape.push(number);
            // Python 2 marked long integers.
            self.rest = rest.strip_prefix('L').unwrap_or(rest);
            if !self.take(',') {
                self.require(')')?;
                break;
            }
        }
        Ok(shape)
    }
}

/// Bytes before the dictionary: mark, version and length.
const PREFIX: usize = 10;

/// The bytes before the data of an array of that type, as NumPy writes it, and shape; the last index runs fastest.
fn preamble(descr: &str, shape: &[usize]) -> io::Result<Vec<u8>> {
    // A tuple of one has a comma after it.
    let sizes: String = shape.iter().map(|size| format!("{size}, ")).collect();
    let dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", sizes.trim_end());
    // The data start at a multiple of 64 bytes; the header ends with a line feed.
    let padded = (PREFIX + dictionary.len() + 1).next_multiple_of(64) - PREFIX - 1;
    let dictionary = format!("{dictionary:padded$}\n");
    let length = u16::try_from(dictionary.len()).map_err(io::Error::other)?;
    Ok([b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], dictionary.as_bytes()].concat())
}

/// Reads the whole content of an .npy file: heights of the model, as those of an HDF5 file.
pub(super) fn read(content: &[u8], options: &ReadOptions) -> Result<Measured, NpyError> {
    let header = Header::read(content)?;
    let (number, columns, rows) = grid_of(&header, content.len() as u64)?;
    let points = columns * rows;
    // Heights, and once more where they are to be transposed.
    refuse_beyond((2 * points * size_of::<f64>()) as u64).map_err(NpyError::Memory)?;
    let mut heights: Vec<f64> =
        content[header.data..].chunks_exact(number.size).map(|bytes| number.read(bytes)).collect();
    if header.fortran_order {
        let transposed = (0..columns).flat_map(|column| heights.iter().skip(column).step_by(columns).copied());
        heights = transposed.collect();
    }
    if let Some(unit) = options.unit {
        heights.iter_mut().for_each(|height| *height *= unit);
    }
    let count = heights.iter().filter(|height| height.is_infinite()).count();
    if count > 0 {
        return Err(NpyError::Infinite { count, points });
    }
    let mut warnings = Vec::new();
    if number.kind != Kind::Float && options.unit.is_none() {
        warnings.push("integers taken as heights in m: unit = \"nm\" says what 1 stands for".to_owned());
    }
    let notes = vec![format!("type {}", header.descr)];
    let plain = Measured::new(Format::Npy, [columns, rows], options.pitch, heights);
    Ok(Measured { notes, warnings, instrument: false, ..plain })
}

/// Refuses an .npy file that is not as long as its first [`HEAD`] bytes say, before the rest is read: it may have gigabytes of holes.
pub(super) fn check_length(head: &[u8], bytes: u64) -> Result<(), NpyError> {
    grid_of(&Header::read(head)?, bytes).map(drop)
}

/// Finds type of the numbers, columns and rows of an .npy file of so many bytes.
fn grid_of(header: &Header, bytes: u64) -> Result<(Number, usize, usize), NpyError> {
    let number = number(&header.descr)?;
    let (columns, rows, points) = header.grid()?;
    let found = bytes.saturating_sub(header.data as u64);
    // At most 2^28 points of 8 bytes: this does not overflow.
    let expected = points * number.size;
    if found != expected as u64 {
        return Err(NpyError::Length { found, expected, shape: (columns as u64, rows as u64) });
    }
    Ok((number, columns, rows))
}

/// Reads an array of an archive: the one that is named, or the only one with two dimensions.
pub(super) fn read_archive(content: &[u8], options: &ReadOptions) -> Result<Measured, NpyError> {
    let name = options.dataset.as_deref();
    let mut archive = ZipArchive::new(Cursor::new(content))?;
    let members = members(&mut archive)?;
    let wanted = |member: &Member| match name {
        Some(name) => member.name == name,
        // What is damaged may be the one, and is told as such.
        None => member.header.as_ref().map_or(true, |header| header.shape.len() == 2),
    };
    let (chosen, others): (Vec<_>, Vec<_>) = members.into_iter().partition(wanted);
    let [Member { index, name, header }] = <[Member; 1]>::try_from(chosen)
        .map_err(|chosen| NpyError::choice(name, &chosen.into_iter().chain(others).collect::<Vec<_>>()))?;
    let read = || {
        let header = header?;
        let number = number(&header.descr)?;
        let (columns, rows, points) = header.grid()?;
        let needed = header.data + points * number.size;
        let most = inflated(content.len());
        if needed > most {
            let shape = (columns as u64, rows as u64);
            return Err(NpyError::TooLarge { shape, most: most / number.size });
        }
        refuse_beyond(needed as u64).map_err(NpyError::Memory)?;
        // One byte more than needed, so that what is too long is found and the checksum at the end is verified.
        read(&inflate(&mut archive, index, needed as u64 + 1)?, options)
    };
    let mut measured = read().map_err(|reason| NpyError::Member { name: name.clone(), reason: Box::new(reason) })?;
    measured.notes.insert(0, format!("array {name}"));
    Ok(Measured { format: Format::Npz, ..measured })
}

struct Member {
    index: usize,
    name: String,
    header: Result<Header, NpyError>,
}

impl Member {
    fn describe(&self) -> String {
        let what = match &self.header {
            Ok(header) => format!("{}, shape {}", short(&header.descr).escape_debug(), header.shown_shape()),
            Err(_) => "unreadable".to_owned(),
        };
        format!("{} ({what})", short(&self.name).escape_debug())
    }
}

/// Members that are searched; more are no measurement.
const MOST_MEMBERS: usize = 1000;

fn members(archive: &mut ZipArchive<Cursor<&[u8]>>) -> Result<Vec<Member>, NpyError> {
    let mut members = Vec::new();
    for index in 0..archive.len().min(MOST_MEMBERS) {
        let Some(Ok(file)) = archive.name_for_index(index) else { continue };
        let Some(name) = file.strip_suffix(".npy").map(str::to_owned) else { continue };
        let header = inflate(archive, index, HEAD as u64).and_then(|start| Header::read(&start));
        members.push(Member { index, name, header });
    }
    Ok(members)
}

/// The first bytes of a member.
fn inflate(archive: &mut ZipArchive<Cursor<&[u8]>>, index: usize, bytes: u64) -> Result<Vec<u8>, NpyError> {
    let mut content = Vec::new();
    archive.by_index(index)?.take(bytes).read_to_end(&mut content).map_err(NpyError::Inflate)?;
    Ok(content)
}

/// Writes the heights of a patch as an .npy file: float64, shape (columns, rows), m, NaN where a point is missing. The
/// format has no place for the pitch.
pub(super) fn write(path: &Path, patch: &Patch) -> io::Result<()> {
    write_array(path, "<f8", &[patch.columns, patch.rows], patch.heights.iter().flat_map(|height| height.to_le_bytes()))
}

/// Writes an .npy file of this type and shape.
pub fn write_array(path: &Path, descr: &str, shape: &[usize], bytes: impl Iterator<Item = u8>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(&preamble(descr, shape)?)?;
    for byte in bytes {
        file.write_all(&[byte])?;
    }
    file.into_inner()?.sync_all()
}
