use std::fs::File;
use std::io::Write;

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;

#[test]
fn every_encoding_gives_the_same_text() {
    let text = "x [µm]\r\n1";
    let utf16 = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    let [little, big] = [utf16(u16::to_le_bytes), utf16(u16::to_be_bytes)];
    let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
    for content in [text.as_bytes(), &little, &big, &little[2..], &big[2..], &latin] {
        assert_eq!(decode(content), text);
    }
    assert_eq!(decode(b"\xef\xbb\xbfa"), "a");
    assert_eq!(decode(b"\xff\xfe1\0\x00\xd8\x32"), "1\u{fffd}");
    assert_eq!(decode(b"\xff\xfe"), "");
    assert_eq!(decode(b"20 \x80, \x93a\x94, \xb5m"), "20 €, “a”, µm");
}

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
