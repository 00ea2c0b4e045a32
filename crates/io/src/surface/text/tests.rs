//! Matrices and lists as programs write them, and what is refused.

use super::*;

fn options(unit: Option<f64>, pitch: Option<[f64; 2]>) -> ReadOptions {
    ReadOptions { unit, pitch, ..ReadOptions::default() }
}

fn um(text: &str) -> Result<Table, TextError> {
    read(text.as_bytes(), false, &options(Some(1e-6), None))
}

/// Heights line by line in µm, "-" where missing.
fn shape(table: &Table) -> String {
    let line = |row: usize| {
        let cell = |column: usize| match table.heights[column * table.rows + row] {
            height if height.is_nan() => "-".to_owned(),
            height => format!("{}", (height * 1e6).round()),
        };
        (0..table.columns).map(cell).collect::<Vec<_>>().join(" ")
    };
    (0..table.rows).map(line).collect::<Vec<_>>().join("/")
}

fn error(text: &str) -> String {
    um(text).unwrap_err().to_string()
}

#[test]
fn a_matrix_in_every_spelling() {
    for text in [
        "1 2\n3 4\n5 6",
        "1 2\r\n3 4\r\n5 6\r\n",
        "1 2\r3 4\r5 6\r",
        "\u{feff}1,2\n3,4\n5,6\n\n",
        "  1   2 \n\n 3 4\n5 6\n",
        "1;2;\n3;4;\n5;6;\n",
        "1\t2\t\n3\t4\t\n5\t6\t\n",
        "# a comment\n1, 2\n# another\n3, 4\n5, 6",
        "\"1\",\"2\"\n\"3\",\"4\"\n\"5\",\"6\"",
        "note: measured on Monday\ncolumns = 2\nrows = 3\n1 2\n3 4\n5 6",
    ] {
        let table = um(text).unwrap();
        assert_eq!((table.columns, table.rows, shape(&table).as_str()), (2, 3, "1 2/3 4/5 6"), "{text:?}");
        assert_eq!(table.pitch, None);
    }
}

#[test]
fn missing_points_in_every_spelling() {
    for text in [
        "1,,3,4\nNaN,6,7,8",
        "1\t\t3\t4\n\t6\t7\t8",
        "1 BAD 3 4\n*** 6 7 8",
        "1;nan;3;4\n;6;7;8",
        "1 -- 3 4\nbad 6 7 8",
    ] {
        assert_eq!(shape(&um(text).unwrap()), "1 - 3 4/- 6 7 8", "{text:?}");
    }
    assert_eq!(shape(&um("1,2,\n3,4,5").unwrap()), "1 2 -/3 4 5");
    assert_eq!(shape(&um("NaN NaN\n1 2").unwrap()), "- -/1 2");
}

#[test]
fn a_list_in_any_order_with_holes() {
    // 3 x 2 points, x in steps of 2, y in steps of 5; (4, 5) is not there.
    let points = ["0 0 1", "2 0 2", "4 0 3", "0 5 4", "2 5 5"];
    let mut shuffled = points;
    shuffled.swap(0, 3);
    shuffled.swap(1, 4);
    for lines in [points, shuffled] {
        for text in [lines.join("\n"), format!("x y z\n{}", lines.join("\n")), lines.join("\n").replace(' ', ";")] {
            let table = um(&text).unwrap();
            assert_eq!(shape(&table), "1 2 3/4 5 -", "{text}");
            let [x, y] = table.pitch.unwrap();
            assert!((x - 2e-6).abs() < 1e-20 && (y - 5e-6).abs() < 1e-20, "{x} {y}");
        }
    }
    let other = read(points.join("\n").as_bytes(), true, &options(Some(1e-6), Some([1e-3, 2e-3]))).unwrap();
    assert_eq!((shape(&other).as_str(), other.pitch), ("1 2 3/4 5 -", Some([1e-3, 2e-3])));
    let intensity = points.map(|point| format!("{point} 255")).join("\n");
    assert_eq!(shape(&read(intensity.as_bytes(), true, &options(Some(1e-6), None)).unwrap()), "1 2 3/4 5 -");
    let pairs = read(b"1 2\n3 4\n", true, &options(Some(1e-6), None)).unwrap_err().to_string();
    assert_eq!(pairs, "line 1 has 2 numbers, expected 3 as in line 1");
    // Rounded coordinates, a whole grid line that is not there, other columns, units of their own.
    let named = "x [mm], i, y [mm], z [um]\n0.333,9,1,1\n0.667,9,1,2\n1.333,9,1,4\n0.333,9,2,5\n1.333,9,2,8";
    let table = read(named.as_bytes(), false, &options(None, None)).unwrap();
    assert_eq!(shape(&table), "1 2 - 4/5 - - 8");
    let [x, y] = table.pitch.unwrap();
    assert!((x - 1e-3 / 3.0).abs() < 1e-9 && (y - 1e-3).abs() < 1e-15, "{x} {y}");
}

#[test]
fn three_columns_that_are_no_grid_are_a_matrix_if_they_are_few() {
    let table = um("1 2 3\n4 5 6\n7 8 9\n10 11 12").unwrap();
    assert_eq!(shape(&table), "1 2 3/4 5 6/7 8 9/10 11 12");
    assert_eq!(table.warnings.len(), 1);
    let flat = um("0 0 0\n0 0 0\n0 0 0\n0 0 0").unwrap();
    assert_eq!((flat.columns, flat.rows), (3, 4));
    let cloud: Vec<String> = (0..200).map(|i| format!("{} {} 1", (i as f64).sin(), (i as f64).cos())).collect();
    assert!(error(&cloud.join("\n")).starts_with("200 lines of three numbers, the first two on no grid"));
}

