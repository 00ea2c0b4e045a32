//! Text of numbers that others have written: surfaces, cycles, designs, values that were measured. All of it is read by one rule.
//!
//! | file | content |
//! |---|---|
//! | here | the text of a file, decoded; refusal of workbooks and archives |
//! | `dialect.rs` | numbered lines, separators of cells, the decimal mark of numbers, the beginning of a second table |
//! | `named.rs` | a table whose first line names its columns |

mod dialect;
mod named;

use std::borrow::Cow;
use std::io::{self, Cursor, ErrorKind};
use std::path::Path;

use zip::ZipArchive;

use crate::input;

pub use dialect::{Decimal, numbered};
pub(crate) use dialect::{Kind, Separator, lines, starts, stated_separator};
pub(crate) use named::{Fault, Line, Named};

/// The bytes 0x80 to 0x9f of Windows-1252; the others are those of Latin-1 (WHATWG Encoding Standard, index windows-1252).
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘', '’',
    '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Tells whether a text has two bytes a character: by its byte order mark, or by its first two characters, which are of ASCII.
pub(crate) fn is_utf16(content: &[u8]) -> bool {
    utf16(content).is_some()
}

/// The unit of UTF-16 that two bytes make.
type Unit = fn([u8; 2]) -> u16;

/// Way in which two bytes make a unit, and where the first one stands; none if the text has one byte a character.
fn utf16(content: &[u8]) -> Option<(Unit, usize)> {
    let is_ascii = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    match content {
        [0xff, 0xfe, ..] => Some((u16::from_le_bytes, 2)),
        [0xfe, 0xff, ..] => Some((u16::from_be_bytes, 2)),
        [one, 0, other, 0, ..] if is_ascii(one) && is_ascii(other) => Some((u16::from_le_bytes, 0)),
        [0, one, 0, other, ..] if is_ascii(one) && is_ascii(other) => Some((u16::from_be_bytes, 0)),
        _ => None,
    }
}

/// The text of a file: UTF-8 or UTF-16, with byte order mark or without, else Windows-1252, in which "µ" is the byte 181.
///
/// What is damaged becomes U+FFFD, which no number has.
pub fn decode(content: &[u8]) -> Cow<'_, str> {
    if let Some((unit, start)) = utf16(content) {
        // A last byte without its pair is half a character.
        let (pairs, _) = content[start..].as_chunks::<2>();
        let characters = char::decode_utf16(pairs.iter().map(|pair| unit(*pair)));
        return Cow::Owned(characters.map(|character| character.unwrap_or(char::REPLACEMENT_CHARACTER)).collect());
    }
    let content = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    let character = |byte: &u8| match byte {
        0x80..=0x9f => WINDOWS[usize::from(byte - 0x80)],
        other => char::from(*other),
    };
    match std::str::from_utf8(content) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(content.iter().map(character).collect()),
    }
}

/// The text of a table: of a regular file of at most so many bytes.
///
/// # Errors
/// What the system says, and [`ErrorKind::InvalidData`] where it is no text: then, what it is, and how to save it.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<String> {
    let content = input::read(path, most)?;
    let refuse = |what: &str| Err(io::Error::new(ErrorKind::InvalidData, format!("this is {what}")));
    if content.starts_with(b"PK\x03\x04") {
        let archive = ZipArchive::new(Cursor::new(&content));
        return refuse(&match archive.ok().and_then(|archive| workbook(archive.file_names_raw())) {
            Some(book) => format!("{book}, expected text: save its sheet as CSV"),
            None => "a zip archive, expected text: unpack it, and name the file in it".to_owned(),
        });
    }
    if content.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") {
        return refuse("a workbook (.xls) or another document, expected text: save its sheet as CSV");
    }
    let text = decode(&content);
    if text.contains('\0') {
        return refuse("no text, expected a table in CSV");
    }
    Ok(text.into_owned())
}

/// Kind of a workbook, by the names of the entries of a zip archive; none of another archive.
pub(crate) fn workbook<'a>(names: impl Iterator<Item = &'a [u8]>) -> Option<&'static str> {
    // The folder of the sheets in Office Open XML, and what every document of OpenDocument has.
    names.into_iter().find_map(|name| match name {
        b"content.xml" => Some("a workbook (.ods)"),
        name => name.starts_with(b"xl/").then_some("a workbook (.xlsx)"),
    })
}

#[cfg(test)]
#[path = "../../tests/unit/delimited/file.rs"]
mod tests;
