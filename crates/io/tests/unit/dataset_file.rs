use std::fs;

use super::*;

fn place(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}

/// A file without rows that come one by one.
fn write(path: &Path, replace: bool, content: &Content) -> Result<(), DatasetFileError> {
    write_rows(path, replace, content, |_| Ok(()))
}

fn content() -> Content {
    Content {
        attributes: vec![("title", Attribute::Text("a".into())), ("count", Attribute::Integer(3))],
        dimensions: vec![
            Coordinate { name: "run", unit: "1".into(), long_name: "number".into(), values: vec![0.0, 1.0] },
            Coordinate { name: "time", unit: "s".into(), long_name: "time".into(), values: vec![5.0, 10.0, 15.0] },
        ],
        variables: vec![
            Variable {
                name: "area".into(),
                dimensions: vec!["run", "time"],
                unit: "m2".into(),
                long_name: "area".into(),
                attributes: vec![("valid_min", Attribute::Number(0.0))],
                values: Values::Float(vec![1.0, 2.0, 3.0, 4.0, 5.0, f64::NAN]),
            },
            Variable {
                name: "name".into(),
                dimensions: vec!["run"],
                unit: "".into(),
                long_name: "name".into(),
                attributes: Vec::new(),
                values: Values::Text(vec!["one".into(), "µ".into()]),
            },
        ],
    }
}

#[test]
fn what_is_written_is_read() {
    let (_directory, path) = place("results.h5");
    write(&path, false, &content()).unwrap();
    let file = File::open(&path).unwrap();
    let area: Vec<f64> = file.dataset("area").unwrap().read_raw().unwrap();
    assert_eq!(area[..5], [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert!(area[5].is_nan());
    assert_eq!(file.dataset("area").unwrap().shape(), [2, 3]);
    assert_eq!(file.dataset("area").unwrap().attr("valid_min").unwrap().read_scalar::<f64>().unwrap(), 0.0);
    let names: Vec<VarLenUnicode> = file.dataset("name").unwrap().read_raw().unwrap();
    assert_eq!(names.iter().map(|name| name.as_str()).collect::<Vec<_>>(), ["one", "µ"]);
    assert_eq!(file.attr("count").unwrap().read_scalar::<i64>().unwrap(), 3);
}

#[test]
fn rows_come_one_by_one() {
    let (_directory, path) = place("rows.h5");
    let mut content = content();
    content.variables[0].values = Values::Rows;
    write_rows(&path, false, &content, |rows| rows.put("area", 1, &[4.0, 5.0])).unwrap();
    let area: Vec<f64> = File::open(&path).unwrap().dataset("area").unwrap().read_raw().unwrap();
    assert_eq!(area[3..5], [4.0, 5.0]);
    assert!([0, 1, 2, 5].into_iter().all(|at| area[at].is_nan()));
    content.dimensions[1].values.clear();
    write(&path, true, &content).unwrap();
    let failed = write_rows(&path, true, &content, |rows| rows.put("nothing", 0, &[1.0]));
    assert!(failed.is_err());
    assert_eq!(File::open(&path).unwrap().dataset("area").unwrap().shape(), [2, 0]);
}

#[test]
fn there_may_be_nothing_along_a_dimension() {
    let (_directory, path) = place("results.h5");
    let mut content = content();
    content.dimensions[0].values.clear();
    content.variables[0].values = Values::Float(Vec::new());
    content.variables[1].values = Values::Text(Vec::new());
    write(&path, false, &content).unwrap();
    assert_eq!(File::open(&path).unwrap().dataset("area").unwrap().shape(), [0, 3]);
}

#[test]
fn another_file_is_replaced_only_on_demand() {
    let (directory, path) = place("results.h5");
    fs::write(&path, "mine").unwrap();
    assert!(write(&path, false, &content()).is_err());
    assert_eq!(fs::read(&path).unwrap(), b"mine");
    write(&path, true, &content()).unwrap();
    assert!(fs::read(&path).unwrap().starts_with(b"\x89HDF"));
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
}
