//! Scenes and the tables of their cycles: a scene that is accepted resolves to itself, and makes surfaces and steps if it is small.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::simulation::Simulation;
use plateau_io::plausibility;
use plateau_io::scene::{self, BaseSource, HeightSource, Scene, memory_estimate};
use plateau_io::surface;
use proptest::prelude::*;

use super::harness::Fuzz;
use super::lines::changed;

/// Cells of scenes that are made.
const FEW: usize = 20_000;
/// Fibres of these.
const FEW_FIBRES: f64 = 1e4;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn text(name: &str) -> String {
    fs::read_to_string(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Scenes that ask for all that there is, each on a small mesh.
fn seeds() -> Vec<String> {
    let names = ["minimal.toml", "full.toml", "hot.toml", "round.toml"].map(|name| format!("tests/scenes/good/{name}"));
    let shipped =
        ["quick.toml", "stops.toml", "cermet-hot.toml", "pad.toml"].map(|name| format!("../../data/scenes/{name}"));
    names.iter().chain(&shipped).map(|name| text(name)).collect()
}

/// Paths in the text are relative to the file.
fn beside_the_others(folder: &Path) -> PathBuf {
    let good = file("tests/scenes/good");
    for entry in fs::read_dir(&good).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        }
    }
    folder.join("changed.toml")
}

#[test]
fn changed_scenes_are_accepted_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = beside_the_others(folder.path());
    Fuzz { corpus: "scenes", cases: 600, least_accepted: 50 }.run(changed(seeds()), |content| {
        fs::write(&path, content).unwrap();
        match scene::load(&path, &[]) {
            Err(error) => {
                prop_assert!(!error.to_string().is_empty());
                Ok(false)
            }
            Ok(scene) => check(&scene, folder.path()).map(|()| true),
        }
    });
}

#[test]
fn changed_cycles_are_accepted_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cycle.csv");
    let lines = |name: &str| text(name).lines().take(40).collect::<Vec<_>>().join("\n");
    let stops =
        "time [s],nominal_pressure [MPa],rotational_speed [rpm]\n0,1.0,300\n3,1.0,0\n8,0,0\n9,0,300\n10,1,300\n";
    let decimal = "time [s];normal_force [N];sliding_speed [m/s]\n0;47,5;2\n1;40;2\n1;0;0\n4,5;0;0\n";
    let shipped = "../../data/cycles/wltc-front-brake.csv";
    let seeds = vec![stops.to_owned(), decimal.to_owned(), lines(shipped)];
    // The shipped one has a braking torque, which needs friction.
    let friction = "friction={ pressure_coefficient = 0.33, shear_strength = \"0.75 MPa\", maximum = 0.6 }".to_owned();
    let file_set = format!("operation.cycle.file=\"{}\"", path.display());
    let sets = [file_set, friction, "operation.duration=5 s".to_owned()];
    Fuzz { corpus: "cycles", cases: 600, least_accepted: 40 }.run(changed(seeds), |content| {
        fs::write(&path, content).unwrap();
        match scene::load(&file("../../data/scenes/quick.toml"), &sets) {
            Err(error) => {
                prop_assert!(!error.to_string().is_empty());
                Ok(false)
            }
            Ok(scene) => check(&scene, folder.path()).map(|()| true),
        }
    });
}

/// What is accepted can be written down, planned, and simulated.
fn check(scene: &Scene, folder: &Path) -> Result<(), TestCaseError> {
    let again = folder.join("resolved.toml");
    fs::write(&again, &scene.resolved).unwrap();
    match scene::load(&again, &[]) {
        Ok(resolved) => prop_assert_eq!(&resolved.resolved, &scene.resolved),
        Err(error) => prop_assert!(false, "what it resolves to is refused: {error}\n{}", scene.resolved),
    }
    let schedule = scene.schedule();
    let (mut steps, mut reached) = (0, 0.0);
    for _ in 0..3 {
        let Some(moment) = schedule.next(steps, reached) else { break };
        prop_assert!(moment.step >= steps, "{moment:?} after step {steps}");
        (steps, reached) = (moment.step, moment.time);
    }
    prop_assert!(memory_estimate(scene) > 0);
    if is_small(scene) { simulate(scene) } else { Ok(()) }
}

fn is_small(scene: &Scene) -> bool {
    let mesh = &scene.parameters.mesh;
    let heights = [&scene.disc_surface.source, &scene.pin_surface.source];
    let read = heights.iter().any(|source| matches!(source, HeightSource::File { .. }));
    let fibres = match &scene.pin_base {
        BaseSource::Synthetic(fibres) => {
            fibres.fibre_fraction * mesh.pin_area() / (fibres.fibre_length * fibres.fibre_width)
                * (1.0 + fibres.fibre_length / mesh.column_width() / mesh.pin_columns() as f64).powi(2)
        }
        BaseSource::Uniform(_) => 0.0,
        BaseSource::File { .. } | BaseSource::Image { .. } => f64::INFINITY,
    };
    mesh.disc_cells() <= FEW && !read && fibres <= FEW_FIBRES
}

fn simulate(scene: &Scene) -> Result<(), TestCaseError> {
    let loaded = match surface::load(scene) {
        Ok(loaded) => loaded,
        Err(error) => {
            prop_assert!(!error.to_string().is_empty());
            return Ok(());
        }
    };
    let _ = plausibility::of_surfaces(scene, &loaded);
    let answer = Simulation::new(scene.parameters.clone(), loaded.surfaces).and_then(|mut simulation| {
        for step in 1..=3 {
            simulation.advance_to(step)?;
            simulation.sample_at(&Default::default(), &scene.output.extras)?;
        }
        simulation.snapshot(&scene.output.maps)?;
        simulation.check_heights()
    });
    if let Err(error) = answer {
        prop_assert!(!error.to_string().is_empty());
    }
    Ok(())
}
