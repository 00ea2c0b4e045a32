//! A run as another program has it: observed, stopped, gone on with.

mod generations;
#[path = "../../io/tests/studies.rs"]
#[expect(dead_code, reason = "other tests need more of it")]
mod studies;
mod sweep;

use std::cell::RefCell;
use std::fmt::Display;
use std::path::Path;

use plateau_core::observe::Sample;
use plateau_core::simulation::{Execution, SimulationError};
use plateau_io::run_file::RunFile;
use plateau_io::scene::Scene;
use plateau_io::{scene, surface};
use plateau_run::{Assembly, Job, Observer, Progress, RunError, RunOptions, Sink, StartMode, run};

/// Notes what a run says, and stops it after so many samples.
#[derive(Default)]
struct Notes {
    said: RefCell<Vec<String>>,
    samples: RefCell<Vec<Sample>>,
    stop_after: Option<usize>,
}

impl Observer for Notes {
    fn note(&self, message: &dyn Display) {
        self.said.borrow_mut().push(message.to_string());
    }

    fn sample(&self, sample: &Sample) {
        self.samples.borrow_mut().push(sample.clone());
    }

    fn asked_to_stop(&self) -> Option<u8> {
        self.stop_after.filter(|samples| self.samples.borrow().len() >= *samples).map(|_| 2)
    }
}

/// The first half of the quick scene, 300 samples.
fn quick() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/quick.toml");
    scene::load(&path, &["operation.duration=30 s".to_owned()]).unwrap_or_else(|error| panic!("{error}"))
}

fn options(output: &Path, mode: StartMode) -> RunOptions {
    RunOptions { output: Some(output.to_owned()), mode, ..RunOptions::default() }
}

fn job() -> Job {
    Job::start().unwrap()
}

fn contact_areas(file: &Path) -> Vec<f64> {
    RunFile::open(file).unwrap().values("contact_area").unwrap().unwrap()
}

#[test]
fn an_observer_is_told_every_sample_that_is_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.h5");
    let notes = Notes::default();
    let summary = run(quick(), &options(&file, StartMode::New), &mut job(), &notes).unwrap().unwrap();
    assert_eq!((summary.steps, notes.samples.borrow().len()), (quick().steps, 300));
    let areas: Vec<f64> = notes.samples.borrow().iter().map(|sample| sample.contact_area).collect();
    assert_eq!(contact_areas(&file), areas);
    assert_eq!(summary.contact_area, areas[299]);
}

#[test]
fn a_run_that_was_stopped_goes_on_to_the_same_samples() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, stopped] = ["whole.h5", "stopped.h5"].map(|name| folder.path().join(name));
    run(quick(), &options(&whole, StartMode::New), &mut job(), &()).unwrap();
    let notes = Notes { stop_after: Some(20), ..Notes::default() };
    let Err(RunError::Stopped(stop)) = run(quick(), &options(&stopped, StartMode::New), &mut job(), &notes) else {
        panic!("not stopped")
    };
    let Progress::Saved { steps, samples, .. } = stop.progress else { panic!("{stop}") };
    assert!(stop.signal == 2 && (20..300).contains(&samples) && (1..quick().steps).contains(&steps), "{stop:?}");
    let notes = Notes::default();
    let summary = run(quick(), &options(&stopped, StartMode::Resume), &mut job(), &notes).unwrap().unwrap();
    assert!(notes.said.borrow()[0].starts_with(&format!("goes on from step {steps}, ")), "{:?}", notes.said);
    assert_eq!((summary.steps, notes.samples.borrow().len()), (quick().steps, 300 - samples));
    assert_eq!(contact_areas(&stopped), contact_areas(&whole));
    // Now there is nothing left to do, and that is said.
    let notes = Notes::default();
    assert!(run(quick(), &options(&stopped, StartMode::Resume), &mut job(), &notes).unwrap().is_none());
    assert!(notes.said.borrow()[0].contains("is finished"), "{:?}", notes.said);
}

/// Keeps every sample.
#[derive(Default)]
struct Rows(Vec<Sample>);

impl Sink for Rows {
    type Error = SimulationError;

    fn sample(&mut self, sample: Sample) -> Result<(), SimulationError> {
        self.0.push(sample);
        Ok(())
    }
}

#[test]
fn a_run_without_a_file_has_the_same_samples() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.h5");
    run(quick(), &options(&file, StartMode::New), &mut job(), &()).unwrap();
    let scene = quick();
    let surfaces = surface::load(&scene).unwrap().surfaces;
    let mut rows = Rows::default();
    Assembly::new(&scene, surfaces, Execution::default()).unwrap().run_to_end(&mut rows).unwrap();
    let areas: Vec<f64> = rows.0.iter().map(|sample| sample.contact_area).collect();
    assert_eq!(areas, contact_areas(&file));
}

#[test]
fn the_last_sample_is_the_row_of_its_step() {
    let scene = quick();
    let assembly = || Assembly::new(&scene, surface::load(&scene).unwrap().surfaces, Execution::default()).unwrap();
    let mut rows = Rows::default();
    assembly().run_to_end(&mut rows).unwrap();
    let mut stepwise = assembly();
    for expected in [&rows.0[0], &rows.0[9]] {
        stepwise.simulation.advance_to(expected.step).unwrap();
        assert_eq!(stepwise.last_sample().unwrap(), *expected);
    }
}
