//! X3P files of every kind that the standard allows, and damaged ones.

use std::io::{Cursor, Write};

use plateau_io::surface::x3p::{Surface, X3pError, read};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A description of `columns` x `rows` points; `data` stands after the matrix dimension.
fn main_xml(x: &str, y: &str, z: &str, size: [u64; 3], data: &str) -> String {
    let [columns, rows, layers] = size;
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">\
         <Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes><CX>{x}</CX><CY>{y}</CY>\
         <CZ>{z}</CZ></Axes></Record1>\
         <Record2><Instrument><Manufacturer>M&amp;M</Manufacturer><Model>not available</Model></Instrument></Record2>\
         <Record3><MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>{layers}</SizeZ></MatrixDimension>\
         {data}</Record3><Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>"
    )
}

/// An axis whose points are counted.
fn counted(increment: &str) -> String {
    format!("<AxisType>I</AxisType><Increment>{increment}</Increment><Offset>1e-3</Offset>")
}

/// An axis whose coordinates are stored.
fn stored(letter: &str, rest: &str) -> String {
    format!("<AxisType>A</AxisType><DataType>{letter}</DataType>{rest}")
}

const LINK: &str = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>";
const LINKS: &str = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>\
    <ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink>";

fn archive(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        archive.start_file(*name, options).unwrap();
        archive.write_all(content).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// The surface of a description and the binary files, and its checksum file.
fn surface(main: &str, binary: &[(&str, &[u8])]) -> Result<Surface, X3pError> {
    use md5::{Digest, Md5};
    let checksum = format!("{:x} *main.xml\n", Md5::digest(main.as_bytes()));
    let mut entries = vec![("main.xml", main.as_bytes())];
    entries.extend(binary);
    entries.push(("md5checksum.hex", checksum.as_bytes()));
    read(Cursor::new(archive(&entries)))
}

fn bytes<const SIZE: usize>(numbers: impl IntoIterator<Item = [u8; SIZE]>) -> Vec<u8> {
    numbers.into_iter().flatten().collect()
}

/// Three columns and two rows with the height 10 column + row.
const COLUMN_BY_COLUMN: [f64; 6] = [0.0, 1.0, 10.0, 11.0, 20.0, 21.0];
/// The same in the order of the file, x growing fastest.
const PROFILES: [f64; 6] = [0.0, 10.0, 20.0, 1.0, 11.0, 21.0];

#[test]
fn all_types_with_increment_and_offset() {
    let scale = "<Increment>0.5</Increment><Offset>3</Offset>";
    let expected = COLUMN_BY_COLUMN.map(|height| height * 0.5 + 3.0);
    for (letter, data) in [
        ("I", bytes(PROFILES.map(|z| (z as i16).to_le_bytes()))),
        ("L", bytes(PROFILES.map(|z| (z as i32).to_le_bytes()))),
        ("F", bytes(PROFILES.map(|z| (z as f32).to_le_bytes()))),
        ("D", bytes(PROFILES.map(f64::to_le_bytes))),
    ] {
        let main = main_xml(&counted("1e-6"), &counted("2e-6"), &stored(letter, scale), [3, 2, 1], LINK);
        let found = surface(&main, &[("bindata/data.bin", &data)]).unwrap();
        assert_eq!((found.patch.columns, found.patch.rows), (3, 2));
        assert_eq!((found.patch.column_pitch, found.patch.row_pitch), (1e-6, 2e-6));
        assert_eq!(found.patch.heights, expected, "{letter}");
        assert_eq!(found.warnings, [""; 0]);
        let note = "heights are the stored numbers times the increment of the z axis, 5e-1 m";
        assert_eq!(found.notes, ["instrument M&M", note]);
    }
    // Signed: the smallest number is a height as any other.
    let main = main_xml(&counted("1"), &counted("1"), &stored("I", ""), [2, 1, 1], LINK);
    let found = surface(&main, &[("bindata/data.bin", &bytes([i16::MIN, -1].map(i16::to_le_bytes)))]).unwrap();
    assert_eq!(found.patch.heights, [-32768.0, -1.0]);
}

#[test]
fn missing_points_are_nan_or_marked() {
    let data = bytes([0.0, f64::NAN, 20.0, 1.0, 11.0, f64::INFINITY].map(f64::to_le_bytes));
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [3, 2, 1], LINKS);
    // Point 3 (column 0, row 1) is marked as invalid. The infinite one is a mark of Alicona's instruments.
    let valid = [0b0011_0111];
    let binary = |data| [("bindata/data.bin", data), ("bindata/valid.bin", valid.as_slice())];
    let found = surface(&main, &binary(data.as_slice())).unwrap();
    let missing: Vec<usize> = (0..6).filter(|index| found.patch.heights[*index].is_nan()).collect();
    // Column by column: (0, 1), (1, 0) and (2, 1).
    assert_eq!(missing, [1, 2, 5]);
    assert_eq!(found.patch.heights[3..5], [11.0, 20.0]);
    assert_eq!(found.notes, ["instrument M&M", "1 missing points are stored as +inf"]);
    // No point is infinitely deep, and none too high for a number.
    let mut numbers = [0.0, f64::NAN, 20.0, 1.0, 11.0, f64::NEG_INFINITY];
    for (last, increment, expected) in [(f64::NEG_INFINITY, "1", "-inf"), (1e300, "1e10", "inf")] {
        numbers[5] = last;
        let z = stored("D", &format!("<Increment>{increment}</Increment>"));
        let main = main_xml(&counted("1"), &counted("1"), &z, [3, 2, 1], LINKS);
        let data = bytes(numbers.map(f64::to_le_bytes));
        let binary = [("bindata/data.bin", &data[..]), ("bindata/valid.bin", &valid)];
        let found = surface(&main, &binary).unwrap_err().to_string();
        assert!(
            found.starts_with(&format!("the point (column 2, row 1) has {expected}, expected a finite")),
            "{found}"
        );
    }
}

