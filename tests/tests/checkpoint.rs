//! A simulation that goes on from a checkpoint takes the steps of one that never stopped.

use std::path::Path;

use plateau_core::engine::kernel::InstructionSet;
use plateau_core::simulation::checkpoint::Checkpoint;
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_io::{scene as scene_file, surface};
use plateau_tests::divergence::differences;
use plateau_tests::program::scene;

/// `quick.toml` with changes.
fn simulation(sets: &[&str], workers: usize, instructions: InstructionSet) -> Simulation {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let scene = scene_file::load(Path::new(&scene("quick.toml")), &sets).unwrap();
    let surfaces = surface::load(&scene).unwrap().surfaces;
    let execution = Execution { workers, instructions, ..Execution::default() };
    Simulation::with_execution(scene.parameters, surfaces, execution).unwrap()
}

/// Scenes with every part of the model on and off.
const SCENES: [&[&str]; 8] = [
    &[],
    &["materials.pin_secondary.youngs_modulus=5e8 Pa", "numerics.time_acceleration=400"],
    &["plateaus.debris=contact", "plateaus.captured_fraction=0.06"],
    &["plateaus.formation=false"],
    &["plateaus.debris=track", "plateaus.captured_fraction=0.5"],
    &["materials.disc_primary.specific_wear_rate=1e-15 1/Pa", "numerics.integrator=exponential"],
    &[
        "materials.pin_secondary.youngs_modulus=5e8 Pa",
        "plateaus.debris=contact",
        "plateaus.captured_fraction=0.9",
        "plateaus.destruction=true",
    ],
    &["mesh.rows=13", "mesh.disc_columns=61", "mesh.pin_columns=61"],
];

#[test]
fn no_step_after_a_checkpoint_differs() {
    for sets in SCENES {
        let best = InstructionSet::best();
        let mut whole = simulation(sets, 1, InstructionSet::PORTABLE);
        let mut taken = simulation(sets, 2, best);
        for (stop, workers, instructions) in
            [(0, 1, best), (201, 3, best), (450, 1, InstructionSet::PORTABLE), (2111, 5, best), (2900, 2, best)]
        {
            taken.pass_to(stop).unwrap();
            let checkpoint = taken.checkpoint().unwrap();
            assert_eq!(checkpoint.steps(), stop);
            let mut restored = simulation(sets, workers, instructions);
            restored.restore(&checkpoint).unwrap();
            assert_eq!(restored.checkpoint().unwrap(), checkpoint, "{sets:?} after {stop} steps");
            let mut pair = [whole, restored];
            for step in [stop + 1, stop + 2, stop + 200] {
                assert_eq!(differences(&mut pair, step), [], "{sets:?} after {stop} steps");
            }
            // What is kept of the steps, too.
            let [one, other] = pair.each_mut().map(|simulation| simulation.checkpoint().unwrap());
            assert!(one == other, "{sets:?} after {stop} steps: what is kept differs");
            [whole, _] = pair;
        }
    }
}

#[test]
fn an_acceleration_that_changed_goes_on() {
    let best = InstructionSet::best();
    let mut whole = simulation(&[], 1, best);
    for (step, acceleration) in [(100, 3.0), (300, 55.5)] {
        whole.pass_to(step).unwrap();
        whole.accelerate(acceleration).unwrap();
    }
    whole.pass_to(350).unwrap();
    let mut restored = simulation(&[], 2, best);
    restored.restore(&whole.checkpoint().unwrap()).unwrap();
    assert_eq!(restored.parameters().time_acceleration, 55.5);
    assert_eq!(differences(&mut [whole, restored], 700), []);
}

#[test]
fn a_checkpoint_of_another_mesh_is_refused() {
    let best = InstructionSet::best();
    let checkpoint: Checkpoint = simulation(&[], 1, best).checkpoint().unwrap();
    let refused = simulation(&["mesh.rows=21"], 2, best).restore(&checkpoint);
    let Err(SimulationError::Checkpoint(wrong)) = refused else { panic!("{refused:?}") };
    assert_eq!(wrong.to_string(), "the checkpoint is of another mesh: 13800 disc cells, expected 14490");
}
