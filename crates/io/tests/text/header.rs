//! What stands before the numbers: names with values, names of columns, lines that are left out.

use super::*;

/// The unit of heights and the pitch, m, that these lines above a matrix of 2 by 2 state.
fn header(lines: &[&str]) -> (f64, Option<[f64; 2]>) {
    let table = read(format!("{}\n1 2\n3 4", lines.join("\n")).as_bytes(), false, &options(None, None));
    let table = table.unwrap_or_else(|error| panic!("{lines:?}: {error}"));
    (table.heights[0], table.pitch)
}

/// Pitch and unit, m, of a list of 2 by 2 points under this line; `cells` are those of a point, in its places.
fn list(names: &str, mark: &str, cells: &[&str], unit: Option<f64>) -> (Option<[f64; 2]>, f64) {
    let point = |[x, y, z]: [&str; 3]| {
        let cells = cells.iter().map(|cell| cell.replace('x', x).replace('y', y).replace('z', z));
        cells.collect::<Vec<_>>().join(mark)
    };
    let points = [["0", "0", "1"], ["1", "0", "2"], ["0", "1", "3"], ["1", "1", "4"]].map(point).join("\n");
    let table = read(format!("{names}\n{points}").as_bytes(), false, &options(unit, None));
    let table = table.unwrap_or_else(|error| panic!("{names}: {error}"));
    (table.pitch, table.heights[3] / 4.0)
}

#[test]
fn columns_are_read_by_their_names() {
    let xyz = ["x", "y", "z"];
    for (names, mark, cells, pitch, unit) in [
        ("X [mm], Y [mm], Intensity, Z [nm]", ",", &["x", "y", "9.5", "z"][..], 1e-3, 1e-9),
        ("\"x (µm)\";\"y (µm)\";\"height\"", ";", &xyz, 1e-6, 1.0),
        ("X in mm; Y in mm; Hoehe in Mikrometer", ";", &xyz, 1e-3, 1e-6),
        ("X [mm] Y [mm] Z [um]", " ", &xyz, 1e-3, 1e-6),
        ("X [um]\tY [um]\tZ [2.9e-8 m]", "\t", &xyz, 1e-6, 2.9e-8),
        ("x;y;z\n[mm];[mm];[um]", ";", &xyz, 1e-3, 1e-6),
    ] {
        let (found, height) = list(names, mark, cells, (unit == 1.0).then_some(1.0));
        let found = found.unwrap();
        assert!(found.iter().all(|found| (found / pitch - 1.0).abs() < 1e-12), "{names}: {found:?}");
        assert!((height / unit - 1.0).abs() < 1e-12, "{names}: {height}");
    }
    for none in ["x", "y z", "x y z z", "a b c", "xyz", "x x z"] {
        assert!(error(&format!("{none}\n1 2 3\n4 5 6")).starts_with("line 1: found "), "{none}");
    }
}

#[test]
fn profiles_are_read_by_the_names_of_their_columns() {
    for (text, pitch, unit) in [
        ("index; x in µm;y in µm\n0;0;1\n1;1;2", 1e-6, 1e-6),
        ("X_(microns);y1\n0;1\n1;2", 1e-6, 1.0),
        ("Lateral um;Raw Micrometer;\n0;1;\n1;2;", 1e-6, 1e-6),
        ("X;Y;valid\n[mm];[um];[1/0]\n0;1;1\n1;2;1", 1e-3, 1e-6),
        ("x [mm]\tz [um]\n0\t1\n1\t2", 1e-3, 1e-6),
    ] {
        let table = profile(text, (unit == 1.0).then_some(1.0), None).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((table.pitch.unwrap()[0], table.heights[1]), (pitch, 2.0 * unit), "{text}");
    }
}

