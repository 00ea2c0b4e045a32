//! Run files of the runs of a study: kept on request, and of one run by itself; and results in another folder than the study names.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use plateau_tests::program::{Outcome, WorkingDirectory, scene, wait_until};
use plateau_tests::run_file::{RunFile, differences};
use serde_json::Value;

use super::{RUN_15, RUNS, directory, json, records, results, study, sweep};

/// The run files that are kept, by their names.
fn kept(directory: &WorkingDirectory) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory.path("results/runs")).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.sort();
    files
}

/// The one of a run.
fn of_run(directory: &WorkingDirectory, number: usize) -> PathBuf {
    let start = format!("run-{number:04}-");
    let is_of = |file: &PathBuf| file.file_name().unwrap().to_str().unwrap().starts_with(&start);
    let files: Vec<_> = kept(directory).into_iter().filter(is_of).collect();
    let [file] = files.as_slice() else { panic!("{start}: {files:?}") };
    file.clone()
}

fn finished(summary: &Value) -> [u64; 2] {
    ["finished_before", "finished"].map(|key| summary[key].as_u64().unwrap())
}

fn content_differs(one: impl AsRef<std::path::Path>, other: impl AsRef<std::path::Path>) -> Vec<String> {
    differences(&RunFile::open(one).content(), &RunFile::open(other).content())
}

#[test]
fn run_files_are_kept_and_nothing_else_changes() {
    let (plain, keeping) = (directory(), directory());
    sweep(&plain, &["--jobs", "2"]);
    assert!(!plain.path("results/runs").exists());
    // Tasks, as of a job array, and what is there already.
    sweep(&keeping, &["--task", "1/2", "--keep-files"]);
    assert_eq!(kept(&keeping).len(), RUNS.div_ceil(2));
    assert_eq!(finished(&sweep(&keeping, &["--keep-files"])), [14, 13]);
    assert_eq!(kept(&keeping).len(), RUNS, "nothing but run files: {:?}", kept(&keeping));
    assert_eq!(results(&keeping), results(&plain));
    // Run 15 by hand, with its maps.
    let (quick, sets) = (scene("quick.toml"), RUN_15.iter().flat_map(|set| ["--set", set]));
    plain.plateau(["run", &quick, "-o", "alone.h5"].into_iter().chain(sets)).quiet_success();
    assert_eq!(content_differs(plain.path("alone.h5"), of_run(&keeping, 15)), [""; 0]);
    assert!(RunFile::open(of_run(&keeping, 15)).shape("/pin/height")[0] > 1);

    // A file that is gone is made again, and no other one.
    fs::remove_file(of_run(&keeping, 15)).unwrap();
    assert_eq!(finished(&sweep(&keeping, &[])), [27, 0]);
    assert_eq!(finished(&sweep(&keeping, &["--keep-files"])), [26, 1]);
    assert_eq!(content_differs(plain.path("alone.h5"), of_run(&keeping, 15)), [""; 0]);
    assert_eq!(results(&keeping), results(&plain));

    // With a level more most runs have another number, and so have their files; with one less, some are of no run.
    let has_load = |number: usize, load: &str| {
        let scene = RunFile::open(of_run(&keeping, number)).text("scene");
        assert!(scene.contains(&format!("normal_force = \"{load}\"")), "run {number}, {load}: {scene}");
    };
    keeping.write("study.toml", study().replace("\"20 N\"]", "\"8 N\", \"20 N\"]"));
    assert_eq!(finished(&sweep(&keeping, &["--keep-files"])), [27, 9]);
    assert_eq!(kept(&keeping).len(), 36);
    for (number, load) in [(1, "5 N"), (4, "10 N"), (7, "8 N"), (10, "20 N"), (13, "5 N")] {
        has_load(number, load);
    }
    keeping.write("study.toml", study().replace("\"5 N\", ", ""));
    let less = keeping.plateau(["sweep", "run", "study.toml", "--json", "--keep-files"]);
    assert_eq!(finished(&json(&less)), [18, 0], "{less:?}");
    for (number, load) in [(2, "10 N"), (4, "20 N"), (7, "10 N")] {
        has_load_or_another(&keeping, number, load);
    }
    assert!(less.stderr.contains("results/runs: 18 run files of runs that the study no longer has"), "{less:?}");
}

