//! Maps of a run file as the surfaces of another run.

use hdf5::File;
use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, sets};

/// One map of a run file.
fn map(directory: &WorkingDirectory, file: &str, dataset: &str, moment: usize) -> Vec<u64> {
    let dataset = File::open(directory.path(file)).unwrap().dataset(dataset).unwrap();
    let (moments, values) = (dataset.shape()[0], dataset.read_raw::<f64>().unwrap());
    let cells = values.len() / moments;
    values[moment * cells..][..cells].iter().map(|value| value.to_bits()).collect()
}

/// The quick scene with these surfaces, as they are.
fn scene_of(directory: &WorkingDirectory, name: &str, disc: &str, pin: &str) {
    let text = quick_scene_with(&[]);
    let mut tables: Vec<String> = Vec::new();
    for table in text.split("\n[") {
        let replaced = match table.split_once(']').map(|(name, _)| name) {
            Some("disc.surface") => format!("disc.surface]\nfile = \"run.h5\"\n{disc}\n"),
            Some("pin.surface") => format!("pin.surface]\nfile = \"run.h5\"\n{pin}\n"),
            Some("disc.prepare") => continue,
            _ => table.to_owned(),
        };
        tables.push(replaced);
    }
    directory.write(name, tables.join("\n["));
}

fn run_with(directory: &WorkingDirectory, disc: &str, pin: &str) -> Outcome {
    scene_of(directory, "next.toml", disc, pin);
    directory.plateau(["run", "next.toml", "-o", "next.h5", "--force", "--set", "operation.duration=1 s"])
}

#[test]
fn the_last_map_or_one_at_a_time_is_the_surface_of_the_next_run() {
    let directory = WorkingDirectory::with("first.toml", quick_scene_with(&[]));
    let first = ["run", "first.toml", "-o", "run.h5", "--set", "operation.duration=3 s"];
    directory.plateau([&first[..], &["--set", "output.maps_at=[\"0 s\", \"1 s\"]"]].concat()).ends(0, &[]);

    run_with(&directory, "dataset = \"/disc/height\"", "dataset = \"pin/height\"").ends(0, &[]);
    for dataset in ["disc/height", "pin/height"] {
        // Bit for bit and with the same sign: the state before the first step is the last one of the run before.
        assert_eq!(map(&directory, "next.h5", dataset, 0), map(&directory, "run.h5", dataset, 2), "{dataset}");
        assert_ne!(map(&directory, "run.h5", dataset, 1), map(&directory, "run.h5", dataset, 2), "{dataset}");
    }
    let at = "at = \"1 s\"";
    run_with(&directory, &format!("dataset = \"/disc/height\"\n{at}"), &format!("dataset = \"/pin/height\"\n{at}"))
        .ends(0, &[]);
    for dataset in ["disc/height", "pin/height"] {
        assert_eq!(map(&directory, "next.h5", dataset, 0), map(&directory, "run.h5", dataset, 1), "{dataset}");
    }
    // What the first run has done is done once more only with a warning.
    let recess =
        "pin.surface: resin_recess is applied to the map of a run, which has already been prepared: leave it out";
    let cut = "disc.prepare: cutoff is applied to the map of a run, which has already been prepared: leave it out";
    for (set, warnings) in [
        (None, [false, false]),
        (Some("pin.surface.resin_recess=8 um"), [true, false]),
        (Some("disc.prepare.cutoff=1 um"), [false, true]),
    ] {
        let set = set.into_iter().flat_map(|value| ["--set", value]);
        let checked = directory.plateau(["check", "next.toml"].into_iter().chain(set)).ends(0, &[]);
        assert_eq!([recess, cut].map(|warning| checked.stderr.contains(warning)), warnings, "{checked:?}");
    }
    // Where the map comes from is in the report.
    let checked = directory.plateau(["check", "next.toml", "--all"]);
    assert!(checked.stdout.contains("dataset /disc/height, recorded by a run at 1."), "{checked:?}");

    for (disc, said) in [
        ("dataset = \"/pin/height\"", "disc.surface takes /disc/height"),
        ("", "this is a run file: dataset = \"/disc/height\" takes its last map of the disc"),
        (
            "dataset = \"/disc/height\"\nat = \"2 s\"",
            "this run file has no map disc/height at 2 s, its maps are at 0 s, 1.",
        ),
        (
            "dataset = \"/disc/status\"\nat = \"1 s\"",
            "at is a time of a map of heights of a run file, which /disc/status is not",
        ),
    ] {
        run_with(&directory, disc, "dataset = \"/pin/height\"").ends(2, &[said]);
    }
}

#[test]
fn a_mesh_of_other_cells_takes_the_map_as_a_patch_of_its_size() {
    let directory = WorkingDirectory::with("first.toml", quick_scene_with(&[]));
    directory.plateau(["run", "first.toml", "-o", "run.h5", "--set", "operation.duration=1 s"]).ends(0, &[]);
    scene_of(&directory, "next.toml", "dataset = \"/disc/height\"", "dataset = \"/pin/height\"");
    let coarser = ["mesh.rows=10", "mesh.disc_columns=345", "mesh.pin_columns=20", "operation.duration=1 s"];
    directory.plateau([&["run", "next.toml", "-o", "next.h5"], &sets(&coarser)[..]].concat()).ends(0, &[]);
    let heights = |file, moment| -> Vec<f64> {
        map(&directory, file, "disc/height", moment).into_iter().map(f64::from_bits).collect()
    };
    let (fine, coarse) = (heights("run.h5", 1), heights("next.h5", 0));
    // Two by two cells make one: its height is their mean.
    for (cell, height) in coarse.iter().enumerate() {
        let (column, row) = (2 * (cell / 10), 2 * (cell % 10));
        let four = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(x, y)| fine[(column + x) * 20 + row + y]);
        let mean = four.iter().sum::<f64>() / 4.0;
        assert!((height - mean).abs() < 1e-15, "cell {cell}: {height}, expected {mean}");
    }
}
