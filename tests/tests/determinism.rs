//! Equal scenes give equal bits, whatever the number of workers.

use std::collections::BTreeMap;

use plateau_tests::program::{WorkingDirectory, scene};
use plateau_tests::run_file::{Content, RunFile, differences};

/// Every dataset of a short run of `quick.toml` with these arguments.
fn content(arguments: &[&str]) -> BTreeMap<String, Content> {
    let directory = WorkingDirectory::new();
    let scene = scene("quick.toml");
    let common = ["run", &scene, "-o", "run.h5", "--set", "operation.steps=1500"];
    let outcome = directory.plateau(common.iter().chain(arguments));
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    RunFile::open(directory.path("run.h5")).content()
}

#[test]
fn equal_scenes_give_equal_bits() {
    let (one, other) = (content(&[]), content(&[]));
    // 3 coordinates, time and map time, 23 series, 7 maps, the fibre map.
    assert_eq!(one.len(), 36);
    assert_eq!(differences(&one, &other), [""; 0]);
}

#[test]
fn the_number_of_workers_does_not_show() {
    let one = content(&["--workers", "1"]);
    for workers in ["2", "3", "auto"] {
        assert_eq!(differences(&one, &content(&["--workers", workers])), [""; 0], "{workers} workers");
    }
}

#[test]
fn another_seed_gives_other_numbers() {
    let different = differences(&content(&[]), &content(&["--set", "pin.surface.synthetic.seed=4"]));
    for path in ["/pin/height", "/disc/height", "/series/displacement"] {
        assert!(different.iter().any(|text| text.starts_with(path)), "{path} is not in {different:?}");
    }
}