/// One of the files of a number is of a run with this load: a run that is no more may have had the number.
fn has_load_or_another(directory: &WorkingDirectory, number: usize, load: &str) {
    let start = format!("run-{number:04}-");
    let is_of = |file: &PathBuf| file.file_name().unwrap().to_str().unwrap().starts_with(&start);
    let scenes = kept(directory).into_iter().filter(is_of).map(|file| RunFile::open(file).text("scene"));
    let load = format!("normal_force = \"{load}\"");
    assert!(scenes.into_iter().any(|scene| scene.contains(&load)), "run {number}, {load}");
}

#[test]
fn a_run_with_a_file_that_was_stopped_or_killed_goes_on() {
    let long = study()
        .replace("quick.toml", "stops.toml")
        .replace("'3 s'\"", "'40 s'\", \"numerics.time_acceleration = 1\", \"output.checkpoint_every = '0.05 s'\"")
        .replace("\"operation.normal_force\"", "\"materials.pin_primary.youngs_modulus\"")
        .replace("\"5 N\", \"10 N\", \"20 N\"", "\"1 GPa\", \"2 GPa\"")
        .replace("levels = [0.2, 0.3, 0.4]", "levels = [0.2, 0.3]")
        .replace("seeds = [7, 8, 9]", "seeds = [7]");
    let [whole, stopped] = [(), ()].map(|()| {
        let directory = WorkingDirectory::new();
        directory.write("study.toml", &long);
        directory
    });
    assert_eq!(whole.plateau(["sweep", "run", "study.toml", "--jobs", "2"]).status, Some(0));
    let start = ["sweep", "run", "study.toml", "--jobs", "2", "--keep-files"];
    let is_state = |entry: &fs::DirEntry| entry.file_name().len() == 64;
    let folder = stopped.path("results/under-way");
    let states = || fs::read_dir(&folder).map_or(0, |entries| entries.flatten().filter(is_state).count());
    for signal in ["TERM", "KILL"] {
        let mut command = stopped.command(start);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(100));
        assert!(wait_until(|| states() > 0), "no run is under way");
        let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(sent.unwrap().success());
        child.wait().unwrap();
        assert!(states() > 0, "nothing was kept after {signal}");
        if signal == "TERM" {
            // The one that is being made is closed.
            let is_closed = |file: &PathBuf| ["finished", "interrupted"].contains(&&*RunFile::open(file).text("state"));
            assert!(kept(&stopped).iter().all(is_closed), "{:?}", kept(&stopped));
        }
    }
    let last = stopped.plateau(start);
    assert!(last.status == Some(0) && last.stderr.contains("goes on from step "), "{last:?}");
    assert_eq!(results_of_stops(&stopped), results_of_stops(&whole));
    for number in 1..=4 {
        let (file, alone) = (of_run(&stopped, number), format!("alone-{number}.h5"));
        let run = number.to_string();
        whole.plateau(["sweep", "run", "study.toml", "--run", &run, "-o", &alone]).quiet_success();
        assert_eq!(content_differs(whole.path(&alone), file), [""; 0], "run {number}");
    }
    assert_eq!(kept(&stopped).len(), 4, "{:?}", kept(&stopped));
}

/// The table and two series of a study with a cycle.
fn results_of_stops(directory: &WorkingDirectory) -> (String, [Vec<u64>; 2]) {
    let outcome = directory.plateau(["sweep", "collect", "study.toml"]);
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    let file = RunFile::open(directory.path("results/results.h5"));
    let bits = |name: &str| file.floats(name).iter().map(|value| value.to_bits()).collect();
    let table = fs::read_to_string(directory.path("results/results.csv")).unwrap();
    (table, ["/contact_area", "/worn_pin"].map(bits))
}

