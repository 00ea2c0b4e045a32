//! Run files of the runs of a study: kept on request, and of one run by itself; and results in another folder than the study names.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use plateau_tests::program::{WorkingDirectory, run, run_words};
use plateau_tests::run_file::{RunFile, differences};
use serde_json::Value;

use super::stopped::stop_and_kill;
use super::{RUN_15, RUNS, counts, directory, records, results, study, sweep};

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
    counts(summary, ["finished_before", "finished"])
}

fn content_differs(one: impl AsRef<std::path::Path>, other: impl AsRef<std::path::Path>) -> Vec<String> {
    differences(&RunFile::open(one).content(), &RunFile::open(other).content())
}

#[test]
fn workers_of_a_run_have_what_the_scene_says() {
    let of_sectors = study().replace("'3 s'\"", "'3 s'\", \"numerics.decomposition = 'sectors'\"");
    let directory = WorkingDirectory::with("study.toml", &of_sectors);
    sweep(&directory, &["--task", "1/27", "--workers", "2", "--keep-files"]);
    let told = RunFile::open(&kept(&directory)[0]).text("decomposition");
    assert!(told.ends_with(" sectors") && !told.contains("bands"), "{told}");
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
    plain.plateau(run_words("quick.toml", "alone.h5", &RUN_15, &[])).quiet_success();
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
    assert_eq!(finished(&less.json()), [18, 0], "{less:?}");
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
    let [whole, stopped] = [(), ()].map(|()| WorkingDirectory::with("study.toml", &long));
    whole.plateau(["sweep", "run", "study.toml", "--jobs", "2"]).ends(0, &[]);
    let words = ["sweep", "run", "study.toml", "--jobs", "2", "--keep-files"];
    stop_and_kill(&stopped, &words, |signal| {
        // The one that is being made is closed.
        let is_closed = |file: &PathBuf| ["finished", "interrupted"].contains(&&*RunFile::open(file).text("state"));
        assert!(signal != "TERM" || kept(&stopped).iter().all(is_closed), "{:?}", kept(&stopped));
    });
    stopped.plateau(words).ends(0, &["goes on from step "]);
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
    directory.plateau(["sweep", "collect", "study.toml"]).ends(0, &[]);
    let file = directory.run_file("results/results.h5");
    let bits = |name: &str| file.floats(name).iter().map(|value| value.to_bits()).collect();
    (directory.text("results/results.csv"), ["/contact_area", "/worn_pin"].map(bits))
}

#[test]
fn a_file_that_cannot_be_kept_is_no_failure_of_its_run() {
    let directory = directory();
    fs::create_dir(directory.path("results")).unwrap();
    // A file is where the folder would be.
    directory.write("results/runs", "mine");
    let keeping = ["sweep", "run", "study.toml", "--keep-files"];
    directory.plateau(keeping).ends(1, &["cannot write to results/runs: "]);
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
    let mut after = directory.content();
    after.retain(|name, _| !["r15", "by-scene"].iter().any(|made| name.to_str().unwrap().contains(made)));
    assert_eq!(after, before, "neither journal nor results");

    // It has the series of the study's own run.
    sweep(&directory, &["--jobs", "2"]);
    results(&directory);
    let [file, alone_file] = ["results/results.h5", "r15.h5"].map(|name| directory.run_file(name));
    for series in ["contact_area", "worn_pin", "pool"] {
        assert_eq!(file.floats(&format!("/{series}"))[14 * 6..15 * 6], alone_file.floats(&format!("/series/{series}")));
    }

    // What is there stays, and there are no more runs than the plan has.
    directory.plateau(alone).ends(2, &["r15.h5", "--force"]);
    directory.plateau(alone.iter().chain(&["--force"])).ends(0, &[]);
    for words in [&["run", "study.toml", "--run", "28"][..], &["scene", "study.toml", "28"]] {
        let refused = directory.plateau(["sweep"].iter().chain(words));
        let expected = "plateau: study.toml: there is no run 28; its runs are 1 to 27\n";
        assert_eq!((refused.status, refused.stderr.as_str()), (Some(2), expected));
    }
    for other in [&["--keep-files"][..], &["--task", "1/2"], &["--retry"], &["--jobs", "2"]] {
        directory.plateau(alone.iter().chain(other)).ends(2, &[]);
    }
    directory.plateau(["sweep", "run", "study.toml", "-o", "r.h5"]).ends(2, &[]);
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
    directory.plateau(["sweep", "run", "study.toml", "--run", "2", "-o", "r2.h5", "-q"]).ends(0, &[]);
    assert_eq!(content_differs(directory.path("r2.h5"), directory.path("elsewhere/r2.h5")), [""; 0]);
}

#[test]
fn results_are_where_the_user_says() {
    let (usual, other) = (directory(), directory());
    sweep(&usual, &["--jobs", "2"]);
    other.plateau(["sweep", "slurm", "study.toml", "--directory", "here", "--keep-files", "--tasks", "2"]).ends(0, &[]);
    let script = other.text("study.sbatch");
    let expected = format!(" --directory '{}' --keep-files --task ", other.path("here").display());
    assert!(script.contains(&expected), "{expected} in {script}");
    // From any folder.
    let mut shell = Command::new("sh");
    shell.arg(other.path("study.sbatch")).env("SLURM_ARRAY_TASK_ID", "1").current_dir("/");
    run(shell).ends(0, &[]);
    assert_eq!(finished(&sweep(&other, &["--directory", "here"])), [14, 13]);
    let planned = other.plateau(["sweep", "plan", "study.toml", "--directory", "here", "--json"]).json();
    assert_eq!((&planned["directory"], planned["ended"]["finished"].as_u64()), (&"here".into(), Some(27)));
    other.plateau(["sweep", "collect", "study.toml", "--directory", "here"]).ends(0, &[]);
    results(&usual);
    let table = |path: PathBuf| fs::read_to_string(path).unwrap();
    assert_eq!(table(other.path("here/results.csv")), table(usual.path("results/results.csv")));
    assert_eq!(fs::read_dir(other.path("here/runs")).unwrap().count(), 14);
    assert!(!other.path("results").exists());
    // Advice is of that folder, too.
    let asked = study().replace("directory =", "series = [\"worn_pin\"]\ndirectory =").replace("'3 s'", "'2 s'");
    other.write("study.toml", &asked);
    let there = ["sweep", "run", "study.toml", "--directory", "here"];
    other.plateau(there).ends(0, &[]);
    other.write("study.toml", asked.replace("/series/filled_fraction", "/series/pin_none"));
    let advice = "`plateau sweep run study.toml --directory here --retry` makes them again";
    assert!(other.plateau(there).stderr.contains(advice));
}

#[test]
fn the_plan_tells_how_large_run_files_are() {
    let directory = directory();
    let planned = directory.plateau(["sweep", "plan", "study.toml", "--json"]).json();
    sweep(&directory, &["--keep-files"]);
    let all: u64 = kept(&directory).iter().map(|file| file.metadata().unwrap().len()).sum();
    let most = planned["run_files"].as_u64().unwrap();
    // Heights and series take about four fifths of what is said at most, statuses hardly anything, and names a fixed part.
    assert!(all <= most && most < 4 * all, "{all} of {most}");
}