#[test]
fn headers_of_several_programs_and_languages_are_read() {
    for (lines, expected) in [
        (&["Einheit: µm", "Schrittweite: 20 um"][..], (1e-6, Some([2e-5; 2]))),
        (&["Einheit: Mikrometer"], (1e-6, None)),
        (&["Werteinheiten: nm", "Punktabstand = 5 um, 10 um"], (1e-9, Some([5e-6, 1e-5]))),
        (&["# unit: um, pitch: 15 um"], (1e-6, Some([1.5e-5; 2]))),
        (&["unit = um; pitch = 15 um"], (1e-6, Some([1.5e-5; 2]))),
        (&["pitch: 15 um , unit: um"], (1e-6, Some([1.5e-5; 2]))),
        (&["# pitch: 15 um, 20 um, unit: nm, of: sample 3, left"], (1e-9, Some([1.5e-5, 2e-5]))),
        // A comma may be part of a name, and a value may have a colon.
        (&["size (x, y): 3 mm, made by: hand", "unit: um"], (1e-6, None)),
        (&["date: 12:30:05", "unit: um"], (1e-6, None)),
        // Gwyddion, in two of its languages, and ours.
        (
            &["# Channel: Height", "# Width: 30 µm", "# Height: 20.0 µm", "# Value units: nm"],
            (1e-9, Some([1.5e-5, 1e-5])),
        ),
        (&["# Kanal: Höhe", "# Breite: 30 µm", "# Höhe: 20.0 µm", "# Einheiten: nm"], (1e-9, Some([1.5e-5, 1e-5]))),
        (&["# unit: um", "# pitch: 50 um, 25 um"], (1e-6, Some([50e-6, 25e-6]))),
        (&["unit=um rows=2 columns=2", "% pitch = 1 mm x 2 mm"], (1e-6, Some([1e-3, 2e-3]))),
    ] {
        assert_eq!(header(lines), expected, "{lines:?}");
    }
    for nothing in ["pitch = 5", "pitch = -5 um", "pitch=1 m, 2"] {
        assert_eq!(header(&["unit: um", nothing]), (1e-6, None), "{nothing}");
    }
    for nothing in ["unit: V", "unit: 0 m"] {
        let found = read(format!("{nothing}\n1 2").as_bytes(), false, &options(None, None)).unwrap_err().to_string();
        assert!(found.starts_with("the file does not say the unit"), "{nothing}: {found}");
    }
    // Numbers of a header are written as those of the table.
    for (line, pitch) in [
        ("pitch: 0,5 um", Some([0.5e-6; 2])),
        ("pitch: 1,25 um; 2 um", Some([1.25e-6, 2e-6])),
        ("Schrittweite: 1,5 um, Einheit: um", Some([1.5e-6; 2])),
        ("pitch: 1.25 um", None),
    ] {
        assert_eq!(um(&format!("{line}\n1,5;2\n3;4")).unwrap().pitch, pitch, "{line}");
    }
}

#[test]
fn the_table_begins_below_the_last_odd_line() {
    let many = "line 7\n".repeat(1000);
    for (text, expected) in [
        (
            "Protocol\nDate;12.03.2026 14:05:11\nResolution X/Y\t5,0 um\nPoints 800 x 400\nBEGIN\n1,5\t2\t***\n3\t4\t5\n",
            Some(5),
        ),
        // Counts, which are numbers themselves; a single line; blank lines and comments.
        ("Sample 7\n3 2\n1,5 2,5 3\n4 5 6\n", Some(2)),
        ("Sample 7\n1 2 3 4\n", Some(1)),
        ("Sample 7\n\n# mean\n1 2\n# more\n3 4\n", Some(1)),
        // A line that is shorter does not make the rest of the table its begin.
        ("Sample 7\n1 2\n3 4\n5 6\n7\n8 9\n", Some(1)),
        // What a header says right above the table is kept.
        ("Sample 7\nunit: um\nMeasured\npitch = 5 um\n1 2\n3 4\n", Some(3)),
        ("Sample 7\n1,5, 2,5\n3, 4,25\n", Some(1)),
        ("Sample 7\nno numbers\n***\n", None),
        (&format!("{many}1 2\n3 4\n"), None),
    ] {
        let advice = expected.map_or("no lines of equally many numbers are seen below".to_owned(), |lines| {
            format!("skip = {lines} below file in the scene leaves out the lines before the table")
        });
        assert!(error(text).contains(&advice), "{text}: {}", error(text));
    }
}

/// A matrix of 7 lines by 8 columns of these heights, column by column; no number for NaN.
fn matrix(heights: &[f64]) -> Vec<String> {
    let cell = |height: f64| if height.is_nan() { "NaN".to_owned() } else { format!("{height:.12}") };
    let line = |row: usize| heights[row..].iter().step_by(7).map(|height| cell(*height)).collect::<Vec<_>>().join(";");
    um(&(0..7).map(line).collect::<Vec<_>>().join("\n")).unwrap().warnings
}

#[test]
fn numbers_of_lines_and_coordinates_are_told() {
    let rough: Vec<f64> = (0..56).map(|point| f64::from(point * point % 17) / 7.0).collect();
    assert_eq!(matrix(&rough), [""; 0]);
    // As pandas writes a table: numbers of lines in front of them, an empty corner, and numbers of columns above.
    let mut table = rough;
    (0..7).for_each(|row| table[row] = row as f64 - 1.0);
    let told = matrix(&table);
    assert!(told.len() == 1 && told[0].starts_with("the first column counts evenly to 5, from 0 on"), "{told:?}");
    table[0] = f64::NAN;
    // Coordinates in mm, rounded.
    (1..8).for_each(|column| table[7 * column] = [0.33, 0.67, 1.0, 1.33, 1.67, 2.0, 2.33][column - 1]);
    assert_eq!(matrix(&table).len(), 2);
    // A plane has none.
    assert_eq!(matrix(&(0..56).map(f64::from).collect::<Vec<_>>()), [""; 0]);
}