#[test]
fn what_the_header_states_needs_no_scene_and_must_not_contradict_it() {
    let text = "# unit: nm\n# pitch: 50 um\n1000 2000\n3000 4000";
    let read = |unit, pitch| read(text.as_bytes(), false, &options(unit, pitch));
    for table in [read(None, None), read(Some(1e-9), Some([50e-6; 2]))] {
        let table = table.unwrap();
        assert_eq!((shape(&table).as_str(), table.pitch), ("1 2/3 4", Some([50e-6; 2])));
    }
    assert_eq!(
        read(Some(1e-6), None).unwrap_err().to_string(),
        "the file states a unit of 1 nm, the scene 1 um: leave out unit (pixel and scale in the prepare table read a file \
         differently than it says)"
    );
    assert!(read(None, Some([50e-6, 60e-6])).unwrap_err().to_string().starts_with("the file states a pitch of 50 um"));
    let latin = b"# Width: 2 \xb5m\n# Height: 4 \xb5m\n# Value units: \xb5m\n1 2\n3 4";
    let table = super::read(latin, false, &ReadOptions::default()).unwrap();
    assert_eq!((shape(&table).as_str(), table.pitch), ("1 2/3 4", Some([1e-6, 2e-6])));
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    assert_eq!(error("1 2\n\n3 4 5\n"), "line 3 has 3 numbers, expected 2 as in line 1");
    assert_eq!(error("1 2\n3 4a\n").split(',').take(2).collect::<String>(), "line 2 column 2: found \"4a\"");
    assert_eq!(error("1,5;2\n3;4"), "line 1, column 1: \"1,5\" has a decimal comma, expected a decimal point");
    assert_eq!(error("1\t2,5"), "line 1, column 2: \"2,5\" has a decimal comma, expected a decimal point");
    assert!(error("1,5 2,5\n").starts_with("line 1, column 2: found \"5 2\", expected a number with a decimal point"));
    assert!(error("1 inf\n").starts_with("line 1, column 2: inf is not finite"));
    assert!(error("1 1e999\n").starts_with("line 1, column 2: 1e999 is not finite"));
    assert_eq!(error("columns=3\n1 2\n"), "the header states 3 columns, but the file has 2");
    assert_eq!(error("rows=3\n1 2\n"), "the header states 3 rows, but the file has 1");
    assert!(error("hello\n1 2\n").starts_with("line 1: found \"hello\", expected numbers, a comment (#)"));
    assert_eq!(error("# only words 1\n"), "the file has no line of numbers");
    assert_eq!(error("x y z\n1 2\n"), "line 2 has 2 numbers, expected 3 as in line 1");
    assert_eq!(error("x y z\n0 0 1\n1 0 1\n"), "all points have the same y, expected a surface");
    assert_eq!(error("x y z\n0 0 1\n1 0 1\n0 1 1\n1 0 1\n"), "line 5 has the same x and y as line 3");
    assert!(error("x y z\n0 0 1\nNaN 0 1\n").starts_with("line 3, column 1: found \"NaN\", expected a number"));
    assert_eq!(
        error("x y z\n0 0 1\n1 0 1\n2.3 0 1\n3 0 1\n0 1 1\n1 1 1\n2.3 1 1\n3 1 1"),
        "line 4: x = 2.3 lies off the regular grid from 0 in steps of 1"
    );
    let diagonal: Vec<String> = (0..100).map(|i| format!("{i} {i} 1")).collect();
    assert_eq!(
        error(&format!("x y z\n{}", diagonal.join("\n"))),
        "the 100 points lie on a grid of 100 x 100, which they hardly fill: expected a regular grid"
    );
    assert!(read(b"1 2\n3 4", false, &ReadOptions::default()).unwrap_err().to_string().contains("unit = \"um\""));
    assert_eq!(read(b"\xff\xfe1\0", false, &ReadOptions::default()).unwrap_err(), TextError::Utf16);
}

#[test]
fn an_absurd_unit_gives_no_infinite_heights() {
    let found = read(b"1e300 1\n1 2", false, &options(Some(1e300), None)).unwrap_err();
    assert!(found.to_string().contains("a height of inf m is not finite"), "{found}");
}

#[test]
fn a_file_cut_anywhere_gets_an_answer() {
    let list = "\u{feff}# unit: um\r\nx [mm];y [mm];z\r\n0;0;1\r\n1;0;2\r\n0;1;\r\n1;1;NaN\r\n";
    let matrix = "h=2 w=3\npixel size=1e-6 m\nheight conversion factor (-> m)=1e-9\n1 2 3\n4 5 6\n";
    for content in [list.as_bytes(), matrix.as_bytes()] {
        for length in 0..content.len() {
            let _ = read(&content[..length], false, &options(None, None));
            let mut damaged = content.to_vec();
            damaged[length] ^= 0x15;
            let _ = read(&damaged, true, &options(Some(1e-6), None));
        }
        assert!(read(content, false, &options(None, None)).is_ok());
    }
}
