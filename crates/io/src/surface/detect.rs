//! What a surface file is, told by how it starts.

use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::Path;

use zip::ZipArchive;

use super::error::FileError;
use super::format::{Format, PLUX, WORKBOOK, X3P, by_ending, recognise};
use super::sdf::{SdfKind, without_margin};
use crate::delimited::{is_utf16, workbook};
use crate::input;

/// How far into a file is looked.
const HEAD: u64 = 4096;

/// Tells what a file is.
///
/// # Errors
/// [`FileError`] when it cannot be read, is not a regular file or is none of the known formats.
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

/// What a zip archive is, told by its entries.
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
