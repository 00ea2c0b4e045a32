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

#[test]
fn a_number_tells_its_mark() {
    for (cells, mark) in [
        (&["1,5", "-0,25e-3", "7,5 N", ",5"][..], Some(Decimal::Comma)),
        (&["1.5", "-0.25e-3", "7.5 N", ".5"], Some(Decimal::Point)),
        (&["1.234,5", "1,2,3", "a, b", ",", "7", "12.03.2026", "a.5", ""], None),
    ] {
        cells.iter().for_each(|cell| assert_eq!(Decimal::of(cell), mark, "{cell}"));
    }
}

#[test]
fn cells_are_parted_by_the_strongest_separator() {
    let cells = |line: &str, terminated| {
        Separator::of(line).cells(line, terminated).map(str::to_owned).collect::<Vec<_>>().join("|")
    };
    assert_eq!(cells(" 1  2\u{a0}3 ", false), "1|2|3");
    assert_eq!(cells("1, 2 ,,4", false), "1|2||4");
    assert_eq!(cells("1;2,5; ", false), "1|2,5|");
    assert_eq!(cells("1;2,5; ", true), "1|2,5");
    assert_eq!(cells("\t1\t\t3", false), "|1||3");
    assert_eq!(cells("\"1.5\",\"2\"", false), "1.5|2");
    assert_eq!(cells("\"1,5\", \"2,5\",\"\"", false), "1,5|2,5|");
}

#[test]
fn quotation_marks_are_those_of_rfc_4180() {
    let texts = |line: &str| {
        let texts = Separator::Character(',').parts(line, false).map(unquoted).collect::<Vec<_>>();
        texts.into_iter().map(|text| text.map_or_else(|| "?".to_owned(), Cow::into_owned)).collect::<Vec<_>>()
    };
    assert_eq!(texts(r#"a "b",2"#), [r#"a "b""#, "2"]);
    assert_eq!(texts(r#"5",7"#), [r#"5""#, "7"]);
    assert_eq!(texts(r#""a, ""b"", c", "" ,"""","x"#), [r#"a, "b", c"#, "", "\"", "?"]);
    assert_eq!(texts(r#""a" b,1"#), ["?", "1"]);
}

#[test]
fn lines_end_as_on_any_system() {
    for text in ["1\n\n2\n", "1\r\n\r\n2\r\n", "1\r\r2\r", "1\r\r\n\r\r\n2\r\r\n"] {
        assert_eq!(lines(text).collect::<Vec<_>>(), [(1, "1"), (3, "2")], "{text:?}");
    }
}

#[test]
fn a_first_line_for_spreadsheets_is_no_line_of_the_table() {
    for (text, mark) in [("sep=;\r\n1;2", ';'), ("\"SEP=,\"\n1;2", ','), ("sep=\t\n1;2", '\t')] {
        assert_eq!((stated_separator(text), lines(text).collect::<Vec<_>>()), (Some(mark), vec![(2, "1;2")]));
    }
    for text in ["sep=\n1", "sep=5 um\n1", "separator=;\n1", "1\nsep=;", "é", ""] {
        assert_eq!(stated_separator(text), None, "{text}");
    }
}

#[test]
fn blocks_begin_below_blank_lines_and_with_headers() {
    let kind = |text: &str| match text.chars().next() {
        Some('#') => Kind::Comment,
        Some('h') => Kind::Header,
        _ => Kind::Row,
    };
    for (text, expected) in [
        ("h\n\n# a\n\n1\n2\n# b\n3\n\n# end\n\nh\n", vec![]),
        ("1\n\n2\n3\nh\nh\n4\n", vec![(3, "below a blank line"), (5, "with a header")]),
        ("1\n\n# a\n\nh\n2\n\n\n3", vec![(3, "below a blank line"), (9, "below a blank line")]),
        ("", vec![]),
    ] {
        let found: Vec<_> = starts(lines(text), kind).map(|start| (start.line, start.sign)).collect();
        assert_eq!(found, expected, "{text}");
    }
}

/// The cells of names and rows, parted by bars, a line each.
fn table(text: &str) -> Result<Vec<String>, Fault> {
    let shown = |line: &Line<'_>| line.cells.iter().map(|cell| &cell.text[..]).collect::<Vec<_>>().join("|");
    let Some(table) = Named::of(text)? else { return Ok(Vec::new()) };
    let mut lines = vec![shown(&table.head)];
    for row in table.rows() {
        lines.push(shown(&row?));
    }
    Ok(lines)
}

#[test]
fn every_dialect_gives_the_same_table() {
    for text in [
        "# rig 2\nload [N],worn\n7.5 N,-1.25e-3\n# no\n,dry\n\n# end\n",
        "sep=;\r\nload [N];worn\r\n7,5 N;-1,25e-3\r\n;dry\r\n",
        "load [N];worn;\n7.5 N;-1.25e-3;\n;dry;\n",
        "\"load [N]\"\t\"worn\"\r\"7,5 N\"\t\"-1,25e-3\"\r\tdry\r",
    ] {
        assert_eq!(table(text).unwrap(), ["load [N]|worn", "7.5 N|-1.25e-3", "|dry"], "{text}");
    }
    assert_eq!(table("a,b\n\"x, \"\"y\"\"\",\"1,5\"\n").unwrap()[1], "x, \"y\"|1,5");
    assert_eq!(table("sep=;\n# nothing\n").unwrap(), [""; 0]);
}

#[test]
fn two_marks_two_tables_and_open_quotation_marks_are_refused_with_their_places() {
    let fault = |text: &str| {
        let Fault { line, column, message } = table(text).unwrap_err();
        format!("{line}:{column}: {message}")
    };
    let texts = [
        "time [s];normal_force [N]\n0;10,5\n3; 1.200\n",
        "a\tb\n1.5\t2\n1,5\t2\n",
        "a,b\n1,2\n\n3,4\n",
        "a,b\n1,2\n\n# more\na,b\n3,4\n",
        "a,b\n1,2\na,b\n3,4\n",
        "a,b\n1,\"2\n3\",4\n",
        "\"a,b\n1,2\n",
    ];
    insta::assert_snapshot!(texts.map(fault).join("\n"));
}
