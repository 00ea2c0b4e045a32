//! X3P (ISO 25178-72, before ISO 5436-2): a zip archive with `main.xml`, which says what the axes are, and the heights in
//! it or in a binary file beside.
//!
//! Heights stand in the order of SDF: x grows fastest, then y. All lengths are in m. A height is the stored number times
//! the increment of the z axis plus its offset. A point that was not measured is NaN, +inf of a decimal axis (as
//! Alicona writes), an empty `Datum`, or marked in the validity file: one bit a point, the least significant first. The offsets of x and y move the patch as a whole and
//! are not used.
//!
//! Nothing is extracted to files, and no more is unpacked than the size of the matrix asks for.

mod checksum;
mod document;
mod entry;
mod error;
mod matrix;
mod points;
mod write;

pub use error::X3pError;
pub(super) use write::write;

use std::io::{Read, Seek};

use plateau_core::surface::Patch;
use zip::ZipArchive;

use crate::text::short;

use checksum::Checksums;
use document::{DATA_LINK, Document, MAIN, VALID_LINK};
use entry::Entry;
use matrix::Matrix;
use points::Points;

/// What an X3P file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The heights.
    pub patch: Patch,
    /// What the file says of itself.
    pub notes: Vec<String>,
    /// What is wrong with the file but does not change its heights.
    pub warnings: Vec<String>,
}

/// Reads an X3P file.
///
/// # Errors
/// [`X3pError`] when the archive or an entry is damaged or of another size than the matrix asks for, or when `main.xml`
/// describes something other than one layer of heights on a regular grid.
pub fn read(source: impl Read + Seek) -> Result<Surface, X3pError> {
    let mut archive = ZipArchive::new(source).map_err(|error| X3pError::Archive(error.to_string()))?;
    let folder = folder_of_main(&archive)?;
    let mut checksums = Checksums::default();
    let mut main = Entry::open(&mut archive, &folder, MAIN)?;
    let document = Document::read(&mut main)?;
    checksums.add(MAIN, main.finish()?);

    let matrix = Matrix::new(&document)?;
    let points = match document.datums() {
        Some(datums) => {
            matrix.check_count(datums.len())?;
            let mut points = Points::new(matrix, None);
            datums.chunks_exact(document.coordinates()).try_for_each(|datum| points.push(datum))?;
            points
        }
        None => {
            let valid = match document.get(VALID_LINK) {
                Some(name) => Some(read_valid(&mut archive, &folder, name, &matrix, &mut checksums)?),
                None => None,
            };
            let name = document.require(DATA_LINK)?;
            let mut entry = Entry::open(&mut archive, &folder, name)?;
            entry.check_size(matrix.bytes(), || matrix.describe())?;
            let record = matrix.record_size();
            let mut points = Points::new(matrix, valid);
            entry.for_each_record(record, |bytes| points.push_raw(bytes))?;
            checksums.add(name, entry.finish()?);
            points
        }
    };
    let warnings = checksums.compare(&document, &mut archive, &folder);
    let mut notes = document.notes();
    notes.extend(points.notes());
    Ok(Surface { patch: points.finish()?, notes, warnings })
}

/// The folder of the archive that holds `main.xml`, with the slash behind it: none, or that which was packed as a whole.
fn folder_of_main<R: Read + Seek>(archive: &ZipArchive<R>) -> Result<String, X3pError> {
    let names = archive.file_names().flatten();
    let folders = names.filter_map(|name| name.strip_suffix(MAIN).map(str::to_owned));
    let mut folders: Vec<String> = folders.filter(|folder| folder.is_empty() || folder.ends_with('/')).collect();
    folders.sort_by_key(String::len);
    match &folders[..] {
        [first, second, ..] if !first.is_empty() => {
            Err(X3pError::Folders { folders: [first, second].map(|folder| short(folder).into_owned()) })
        }
        _ => Ok(folders.into_iter().next().unwrap_or_default()),
    }
}

/// The validity file: one bit a point.
fn read_valid<R: Read + Seek>(
    archive: &mut ZipArchive<R>,
    folder: &str,
    name: &str,
    matrix: &Matrix,
    checksums: &mut Checksums,
) -> Result<Vec<u8>, X3pError> {
    let mut entry = Entry::open(archive, folder, name)?;
    entry.check_size(matrix.count().div_ceil(8), || format!("one bit for each of {}", matrix.describe()))?;
    let mut valid = Vec::new();
    entry.read_to_end(&mut valid).map_err(|error| entry.failed(&error))?;
    checksums.add(name, entry.finish()?);
    Ok(valid)
}