#[test]
fn an_infinite_coordinate_of_a_decimal_axis_marks_a_missing_point() {
    let xyz = |x: f32, z: f32| [x.to_le_bytes(), z.to_le_bytes()].concat();
    let data: Vec<u8> = [xyz(5.0, 0.0), xyz(f32::INFINITY, 10.0), xyz(6.0, f32::INFINITY), xyz(6.5, 30.0)].concat();
    let main = main_xml(&stored("F", ""), &counted("1"), &stored("F", ""), [4, 1, 1], LINK);
    let found = surface(&main, &[("bindata/data.bin", &data)]).unwrap().patch;
    assert_eq!(found.column_pitch, 0.5);
    let missing: Vec<bool> = found.heights.iter().map(|height| height.is_nan()).collect();
    assert_eq!(missing, [false, true, true, false]);
    // In the text, too: xs:double of XML Schema writes it INF.
    let list = |point: &str| {
        let data = format!("<DataList><Datum>1</Datum><Datum>{point}</Datum></DataList>");
        surface(&main_xml(&counted("1"), &counted("1"), &stored("D", ""), [2, 1, 1], &data), &[])
    };
    assert!(list("INF").unwrap().patch.heights[1].is_nan());
    assert!(list("1e400").unwrap_err().to_string().contains("found the coordinate \"1e400\", expected a number"));
}

