//! What differs between the dialects of SDF, and their damaged files.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use plateau_core::surface::Patch;
use plateau_io::surface::sdf;

use crate::few_or_all;
use crate::sdf::read;

fn text(dialect: &str, fields: &str, data: &str) -> String {
    format!(
        "a{dialect}\nManufacID = test\nCreateDate = 010120260000\nModDate = 010120260000\nNumPoints = 3\nNumProfiles = 2\n\
         Xscale = 1e-6\nYscale = 2e-6\nZscale = 0.5\nZresolution = -1\n{fields}*\n{data}\n*\n*\n"
    )
}

const INT16: &str = "Compression = 0\nDataType = 5\nCheckType = 0\n";

/// A binary file of int16 heights.
fn binary(dialect: &str, points: u32, profiles: u32, heights: &[i16], trailer: &[u8]) -> Vec<u8> {
    let mut file = format!("b{dialect}{:10}{:12}{:12}", "test", "010120260000", "010120260000").into_bytes();
    for count in [points, profiles] {
        file.extend(&count.to_le_bytes()[..if dialect == "ISO-2.0" { 4 } else { 2 }]);
    }
    for real in [1e-6, 2e-6, 0.5, -1.0_f64] {
        file.extend(real.to_le_bytes());
    }
    file.extend([0, 5, 0]);
    file.extend(heights.iter().flat_map(|height| height.to_le_bytes()));
    file.extend(trailer);
    file
}

#[test]
fn the_first_profile_has_the_smallest_y_but_in_bcr() {
    // y grows from profile to profile in ISO 25178-71; MountainsMap and sdfio take the first profile of a BCR-1.0 file
    // for the one with the largest y.
    for (dialect, expected) in [
        ("ISO-1.0", [0.5, 2.0, 1.0, 2.5, 1.5, 3.0]),
        ("ISO-2.0", [0.5, 2.0, 1.0, 2.5, 1.5, 3.0]),
        ("BCR-1.0", [2.0, 0.5, 2.5, 1.0, 3.0, 1.5]),
    ] {
        let ascii = read(text(dialect, INT16, "1 2 3\n4 5 6").as_bytes()).unwrap();
        let binary = read(&binary(dialect, 3, 2, &[1, 2, 3, 4, 5, 6], b"")).unwrap();
        assert_eq!(ascii, binary);
        assert_eq!((ascii.columns, ascii.rows, ascii.heights), (3, 2, expected.to_vec()), "{dialect}");
    }
}

#[test]
fn the_mark_of_a_missing_point_is_the_smallest_number_and_in_bcr_the_largest() {
    let marks = [i16::MIN, i16::MAX, 0, 0, 0, 0];
    for (dialect, missing, other) in [("ISO-1.0", 0, 1), ("ISO-2.0", 0, 1), ("BCR-1.0", 1, 0)] {
        let heights = read(&binary(dialect, 6, 1, &marks, b"")).unwrap().heights;
        assert!(heights[missing].is_nan(), "{dialect}");
        assert_eq!(heights[other], 0.5 * f64::from(marks[other]));
    }
    // In the text of ISO 25178-71 only BAD is missing; BCR-1.0 has no such word but is read with it.
    let iso = read(text("ISO-1.0", INT16, "-32768 32767 BAD 0 0 0").as_bytes()).unwrap().heights;
    assert!(iso[0] == -16384.0 && iso[2] == 16383.5 && iso[4].is_nan());
    let bcr = read(text("BCR-1.0", INT16, "-32768 32767 BAD 0 0 0").as_bytes()).unwrap().heights;
    assert!(bcr[1] == -16384.0 && bcr[3].is_nan() && bcr[5].is_nan());
    // Real numbers of BCR-1.0 are missing from a little below the largest on.
    for (code, mark) in [("3", "3.4e38"), ("7", "1.7e308"), ("7", "1.79e308")] {
        let fields = INT16.replace('5', code);
        let heights = read(text("BCR-1.0", &fields, &format!("{mark} 0 0 0 0 0")).as_bytes()).unwrap().heights;
        assert_eq!(heights.iter().filter(|height| height.is_nan()).count(), 1, "{mark}");
    }
}

#[test]
fn bcr_has_comments_and_words_and_line_ends_of_its_own() {
    let plain = read(text("BCR-1.0", INT16, "1 2 3\n4 5 6").as_bytes()).unwrap();
    let words = "Compression = NULL ; none\nDataType = INTEGER\nCheckType = none\n";
    let with_words = text("BCR-1.0 ; comment", words, "1 2 3 ; 7 8 9\n; *\n4 5 6;");
    for file in [
        with_words.clone(),
        with_words.replace('\n', "\r"),
        with_words.replace('\n', "\r\n"),
        with_words.replacen('a', "A", 1),
    ] {
        assert_eq!(read(file.as_bytes()).unwrap(), plain);
    }
    // ISO 25178-71 has neither.
    let found = read(text("ISO-1.0", words, "1 2 3 4 5 6").as_bytes()).unwrap_err().to_string();
    assert_eq!(found, "line 11: Compression is \"NULL ; none\", expected a whole number");
    let found = read(text("ISO-1.0", INT16, "1 2 3 4 5 6 ; 7").as_bytes()).unwrap_err().to_string();
    assert_eq!(found, "line 15: more heights than NumPoints x NumProfiles = 3 x 2");
}

