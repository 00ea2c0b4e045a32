//! Files that say they are huge, and machines that have next to nothing: an answer at once, in bounded memory, and never a panic.

use std::fs::{self, File};
use std::path::Path;

use plateau_tests::fault::without_threads;
use plateau_tests::program::{DISC, Outcome, WorkingDirectory, quick_scene_with, run, scene};
use plateau_tests::scenes::few_or_all;
use plateau_tests::studies::Study;

/// Bytes that nobody reads.
const HUGE: u64 = 1 << 40;

/// A file that begins like this and takes no room for the rest.
fn huge(directory: &WorkingDirectory, name: &str, start: &[u8], length: u64) {
    let path = directory.write(name, start);
    File::options().write(true).open(path).unwrap().set_len(length).unwrap();
}

/// Two runs of a moment.
fn loads() -> Study {
    let set = "set = [\"operation.duration = '1 s'\"]";
    Study::new(&scene("quick.toml"), "full-factorial", set).load("levels = [\"5 N\", \"6 N\"]")
}

fn assert_refused(outcome: &Outcome, said: &str) {
    assert!(outcome.status == Some(2) && outcome.stderr.contains(said), "expected {said}: {outcome:?}");
}

fn surface_scene(directory: &WorkingDirectory, file: &str, more: &str) {
    directory.write("scene.toml", quick_scene_with(&[(DISC, &format!("file = \"{file}\"\n{more}"))]));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes a second in release")]
fn a_design_of_as_many_points_as_there_may_be_is_planned() {
    let directory = WorkingDirectory::new();
    let study = |points: usize| {
        let study = Study::new(&scene("quick.toml"), "sobol", &format!("points = {points}"));
        study.load("range = [\"5 N\", \"60 N\"]")
    };
    directory.write("study.toml", study(10_000_000));
    let planned = directory.plateau(["sweep", "plan", "study.toml"]);
    assert!(planned.status == Some(0) && planned.stdout.contains("10 000 000"), "{planned:?}");
    directory.write("study.toml", study(10_000_001));
    let refused = directory.plateau(["sweep", "plan", "study.toml"]);
    assert_refused(&refused, "has at most 10000000 points, not 10000001");
}

#[test]
fn files_that_are_too_large_are_refused_with_both_numbers() {
    let directory = WorkingDirectory::new();
    let most = "expected at most";
    huge(&directory, "study.toml", b"version = 1\n", HUGE);
    for command in ["plan", "run", "collect", "slurm"] {
        assert_refused(&directory.limited(["sweep", command, "study.toml"]), most);
    }
    huge(&directory, "big.toml", b"version = 1\n", HUGE);
    for command in ["run", "check"] {
        assert_refused(&directory.limited([command, "big.toml"]), "larger than 1 MiB");
    }
    huge(&directory, "points.csv", b"load\n5 N\n", HUGE);
    directory.write("points.toml", Study::new(&scene("quick.toml"), "csv", "file = \"points.csv\"").load(""));
    assert_refused(&directory.limited(["sweep", "plan", "points.toml"]), most);
    huge(&directory, "stops.csv", b"time [s]\n0\n1\n", HUGE);
    let cycle = ["check", &scene("quick.toml"), "--set"];
    let set = format!("operation.cycle.file=\"{}\"", directory.path("stops.csv").display());
    assert_refused(&directory.limited([&cycle[..], &[&set]].concat()), most);
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    for (name, start, more) in [
        ("heights.txt", &b"1 2 3 4\n5 6 7 8\n"[..], "unit = \"um\"\n"),
        ("heights.npy", b"\x93NUMPY\x01\0", ""),
        ("heights.png", png, "height_range = [\"0 um\", \"1 um\"]\n"),
    ] {
        // Behind the part that tells what it is.
        let start: Vec<u8> =
            start.iter().copied().chain(if name.ends_with("txt") { vec![b' '; 8192] } else { vec![] }).collect();
        huge(&directory, name, &start, HUGE);
        surface_scene(&directory, name, more);
        assert_refused(&directory.limited(["check", "scene.toml"]), most);
        assert_refused(&directory.limited(["surface", name]), most);
    }
    // Below the limit, and not what its header says: more than the memory here.
    let header = b"\x93NUMPY\x01\0\x76\0{'descr': '<f8', 'fortran_order': False, 'shape': (10, 10), }";
    huge(&directory, "holes.npy", &[&header[..], &[b' '; 56], b"\n"].concat(), 3_200_000_000);
    let said = directory.limited(["surface", "holes.npy"]);
    assert_refused(&said, "3199999872 bytes");
}

#[test]
fn checkpoints_and_journals_take_no_more_memory_than_they_hold() {
    let directory = WorkingDirectory::new();
    let short = ["run", &scene("quick.toml"), "-o", "run.h5", "--set", "operation.duration=2 s"];
    directory.plateau(short).ends(0, &[]);
    let before = fs::read(directory.path("run.h5")).unwrap();
    let content = (HUGE - 16 - 8 - 32).to_le_bytes();
    huge(&directory, "run.h5.checkpoint", &[&b"plateau state 8\n"[..], &content].concat(), HUGE);
    let refused = directory.limited([&short[..], &["--resume"]].concat());
    assert_refused(&refused, "larger than any of this run");
    assert!(fs::read(directory.path("run.h5")).unwrap() == before);
    // A line that never ends, and a pipe.
    directory.write("study.toml", loads());
    huge(&directory, "results/journal/h_1_0-0.journal", b"00000000 {", 1 << 30);
    directory.fifo("results/journal/h_1_0-1.journal");
    for command in ["run", "collect"] {
        directory.limited(["sweep", command, "study.toml"]).ends(0, &[]);
    }
}

#[test]
fn what_can_be_read_and_not_described_is_refused_with_both_numbers() {
    let directory = WorkingDirectory::new();
    let header = b"\x93NUMPY\x01\0\x76\0{'descr': '<f4', 'fortran_order': False, 'shape': (4, 500000), }";
    let header = [&header[..], &[b' '; 53], b"\n"].concat();
    assert_eq!(header.len(), 128);
    huge(&directory, "flat.npy", &header, 128 + 4 * 4 * 500_000);
    let mut seen = [false; 3];
    // A step at a time from what does not read it to what describes it.
    for mebibytes in (60..260).step_by(10) {
        let limit = format!("ulimit -c 0; ulimit -v {}", mebibytes << 10);
        let outcome = run(directory.command_after(&limit, ["surface", "flat.npy", "--pitch", "1 um"]));
        let one_line = outcome.stderr.starts_with("plateau: ") && outcome.stderr.lines().count() == 1;
        let described = outcome.stderr.contains("4 x 500000 points can be read, but to describe them needs ");
        let kind = match outcome.status {
            Some(0) => 2,
            Some(1 | 2) if one_line => usize::from(described),
            _ => panic!("{mebibytes} MiB: {outcome:?}"),
        };
        seen[kind] = true;
    }
    assert_eq!(seen, [true; 3], "not read, not described, described");
}

/// Every command that does something.
fn commands(directory: &WorkingDirectory) -> Vec<Vec<String>> {
    directory.write("study.toml", loads().response("pool", "/series/pool", "at = \"end\""));
    fs::write(directory.path("heights.sdf"), fs::read(corpus("bcr1_surface_ascii.sdf")).unwrap()).unwrap();
    let made = ["run", &scene("quick.toml"), "-o", "run.h5", "--set", "operation.duration=1 s"];
    directory.plateau(made).ends(0, &[]);
    let short = format!("run {} -o other.h5 --force --set operation.duration=1\u{a0}s", scene("quick.toml"));
    let lines = [
        short.as_str(),
        "check SCENE",
        "surface heights.sdf --plot surface.png --force",
        "verify run.h5",
        "summary run.h5",
        "watch run.h5 --once",
        "sweep plan study.toml",
        "sweep run study.toml --jobs 2",
        "sweep collect study.toml",
    ];
    let words = |line: &str| {
        line.split(' ').map(|word| word.replace("SCENE", &scene("quick.toml")).replace('\u{a0}', " ")).collect()
    };
    lines.into_iter().map(words).collect()
}

fn corpus(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/io/tests/surfaces").join(name)
}

/// A line that says what is lacking, and status 1; or all is well.
fn assert_told(outcome: &Outcome, what: &str) {
    // It may go on in lines below, and the standard library has a note of its own behind what it says of memory.
    let told = |line: &str| line.starts_with("plateau: ") || line.starts_with("memory allocation of");
    let told = outcome.stderr.lines().any(told);
    assert!(outcome.status == Some(0) || outcome.status == Some(1) && told, "{what}: {outcome:?}");
    assert!(!outcome.stderr.contains("panicked"), "{what}: {outcome:?}");
}

#[test]
fn what_memory_does_not_hold_is_refused_before_it_is_made() {
    let directory = WorkingDirectory::new();
    // 2^28 grey pixels, which are refused by the size that the file and its header have.
    let side = (1_u32 << 14).to_be_bytes();
    let header = [b"IHDR", &side[..], &side, &[8, 0, 0, 0, 0]].concat();
    let mut sum = flate2::Crc::new();
    sum.update(&header);
    let length = (header.len() as u32 - 4).to_be_bytes();
    let image = [b"\x89PNG\r\n\x1a\n", &length[..], &header, &sum.sum().to_be_bytes(), &[0; 300_000]].concat();
    directory.write("height.png", image);
    surface_scene(&directory, "height.png", "pitch = \"1 um\"\nheight_range = [\"0 um\", \"1 um\"]\n");
    let refused = directory.limited(["run", "scene.toml"]);
    assert_refused(&refused, "16384 x 16384 pixels need 2.5 GiB of memory and ");
    // As many heights, of which one chunk is there.
    let file = hdf5::File::create(directory.path("height.h5")).unwrap();
    let heights =
        file.new_dataset::<f64>().shape((1 << 14, 1 << 14)).chunk((1 << 7, 1 << 14)).create("height").unwrap();
    heights.write_slice(&ndarray::Array2::<f64>::zeros((1 << 7, 1 << 14)), (..1 << 7, ..)).unwrap();
    drop(heights);
    file.close().unwrap();
    surface_scene(&directory, "height.h5", "pitch = \"1 um\"\n");
    let refused = directory.limited(["run", "scene.toml"]);
    assert_refused(&refused, "the heights of dataset /height need 4.0 GiB of memory and ");
    // More objects than a file of measurements has.
    let file = hdf5::File::create(directory.path("many.h5")).unwrap();
    for number in 0..10_001 {
        file.create_group(&number.to_string()).unwrap();
    }
    file.close().unwrap();
    surface_scene(&directory, "many.h5", "pitch = \"1 um\"\n");
    let refused = directory.limited(["run", "scene.toml"]);
    assert_refused(&refused, "it has more than 10000 groups and datasets, expected at most that many");
}

#[test]
fn without_threads_nothing_panics() {
    let directory = WorkingDirectory::new();
    for command in commands(&directory) {
        directory.plateau(&command).ends(0, &[]);
        for &threads in few_or_all(&[0, 2][..], &[0, 1, 2, 3]) {
            let outcome = without_threads(directory.command(&command), threads);
            assert_told(&outcome, &format!("{command:?} with {threads} threads"));
        }
    }
}

#[test]
fn without_threads_no_run_file_is_replaced() {
    let directory = WorkingDirectory::new();
    let scene = scene("quick.toml");
    let arguments = ["run", &scene, "-o", "run.h5", "--force", "--set", "operation.duration=1 s"];
    directory.plateau(arguments).quiet_success();
    let before = fs::read(directory.path("run.h5")).unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    let mut refused = 0;
    // A thread that looks for signals, one for each core, one that writes: with one less there is no run.
    for threads in 0..cores + 2 {
        let outcome = without_threads(directory.command(arguments), threads);
        assert_told(&outcome, &format!("{threads} threads"));
        if outcome.status == Some(0) {
            break;
        }
        refused += 1;
        assert!(outcome.stderr.starts_with("plateau: ") && outcome.stderr.contains("the system gives no more threads"));
        // An error that the library returns, not a panic of rayon's.
        assert!(!outcome.stderr.contains("ThreadPoolBuildError"), "{}", outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
        assert!(fs::read(directory.path("run.h5")).unwrap() == before, "{threads} threads");
    }
    assert!(refused > 1);
}

#[test]
fn without_files_or_memory_nothing_panics() {
    let directory = WorkingDirectory::new();
    let (files, megabytes) = few_or_all((&[4][..], &[100][..]), (&[3, 4, 5], &[60, 100, 200]));
    let mut limits: Vec<String> = files.iter().map(|files| format!("ulimit -n {files}")).collect();
    limits.extend(megabytes.iter().map(|megabytes| format!("ulimit -c 0; ulimit -v {}", megabytes * 1000)));
    for command in commands(&directory) {
        directory.plateau(&command).ends(0, &[]);
        for limit in &limits {
            let mut limited = directory.command_after(limit, &command);
            limited.env_remove("RUST_BACKTRACE");
            let outcome = run(limited);
            // The system itself cannot start it.
            if !outcome.stderr.contains("error while loading shared libraries") {
                assert_told(&outcome, &format!("{command:?} after {limit}"));
            }
        }
    }
}