#[test]
fn a_packed_folder_is_read() {
    let main = main_xml(&counted("1e-6"), &counted("2e-6"), &stored("D", ""), [3, 2, 1], LINK);
    let data = bytes(PROFILES.map(f64::to_le_bytes));
    let named = |folder: &str| {
        let names = ["main.xml", "bindata/data.bin", "md5checksum.hex"].map(|name| format!("{folder}{name}"));
        let contents = [main.as_bytes(), &data, b"0123 *main.xml\n"];
        names.into_iter().zip(contents.map(<[u8]>::to_vec)).collect::<Vec<_>>()
    };
    let read_all = |entries: &[(String, Vec<u8>)]| {
        let entries: Vec<(&str, &[u8])> = entries.iter().map(|(name, content)| (name.as_str(), &content[..])).collect();
        read(Cursor::new(archive(&entries)))
    };
    let found = read_all(&named("scan-1/")).unwrap();
    assert_eq!(found.patch.heights, COLUMN_BY_COLUMN);
    assert!(found.warnings[0].contains("but md5checksum.hex says 0123"), "{:?}", found.warnings);
    // What stands at the top is the surface, whatever folders there are; of two folders nobody can tell.
    let found = read_all(&[named(""), named("copy/")].concat()).unwrap();
    assert_eq!(found.patch.heights, COLUMN_BY_COLUMN);
    let error = read_all(&[named("scan-1/"), named("scan-2/")].concat()).unwrap_err().to_string();
    assert_eq!(
        error,
        "the archive has \"scan-1/main.xml\" and \"scan-2/main.xml\", expected one surface: pack one of the folders alone"
    );
}

#[test]
fn only_elements_that_are_used_must_not_say_two_things() {
    let data = bytes(PROFILES.map(f64::to_le_bytes));
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [3, 2, 1], LINK);
    let read = |from: &str, to: &str| {
        assert!(main.contains(from));
        surface(&main.replacen(from, to, 1), &[("bindata/data.bin", &data)]).map(|found| found.patch.heights)
    };
    let revisions = "<Revision>ISO5436 - 2000</Revision>";
    let twice = "<Revision>ISO5436 - 2000</Revision><Revision>ISO25178</Revision><Note>a</Note><Note>b</Note>";
    assert_eq!(read(revisions, twice).unwrap(), COLUMN_BY_COLUMN);
    assert_eq!(read("<SizeX>3</SizeX>", "<SizeX>3</SizeX><SizeX>3</SizeX>").unwrap(), COLUMN_BY_COLUMN);
    let error = read("<SizeX>3</SizeX>", "<SizeX>3</SizeX><SizeX>2</SizeX>").unwrap_err().to_string();
    assert!(error.contains("Record3/MatrixDimension/SizeX stands twice, as \"3\" and \"2\""), "{error}");
}

#[test]
fn points_in_the_text() {
    let list = |letter: &str, points: &str| {
        let data = format!("<DataList>{points}</DataList>");
        let z = stored(letter, "<Increment>2</Increment>");
        surface(&main_xml(&counted("1"), &counted("1"), &z, [3, 2, 1], &data), &[])
    };
    let points = "<Datum>0</Datum><Datum> 10 </Datum><Datum/><Datum>1</Datum><Datum></Datum><Datum>21</Datum>";
    for letter in ["I", "L", "F", "D"] {
        let heights = list(letter, points).unwrap().patch.heights;
        assert!(heights[3].is_nan() && heights[4].is_nan());
        assert_eq!((heights[0], heights[1], heights[2], heights[5]), (0.0, 2.0, 20.0, 42.0));
    }
    let half = points.replace("21", "0.5");
    assert_eq!(list("D", &half).unwrap().patch.heights[5], 1.0);
    let message = |letter, points: &str| list(letter, points).unwrap_err().to_string();
    assert_eq!(message("I", &half), "the point (column 2, row 1) has 0.5, expected an int16 number");
    assert_eq!(
        message("I", &points.replace("21", "32768")),
        "the point (column 2, row 1) has 32768, expected an int16 number"
    );
    assert_eq!(
        message("D", "<Datum>1</Datum>"),
        "main.xml: the DataList has 1 numbers, expected 6 for 3 x 2 points of 8 bytes"
    );
    assert!(message("D", "<Datum>1;2;3</Datum>").contains("found a point of 3 coordinates, expected 1"));
    assert!(message("D", "<Datum>one</Datum>").contains("found the coordinate \"one\", expected a number"));
}

