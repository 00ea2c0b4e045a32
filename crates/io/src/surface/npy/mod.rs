//! NumPy arrays (.npy) and archives of them (.npz): shape (columns, rows), heights in m.

mod error;
mod header;
mod number;

use std::fs::File;
use std::io::{self, BufWriter, Cursor, Read, Write};
use std::path::Path;

use plateau_core::surface::Patch;
use zip::ZipArchive;

pub use error::NpyError;
pub(super) use header::HEAD;
use header::Header;
use header::preamble;
use number::Number;

use super::options::inflated;
use crate::memory::refuse_beyond;
use crate::text::short;

/// An array as heights, column by column.
#[derive(Debug)]
pub(super) struct Array {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// NaN where there is none.
    pub(super) heights: Vec<f64>,
    /// Type as NumPy writes it.
    pub(super) descr: String,
    /// Whether the array holds integers.
    pub(super) integers: bool,
}

/// Reads the whole content of an .npy file; a number 1 stands for `unit` m.
///
/// # Errors
/// [`NpyError`] when the header is damaged, the array holds no real numbers in two dimensions, or the data are longer or
/// shorter than the header says.
pub(super) fn read(content: &[u8], unit: f64) -> Result<Array, NpyError> {
    let header = Header::read(content)?;
    let (number, columns, rows) = grid_of(&header, content.len() as u64)?;
    let points = columns * rows;
    // Heights, and once more where they are to be transposed.
    refuse_beyond((2 * points * size_of::<f64>()) as u64).map_err(NpyError::Memory)?;
    let mut heights = number.read(&content[header.data..]);
    if header.fortran_order {
        let transposed = (0..columns).flat_map(|column| heights.iter().skip(column).step_by(columns).copied());
        heights = transposed.collect();
    }
    if unit != 1.0 {
        heights.iter_mut().for_each(|height| *height *= unit);
    }
    let count = heights.iter().filter(|height| height.is_infinite()).count();
    if count > 0 {
        return Err(NpyError::Infinite { count, points });
    }
    Ok(Array { columns, rows, heights, integers: number.is_integer(), descr: header.descr })
}

/// Refuses an .npy file that is not as long as its first [`HEAD`] bytes say, before the rest is read: it may have gigabytes of holes.
///
/// # Errors
/// [`NpyError`] as for [`read`].
pub(super) fn check_length(head: &[u8], bytes: u64) -> Result<(), NpyError> {
    grid_of(&Header::read(head)?, bytes).map(drop)
}

/// What an .npy file of so many bytes holds: type of its numbers, columns and rows.
fn grid_of(header: &Header, bytes: u64) -> Result<(Number, usize, usize), NpyError> {
    let number = Number::of(&header.descr)?;
    let (columns, rows, points) = header.grid()?;
    let found = bytes.saturating_sub(header.data as u64);
    // At most 2^28 points of 8 bytes: this does not overflow.
    let expected = points * number.size();
    if found != expected as u64 {
        return Err(NpyError::Length { found, expected, shape: (columns as u64, rows as u64) });
    }
    Ok((number, columns, rows))
}

/// Reads an array of an archive: the one that is named, or the only one with two dimensions. Gives its name too.
///
/// # Errors
/// [`NpyError`] as for [`read`], and when the archive is damaged or leaves no one choice.
pub(super) fn read_archive(content: &[u8], name: Option<&str>, unit: f64) -> Result<(String, Array), NpyError> {
    let mut archive = ZipArchive::new(Cursor::new(content))?;
    let members = members(&mut archive)?;
    let wanted = |member: &Member| match name {
        Some(name) => member.name == name,
        // What is damaged may be the one, and is told as such.
        None => member.header.as_ref().map_or(true, |header| header.shape.len() == 2),
    };
    let (chosen, others): (Vec<_>, Vec<_>) = members.into_iter().partition(wanted);
    let [Member { index, name, header }] = <[Member; 1]>::try_from(chosen)
        .map_err(|chosen| NpyError::choice(name, chosen.into_iter().chain(others).map(|member| member.describe())))?;
    let wrap = |reason| NpyError::Member { name: name.clone(), reason: Box::new(reason) };
    let header = header.map_err(wrap)?;
    let number = Number::of(&header.descr).map_err(wrap)?;
    let (columns, rows, points) = header.grid().map_err(wrap)?;
    let needed = header.data + points * number.size();
    let most = inflated(content.len());
    if needed > most {
        let shape = (columns as u64, rows as u64);
        return Err(wrap(NpyError::TooLarge { shape, most: most / number.size() }));
    }
    refuse_beyond(needed as u64).map_err(|no_room| wrap(NpyError::Memory(no_room)))?;
    // One byte more than needed, so that what is too long is found and the checksum at the end is verified.
    let bytes = inflate(&mut archive, index, needed as u64 + 1).map_err(wrap)?;
    let array = read(&bytes, unit).map_err(wrap)?;
    Ok((name, array))
}

/// An array of an archive.
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
///
/// # Errors
/// What the operating system says, or that the patch has other than columns times rows heights.
pub fn write(path: &Path, patch: &Patch) -> io::Result<()> {
    if patch.columns.checked_mul(patch.rows) != Some(patch.heights.len()) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the patch has other than columns times rows heights"));
    }
    write_array(path, "<f8", &[patch.columns, patch.rows], patch.heights.iter().flat_map(|height| height.to_le_bytes()))
}

/// Writes an .npy file of this type and shape.
///
/// # Errors
/// Those of the system.
pub fn write_array(path: &Path, descr: &str, shape: &[usize], bytes: impl Iterator<Item = u8>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(&preamble(descr, shape)?)?;
    for byte in bytes {
        file.write_all(&[byte])?;
    }
    file.into_inner()?.sync_all()
}
