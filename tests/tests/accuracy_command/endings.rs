//! How it ends when its input is wrong, a run fails, or it is stopped.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use plateau_tests::program::{ended, send, sets, start, wait_until};
use plateau_tests::run_file::set_text;
use plateau_tests::table::Row;

use super::{measured, refusal, run, with_scene};

#[test]
fn bad_input_is_refused() {
    let directory = with_scene(&[]);
    let fine = "numerics.time_acceleration=5";
    drop(run(&directory, "good.h5", &[fine]));
    drop(run(&directory, "other.h5", &[fine, "operation.normal_force=6 N"]));
    drop(run(&directory, "short.h5", &[fine, "operation.duration=10 s"]));
    fs::copy(directory.path("good.h5"), directory.path("stopped.h5")).unwrap();
    set_text(directory.path("stopped.h5"), "state", "interrupted");
    let model = ["--set", "numerics.time_acceleration=1"];
    let chosen = ["--set", "numerics.time_acceleration={ tolerance = 0.01, max = 20 }"];
    directory.write("taken/accuracy.svg", "mine");
    let cases: [&[&str]; 17] = [
        &["scene.toml", "--ladder", "mesh"],
        &["scene.toml", "--quantity", "area"],
        &["scene.toml", "--tolerance", "1 %"],
        &["scene.toml", "--tolerance", "0"],
        &["scene.toml", "--budget", "10"],
        &["scene.toml", "--budget", "0 s"],
        &["scene.toml", "--budget", "1 us"],
        &[&["scene.toml", "--budget", "1 us"], &model[..]].concat(),
        &["missing.toml"],
        &["scene.toml", "--reference", "scene.toml"],
        &["scene.toml", "--reference", "other.h5"],
        &["scene.toml", "--reference", "short.h5"],
        &["scene.toml", "--reference", "stopped.h5"],
        // A reference is finer than what it judges.
        &["scene.toml", "--reference", "good.h5", "--set", "numerics.time_acceleration=5"],
        &[&["scene.toml", "--reference", "good.h5"], &chosen[..]].concat(),
        &["scene.toml", "-o", "scene.toml"],
        &["scene.toml", "-o", "taken"],
    ];
    let said = cases.map(|arguments| format!("$ {}\n{}", arguments.join(" "), steady(&refusal(&directory, arguments))));
    insta::assert_snapshot!(said.join("\n"));
}

/// A message with what depends on the machine taken out: speeds, the budgets that follow from them, and the folder.
fn steady(message: &str) -> String {
    let mut steady = message.to_owned();
    for (before, after) in [
        ("at ", " steps/s"),
        ("needs a budget of ", "; give"),
        ("--budget ", " or more"),
        (", or ", " for 1,"),
        ("looked for ", "/missing.toml"),
    ] {
        if let Some((start, rest)) = steady.split_once(before)
            && let Some((_, end)) = rest.split_once(after)
        {
            steady = format!("{start}{before}…{after}{end}");
        }
    }
    steady
}

#[test]
fn a_signal_ends_it_in_good_order() {
    let directory = with_scene(&[]);
    let long = ["accuracy", "scene.toml", "--set", "operation.duration=1000 h", "--budget", "10000 h"];
    let child = start(directory.command(long));
    // The folder is made just before signals are heard; the reference takes hours.
    let started = wait_until(|| directory.path("accuracy").is_dir());
    sleep(Duration::from_secs(1));
    send("INT", child.id());
    let said = "stopped by signal 2 (Ctrl-C) during the reference run with time_acceleration = 1; nothing is written";
    ended(child).ends(130, &[said]);
    assert!(started);
    assert_eq!(directory.names(), ["scene.toml"]);
}

#[test]
fn a_run_that_fails_is_in_the_table_and_the_others_go_on() {
    let directory = with_scene(&[]);
    // With a large time acceleration the explicit rule wears beyond what numbers can hold.
    let settings = [
        "materials.pin_primary.specific_wear_rate=1e7 1/Pa",
        "plateaus.debris=contact",
        "plateaus.captured_fraction=0.06",
    ];
    let (text, rows) = measured(&directory, &[&sets(&settings)[..], &["--ladder", "time_acceleration"]].concat());
    let failed: Vec<&Row> = rows.iter().filter(|row| row["state"] == "failed").collect();
    assert_eq!(failed.len(), 1, "{text}");
    assert_eq!((failed[0]["value"].as_str(), failed[0]["contact_area_error"].as_str()), ("20.0", ""));
    assert!(failed[0]["failure"].contains("nothing carries the load"), "{failed:?}");
    assert!(rows.len() > 3 && text.contains("time_acceleration = 20 failed: step "), "{text}");
    assert!(text.contains("above 2 it is unstable"), "{text}");
}