#[test]
fn a_file_that_cannot_be_kept_is_no_failure_of_its_run() {
    let directory = directory();
    fs::create_dir(directory.path("results")).unwrap();
    // A file is where the folder would be.
    directory.write("results/runs", "mine");
    let outcome = directory.plateau(["sweep", "run", "study.toml", "--keep-files"]);
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    assert!(outcome.stderr.contains("cannot write to results/runs: "), "{outcome:?}");
    assert_eq!(records(&directory).len(), 0, "a run is said to have failed");
    assert_eq!(finished(&sweep(&directory, &[])), [0, 27]);
}

#[test]
fn one_run_is_made_again_by_itself_or_from_its_scene() {
    let directory = directory();
    let before = directory.content();
    let alone = ["sweep", "run", "study.toml", "--run", "15", "-o", "r15.h5"];
    let said = directory.plateau(alone).quiet_success();
    assert!(said.contains("r15.h5"), "{said}");
    let printed = directory.plateau(["sweep", "scene", "study.toml", "15"]).quiet_success();
    assert!(printed.starts_with("# run 15 (load = 10 N, fibre fraction = 0.3) of study.toml\n"), "{printed}");
    directory.write("r15.toml", &printed);
    directory.plateau(["run", "r15.toml", "-o", "by-scene.h5"]).quiet_success();
    assert_eq!(content_differs(directory.path("r15.h5"), directory.path("by-scene.h5")), [""; 0]);
    let is_own =
        |name: &PathBuf| !name.to_str().unwrap().contains("r15") && !name.to_str().unwrap().contains("by-scene");
    let mut after = directory.content();
    after.retain(|name, _| is_own(name));
    assert_eq!(after, before, "neither journal nor results");

    // It has the series of the study's own run.
    sweep(&directory, &["--jobs", "2"]);
    results(&directory);
    let (file, alone_file) =
        (RunFile::open(directory.path("results/results.h5")), RunFile::open(directory.path("r15.h5")));
    for series in ["contact_area", "worn_pin", "pool"] {
        assert_eq!(file.floats(&format!("/{series}"))[14 * 6..15 * 6], alone_file.floats(&format!("/series/{series}")));
    }

    // What is there stays, and there are no more runs than the plan has.
    let again = directory.plateau(alone);
    assert!(
        again.status == Some(2) && again.stderr.contains("r15.h5") && again.stderr.contains("--force"),
        "{again:?}"
    );
    assert_eq!(directory.plateau(alone.iter().chain(&["--force"])).status, Some(0));
    for words in [&["run", "study.toml", "--run", "28"][..], &["scene", "study.toml", "28"]] {
        let refused = directory.plateau(["sweep"].iter().chain(words));
        let expected = "plateau: study.toml: there is no run 28; its runs are 1 to 27\n";
        assert_eq!((refused.status, refused.stderr.as_str()), (Some(2), expected));
    }
    for other in [&["--keep-files"][..], &["--task", "1/2"], &["--retry"], &["--jobs", "2"]] {
        assert_eq!(directory.plateau(alone.iter().chain(other)).status, Some(2), "{other:?}");
    }
    assert_eq!(directory.plateau(["sweep", "run", "study.toml", "-o", "r.h5"]).status, Some(2));
    // Without a name, in the working directory.
    directory.plateau(["sweep", "run", "study.toml", "--run", "1"]).quiet_success();
    // Never over the study, whatever is said.
    let study = std::fs::read(directory.path("study.toml")).unwrap();
    let over = ["sweep", "run", "study.toml", "--run", "1", "-o", "study.toml", "--force"];
    directory.plateau(over).ends(2, &["study.toml", "is an input and is not replaced"]);
    assert_eq!(std::fs::read(directory.path("study.toml")).unwrap(), study);
    let no_folder = ["sweep", "run", "study.toml", "--directory", "study.toml"];
    directory.plateau(no_folder).ends(2, &["study.toml: this is no folder, expected one for the results of the study"]);
    assert!(directory.path("run-0001.h5").exists());
}

