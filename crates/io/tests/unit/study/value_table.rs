use super::*;
use crate::study::factor::Values;

/// What is made of a file with this text; the folder is left out of what is said.
fn read<T>(text: &str, reading: impl Fn(&Path) -> Result<T, String>) -> Result<T, String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("t.csv");
    std::fs::write(&path, text).unwrap();
    reading(&path).map_err(|error| error.replace(&directory.path().display().to_string(), "."))
}

fn table(text: &str) -> Result<ValueTable, String> {
    read(text, |path| ValueTable::read(path, limits::ROWS))
}

/// A factor whose levels the table has.
fn factor(name: &str, key: &str) -> Factor {
    let keys = if key.is_empty() { Vec::new() } else { vec![key.into()] };
    Factor { name: name.into(), keys, stated_unit: String::new(), values: Values::Levels(Vec::new()) }
}

#[test]
fn columns_have_names_and_units() {
    let factors = [factor("load", "operation.normal_force"), factor("fibres", "pin.base.synthetic.fibre_fraction")];
    let table =
        table("load [kN],y [m2],pin.base.synthetic.fibre_fraction\n# measured\n0.005,1e-6,0.2\n,,0.3\n").unwrap();
    assert_eq!(table.factor_columns(&factors).unwrap(), [Some(0), Some(2)]);
    assert_eq!((table.named(1), table.named(2).1), (("y", "m2"), ""));
    let [first, second] = table.rows.as_slice() else { panic!("two lines") };
    assert_eq!((first.line, second.line), (3, 4));
    assert_eq!(table.level(first, 0, &factors[0]).unwrap().number, Some(5.0));
    assert_eq!(table.level(first, 2, &factors[1]).unwrap().number, Some(0.2));
    assert!(table.level(second, 0, &factors[0]).unwrap_err().ends_with("t.csv:4: \"load\" is empty"));
}

#[test]
fn what_is_too_much_or_no_text_is_refused() {
    let read = |text: &str| read(text, |path| ValueTable::read(path, 3));
    assert_eq!(read("a\n1\n2\n3\n4\n").unwrap_err(), "./t.csv:5: more points, expected at most 3");
    let bell = read("a,b\n5 N\u{7},1\n").unwrap_err();
    assert_eq!(bell, "./t.csv:2: \"a\" has the control character U+0007; take it out");
}

fn read_text(text: &str) -> Result<Points, String> {
    let factors = [factor("load", "operation.normal_force"), factor("rows", "mesh.rows")];
    read(text, |path| read_points(path, &factors, &["y"]))
}

#[test]
fn columns_are_told_by_factor_or_key() {
    let points = read_text("mesh.rows, load, y [m2]\n20, 5 N, 1\n# no\n40, 7.5 N,\n").unwrap();
    let numbers: Vec<Vec<f64>> = points.iter().map(|p| p.iter().map(|l| l.number.unwrap()).collect()).collect();
    assert_eq!(numbers, [[5.0, 20.0], [7.5, 40.0]]);
}

#[test]
fn equal_levels_are_one_however_they_are_spelt() {
    let points = read_text("rows,load\n1,5 N\n2,5000 mN\n3,5.0 N\n4,6 N\n").unwrap();
    let labels: Vec<&str> = points.iter().map(|point| point[0].label.as_str()).collect();
    assert_eq!(labels, ["5 N", "5 N", "5 N", "6 N"]);
}

#[test]
fn levels_that_the_study_lists_are_the_only_ones() {
    let level = |text: &str| Level::parse("operation.normal_force", text);
    let values = Values::Levels(vec![level("5 N"), level("6 N")]);
    let keys = vec!["operation.normal_force".into()];
    let factor = Factor { name: "load".into(), keys, stated_unit: String::new(), values };
    let mut spellings = Spellings::of(&factor);
    assert_eq!(spellings.first_spelt(level("6000 mN")).unwrap().label, "6 N");
    assert_eq!(spellings.first_spelt(level("7 N")).unwrap_err(), "7 N is none of the levels 5 N, 6 N");
}

#[test]
fn a_word_among_numbers_is_no_level() {
    let factors = [factor("humidity", "")];
    let read = |text: &str| read(text, |path| read_points(path, &factors, &[]));
    for word in ["O.3", "1e400", "0,3", "high"] {
        let said = read(&format!("humidity\n0.4\n\"{word}\"\n0.5\n")).unwrap_err();
        let expected = format!("t.csv:3: \"humidity\" is \"{word}\", which is no number, and 0.4 in line 2 is one;");
        assert!(said.contains(&expected), "{said}");
    }
    assert_eq!(read("humidity\nhigh\nlow\n").unwrap().len(), 2);
}

#[test]
fn what_is_wrong_is_said() {
    let tables = ["a,a\n1,2\n", "a,b\n", "\u{feff}a,b\n\n# no\n1\n"].map(|text| table(text).map(drop));
    let points = ["load\n5 N\n", "load,rows,x\n5 N,1,2\n", "load,rows\n5 N,\n", "load,rows\n"];
    let points = points.map(|text| read_text(text).map(drop));
    let said: Vec<String> = tables.into_iter().chain(points).map(|refused| refused.unwrap_err()).collect();
    insta::assert_snapshot!(said.join("\n"));
}
