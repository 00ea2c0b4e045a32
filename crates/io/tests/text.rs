//! Tables of numbers as programs write them, and what of them is refused.

mod dialect;
mod header;
mod spacing;

use std::fs;

use plateau_io::surface::{Decimal, FileError, Lay, Measured, ReadOptions};

fn options(unit: Option<f64>, pitch: Option<[f64; 2]>) -> ReadOptions {
    ReadOptions { unit, pitch, ..ReadOptions::default() }
}

/// What is read of a file with this content, which may be named as a list of points.
fn read(content: &[u8], xyz: bool, options: &ReadOptions) -> Result<Measured, FileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(if xyz { "table.xyz" } else { "table.txt" });
    fs::write(&path, content).unwrap();
    plateau_io::surface::read(&path, options)
}

fn um(text: &str) -> Result<Measured, FileError> {
    read(text.as_bytes(), false, &options(Some(1e-6), None))
}

/// Heights line by line in µm, to three decimals, "-" where missing.
fn shape(table: &Measured) -> String {
    let line = |row: usize| {
        let cell = |column: usize| match table.heights[column * table.rows + row] {
            height if height.is_nan() => "-".to_owned(),
            height => format!("{}", (height * 1e9).round() / 1e3),
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
        "\u{feff}1, 2\n3, 4\n5, 6\n\n",
        "1.0,2\n3,4\n5,6",
        "1,0;2\n3;4\n5;6",
        "1,0 2,0\n3 4\n5,0 6",
        "1,0\t2,0\n3\t4\n5\t6",
        "\"1,0\",\"2,0\"\n\"3\",\"4\"\n\"5\",\"6\"",
        "\n  1   2 \n 3 4\n5 6\n\n",
        "sep=,\r\n1,2\r\n3,4\r\n5,6\r\n",
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
fn a_list_without_a_unit_of_x_and_y_is_warned_of() {
    // 20 x 12 points 12.5 um apart, in mm, with heights in um.
    let place = |point: usize| (0.0125 * (point % 20) as f64, 0.0125 * (point / 20) as f64);
    let lines: Vec<String> =
        (0..240).map(|point| (place(point), point)).map(|((x, y), z)| format!("{x} {y} {z}")).collect();
    let list = lines.join("\n");
    for text in [list.clone(), format!("x y z [um]\n{list}")] {
        let table = um(&text).unwrap();
        assert!(table.is_pitch_assumed);
        let [warning] = &table.warnings[..] else { panic!("{:?}", table.warnings) };
        assert!(warning.contains("12.5 nm by 12.5 nm apart, 250 nm by 150 nm in all"), "{warning}");
        assert!(warning.contains(r#"say pitch = ["12.5 um", "12.5 um"]"#), "{warning}");
    }
    // What is said is not wondered at: by the names, by the whole file, by the user; nor are heights in m.
    for (text, options) in [
        (format!("x [mm] y [mm] z [um]\n{list}"), options(None, None)),
        (format!("unit: um\n{list}"), options(None, None)),
        (list.clone(), options(Some(1e-6), Some([1e-3, 2e-3]))),
        (list.clone(), options(Some(1.0), None)),
    ] {
        let table = read(text.as_bytes(), false, &options).unwrap();
        assert!(!table.is_pitch_assumed && table.warnings.is_empty(), "{:?}", table.warnings);
    }
    // With one more column it is read as a matrix, which can hardly be meant.
    let table = um(&lines.iter().map(|line| format!("{line} 100")).collect::<Vec<_>>().join("\n")).unwrap();
    assert_eq!((table.columns, table.rows), (4, 240));
    assert!(table.warnings[0].starts_with("the first two of 4 columns make a grid"), "{:?}", table.warnings);
}

#[test]
fn three_columns_that_are_no_grid_are_a_matrix_if_they_are_few() {
    let table = um("1 2 3\n4 5 6\n7 8 9\n10 11 12").unwrap();
    assert_eq!(shape(&table), "1 2 3/4 5 6/7 8 9/10 11 12");
    assert_eq!(table.warnings.len(), 1);
    let flat = um("0 0 0\n0 0 0\n0 0 0\n0 0 0").unwrap();
    assert_eq!((flat.columns, flat.rows), (3, 4));
}

#[test]
fn what_the_header_states_needs_no_scene_and_must_not_contradict_it() {
    let text = "# unit: nm\n# pitch: 50 um\n1000 2000\n3000 4000";
    let told = |unit, pitch| read(text.as_bytes(), false, &options(unit, pitch));
    for table in [told(None, None), told(Some(1e-9), Some([50e-6; 2]))] {
        let table = table.unwrap();
        assert_eq!((shape(&table).as_str(), table.pitch), ("1 2/3 4", Some([50e-6; 2])));
    }
    assert_eq!(
        told(Some(1e-6), None).unwrap_err().to_string(),
        "the file states a unit of 1 nm, the scene 1 um: leave out unit"
    );
    assert!(told(None, Some([50e-6, 60e-6])).unwrap_err().to_string().starts_with("the file states a pitch of 50 um"));
    let latin = b"# Width: 2 \xb5m\n# Height: 4 \xb5m\n# Value units: \xb5m\n1 2\n3 4";
    let table = read(latin, false, &ReadOptions::default()).unwrap();
    assert_eq!((shape(&table).as_str(), table.pitch), ("1 2/3 4", Some([1e-6, 2e-6])));
}

/// Decimal mark and lines that the scene gives.
fn told(text: &str, decimal: Option<Decimal>, skip: Option<u64>) -> Result<Measured, FileError> {
    read(text.as_bytes(), false, &ReadOptions { decimal, skip, ..options(Some(1e-6), None) })
}

#[test]
fn of_several_tables_one_is_read_that_is_chosen() {
    let chosen = |text: &str, dataset: Option<&str>| {
        let options = ReadOptions { dataset: dataset.map(str::to_owned), ..options(None, None) };
        read(text.as_bytes(), false, &options).map_err(|error| error.to_string())
    };
    // As Gwyddion writes two channels.
    let two = "# Channel: Height\n# Width: 2 um\n# Height: 4 um\n# Value units: um\n1 2\n3 4\n\n\
               # Channel: Error\n# Width: 2 um\n# Height: 2 um\n# Value units: nm\n1000 2000\n3000 5000\n";
    for (dataset, heights, pitch) in [("1", "1 2/3 4", [1e-6, 2e-6]), ("2", "1 2/3 5", [1e-6; 2])] {
        let table = chosen(two, Some(dataset)).unwrap();
        assert_eq!((shape(&table).as_str(), table.pitch), (heights, Some(pitch)));
    }
    let said = [
        (two, None),
        (two, Some("0")),
        (two, Some("3")),
        (two, Some("Height")),
        (two, Some("")),
        // A table says of itself what its numbers are.
        ("unit: um\n1 2\n\n3 4\n", Some("2")),
        ("unit: um\n1 2\n3 4\nunit: nm\n5 6\n", None),
        ("unit: um\n1 2\n3 4\n# pitch: 2 um\n5 6\n", None),
        ("x y z\n0 0 1\n1 0 1\nx y z\n0 1 1\n1 1 1\n", None),
        ("unit: um\n\n1 2\n\n\n3 4\n", None),
    ];
    insta::assert_snapshot!(said.map(|(text, dataset)| chosen(text, dataset).unwrap_err()).join("\n"));
    // What has no numbers below it is no table.
    assert_eq!(shape(&chosen("unit: um\n\n1 2\n# a b\n3 4\n\n# end: here\n\n", Some("1")).unwrap()), "1 2/3 4");
}

/// 20 x 12 points 2 apart of which each is off by up to this, in steps, at random.
fn jittered(off: f64) -> String {
    let mut state = 1_u32;
    // Numerical Recipes, a quick and even number from -1 to 1.
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX) * 2.0 - 1.0
    };
    let points = (0..240).map(|point| {
        let [x, y] = [point % 20, point / 20].map(|place| 2.0 * (f64::from(place) + off * random()));
        format!("{x:.9} {y:.9} {point}\n")
    });
    points.collect()
}

#[test]
fn points_off_the_grid_by_less_than_a_fiftieth_of_its_step_are_on_it() {
    for (off, xyz) in [(1e-9, true), (1e-6, true), (5e-3, true), (0.0199, true), (5e-3, false)] {
        let table = read(jittered(off).as_bytes(), xyz, &options(Some(1e-6), Some([2e-6; 2])));
        let table = table.unwrap_or_else(|error| panic!("{off}: {error}"));
        assert_eq!((table.columns, table.rows), (20, 12), "{off}");
        let at = |point: usize| table.heights[point % 20 * 12 + point / 20];
        assert!((0..240).all(|point| (at(point) - 1e-6 * point as f64).abs() < 1e-15), "{off}");
        let pitch = read(jittered(off).as_bytes(), xyz, &options(Some(1e-6), None)).unwrap().pitch.unwrap();
        // An end of 20 or 12 lines is off by no more than a point is.
        assert!(pitch.iter().all(|pitch| (pitch / 2e-6 - 1.0).abs() <= 2.0 * off / 11.0 + 1e-9), "{off}: {pitch:?}");
    }
    // Rows that are missing leave holes; coordinates of few digits make a finer grid, which the points would hardly fill.
    let gaps: String = jittered(5e-3)
        .lines()
        .enumerate()
        .filter(|(at, _)| at / 20 != 5)
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    let table = read(gaps.as_bytes(), true, &options(Some(1e-6), None)).unwrap();
    assert_eq!(
        (table.columns, table.rows, table.heights.iter().filter(|height| height.is_nan()).count()),
        (20, 12, 20)
    );
    let rounded = "0.001 0.000 1\n0.099 0.001 2\n0.200 0.001 3\n0.000 0.100 4\n0.101 0.101 5\n0.201 0.099 6\n";
    let table = read(rounded.as_bytes(), true, &options(Some(1e-6), None)).unwrap();
    assert_eq!(shape(&table), "1 2 3/4 5 6");
    let off = read(jittered(0.03).as_bytes(), true, &options(Some(1e-6), None)).unwrap_err();
    assert!(off.to_string().contains("lies off the regular grid"), "{off}");
}

#[test]
fn the_scene_says_what_the_file_does_not() {
    let shape_of =
        |text, decimal, skip| told(text, decimal, skip).map(|table| shape(&table)).map_err(|error| error.to_string());
    assert_eq!(shape_of("1,234;2,345\n4,321;3,210", Some(Decimal::Comma), None).unwrap(), "1.234 2.345/4.321 3.21");
    assert_eq!(shape_of("1,2\n3,4", Some(Decimal::Point), None).unwrap(), "1 2/3 4");
    assert_eq!(shape_of("1,2\n3,4", Some(Decimal::Comma), None).unwrap(), "1.2/3.4");
    let text = "Sample 7\n12 3 4\nanything\n1 2\n3 4\n";
    let said = [
        shape_of("1,234;2,345\n4,321;3,210", Some(Decimal::Point), None),
        shape_of(text, None, None),
        // A header that begins with a number is told as one; a mistyped first line of a table is not.
        shape_of("2 points each\n1 2\n3 4\n", None, None),
        shape_of("2 points each\nunit: um\n1 2\n3 4\n", None, None),
        shape_of("1 2x\n3 4\n5 6\n", None, None),
        shape_of(text, None, Some(2)),
        shape_of(text, None, Some(5)),
    ];
    insta::assert_snapshot!(said.map(Result::unwrap_err).join("\n"));
    assert_eq!(shape_of(text, None, Some(3)).unwrap(), "1 2/3 4");
    assert_eq!(shape_of(text, None, Some(4)).unwrap(), "3 4");
    assert_eq!(shape_of("1 2\n3 4", None, Some(0)).unwrap(), "1 2/3 4");
    // A header below the lines that are skipped still counts; numbers in it are written as those of the table.
    let text = "first\n# unit: nm\n# pitch: 0,5 um\n1000,25;2000\n3000;4000";
    let table = read(text.as_bytes(), false, &ReadOptions { skip: Some(1), ..options(None, None) }).unwrap();
    assert_eq!((shape(&table).as_str(), table.pitch), ("1 2/3 4", Some([0.5e-6; 2])));
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let lines = |line: fn(usize) -> String| (0..200).map(line).collect::<String>();
    let told = [
        "1 2\n# no\n3 4 5\n",
        "1 2\n3 4a\n",
        "1.5;2\n3;4,5",
        "1,5;2\n3;4.5",
        "1;1,234",
        "1,2\n3,4",
        "1;1.234,5",
        "1,5 2,5\n1,5 x\n",
        "1 inf\n",
        "1 1e999\n",
        "columns=3\n1 2\n",
        "rows=3\n1 2\n",
        "hello\n1 2\n",
        "# only words 1\n",
        "x y z\n1 2\n",
        "x y z\n0 0 1\n1 0 1\n",
        "x y z\n0 0 1\n1 0 1\n0 1 1\n1 0 1\n",
        "x y z\n0 0 1\nNaN 0 1\n",
        "x y z\n0 0 1\n1 0 1\n2.3 0 1\n3 0 1\n0 1 1\n1 1 1\n2.3 1 1\n3 1 1",
        &format!("x y z\n{}", lines(|i| format!("{i} {i} 1\n"))),
        &lines(|n| format!("{n}\n")),
        &lines(|i| format!("{} {} 1\n", (i as f64).sin(), (i as f64).cos())),
        "x z\n0 0\n1 0\n",
    ];
    let unknown = read(b"1 2\n3 4", false, &ReadOptions::default()).unwrap_err().to_string();
    insta::assert_snapshot!(told.map(error).into_iter().chain([unknown]).collect::<Vec<_>>().join("\n"));
}

#[test]
fn an_absurd_unit_gives_no_infinite_heights() {
    let found = read(b"1e300 1\n1 2", false, &options(Some(1e300), None)).unwrap_err();
    assert!(found.to_string().contains("a height of inf m is not finite"), "{found}");
}

#[test]
fn a_file_cut_anywhere_gets_an_answer() {
    let list = "\u{feff}# unit: um\r\nx [mm];y [mm];z\r\n0;0;1\r\n1;0;2\r\n0;1;\r\n1;1;NaN\r\n";
    let matrix = "rows=2 columns=3\npixel size=1e-6 m\nunit=nm\n1 2 3\n4 5 6\n";
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

fn profile(text: &str, unit: Option<f64>, pitch: Option<f64>) -> Result<Measured, FileError> {
    let pitch = pitch.map(|pitch| [pitch; 2]);
    read(text.as_bytes(), false, &ReadOptions { profile_lay: Some(Lay::Across), ..options(unit, pitch) })
}

#[test]
fn profiles_in_every_spelling() {
    let um = Some(1e-6);
    for (text, unit, pitch) in [
        ("1\n2\n4\n", um, Some(5e-7)),
        ("1 2 4", um, Some(5e-7)),
        ("# unit: um\n# pitch: 0.5 um\n1\n2\n4\n", None, None),
        ("# unit: um\n# Width: 1.5 um\n1;2;4", None, None),
        ("0 1\n0.5 2\n1 4\n", um, Some(5e-7)),
        ("x [um];z [nm]\n0,0;1000\n0,5;2000\n1,0;4000\n", None, None),
        ("x in µm,y in µm\n1,1.0\n1.5,2\n2,4\n", None, None),
        ("X;Y;valid\n[mm];[um];[1/0]\n8.0005;1;1\n8.001;2;1\n8.0015;4;1\n", None, None),
        ("x [um] y [um] z [um]\n7 0 1\n7 0.5 2\n7 1 4\n", None, None),
        ("# Lateral units: um\n# Value units: um\n0 1\n0.5 2\n1 4\n", None, None),
    ] {
        let table = profile(text, unit, pitch).unwrap_or_else(|error| panic!("{text:?}: {error}"));
        assert_eq!((table.columns, table.rows, shape(&table).as_str()), (3, 1, "1 2 4"), "{text:?}");
        let [x, y] = table.pitch.unwrap();
        // Distances from 8 on have fewer digits for their differences.
        assert!((x - 5e-7).abs() < 1e-18 && x == y, "{text:?}: {x}");
    }
    // Distances that fall turn the profile around no more than the file does; a point that is not there is missing.
    assert_eq!(shape(&profile("2 1\n1 2\n0 4\n", um, Some(1e-6)).unwrap()), "1 2 4");
    let holed: String = (0..20).filter(|n| *n != 3).map(|n| format!("{n} {n}\n")).collect();
    assert!(shape(&profile(&holed, um, Some(1e-6)).unwrap()).starts_with("0 1 2 - 4 5"));
    assert_eq!(shape(&profile("1\n***\n4", um, um).unwrap()), "1 - 4");
    let valid = "X;Y;valid\n[um];[um];[1/0]\n0;1;1\n1;2;0\n2;4;1\n";
    assert_eq!(shape(&profile(valid, None, None).unwrap()), "1 - 4");
}

#[test]
fn what_is_no_profile_is_refused() {
    let error = |text: &str| profile(text, Some(1e-6), None).unwrap_err().to_string();
    let told = [
        "1 2 3\n4 5 6\n",
        "x y z\n0 0 1\n1 1 1\n",
        "0 1\n1 1\n",
        "7",
        "0 1\n2 1\n1 1\n",
        "0 1\n1 1\n2 1\n3.5 1\n4 1\n",
        "0 1\nNaN 1\n",
    ];
    let other = profile("x [mm],z [um]\n0.0,1\n0.5,1\n", None, Some(1e-3)).unwrap_err().to_string();
    insta::assert_snapshot!(told.map(error).into_iter().chain([other]).collect::<Vec<_>>().join("\n"));
}
