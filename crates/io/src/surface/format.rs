//! What a file is, told by how it starts.

use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::FileError;
use super::text::{TextError, is_utf16};

/// Formats of surface files that are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// HDF5.
    Hdf5,
    /// SDF ISO-1.0 (ISO 25178-71), text.
    SdfAscii,
    /// SDF ISO-1.0 (ISO 25178-71), binary.
    SdfBinary,
    /// SDF ISO-2.0, not read yet.
    SdfIso2,
    /// SDF BCR-1.0, not read yet.
    SdfBcr,
    /// X3P (ISO 25178-72) or another zip archive, not read yet.
    X3p,
    /// NumPy array.
    Npy,
    /// Zip archive of NumPy arrays.
    Npz,
    /// PNG image.
    Png,
    /// TIFF image.
    Tiff,
    /// Matrix of numbers or list of points as text.
    Text,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hdf5 => "an HDF5 file",
            Self::SdfAscii => "an SDF ISO-1.0 file (ASCII)",
            Self::SdfBinary => "an SDF ISO-1.0 file (binary)",
            Self::SdfIso2 => "an SDF ISO-2.0 file",
            Self::SdfBcr => "an SDF BCR-1.0 file",
            Self::X3p => "an X3P file (zip archive)",
            Self::Npy => "a NumPy array file (.npy)",
            Self::Npz => "a NumPy archive (.npz)",
            Self::Png => "a PNG image",
            Self::Tiff => "a TIFF image",
            Self::Text => "a text file",
        })
    }
}

/// How far into a file is looked.
const HEAD: u64 = 4096;

/// Tells what a file is.
///
/// # Errors
/// [`FileError`] when it cannot be read, is no regular file or is none of the known formats.
pub(super) fn detect(path: &Path) -> Result<Format, FileError> {
    // Asked before opening: opening a named pipe would wait for its writer.
    if !std::fs::metadata(path)?.is_file() {
        return Err(FileError::NotAFile);
    }
    let mut head = Vec::new();
    File::open(path)?.take(HEAD).read_to_end(&mut head)?;
    if is_utf16(&head) {
        return Err(TextError::Utf16.into());
    }
    from_head(&head).ok_or_else(|| FileError::Unknown { found: describe(&head) })
}

fn from_head(head: &[u8]) -> Option<Format> {
    let at = |offset: usize, signature: &[u8]| head.get(offset..).is_some_and(|rest| rest.starts_with(signature));
    // An HDF5 file may have a user block before its signature, of 512 bytes or a power of two times that.
    if [0, 512, 1024, 2048].iter().any(|offset| at(*offset, b"\x89HDF\r\n\x1a\n")) {
        return Some(Format::Hdf5);
    }
    if at(0, b"PK\x03\x04") {
        return Some(if holds_array(head) { Format::Npz } else { Format::X3p });
    }
    if at(0, b"\x89PNG\r\n\x1a\n") {
        return Some(Format::Png);
    }
    // The byte order, then 42, or 43 for files beyond 4 GiB.
    if [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|signature| at(0, *signature)) {
        return Some(Format::Tiff);
    }
    if at(0, b"\x93NUMPY") {
        return Some(Format::Npy);
    }
    let text = without_margin(head);
    for (magic, format) in [
        (b"aISO-1.0", Format::SdfAscii),
        (b"bISO-1.0", Format::SdfBinary),
        (b"aISO-2.0", Format::SdfIso2),
        (b"bISO-2.0", Format::SdfIso2),
        (b"aBCR-1.0", Format::SdfBcr),
        (b"bBCR-1.0", Format::SdfBcr),
    ] {
        // Only text may have blanks in front.
        let start = if magic[0] == b'a' { text } else { head };
        if start.starts_with(magic) {
            return Some(format);
        }
    }
    let printable = |byte: &u8| !byte.is_ascii_control() || byte.is_ascii_whitespace();
    (text.iter().any(u8::is_ascii_digit) && head.iter().all(printable)).then_some(Format::Text)
}

/// Whether the first member of a zip archive is a NumPy array, by its name: 30 bytes of header, among them the length of
/// the name at byte 26, then the name.
fn holds_array(head: &[u8]) -> bool {
    let length = head.get(26..28).map_or(0, |bytes| usize::from(bytes[0]) | usize::from(bytes[1]) << 8);
    head.get(30..30 + length).is_some_and(|name| name.ends_with(b".npy"))
}

/// Text without a byte order mark and leading blanks.
pub(super) fn without_margin(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii_start()
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

    #[test]
    fn tells_formats_by_their_signatures() {
        let mut user_block = vec![0; 512];
        user_block.extend(b"\x89HDF\r\n\x1a\n");
        for (head, format) in [
            (b"\x89HDF\r\n\x1a\n".as_slice(), Some(Format::Hdf5)),
            (&user_block, Some(Format::Hdf5)),
            (b"aISO-1.0\r\n", Some(Format::SdfAscii)),
            (b"\xef\xbb\xbf  aISO-1.0\n", Some(Format::SdfAscii)),
            (b"bISO-1.0sdfio", Some(Format::SdfBinary)),
            (b"bISO-2.0sdfio", Some(Format::SdfIso2)),
            (b"aBCR-1.0\r\n", Some(Format::SdfBcr)),
            (b"PK\x03\x04\x14", Some(Format::X3p)),
            (b"\x93NUMPY\x01", Some(Format::Npy)),
            (b"1.0 2.0\n3.0 4.0\n", Some(Format::Text)),
            (b"", None),
            (b"PK\x03\x04\x14\0\0\0\0\0\0\0!\0\0\0\0\0\0\0\0\0\0\0\0\0\x05\0\0\0a.npy\x93", Some(Format::Npz)),
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
