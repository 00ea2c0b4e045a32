//! `plateau export`: the numbers of a run file in a table, to the bit, and files that are there are kept.
//!
//! What NumPy and readers of VTK's files see is tested in tests/python/test_export.py.

use std::fs;

use plateau_tests::program::{WorkingDirectory, quick_scene_with};
use plateau_tests::run_file::RunFile;

/// A directory with the short run `run.h5`, which has maps at two times.
fn directory_with_run() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write("scene.toml", quick_scene_with(&[("duration = \"60 s\"", "duration = \"5 s\"")]));
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    directory
}

/// The columns of a table: name and values.
fn columns(directory: &WorkingDirectory, name: &str) -> Vec<(String, Vec<f64>)> {
    let text = fs::read_to_string(directory.path(name)).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',');
    let mut columns: Vec<_> = names.map(|name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        let values: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        assert_eq!(values.len(), columns.len(), "{line}");
        columns.iter_mut().zip(values).for_each(|((_, column), value)| column.push(value));
    }
    columns
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn a_table_has_the_numbers_of_the_run_file() {
    let directory = directory_with_run();
    let said = directory.plateau(["export", "run.h5", "--to", "csv", "--maps"]).quiet_success();
    let run = RunFile::open(directory.path("run.h5"));
    let series = columns(&directory, "run.csv");
    assert_eq!(series.len(), 26);
    for (column, values) in &series {
        let name = column.split_once(" [").unwrap().0;
        let path = if name == "time" { "/time".to_owned() } else { format!("/series/{name}") };
        assert!(bits(values) == bits(&run.floats(&path)), "{column}");
    }
    assert!(series.iter().any(|(column, _)| column == "contact_area_integral [m2 s]"));
    for index in 0..2 {
        let pin = columns(&directory, &format!("run-pin-000{index}.csv"));
        let pressure = pin.iter().find(|(column, _)| column == "pressure [Pa]").unwrap();
        assert!(bits(&pressure.1) == bits(&run.map("/pin/pressure", index)));
        let disc = columns(&directory, &format!("run-disc-000{index}.csv"));
        let height = disc.iter().find(|(column, _)| column == "height [m]").unwrap();
        assert!(bits(&height.1) == bits(&run.map("/disc/height", index)));
    }
    assert_eq!(said.lines().count(), 6, "{said}");
}

#[test]
fn files_that_are_there_are_replaced_only_by_force_and_never_the_run_file() {
    let directory = directory_with_run();
    let run = fs::read(directory.path("run.h5")).unwrap();
    let kinds = [
        ("csv", "table.csv", "table.csv"),
        ("npz", "arrays.npz", "arrays.npz"),
        ("vtk", "grids", "grids/pin-0001.vts"),
    ];
    for (kind, output, file) in kinds {
        directory.write(file, "precious");
        let before = directory.content();
        let refused = directory.plateau(["export", "run.h5", "--to", kind, "-o", output]);
        assert_eq!(refused.status, Some(2), "{}", refused.stderr);
        assert!(refused.stderr.starts_with(&format!("plateau: {file} exists; give --force")), "{}", refused.stderr);
        assert!(directory.content() == before, "{kind}: the refused export changed something");
        directory.plateau(["export", "run.h5", "--to", kind, "-o", output, "--force"]).quiet_success();
        assert_ne!(fs::read(directory.path(file)).unwrap(), b"precious");
    }
    for kind in ["csv", "npz"] {
        let refused = directory.plateau(["export", "run.h5", "--to", kind, "-o", "run.h5", "--force"]);
        assert_eq!(refused.status, Some(2));
        assert!(refused.stderr.contains("is an input and is not replaced"), "{}", refused.stderr);
    }
    let refused = directory.plateau(["export", "run.h5", "--to", "vtk", "-o", "run.h5"]);
    assert_eq!(refused.status, Some(2));
    assert!(refused.stderr.starts_with("plateau: cannot make the folder run.h5"), "{}", refused.stderr);
    let refused = directory.plateau(["export", "run.h5", "--to", "csv", "-o", "nowhere/table.csv"]);
    assert!(refused.stderr.contains("nowhere is not a directory; make it first"), "{}", refused.stderr);
    assert!(fs::read(directory.path("run.h5")).unwrap() == run);
}

#[test]
fn grids_of_a_run_without_maps_are_none() {
    let directory = WorkingDirectory::new();
    let edits = [("duration = \"60 s\"", "steps = 1"), ("maps_at = [\"0 s\"]", "maps = []")];
    directory.write("scene.toml", quick_scene_with(&edits));
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    let outcome = directory.plateau(["export", "run.h5", "--to", "vtk"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    let notes: Vec<_> = outcome.stderr.lines().collect();
    assert_eq!(notes.last(), Some(&"plateau: nothing is written: this format has maps only"));
    let said = directory.plateau(["export", "run.h5", "--to", "npz"]).quiet_success();
    assert!(said.contains("run.npz  1 sample of 25 series, 0 maps at 0 times"), "{said}");
    assert_eq!(directory.names(), ["run.h5", "run.h5.checkpoint", "run.npz", "scene.toml"]);
}

#[test]
fn a_damaged_run_file_leaves_no_output() {
    let directory = directory_with_run();
    let run = fs::read(directory.path("run.h5")).unwrap();
    for part in 1..12 {
        directory.write("cut.h5", &run[..run.len() * part / 12]);
        for kind in ["csv", "npz", "vtk"] {
            let outcome = directory.plateau(["export", "cut.h5", "--to", kind]);
            assert_eq!(outcome.status, Some(2), "{part}/12 to {kind}: {}", outcome.stderr);
            assert!(outcome.stderr.starts_with("plateau: cut.h5 is "), "{}", outcome.stderr);
        }
    }
    assert_eq!(directory.names(), ["cut.h5", "run.h5", "run.h5.checkpoint", "scene.toml"]);
}
