//! The text of a file of which nobody knows whether it is one.

use std::io::{self, Cursor, ErrorKind};
use std::path::Path;

use zip::ZipArchive;

use super::encoding::decode;
use crate::regular;

/// The text of a table: of a regular file of at most so many bytes.
///
/// # Errors
/// What the system says, and [`ErrorKind::InvalidData`] where it is no text: then, what it is, and how to save it.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<String> {
    let content = regular::read(path, most)?;
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

/// What a workbook is, by the names of the entries of a zip archive; none of another archive.
pub(crate) fn workbook<'a>(names: impl Iterator<Item = &'a [u8]>) -> Option<&'static str> {
    // The folder of the sheets in Office Open XML, and what every document of OpenDocument has.
    names.into_iter().find_map(|name| match name {
        b"content.xml" => Some("a workbook (.ods)"),
        name => name.starts_with(b"xl/").then_some("a workbook (.xlsx)"),
    })
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::Write;

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;

    #[test]
    fn what_is_no_text_is_named_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let said = || read(&path, 1 << 20).unwrap_err().to_string();
        for (entries, expected) in [
            (
                &["[Content_Types].xml", "xl/workbook.xml"][..],
                "this is a workbook (.xlsx), expected text: save its sheet as CSV",
            ),
            (&["mimetype", "content.xml"], "this is a workbook (.ods), expected text: save its sheet as CSV"),
            (&["table.csv"], "this is a zip archive, expected text: unpack it, and name the file in it"),
        ] {
            let mut archive = ZipWriter::new(File::create(&path).unwrap());
            for entry in entries {
                archive.start_file(*entry, SimpleFileOptions::default()).unwrap();
                archive.write_all(b"1").unwrap();
            }
            archive.finish().unwrap();
            assert_eq!(said(), expected);
        }
        std::fs::write(&path, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0\0").unwrap();
        assert!(said().starts_with("this is a workbook (.xls) or another document"), "{}", said());
        std::fs::write(&path, b"\x89HDF\r\n\x1a\n\0\0").unwrap();
        assert_eq!(said(), "this is no text, expected a table in CSV");
    }
}
