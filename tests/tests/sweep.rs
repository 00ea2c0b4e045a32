//! Studies: planned, run, stopped, gone on with and collected, as their users do it.

mod identity;
mod kept_files;
mod shared;
mod stopped;

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use plateau_tests::program::{Outcome, WorkingDirectory, ended, run, run_words, scene, start};
use plateau_tests::studies::Study;
use serde_json::Value;

/// Load times fibre fraction, three sets of surfaces each: 27 runs of some milliseconds.
fn study() -> String {
    let keys = "title = \"A small study\"\nset = [\"operation.duration = '3 s'\", \"output.sample_every = '0.5 s'\"]";
    Study::new(&scene("quick.toml"), "full-factorial", keys)
        .table("[replicates]\nkeys = [\"disc.surface.synthetic.seed\", \"pin.base.synthetic.seed\"]\nseeds = [7, 8, 9]")
        .load(r#"levels = ["5 N", "10 N", "20 N"]"#)
        .factor("fibre fraction", "pin.base.synthetic.fibre_fraction", "levels = [0.2, 0.3, 0.4]")
        .response("contact area at the end", "/series/contact_area_mean", r#"at = "end""#)
        .response("mean filling", "/series/filled_fraction", r#"mean = ["1 s", "3 s"]"#)
        .response("mean contact area", "/series/contact_area", r#"mean = "last tenth""#)
        .text()
}

const RUNS: usize = 27;
/// Changes of `quick.toml` that make run 15 by hand: point 5 (10 N, 0.3) with the third set of surfaces.
const RUN_15: [&str; 6] = [
    "operation.duration=3 s",
    "output.sample_every=0.5 s",
    "operation.normal_force=10 N",
    "pin.base.synthetic.fibre_fraction=0.3",
    "disc.surface.synthetic.seed=9",
    "pin.base.synthetic.seed=9",
];

fn directory() -> WorkingDirectory {
    WorkingDirectory::with("study.toml", study())
}

/// Counts of a plan or a summary.
fn counts<const N: usize>(summary: &Value, keys: [&str; N]) -> [u64; N] {
    keys.map(|key| summary[key].as_u64().unwrap_or_else(|| panic!("{key} of {summary}")))
}

/// The runs of `study` have few simulated revolutions: the mean over the last tenth is one over more, which is said once, and nothing
/// else. Of runs with m = 1 there is nothing to say.
fn says_what_the_mean_is_over(outcome: &Outcome, acceleration: f64) {
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    let said = &outcome.stderr;
    if acceleration == 1.0 {
        assert_eq!(said, "");
        return;
    }
    assert!(said.contains("\"mean contact area\": a tenth of a run has fewer than 10"), "{said}");
    assert!(said.contains("over all of the 3 s") || said.contains(" of 24 s;"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

/// `plateau sweep run study.toml --json`, and what it says.
fn sweep(directory: &WorkingDirectory, arguments: &[&str]) -> Value {
    directory.plateau(["sweep", "run", "study.toml", "--json"].iter().chain(arguments)).ends(0, &[]).json()
}

/// Collects and gives the table without wall times, which it does not have, and the series.
fn results(directory: &WorkingDirectory) -> (String, Vec<Vec<u64>>) {
    let is_plain = directory.text("study.toml").contains("time_acceleration = 1\"");
    let acceleration = if is_plain { 1.0 } else { 20.0 };
    says_what_the_mean_is_over(&directory.plateau(["sweep", "collect", "study.toml"]), acceleration);
    let file = directory.run_file("results/results.h5");
    let bits = |name: &str| file.floats(name).iter().map(|value| value.to_bits()).collect();
    let series = ["/time", "/contact_area", "/pool", "/worn_pin", "/load", "/mean_filling"].map(bits);
    (directory.text("results/results.csv"), series.to_vec())
}

/// The identity of every record that is whole, of all shards, with those of runs that were made twice. Equal lines are
/// copies, of a merge that was killed.
fn records(directory: &WorkingDirectory) -> Vec<String> {
    let read = || -> std::io::Result<Vec<String>> {
        fs::read_dir(directory.path("results/journal"))?.map(|shard| fs::read_to_string(shard?.path())).collect()
    };
    // A shard that is merged meanwhile is gone before it is read.
    let texts = (0..100).find_map(|_| read().ok()).unwrap_or_default();
    let record = |line: &str| serde_json::from_str::<Value>(line.get(9..)?).ok();
    let lines: BTreeSet<&str> = texts.iter().flat_map(|text| text.lines()).collect();
    lines.into_iter().filter_map(record).map(|record| record["identity"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn a_folder_that_cannot_be_written_is_named_before_a_run_is_made() {
    // No user may make anything there.
    let directory = WorkingDirectory::with("study.toml", study().replace("\"results\"", "\"/proc/nowhere\""));
    let advice = "name another folder with `directory` in study.toml";
    let outcome = directory.plateau(["sweep", "run", "study.toml", "-q"]).ends(2, &[advice]);
    assert!(outcome.stderr.starts_with("plateau: cannot write to /proc/nowhere/journal: "), "{outcome:?}");
}

#[test]
fn a_study_is_planned_run_and_collected() {
    let directory = directory();
    let planned = directory.plateau(["sweep", "plan", "study.toml", "--json"]).json();
    assert_eq!(counts(&planned, ["points", "runs"]), [9, 27]);
    assert!(planned["memory"].as_u64() > Some(100_000) && planned["estimated_time"].as_f64() > Some(0.0));
    assert_eq!(directory.names(), ["study.toml"], "a plan leaves nothing behind");

    let [ran, again] = [&["--jobs", "2"][..], &[]].map(|more| sweep(&directory, more));
    assert_eq!([ran, again].map(|summary| counts(&summary, ["finished", "finished_before"])), [[27, 0], [0, 27]]);

    let collected = directory.plateau(["sweep", "collect", "study.toml", "--json"]).json();
    assert_eq!(counts(&collected, ["finished", "missing"]), [27, 0]);
    let file = directory.run_file("results/results.h5");
    assert_eq!(file.shape("/contact_area"), [RUNS, 6]);
    assert_eq!(file.floats("/load")[..4], [5.0, 5.0, 5.0, 10.0]);

    // The same by hand.
    directory.plateau(run_words("quick.toml", "alone.h5", &RUN_15, &[])).quiet_success();
    let alone = directory.run_file("alone.h5");
    for series in ["contact_area", "pool", "worn_resin", "displacement", "filled_fraction"] {
        let of_all = file.floats(&format!("/{series}"));
        assert_eq!(of_all[14 * 6..15 * 6], alone.floats(&format!("/series/{series}")), "{series}");
    }
    let area = alone.floats("/series/contact_area_mean");
    assert_eq!(file.floats("/contact_area_at_the_end")[14], area[5]);
    // The table has units in its head and numbers below, to the bit.
    let table = directory.text("results/results.csv");
    let mut lines = table.lines();
    let head = "run,point,replicate,state,load [N],fibre fraction,contact area at the end [m2],mean filling,";
    assert!(lines.next().is_some_and(|line| line.starts_with(head) && line.ends_with(",error")), "{table}");
    let cells: Vec<&str> = lines.nth(14).unwrap().split(',').collect();
    assert_eq!(cells[..6], ["15", "5", "3", "finished", "10.0", "0.3"]);
    assert_eq!(cells[6].parse(), Ok(area[5]));
    // By hand: the trapezia between the samples at 1, 1.5, 2, 2.5 and 3 s; steps end up to a step after these times.
    let filled = alone.floats("/series/filled_fraction");
    let mean = (filled[1] / 2.0 + filled[2] + filled[3] + filled[4] + filled[5] / 2.0) / 4.0;
    assert!((file.floats("/mean_filling")[14] / mean - 1.0).abs() < 1e-3);
    // So short a run has fewer than ten simulated revolutions: the mean is over all of it, too short for an error.
    let [integral, time] = ["/series/contact_area_integral", "/time"].map(|name| *alone.floats(name).last().unwrap());
    assert_eq!(file.floats("/mean_contact_area")[14], integral / time);
    assert!(file.floats("/mean_contact_area_standard_error").iter().all(|error| error.is_nan()));
    let end = ",mean contact area [m2],mean contact area standard error [m2],error";
    assert!(table.lines().next().unwrap().ends_with(end), "{table}");
}

#[test]
fn a_mean_of_the_last_tenth_is_that_of_the_summary() {
    let directory = directory();
    // Pulses of less than a second.
    let longer = study().replace("'3 s'", "'24 s'").replace("seeds = [7, 8, 9]", "seeds = [7]");
    let longer = longer.replace("set = [", "set = [\"materials.pin_resin.wear_height = '0.1 um'\", ");
    let one = longer.replace("\"10 N\", \"20 N\"", "\"10 N\"").replace("0.2, 0.3, 0.4", "0.2, 0.4");
    directory.write("study.toml", one);
    sweep(&directory, &["--jobs", "2"]);
    says_what_the_mean_is_over(&directory.plateau(["sweep", "collect", "study.toml"]), 20.0);
    let file = directory.run_file("results/results.h5");
    // Run 4: 10 N, 0.4.
    let settings = [
        "materials.pin_resin.wear_height=0.1 um",
        "operation.duration=24 s",
        "output.sample_every=0.5 s",
        "operation.normal_force=10 N",
        "pin.base.synthetic.fibre_fraction=0.4",
        "disc.surface.synthetic.seed=7",
        "pin.base.synthetic.seed=7",
    ];
    let summary = directory.plateau(run_words("quick.toml", "alone.h5", &settings, &["--json"])).json();
    let window = &summary["contact_area_last_tenth"];
    // The run adds up step by step, the study takes the difference of integrals that are ten times as large; each step rounds once.
    let tolerance = 10.0 * summary["steps"].as_f64().unwrap() * f64::EPSILON;
    let ratio = window["mean"].as_f64().unwrap() / file.floats("/mean_contact_area")[3];
    assert!((ratio - 1.0).abs() < tolerance, "{window} {ratio}");
    // The revolutions of a run file follow from its sliding distance.
    let error = file.floats("/mean_contact_area_standard_error")[3];
    assert!((window["standard_error"].as_f64().unwrap() / error - 1.0).abs() < 1e-6, "{window} {error}");
}

#[test]
fn points_that_are_there_twice_are_one_run() {
    let directory = WorkingDirectory::new();
    let composite = study()
        .replace("\"full-factorial\"", "\"central-composite\"\ncentre_points = 6")
        .replace("levels = [\"5 N\", \"10 N\", \"20 N\"]", "range = [\"5 N\", \"20 N\"]")
        .replace("levels = [0.2, 0.3, 0.4]", "range = [0.2, 0.4]")
        .replace("[7, 8, 9]", "[7, 8]");
    directory.write("study.toml", composite);
    // Four corners, four axial points, the centre six times: nine different ones, with two seeds each.
    let planned = directory.plateau(["sweep", "plan", "study.toml", "--json"]).json();
    assert_eq!(counts(&planned, ["runs", "repeats"]), [28, 10]);
    let said = "10 of 28 runs repeat another one and count once with it";
    let text = directory.plateau(["sweep", "plan", "study.toml"]).stdout;
    assert!(text.contains("different runs  18") && text.contains(said) && text.contains("[replicates]"), "{text}");

    // Whichever task makes them, each is made once.
    let made = ["1/2", "2/2"].map(|task| sweep(&directory, &["--task", task])["finished"].as_u64().unwrap());
    assert_eq!((made.iter().sum::<u64>(), records(&directory).len()), (18, 18));
    let again = sweep(&directory, &[]);
    assert_eq!(counts(&again, ["runs", "repeats", "finished_before", "left"]), [28, 10, 18, 0]);
    let planned = directory.plateau(["sweep", "plan", "study.toml", "--json"]).json();
    assert_eq!((planned["ended"]["finished"].as_u64(), planned["estimated_time"].as_f64()), (Some(18), Some(0.0)));

    // All 28 are in the table.
    let (table, _) = results(&directory);
    assert_eq!(table.matches(",finished,").count(), 28);
}

#[test]
fn tasks_share_a_study_and_nothing_of_it_shows() {
    let (whole, shared) = (directory(), directory());
    sweep(&whole, &["--jobs", "1"]);
    let commands = ["1/4", "3/4", "4/4", "2/4", "2/4"].map(|task| {
        start(shared.command(["sweep", "run", "study.toml", "--workers", "2", "--jobs", "1", "--task", task]))
    });
    for child in commands {
        ended(child).ends(0, &[]);
    }
    assert_eq!(results(&shared), results(&whole));
    assert_eq!(records(&shared).into_iter().collect::<BTreeSet<_>>().len(), RUNS);
    assert!(fs::read_dir(shared.path("results/journal")).unwrap().count() <= 8);
}

#[test]
fn a_run_that_fails_does_not_stop_the_others() {
    let directory = directory();
    // At 20 N the explicit rule is far above its bound of stability, and heights overflow.
    directory.write("study.toml", study().replace("\"20 N\"", "\"1e300 N\""));
    let words = ["sweep", "run", "study.toml", "--json"];
    let ran = directory.plateau(words).ends(1, &["failed:"]).json();
    assert_eq!(counts(&ran, ["finished", "failed", "left"]), [18, 9, 0]);
    assert_eq!(counts(&directory.plateau(words).json(), ["finished", "failed"]), [0, 0]);
    let retried = directory.plateau(words.iter().chain(&["--retry", "--max-failures", "1", "--jobs", "1"])).json();
    assert_eq!(counts(&retried, ["failed", "left"]), [1, 8]);
    let collected = directory.plateau(["sweep", "collect", "study.toml"]).stdout;
    let failed = "Failed\n  run 7: step 1: nothing carries";
    assert!(collected.contains("failed    9") && collected.contains(failed), "{collected}");
    let areas = directory.run_file("results/results.h5").floats("/contact_area_at_the_end");
    assert_eq!(areas.iter().filter(|area| area.is_nan()).count(), 9);
}

#[test]
fn results_belong_to_scene_files_and_program_not_to_workers_or_names() {
    let directory = directory();
    sweep(&directory, &["--jobs", "2", "--workers", "1"]);
    let renamed = study().replace("A small study", "Another title").replace("name = \"load\"", "name = \"force\"");
    directory.write("study.toml", renamed.replace("at = \"end\"", "at = \"2 s\""));
    assert_eq!(sweep(&directory, &["--workers", "2"])["finished_before"].as_u64(), Some(RUNS as u64));
    // A level more: nine runs more.
    directory.write("study.toml", study().replace("\"20 N\"]", "\"20 N\", \"30 N\"]"));
    assert_eq!(counts(&sweep(&directory, &[]), ["finished_before", "finished"]), [27, 9]);
    // Another duration: all of them.
    directory.write("study.toml", study().replace("'3 s'", "'3.5 s'"));
    assert_eq!(sweep(&directory, &[])["finished_before"].as_u64(), Some(0));
}

#[test]
fn what_is_wrong_with_a_study_is_said_before_anything_runs() {
    let directory = directory();
    let cases = [
        ("levels = [\"5 N\", \"10 N\", \"20 N\"]", "levels = [\"5 N\", \"10 kg\"]"),
        ("design = \"full-factorial\"", "design = \"full-factoral\""),
        ("key = \"operation.normal_force\"", "key = \"operation.normal_farce\""),
        ("dataset = \"/series/contact_area_mean\"", "dataset = \"/series/contact_aera\""),
        ("seeds = [7, 8, 9]", "seeds = [7, 7, -1]"),
        ("at = \"end\"", "at = \"end\"\nmean = [\"1 s\", \"2 s\"]"),
        ("mean = [\"1 s\", \"3 s\"]", "mean = [\"3 s\", \"1 s\"]"),
        ("mean = [\"1 s\", \"3 s\"]", "mean = \"last fifth\""),
        ("dataset = \"/series/filled_fraction\"", "dataset = \"/series/worn_pin\""),
        ("directory = \"results\"", "directory = \"results\"\npoints = 5"),
        ("directory = \"results\"", "directory = \"results\"\nfoo = 5"),
        ("levels = [0.2, 0.3, 0.4]", "range = [0.4, 0.2]"),
        ("levels = [\"5 N\", \"10 N\", \"20 N\"]", "range = [\"5 N\", \"20 kg\"]"),
        ("levels = [\"5 N\", \"10 N\", \"20 N\"]", "range = [\"5 N\", 20]"),
        ("levels = [\"5 N\", \"10 N\", \"20 N\"]", "range = [\"5 N\", \"1 kN\"]"),
        ("levels = [0.2, 0.3, 0.4]", "range = [0.2, \"0.4\"]"),
        ("levels = [0.2, 0.3, 0.4]", "levels = [0.2, 0.2]"),
        ("levels = [\"5 N\", \"10 N\", \"20 N\"]", "levels = [\"5 N\", \"5000 mN\"]"),
        ("keys = [\"disc.surface.synthetic.seed\", \"pin.base.synthetic.seed\"]", "keys = [\"mesh.rows\"]"),
        ("version = 1", "version = 2"),
        ("version = 1", "version = "),
    ];
    let mut said = String::new();
    for (old, new) in cases {
        assert_eq!(study().matches(old).count(), 1, "{old}");
        directory.write("study.toml", study().replace(old, new));
        let outcome = directory.plateau(["sweep", "run", "study.toml"]);
        assert_eq!(outcome.status, Some(2), "{new}: {outcome:?}");
        said.push_str(&format!("# {new}\n{}\n", outcome.stderr.replace(&scene("quick.toml"), "quick.toml")));
    }
    insta::assert_snapshot!(said);
    assert_eq!(directory.names(), ["study.toml"]);
}

#[test]
fn a_batch_script_asks_for_what_the_estimate_says() {
    let directory = directory();
    directory.plateau(["sweep", "slurm", "study.toml", "--tasks", "4"]).quiet_success();
    let script = directory.text("study.sbatch");
    for line in [
        "#!/bin/sh\n",
        "#SBATCH --array=1-4\n",
        "--task \"$SLURM_ARRAY_TASK_ID/4\" --jobs 1\n",
        "#SBATCH --signal=B:TERM@60\n",
    ] {
        assert!(script.contains(line), "{line} in\n{script}");
    }
    directory.plateau(["sweep", "slurm", "study.toml"]).ends(2, &[]);
    // Without Slurm, a task is what the shell makes of it.
    let mut shell = Command::new("sh");
    shell.arg("study.sbatch").env("SLURM_ARRAY_TASK_ID", "2").current_dir(directory.path("."));
    run(shell).ends(0, &[]);
    assert_eq!(records(&directory).len(), 7);
}

#[test]
fn what_the_scenes_can_hardly_mean_is_said_once_with_its_runs() {
    let directory = WorkingDirectory::new();
    // Cells are 50 um wide; a cutoff of 1 mm cuts nothing.
    let more = "output.sample_every = '0.5 s'\", \"disc.prepare.cutoff = '1 mm'";
    let study = study().replace("output.sample_every = '0.5 s'", more);
    let study = study.replace("operation.normal_force", "disc.surface.synthetic.correlation_length");
    directory.write("study.toml", study.replace(r#"["5 N", "10 N", "20 N"]"#, r#"["60 um", "80 um", "500 um"]"#));
    for command in ["plan", "run"] {
        let outcome = directory.plateau(["sweep", command, "study.toml"]).ends(0, &[]);
        let lines = |words: &str| -> Vec<_> { outcome.stderr.lines().filter(|line| line.contains(words)).collect() };
        let length = lines("correlation_length: ");
        assert!(length.len() == 1 && length[0].ends_with("(so in 18 of 27 runs)"), "{}", outcome.stderr);
        let cutoff = lines("no peak is so high");
        assert!(cutoff.len() == 1 && cutoff[0].contains("(so in "), "{}", outcome.stderr);
        assert!(command == "plan" || cutoff[0].contains("27 of 27 runs that were made now"), "{}", outcome.stderr);
    }
    assert_eq!(directory.plateau(["sweep", "plan", "study.toml", "-q"]).stderr, "");
}
