//! A run whose numbers have left what numbers can hold has failed, and says where.

use plateau_tests::program::{WorkingDirectory, quick_scene_with, scene};
use plateau_tests::studies::Study;

/// Legal scenes that ask for more wear than a number holds.
const ENDLESS: [&str; 2] = ["materials.pin_primary.specific_wear_rate=1e300 1/Pa", "numerics.time_acceleration=1e300"];

#[test]
fn a_run_without_finite_numbers_has_failed() {
    for set in ENDLESS {
        // With a sample at every step, with none before the end, and with a checkpoint before any sample.
        for every in ["1", "100000"] {
            let directory = WorkingDirectory::new();
            let every = format!("output.sample_every_steps={every}");
            let more = ["--set", set, "--set", &every, "--set", "output.checkpoint_every=0.001 s"];
            let arguments = ["run", &scene("quick.toml"), "-o", "run.h5"];
            let failed = directory.plateau(arguments.iter().chain(&more)).ends(1, &["after step ", "no number holds"]);
            let run = directory.run_file("run.h5");
            assert_eq!(run.text("state"), "failed", "{set}, {every}");
            assert!(failed.stderr.contains(&run.text("error")), "{}", run.text("error"));
            let heights = run.content();
            let finite = |bits: &u64| f64::from_bits(*bits).is_finite();
            assert!(heights["/series/worn_pin"].bits.iter().all(finite), "{set}, {every}");
            assert!(heights["/pin/height"].bits.iter().all(finite), "{set}, {every}");
            drop(run);
            directory.plateau(arguments.iter().chain(&more).chain(&["--resume"])).ends(1, &[]);
        }
    }
}

#[test]
fn a_series_without_finite_numbers_is_no_result() {
    let directory = WorkingDirectory::new();
    let short = quick_scene_with(&[("duration = \"60 s\"", "duration = \"1 s\"")]);
    let emission = "[emission]\npm10_fraction = 1.0\nnumber_per_mass = \"1e300 1/kg\"\npin_density = \"1e300 kg/m^3\"\n\
                    disc_density = \"1 kg/m^3\"\n";
    directory.write("emission.toml", format!("{short}\n{emission}"));
    directory.write("rough.toml", short);
    let rough = ["--set", "output.roughness=true", "--set", "pin.surface.resin_recess=1e160 m"];
    for (scene, sets, name) in [
        ("emission.toml", &[][..], "number of airborne particles"),
        ("rough.toml", &rough, "root-mean-square height Sq of the pin"),
    ] {
        directory
            .plateau(["run", scene, "-o", "run.h5", "--force"].iter().chain(sets))
            .ends(1, &[name, "no number holds"]);
        assert_eq!(directory.run_file("run.h5").text("state"), "failed", "{scene}");
    }
}

#[test]
fn what_the_model_has_no_number_for_is_no_failure() {
    let directory = WorkingDirectory::new();
    // A lifted pin has no displacement.
    let stops = scene("stops.toml");
    directory.plateau(["run", &stops, "-o", "run.h5", "--set", "output.roughness=true"]).quiet_success();
    let run = directory.run_file("run.h5");
    assert_eq!(run.text("state"), "finished");
    assert!(run.floats("/series/displacement").iter().any(|value| value.is_nan()));
}

#[test]
fn such_a_run_of_a_study_has_failed_too() {
    let directory = WorkingDirectory::new();
    let levels = "levels = [\"5e-14 1/Pa\", \"1e300 1/Pa\"]";
    let study = Study::new(&scene("quick.toml"), "full-factorial", "");
    let study = study.factor("wear rate", "materials.pin_primary.specific_wear_rate", levels);
    directory.write("study.toml", study);
    directory.plateau(["sweep", "run", "study.toml"]).ends(1, &["1 of 2 runs failed", "no number holds"]);
}
