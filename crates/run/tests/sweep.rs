//! Runs of a study as another program makes them.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use plateau_run::sweep::{self, Sweep, SweepObserver, SweepOptions, SweepSummary};
use plateau_run::{Failure, Job, Observer};

use crate::studies::Study;

/// Counts runs that ended, and stops all after so many.
struct Counter {
    ended: AtomicUsize,
    stop_after: usize,
}

impl Counter {
    fn new(stop_after: usize) -> Self {
        Self { ended: AtomicUsize::new(0), stop_after }
    }
}

impl SweepObserver for Counter {
    fn run_ended(&self, _failed: bool) {
        self.ended.fetch_add(1, Ordering::Relaxed);
    }
}

impl Observer for Counter {
    fn asked_to_stop(&self) -> Option<u8> {
        (self.ended.load(Ordering::Relaxed) >= self.stop_after).then_some(2)
    }
}

/// A study of the quick scene with these levels of the load, in a folder.
fn study(folder: &Path, levels: &str) -> PathBuf {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/quick.toml");
    let set = "set = [\"operation.duration=2 s\"]";
    let study = Study::new(&base.display().to_string(), "full-factorial", set)
        .load(&format!("levels = [{levels}]"))
        .response("area", "/series/contact_area", "at = \"end\"");
    let path = folder.join("loads.toml");
    fs::write(&path, study).unwrap();
    path
}

fn make(path: &Path, observer: &dyn SweepObserver) -> Result<SweepSummary, Failure> {
    let plan = sweep::load(path, None).map_err(Failure::input)?;
    let mut job = Job::start().unwrap();
    Sweep::prepare(&plan, SweepOptions::default(), &job, observer)?.run(&mut job, observer)
}

#[test]
fn a_sweep_that_was_stopped_makes_what_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path(), "\"20 N\", \"30 N\", \"40 N\", \"50 N\"");
    let first = make(&path, &Counter::new(2)).unwrap();
    assert_eq!((first.runs, first.finished, first.left, first.signal), (4, 2, 2, Some(2)));
    let counter = Counter::new(usize::MAX);
    let second = make(&path, &counter).unwrap();
    assert_eq!((second.finished_before, second.finished, second.failed, second.left), (2, 2, 0, 0));
    assert_eq!((second.signal, counter.ended.into_inner()), (None, 2));
    let journal = sweep::journal(sweep::load(&path, None).unwrap().study()).unwrap();
    assert_eq!((journal.entries().count(), journal.damaged), (4, 0));
    let plan = sweep::load(&path, None).unwrap();
    assert!(Sweep::prepare(&plan, SweepOptions::default(), &Job::start().unwrap(), &()).unwrap().pending().is_empty());
}

#[test]
fn a_scene_that_cannot_be_built_is_a_wrong_input_and_nothing_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path(), "\"20 N\", \"30 s\"");
    let said = make(&path, &()).unwrap_err();
    assert_eq!(said.status, Failure::INPUT, "{said}");
    assert!(!folder.path().join("results").exists());
}