#[test]
fn bytes_after_the_heights_that_are_no_text_are_a_warning() {
    let warnings = |trailer: &[u8]| {
        let file = binary("ISO-1.0", 3, 2, &[1, 2, 3, 4, 5, 6], trailer);
        sdf::read(file.as_slice(), file.len() as u64).unwrap().warnings
    };
    assert_eq!(warnings(b""), [""; 0]);
    assert_eq!(warnings("Operator = Jörg\r\n\0\0\0".as_bytes()), [""; 0]);
    assert_eq!(
        warnings(b"a\x01\x02"),
        ["the 3 bytes after the heights are not text (byte 94): do NumPoints, NumProfiles and DataType fit the data?"]
    );
}

#[test]
fn damaged_files_are_errors_that_say_where() {
    let mut found = String::new();
    let mut refuse = |what: &str, content: &[u8]| {
        found.push_str(&format!("{what}\n    {}\n", read(content).unwrap_err()));
    };
    let six = [1, 2, 3, 4, 5, 6];
    refuse("2^31 points", &binary("ISO-2.0", 1 << 31, 1, &six, b""));
    refuse("2^32 - 1 by 2^32 - 1 points", &binary("ISO-2.0", u32::MAX, u32::MAX, &six, b""));
    refuse("0 profiles", &binary("ISO-2.0", 3, 0, &six, b""));
    refuse("one height less", &binary("BCR-1.0", 3, 2, &six[..5], b""));
    refuse("half of a header", &binary("ISO-2.0", 3, 2, &six, b"")[..60]);
    let good = binary("ISO-2.0", 3, 2, &six, b"");
    for (what, at, bytes) in [
        ("Xscale NaN", 50, f64::NAN.to_le_bytes().to_vec()),
        ("Zscale infinite", 66, f64::INFINITY.to_le_bytes().to_vec()),
        ("compressed", 82, vec![1]),
        ("unsigned", 83, vec![1]),
        ("unknown type", 83, vec![8]),
        ("checked", 84, vec![1]),
        ("another version", 5, b"3.0".to_vec()),
    ] {
        let mut content = good.clone();
        content.splice(at..at + bytes.len(), bytes);
        refuse(what, &content);
    }
    let data = "1 2 3\n4 5 6";
    refuse("compressed in words", text("BCR-1.0", &INT16.replacen('0', "RLL", 1), data).as_bytes());
    refuse("a word that is none", text("BCR-1.0", &INT16.replace('5', "WORD"), data).as_bytes());
    refuse("uint8 beyond", text("BCR-1.0", &INT16.replace('5', "UCHAR"), "1 2 3 4 5 256").as_bytes());
    refuse("uint8 in ISO", text("ISO-2.0", &INT16.replace('5', "0"), data).as_bytes());
    refuse("2^31 points", text("ISO-2.0", INT16, data).replace("NumPoints = 3", "NumPoints = 2147483648").as_bytes());
    refuse("1e20 points", text("ISO-2.0", INT16, data).replace("NumPoints = 3", "NumPoints = 1e20").as_bytes());
    refuse("infinite height", text("ISO-2.0", &INT16.replace('5', "7"), "inf 2 3 4 5 6").as_bytes());
    refuse("a word of 100 kB", text("ISO-2.0", INT16, &"7".repeat(100_000)).as_bytes());
    refuse(
        "a thousand fields",
        text("ISO-2.0", &(0..1000).map(|i| format!("F{i} = 1\n")).collect::<String>(), data).as_bytes(),
    );
    refuse("no data", text("ISO-2.0", INT16, "").as_bytes());
    refuse("no end", text("ISO-2.0", INT16, data).trim_end_matches(['*', '\n']).as_bytes());
    refuse("nothing", b"");
    insta::assert_snapshot!(found);
}

/// SDF files of a folder of `tests`.
fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "sdf")).collect()
}

#[test]
fn truncation_at_any_byte_is_an_error_or_only_costs_the_trailer() {
    // Every byte of the head, and in the short form every seventh of what follows.
    let step = few_or_all(7, 1);
    let samples: Vec<PathBuf> = files("surfaces").into_iter().chain(files("corpus/surfaces")).collect();
    assert!(samples.len() > 60);
    let bits = |patch: Patch| patch.heights.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    thread::scope(|scope| {
        for part in samples.chunks(samples.len().div_ceil(4)) {
            scope.spawn(move || {
                for path in part {
                    let content = fs::read(path).unwrap();
                    let whole = bits(read(&content).unwrap());
                    // From the first length on that gives the heights, every longer one does.
                    let mut enough = false;
                    let all = 0..=content.len();
                    for length in all.filter(|length| *length < 200 || (content.len() - length).is_multiple_of(step)) {
                        match read(&content[..length]) {
                            Ok(patch) => {
                                assert!(bits(patch) == whole, "{} at {length}", path.display());
                                enough = true;
                            }
                            Err(error) => assert!(!enough, "{} at {length}: {error}", path.display()),
                        }
                    }
                    assert!(enough);
                }
            });
        }
    });
}