#[test]
fn absolute_axes_are_read_if_they_are_a_regular_grid() {
    let xs = [5.0, 5.5, 6.0];
    let points = |shift: f64| {
        let point = |(index, z): (usize, &f64)| [xs[index % 3] + if index == 4 { shift } else { 0.0 }, *z];
        bytes(PROFILES.iter().enumerate().flat_map(point).map(|number| (number as f32).to_le_bytes()))
    };
    let x = stored("F", "");
    let main = main_xml(&x, &counted("0.25"), &stored("F", ""), [3, 2, 1], LINK);
    let found = surface(&main, &[("bindata/data.bin", &points(0.0))]).unwrap().patch;
    assert_eq!((found.column_pitch, found.row_pitch), (0.5, 0.25));
    assert_eq!(found.heights, COLUMN_BY_COLUMN);
    let error = surface(&main, &[("bindata/data.bin", &points(0.01))]).unwrap_err().to_string();
    assert!(
        error.starts_with("the x coordinates are not equidistant: number 1 is 5.51")
            && error.contains("expected 5.5 m"),
        "{error}"
    );
    // In the text, along both axes.
    let datums: String =
        PROFILES.iter().enumerate().map(|(i, z)| format!("<Datum>{};{};{z}</Datum>", i % 3, 2 * (i / 3))).collect();
    let (x, y) = (stored("L", "<Increment>0.1</Increment>"), stored("D", ""));
    let main = main_xml(&x, &y, &stored("D", ""), [3, 2, 1], &format!("<DataList>{datums}</DataList>"));
    let found = surface(&main, &[]).unwrap().patch;
    assert_eq!((found.column_pitch, found.row_pitch, found.heights), (0.1, 2.0, COLUMN_BY_COLUMN.to_vec()));
}

#[test]
fn checksums_that_do_not_fit_are_warnings() {
    let data = bytes(PROFILES.map(f64::to_le_bytes));
    let digest = "<MD5ChecksumPointData>00112233445566778899AABBCCDDEEFF</MD5ChecksumPointData></DataLink>";
    let link = LINK.replace("</DataLink>", digest);
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [3, 2, 1], &link);
    let entries =
        [("main.xml", main.as_bytes()), ("bindata/data.bin", &data), ("md5checksum.hex", b"0123 *main.xml\n")];
    let found = read(Cursor::new(archive(&entries))).unwrap();
    assert_eq!(found.patch.heights, COLUMN_BY_COLUMN);
    assert_eq!(found.warnings.len(), 2);
    assert!(
        found.warnings[0].starts_with("the MD5 checksum of bindata/data.bin is ")
            && found.warnings[0].ends_with("but main.xml says 00112233445566778899aabbccddeeff: it was changed"),
        "{:?}",
        found.warnings
    );
    assert!(found.warnings[1].ends_with("but md5checksum.hex says 0123: it was changed"), "{:?}", found.warnings);
    let found = read(Cursor::new(archive(&entries[..2]))).unwrap();
    assert_eq!(
        found.warnings[1],
        "the checksum of main.xml is not compared: the archive has no entry \"md5checksum.hex\"; it has main.xml, \
         bindata/data.bin"
    );
}

