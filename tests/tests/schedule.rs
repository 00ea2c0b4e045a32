//! How many steps a scene takes, and when samples and maps are taken (docs/run-file.md).
//!
//! A step of `quick.toml` lasts m · 2π/columns / ω = 20 · 60 s/(850 · 690) = 4/1955 s, so what is expected is
//! computed exactly, in integers.

use plateau_tests::program::{WorkingDirectory, quick_scene_with, vector};
use plateau_tests::run_file::{RunFile, StoredStatus};

/// Duration of a step of `quick.toml`, s, as a fraction.
const STEP: (u64, u64) = (4, 1955);

/// The first step that does not end before `numerator / denominator` s.
fn step_at(numerator: u64, denominator: u64) -> u64 {
    (numerator * STEP.1).div_ceil(denominator * STEP.0)
}

/// Runs `quick.toml`, changed, and opens its run file.
fn quick_run(directory: &WorkingDirectory, edits: &[(&str, &str)]) -> RunFile {
    let scene = directory.write("scene.toml", quick_scene_with(edits));
    directory.plateau(["run".as_ref(), scene.as_os_str(), "-o".as_ref(), "run.h5".as_ref()]).quiet_success();
    directory.run_file("run.h5")
}

/// Asserts that times are those at the ends of the given steps.
fn assert_steps(times: &[f64], steps: &[u64], what: &str) {
    let found: Vec<f64> = times.iter().map(|time| time * STEP.1 as f64 / STEP.0 as f64).collect();
    assert_eq!(found.len(), steps.len(), "{what}: {found:?}, expected {steps:?}");
    for (found, expected) in found.iter().zip(steps) {
        // The product of a few rounded numbers.
        assert!((found / *expected as f64 - 1.0).abs() < 1e-14 || found == &0.0, "{what}: {found}, not {expected}");
    }
}

#[test]
fn samples_are_taken_at_the_first_step_that_reaches_a_multiple() {
    // 0.1 s are 48.875 steps: multiples fall within steps, and every eighth on the end of one.
    // 3 ms are 1.47 steps; 1 ms is less than a step; 5 s are more than the run.
    let duration = ("duration = \"60 s\"", "steps = 1000");
    for (every, thousandths) in [("0.1 s", 100), ("3 ms", 3), ("1 ms", 1), ("5 s", 5000)] {
        let directory = WorkingDirectory::new();
        let every = format!("sample_every = \"{every}\"");
        let run = quick_run(&directory, &[duration, ("sample_every = \"0.1 s\"", &every)]);
        let mut expected: Vec<u64> = (1..).map(|j| step_at(j * thousandths, 1000)).take_while(|n| *n < 1000).collect();
        expected.push(1000);
        expected.dedup();
        assert_steps(&run.floats("/time"), &expected, &every);
        for name in ["displacement", "pool", "balance_residual"] {
            assert_eq!(run.shape(&format!("/series/{name}")), [expected.len()], "{name}, {every}");
        }
    }
}

#[test]
fn samples_can_be_counted_in_steps_and_the_last_step_has_one() {
    for (steps, every, expected) in
        [(50, 7, vec![7, 14, 21, 28, 35, 42, 49, 50]), (20, 10, vec![10, 20]), (3, 1, vec![1, 2, 3]), (4, 9, vec![4])]
    {
        let directory = WorkingDirectory::new();
        let (steps, every) = (format!("steps = {steps}"), format!("sample_every_steps = {every}"));
        let run = quick_run(&directory, &[("duration = \"60 s\"", &steps), ("sample_every = \"0.1 s\"", &every)]);
        assert_steps(&run.floats("/time"), &expected, &every);
    }
}

#[test]
fn maps_are_taken_when_asked_for_and_at_the_end() {
    let cases: [(&str, &[u64]); 4] = [
        // 0.8 s are 391 steps; 0.1 s end in step 49; the last state is written once.
        ("[\"0.8 s\", \"0 s\", \"0.1 s\", \"0.1 s\"]", &[0, 49, 391, 782]),
        ("[\"1.6 s\"]", &[782]),
        ("[\"0 s\"]", &[0, 782]),
        ("[]", &[782]),
    ];
    for (times, expected) in cases {
        let directory = WorkingDirectory::new();
        let asked = format!("maps_at = {times}");
        let run =
            quick_run(&directory, &[("duration = \"60 s\"", "duration = \"1.6 s\""), ("maps_at = [\"0 s\"]", &asked)]);
        assert_steps(&run.floats("/map_time"), expected, times);
        assert_eq!(run.shape("/disc/height"), [expected.len(), 690, 20], "{times}");
        assert_eq!(run.shape("/pin/status"), [expected.len(), 40, 20], "{times}");
    }
}

#[test]
fn the_map_at_0_is_the_initial_state_bit_for_bit() {
    let directory = WorkingDirectory::new();
    let scene = vector("rough", "scene.toml");
    let sets = ["--set", "output.maps_at=[\"0 s\"]", "--set", "operation.steps=3"];
    directory.plateau(["run", &scene, "-o", "run.h5"].iter().chain(&sets)).quiet_success();
    let (run, initial) = (directory.run_file("run.h5"), RunFile::open(vector("rough", "init.h5")));
    let bits = |heights: Vec<f64>| heights.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    for body in ["disc", "pin"] {
        let expected = bits(initial.floats(&format!("/{body}/height")));
        for map in ["height", "substrate"] {
            assert_eq!(bits(run.map(&format!("/{body}/{map}"), 0)), expected, "/{body}/{map}");
        }
        assert_ne!(bits(run.last_map(&format!("/{body}/height"))), expected, "the {body} did not change in 3 steps");
    }
    assert!(run.map("/pin/pressure", 0).iter().all(|pressure| *pressure == 0.0));
    assert!(run.last_map("/pin/pressure").iter().any(|pressure| *pressure > 0.0));

    let base = run.statuses("/pin/base");
    let expected: Vec<_> = initial.floats("/pin/base").into_iter().map(|base| base == 1.0).collect();
    assert_eq!(base.iter().map(|base| *base == StoredStatus::primary).collect::<Vec<_>>(), expected);
    assert_eq!(run.statuses("/pin/status")[..base.len()], base);
    assert!(run.statuses("/disc/status")[..240 * 16].iter().all(|status| *status == StoredStatus::primary));
}
