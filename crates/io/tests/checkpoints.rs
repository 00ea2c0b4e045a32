//! Checkpoints beside a run file: the newest, and the one before.

use std::fs;
use std::path::Path;

use plateau_core::observe::event::EventProgress;
use plateau_core::simulation::Simulation;
use plateau_io::run_file::checkpoint::{self, RunState, SimulationState};
use plateau_io::scene::{self, Scene};
use plateau_io::surface;

use crate::fixtures::place;

/// A scene of some cells.
pub fn scene() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/good/minimal.toml");
    let sets = ["mesh.rows=4", "mesh.disc_columns=40", "mesh.pin_columns=6", "pin.base.uniform=primary"];
    scene::load(&path, &sets.map(str::to_owned)).unwrap()
}

/// Its simulation at the beginning.
pub fn simulation(scene: &Scene) -> Simulation {
    Simulation::new(scene.parameters.clone(), surface::load(scene).unwrap().surfaces).unwrap()
}

/// Its state after some steps.
pub fn state_after(scene: &Scene, steps: u64) -> RunState {
    let mut simulation = simulation(scene);
    simulation.advance_to(steps).unwrap();
    RunState {
        program: "plateau".into(),
        scene: scene.resolved.clone(),
        inputs: Vec::new(),
        samples: 1,
        snapshots: 0,
        last: Some(simulation.sample().unwrap()),
        wall_time: 1.0,
        finished: false,
        simulation: SimulationState {
            run: simulation.checkpoint().unwrap(),
            scout: None,
            reached: 0.5,
            events: EventProgress::default(),
        },
        images: Vec::new(),
    }
}

#[test]
fn what_is_larger_than_any_state_of_a_run_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let [path, _] = checkpoint::paths(&folder.path().join("run.h5"));
    // It takes no room on the disk, and its digest is not looked at.
    for (size, most, expected) in [
        (4 << 30, Some(checkpoint::ample_size(&scene().parameters.mesh)), "larger than any of this run"),
        (1 << 42, None, "larger than the memory of this machine"),
        (1 << 20, None, "its digest does not hold"),
    ] {
        let size: u64 = size;
        let head = [&b"plateau state 8\n"[..], &(size - 16 - 8 - 32).to_le_bytes()].concat();
        fs::write(&path, head).unwrap();
        fs::File::options().write(true).open(&path).unwrap().set_len(size).unwrap();
        let refused = checkpoint::read::<RunState>(&path, most).unwrap_err().to_string();
        assert!(refused.contains(expected), "{refused}");
    }
}

#[test]
fn a_damaged_checkpoint_does_not_take_the_place_of_one_that_holds() {
    let (_folder, run_file) = place("run.h5");
    let [last, before] = checkpoint::paths(&run_file);
    let scene = scene();
    let steps_of = |path: &Path| {
        let state = checkpoint::read::<RunState>(path, None).ok().flatten();
        state.map(|state| state.simulation.run.steps())
    };
    for steps in [1, 2] {
        checkpoint::write(&run_file, &state_after(&scene, steps)).unwrap();
    }
    assert_eq!([steps_of(&last), steps_of(&before)], [Some(2), Some(1)]);

    let mut bytes = fs::read(&last).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&last, &bytes).unwrap();
    checkpoint::write(&run_file, &state_after(&scene, 3)).unwrap();
    assert_eq!([steps_of(&last), steps_of(&before)], [Some(3), Some(1)]);
    checkpoint::write(&run_file, &state_after(&scene, 4)).unwrap();
    assert_eq!([steps_of(&last), steps_of(&before)], [Some(4), Some(3)]);
}