#[test]
fn what_is_not_one_layer_of_heights_on_a_regular_grid_is_refused() {
    let data = bytes(PROFILES.map(f64::to_le_bytes));
    let good = main_xml(&counted("1e-6"), &counted("2e-6"), &stored("D", ""), [3, 2, 1], LINK);
    let message = |from: &str, to: &str| {
        let main = good.replacen(from, to, 1);
        assert_ne!(main, good);
        surface(&main, &[("bindata/data.bin", &data)]).unwrap_err().to_string()
    };
    assert!(surface(&good, &[("bindata/data.bin", &data)]).is_ok());
    let changes = [
        ("SUR", "PCL"),
        ("<FeatureType>SUR</FeatureType>", ""),
        ("<SizeZ>1", "<SizeZ>2"),
        ("<SizeX>3", "<SizeX>0"),
        ("<SizeX>3", "<SizeX>-3"),
        ("<SizeX>3", "<SizeX>2147483648"),
        ("<SizeX>3", "<SizeX>99999999999999999999"),
        ("<SizeX>3</SizeX><SizeY>2</SizeY>", "<SizeX>4294967296</SizeX><SizeY>4294967296</SizeY>"),
        ("<SizeX>3</SizeX>", "<SizeX>3</SizeX><SizeX>2</SizeX>"),
        ("<Increment>1e-6", "<Increment>0"),
        ("<Increment>1e-6", "<Increment>-1e-6"),
        ("<Increment>1e-6", "<Increment>NaN"),
        ("<Increment>1e-6", "<Increment>1e-6 m"),
        ("<Offset>1e-3", "<Offset>inf"),
        ("<DataType>D", "<DataType>Q"),
        ("<DataType>D</DataType>", "<DataType>D</DataType><Increment>inf</Increment>"),
        ("<DataType>D</DataType>", "<DataType>D</DataType><Increment>1e308</Increment>"),
        ("<DataType>D", "<DataType>F"),
        ("<CZ><AxisType>A", "<CZ><AxisType>I"),
        ("<CX><AxisType>I", "<CX><AxisType>X"),
        ("bindata/data.bin", "../../etc/passwd"),
        ("<PointDataLink>bindata/data.bin</PointDataLink>", ""),
        ("<?xml version=\"1.0\" encoding=\"UTF-8\"?>", "<!DOCTYPE a [<!ENTITY b \"1\"><!ENTITY c \"&b;&b;\">]>"),
        ("<SizeX>3", "<SizeX>&c;"),
        ("<SizeX>3", "<SizeX>&#x110000;"),
        ("</Record3>", ""),
        ("</p:ISO5436_2>", ""),
        ("<Record1>", "<Record1>\u{0}<"),
    ];
    let mut text = String::new();
    for (from, to) in changes {
        text.push_str(&format!("{from} -> {to}\n    {}\n", message(from, to)));
    }
    let nested = format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000));
    text.push_str(&format!(
        "100000 elements in each other\n    {}\n",
        message("<Record1>", &format!("{nested}<Record1>"))
    ));
    insta::assert_snapshot!(text);
}

#[test]
fn archives_that_unpack_to_more_than_heights_do_are_refused() {
    // 100 MB of zeros pack to 0.1 MB.
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [5000, 2500, 1], LINK);
    let found = surface(&main, &[("bindata/data.bin", &vec![0; 100_000_000])]).unwrap_err().to_string();
    assert!(
        found.starts_with("bindata/data.bin unpacks ")
            && found.ends_with("to 100000000, which no measured surface does; the file is not read"),
        "{found}"
    );
    let spaces = format!("{}{main}", " ".repeat(100_000_000));
    let found = surface(&spaces, &[]).unwrap_err().to_string();
    assert!(found.starts_with("main.xml unpacks "), "{found}");
    // A small one is read whatever it was packed to: it may be flat.
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [1000, 1000, 1], LINK);
    assert_eq!(surface(&main, &[("bindata/data.bin", &vec![0; 8_000_000])]).unwrap().patch.missing(), 0);
    // An entry that says it is smaller than it is.
    let data = vec![7; 800];
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [5, 10, 1], LINK);
    let mut file = archive(&[("main.xml", main.as_bytes()), ("bindata/data.bin", &data)]);
    for at in 0..file.len() - 4 {
        if file[at..at + 4] == 800_u32.to_le_bytes() {
            file[at..at + 4].copy_from_slice(&400_u32.to_le_bytes());
        }
    }
    let found = read(Cursor::new(file)).unwrap_err().to_string();
    assert!(found.starts_with("bindata/data.bin cannot be unpacked: "), "{found}");
}

#[test]
fn truncation_anywhere_is_an_error() {
    let main = main_xml(&counted("1"), &counted("1"), &stored("D", ""), [3, 2, 1], LINK);
    let data = bytes(PROFILES.map(f64::to_le_bytes));
    let whole =
        archive(&[("main.xml", main.as_bytes()), ("bindata/data.bin", &data), ("md5checksum.hex", b"0 *main.xml")]);
    assert!(read(Cursor::new(&whole)).is_ok());
    for length in 0..whole.len() {
        assert!(read(Cursor::new(&whole[..length])).is_err(), "{length} of {} bytes", whole.len());
    }
}
