//! Workers and instruction sets through the program: what is said about them, and that nothing else tells of them.

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

use plateau_core::engine::kernel::InstructionSet;
use plateau_tests::program::{
    Outcome, WorkingDirectory, kill, quick_scene_with, run_words, scene, sets, start, wait_until,
};
use plateau_tests::run_file::{Content, RunFile, differences};
use serde_json::Value;

/// Run attributes that tell how, where and when a run was carried out, or whose content does: the resolved scene has
/// a line for the workers, and the digest of the attributes is one of the scene, too.
const OF_THE_EXECUTION: &str =
    "decomposition workers instruction_set scene start_time end_time wall_time attributes_sha256 execution_sha256";

fn cores() -> usize {
    available_parallelism().map_or(1, NonZeroUsize::get)
}

/// What `plateau run quick.toml` with these arguments leaves, in a few seconds of the brake.
fn run(arguments: &[&str]) -> (Outcome, RunFile, WorkingDirectory) {
    let directory = WorkingDirectory::new();
    let words = run_words("quick.toml", "run.h5", &["operation.steps=1500"], arguments);
    let outcome = directory.plateau(words).ends(0, &[]);
    let file = directory.run_file("run.h5");
    (outcome, file, directory)
}

/// All that a run file tells but how the run was carried out.
fn told(file: &RunFile) -> (BTreeMap<String, Content>, Vec<(String, String)>) {
    let scene = file.text("scene");
    let lines = scene
        .lines()
        .filter(|line| !["workers = ", "decomposition = "].iter().any(|key| line.starts_with(key)))
        .map(|line| ("scene".into(), line.into()));
    let attributes =
        file.attributes().into_iter().filter(|(name, _)| !OF_THE_EXECUTION.split(' ').any(|own| own == name));
    (file.content(), attributes.chain(lines).collect())
}

/// Asserts that the runs with all numbers of workers and all instruction sets tell what the plainest one tells, and
/// gives its run file.
fn assert_alike(scene: &[&str]) -> (RunFile, WorkingDirectory) {
    let plainest = [scene, &["--workers", "1", "--isa", "portable"]].concat();
    let (_, reference, directory) = run(&plainest);
    let (content, attributes) = told(&reference);
    assert_eq!((reference.number("workers"), reference.text("instruction_set")), (1.0, "portable".into()));
    let sets: Vec<&str> = InstructionSet::available().map(InstructionSet::name).collect();
    let of_workers = ["2", "3", "5", "8"].into_iter().zip(["auto", "sectors", "bands", "sectors"]);
    let of_workers = of_workers.map(|(workers, kind)| vec!["--workers", workers, "--decomposition", kind]);
    let of_sets = sets.iter().flat_map(|set| [vec!["--isa", *set], vec!["--isa", *set, "--workers", "3"]]);
    for arguments in of_workers.chain(of_sets) {
        let (_, file, _directory) = run(&[scene, &arguments].concat());
        let (other_content, other_attributes) = told(&file);
        assert_eq!(differences(&content, &other_content), [""; 0], "{arguments:?}");
        assert_eq!(attributes, other_attributes, "{arguments:?}");
        let value = |option: &str| arguments.iter().skip_while(|word| **word != option).nth(1).copied();
        assert_eq!(file.number("workers").to_string(), value("--workers").unwrap_or("1"), "{arguments:?}");
        let best = InstructionSet::best().name();
        assert_eq!(file.text("instruction_set"), value("--isa").unwrap_or(best), "{arguments:?}");
    }
    (reference, directory)
}

#[test]
fn equal_scenes_give_equal_bits() {
    let ((_, one, _first), (_, other, _second)) = (run(&[]), run(&[]));
    assert_eq!(told(&one).1, told(&other).1);
    // 3 coordinates, time and map time, 25 series, 7 maps, the fibre map.
    assert_eq!(one.content().len(), 38);
    assert_eq!(differences(&one.content(), &other.content()), [""; 0]);
}

#[test]
fn neither_workers_nor_instruction_sets_show_in_a_run_file() {
    // Resin wears and build-up breaks away at this acceleration, and there are maps on the way.
    let local = ["numerics.time_acceleration=400", "output.maps_at=[\"0 s\", \"20 s\", \"40 s\"]"];
    let brittle = [&local[..], &["materials.pin_secondary.strength=2 MPa"]].concat();
    for (scene, moved) in [(&local[..], "emitted"), (&brittle, "returned")] {
        let (reference, _directory) = assert_alike(&sets(scene));
        assert_eq!(reference.shape("/map_time"), [4]);
        for series in ["worn_resin", moved, "deposited_pin", "deposited_disc"] {
            assert!(reference.floats(&format!("/series/{series}")).last() > Some(&0.0), "no {series} to compare");
        }
    }
}

#[test]
fn nor_in_maps_that_are_cut_into_chunks() {
    // 20 · 6900 heights of 8 bytes are more than the 512 KiB of a chunk.
    let scene = ["mesh.disc_columns=6900", "mesh.pin_columns=400", "operation.steps=60"];
    let (reference, _directory) = assert_alike(&sets(&scene));
    let (chunk, shape) = (reference.chunk("/disc/height").expect("chunks"), reference.shape("/disc/height"));
    assert!(chunk[1] < shape[1], "chunks of {chunk:?} in {shape:?}");
}