#[test]
fn the_scene_of_a_run_finds_its_files_from_any_folder() {
    let directory = WorkingDirectory::new();
    let measured = study().replace("quick.toml", "measured.toml").replace("seeds = [7, 8, 9]", "seeds = [7]");
    let measured = measured.replace("\"disc.surface.synthetic.seed\", ", "");
    directory.write("study.toml", measured);
    let printed = directory.plateau(["sweep", "scene", "study.toml", "2"]).quiet_success();
    fs::create_dir(directory.path("elsewhere")).unwrap();
    directory.write("elsewhere/r2.toml", printed);
    let mut there = directory.command(["run", "r2.toml", "-o", "r2.h5", "-q"]);
    assert!(there.current_dir(directory.path("elsewhere")).status().unwrap().success());
    assert_eq!(directory.plateau(["sweep", "run", "study.toml", "--run", "2", "-o", "r2.h5", "-q"]).status, Some(0));
    assert_eq!(content_differs(directory.path("r2.h5"), directory.path("elsewhere/r2.h5")), [""; 0]);
}

#[test]
fn results_are_where_the_user_says() {
    let (usual, other) = (directory(), directory());
    sweep(&usual, &["--jobs", "2"]);
    let said = |outcome: &Outcome| assert_eq!(outcome.status, Some(0), "{outcome:?}");
    said(&other.plateau(["sweep", "slurm", "study.toml", "--directory", "here", "--keep-files", "--tasks", "2"]));
    let script = fs::read_to_string(other.path("study.sbatch")).unwrap();
    let expected = format!(" --directory '{}' --keep-files --task ", other.path("here").display());
    assert!(script.contains(&expected), "{expected} in {script}");
    // From any folder.
    let mut shell = Command::new("sh");
    shell.arg(other.path("study.sbatch")).env("SLURM_ARRAY_TASK_ID", "1").current_dir("/");
    let output = shell.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert_eq!(finished(&sweep(&other, &["--directory", "here"])), [14, 13]);
    let planned = json(&other.plateau(["sweep", "plan", "study.toml", "--directory", "here", "--json"]));
    assert_eq!((&planned["directory"], planned["ended"]["finished"].as_u64()), (&"here".into(), Some(27)));
    said(&other.plateau(["sweep", "collect", "study.toml", "--directory", "here"]));
    results(&usual);
    let table = |path: PathBuf| fs::read_to_string(path).unwrap();
    assert_eq!(table(other.path("here/results.csv")), table(usual.path("results/results.csv")));
    assert_eq!(fs::read_dir(other.path("here/runs")).unwrap().count(), 14);
    assert!(!other.path("results").exists());
    // Advice is of that folder, too.
    let asked = study().replace("directory =", "series = [\"worn_pin\"]\ndirectory =").replace("'3 s'", "'2 s'");
    other.write("study.toml", &asked);
    assert_eq!(other.plateau(["sweep", "run", "study.toml", "--directory", "here"]).status, Some(0));
    other.write("study.toml", asked.replace("/series/filled_fraction", "/series/pin_none"));
    let warned = other.plateau(["sweep", "run", "study.toml", "--directory", "here"]);
    assert!(
        warned.stderr.contains("`plateau sweep run study.toml --directory here --retry` makes them again"),
        "{warned:?}"
    );
}

#[test]
fn the_plan_tells_how_large_run_files_are() {
    let directory = directory();
    let planned = json(&directory.plateau(["sweep", "plan", "study.toml", "--json"]));
    sweep(&directory, &["--keep-files"]);
    let all: u64 = kept(&directory).iter().map(|file| file.metadata().unwrap().len()).sum();
    let most = planned["run_files"].as_u64().unwrap();
    // Heights and series take about four fifths of what is said at most, statuses hardly anything, and names a fixed part.
    assert!(all <= most && most < 4 * all, "{all} of {most}");
}
