//! How it ends when its input is wrong, a run fails, or it is stopped.

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use hdf5::types::VarLenUnicode;
use plateau_tests::program::wait_until;
use plateau_tests::run_file::changed;
use plateau_tests::table::Row;

use super::{expect_refusal, measured, run, with_scene};

#[test]
fn bad_input_is_refused() {
    let directory = with_scene(&[]);
    let fine = ["numerics.time_acceleration=5".to_owned()];
    drop(run(&directory, "good.h5", &fine));
    drop(run(&directory, "other.h5", &[fine.to_vec(), vec!["operation.normal_force=6 N".to_owned()]].concat()));
    drop(run(&directory, "short.h5", &[fine.to_vec(), vec!["operation.duration=10 s".to_owned()]].concat()));
    fs::copy(directory.path("good.h5"), directory.path("stopped.h5")).unwrap();
    let file = changed(directory.path("stopped.h5"));
    let state: VarLenUnicode = "interrupted".parse().unwrap();
    file.attr("state").unwrap().write_scalar(&state).unwrap();
    file.close().unwrap();
    let model = ["--set", "numerics.time_acceleration=1"];
    let chosen = ["--set", "numerics.time_acceleration={ tolerance = 0.01, max = 20 }"];
    let cases: [(&[&str], &[&str]); 14] = [
        (
            &["scene.toml", "--ladder", "steps"],
            &["'steps'", "time_acceleration, tolerance, mesh, integrator, perturbation"],
        ),
        (&["scene.toml", "--budget", "10"], &["'10'", "a time such as"]),
        (&["scene.toml", "--budget", "0 s"], &["expected more than 0 s"]),
        (
            &["scene.toml", "--budget", "1 us"],
            &[
                "the budget of",
                "is too small: at ",
                "steps/s, as measured, a reference with time_acceleration = ",
                "finer than the scene's time_acceleration = 20",
                "give --budget",
                "for a reference with 1, the model itself",
            ],
        ),
        (
            &[&["scene.toml", "--budget", "1 us"], &model[..]].concat(),
            &["too small", "the scene's own run, which is the reference, and one to hold against it take about"],
        ),
        (&["missing.toml"], &["missing.toml"]),
        (&["scene.toml", "--reference", "scene.toml"], &["scene.toml is not an HDF5 file"]),
        (
            &["scene.toml", "--reference", "other.h5"],
            &["other.h5 is a run of another scene", "operation.normal_force: \"6 N\" there, \"5 N\" here"],
        ),
        (&["scene.toml", "--reference", "short.h5"], &["short.h5 ends at 10.", "expected 20 s"]),
        (&["scene.toml", "--reference", "stopped.h5"], &["stopped.h5 is interrupted, expected a run that is finished"]),
        (
            &["scene.toml", "--reference", "good.h5", "--ladder", "mesh", "--budget", "1 us"],
            &["the budget of", "is too small: at ", "the runs to hold against the reference take about"],
        ),
        // A reference is finer than what it judges.
        (
            &["scene.toml", "--reference", "good.h5", "--set", "numerics.time_acceleration=5"],
            &["the reference has time_acceleration = 5, the scene has time_acceleration = 5: expected a reference"],
        ),
        (
            &[&["scene.toml", "--reference", "good.h5"], &chosen[..]].concat(),
            &["the scene has time_acceleration = { tolerance = 0.01, max = 20 }: expected a reference"],
        ),
        (&["scene.toml", "-o", "scene.toml"], &["cannot make the folder scene.toml"]),
    ];
    for (arguments, words) in cases {
        expect_refusal(&directory, arguments, words);
    }
    directory.write("taken/accuracy.svg", "mine");
    expect_refusal(&directory, &["scene.toml", "-o", "taken"], &["taken/accuracy.svg exists; give --force"]);
}

#[test]
fn a_signal_ends_it_in_good_order() {
    let directory = with_scene(&[]);
    let long = ["accuracy", "scene.toml", "--set", "operation.duration=1000 h", "--budget", "10000 h"];
    let mut command = directory.command(long);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    // The folder is made just before signals are heard; the reference takes hours.
    let started = wait_until(|| directory.path("accuracy").is_dir());
    sleep(Duration::from_secs(1));
    let sent = Command::new("kill").args(["-s", "INT", &child.id().to_string()]).status().unwrap();
    let outcome = child.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&outcome.stderr);
    assert!(started && sent.success());
    assert_eq!(outcome.status.code(), Some(130), "{message}");
    assert!(
        message.contains(
            "stopped by signal 2 (Ctrl-C) during the reference run with time_acceleration = 1; nothing is written"
        ),
        "{message}"
    );
    assert_eq!(directory.names(), ["scene.toml"]);
}

#[test]
fn a_run_that_fails_is_in_the_table_and_the_others_go_on() {
    let directory = with_scene(&[]);
    // The explicit rule wears far beyond what numbers can hold; the exponential one no farther than the overlap.
    let sets = [
        "numerics.integrator=exponential",
        "materials.pin_primary.specific_wear_rate=1e100 1/Pa",
        "plateaus.debris=contact",
        "plateaus.captured_fraction=0.06",
    ];
    let mut arguments: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    arguments.extend(["--ladder", "integrator", "--ladder", "time_acceleration"]);
    let (text, rows) = measured(&directory, &arguments);
    let failed: Vec<&Row> = rows.iter().filter(|row| row["state"] == "failed").collect();
    assert_eq!(failed.len(), 1, "{text}");
    assert_eq!((failed[0]["integrator"].as_str(), failed[0]["contact_area_error"].as_str()), ("explicit", ""));
    assert!(failed[0]["failure"].contains("nothing carries the load"), "{failed:?}");
    assert!(rows.len() > 3 && text.contains("integrator = \"explicit\" failed: step "), "{text}");
    assert!(text.contains("above 2 it is unstable"), "{text}");
}