#[test]
fn more_workers_than_cores_work_with_a_warning() {
    let (cores, many) = (cores(), (cores() + 3).to_string());
    let (outcome, file, directory) = run(&["--workers", &many]);
    let warning = format!("plateau: warning: {many} workers on {cores} cores wait for each other at every step; ");
    assert!(outcome.stderr.starts_with(&warning), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    assert_eq!((file.number("workers").to_string(), file.text("state")), (many, "finished".into()));
    assert_eq!(directory.names(), ["run.h5", "run.h5.checkpoint"]);
    // As many as there are cores deserve no warning.
    assert_eq!(run(&["--workers", &cores.to_string()]).0.stderr, "");
}

#[test]
fn a_ring_of_few_columns_takes_no_more_workers_than_it_has_work_for() {
    let (_, file, _directory) =
        run(&["--workers", "8", "--set", "mesh.disc_columns=10", "--set", "mesh.pin_columns=3"]);
    // A sector has at least two columns.
    assert_eq!(file.number("workers"), 5.0);
}

#[test]
fn auto_says_what_it_chose() {
    let directory =
        WorkingDirectory::with("auto.toml", quick_scene_with(&[("[numerics]", "[numerics]\nworkers = \"auto\"")]));
    let from_scene =
        directory.plateau(["run", "auto.toml", "-o", "run.h5", "--set", "operation.steps=1500"]).ends(0, &[]);
    let from_scene = (from_scene, directory.run_file("run.h5"));
    let (outcome, file, _directory) = run(&["--workers", "auto"]);
    for (outcome, file) in [from_scene, (outcome, file)] {
        let chosen = outcome.stderr.strip_prefix("plateau: workers = \"auto\" runs on ");
        let (chosen, rest) = chosen.and_then(|text| text.split_once(" of ")).expect(&outcome.stderr);
        assert!(rest.starts_with(&format!("{} cores (1: ", cores())), "{rest}");
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
        assert!(rest.contains(&format!("{chosen}: ")) && chosen.parse::<usize>().unwrap() <= cores(), "{rest}");
        assert_eq!(file.number("workers").to_string(), chosen);
        assert!(file.text("scene").contains("workers = \"auto\""), "{}", file.text("scene"));
    }
}

#[test]
fn an_unknown_instruction_set_is_refused_with_those_that_are_there() {
    let directory = WorkingDirectory::new();
    for command in ["run", "check"] {
        let sets: Vec<&str> = InstructionSet::available().map(InstructionSet::name).collect();
        let expected = format!("'nonsense' for '--isa <NAME>': this processor has {}\n", sets.join(", "));
        let outcome = directory.plateau([command, &scene("quick.toml"), "--isa", "nonsense"]).ends(2, &[&expected]);
        assert_eq!(outcome.stdout, "");
    }
    assert_eq!(directory.names(), [""; 0]);
}

#[test]
fn a_check_tells_of_workers_and_instruction_set() {
    let check = |arguments: &[&str]| -> Value {
        let directory = WorkingDirectory::new();
        let quick = scene("quick.toml");
        directory.plateau(["check", &quick, "--json"].iter().chain(arguments)).ends(0, &[]).json()
    };
    let reason = |check: &Value, list: &str| -> Option<String> {
        let parts = check[list].as_array().expect("a list of parts");
        let part = parts.iter().find(|part| part["part"] == "several workers")?;
        part["reason"].as_str().map(str::to_owned)
    };
    let one = check(&["--isa", "portable"]);
    assert_eq!((&one["workers"], &one["instruction_set"]), (&1.into(), &"portable".into()));
    assert_eq!((reason(&one, "needed"), reason(&one, "left_out")), (None, Some("workers = 1".into())));
    assert_eq!(one["decomposition"], "none");
    // 20 rows are three strips of eight.
    assert_eq!(check(&["--workers", "2", "--decomposition", "bands"])["decomposition"], "2 bands of rows");
    let sectors = check(&["--workers", "2", "--set", "numerics.decomposition=sectors"])["decomposition"].to_string();
    assert!(sectors.ends_with(" sectors\""), "{sectors}");
    let two = check(&["--workers", "2"]);
    assert_eq!((&two["workers"], &two["instruction_set"]), (&2.into(), &InstructionSet::best().name().into()));
    assert_eq!((reason(&two, "needed"), reason(&two, "left_out")), (Some("workers = 2".into()), None));
}

#[test]
fn pinned_workers_stay_on_a_core_each() {
    let directory = WorkingDirectory::new();
    let quick = scene("quick.toml");
    let arguments = ["run", &quick, "--pin", "--workers", "2", "--set", "operation.steps=1000000000"];
    let child = start(directory.command(arguments));
    // The cores that the system lets a thread run on, as proc(5) has it.
    let cores_of = |worker: &str| {
        let threads = fs::read_dir(format!("/proc/{}/task", child.id())).ok()?;
        let read = |thread: &fs::DirEntry, file| fs::read_to_string(thread.path().join(file)).unwrap_or_default();
        let thread = threads.flatten().find(|thread| read(thread, "comm").trim_end() == worker)?;
        let status = read(&thread, "status");
        let (_, rest) = status.split_once("Cpus_allowed_list:")?;
        rest.split_whitespace().next().map(str::to_owned)
    };
    let is_one = |cores: &Option<String>| cores.as_ref().is_some_and(|cores| cores.parse::<usize>().is_ok());
    let mut pinned = [None, None];
    let in_time = wait_until(|| {
        pinned = ["worker 0", "worker 1"].map(cores_of);
        pinned.iter().all(is_one)
    });
    kill(child);
    assert!(in_time, "{pinned:?}");
    assert!(pinned[0] != pinned[1] || cores() == 1, "{pinned:?}");
    // And a run that comes to its end does so as any other.
    let ((_, free, _first), (outcome, pinned, _second)) = (run(&[]), run(&["--workers", "2", "--pin"]));
    assert!(outcome.stderr.is_empty() || cores() == 1, "{}", outcome.stderr);
    assert_eq!(differences(&free.content(), &pinned.content()), [""; 0]);
}
