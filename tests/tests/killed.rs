//! A run that is killed, or that finds the disc full, leaves a file that does not look finished and that can be read.

use std::fs;

use plateau_tests::program::{ENDLESS, WorkingDirectory, kill, run, scene, start, wait_until};
use plateau_tests::run_file::RunFile;

#[test]
fn a_killed_run_is_still_running_to_its_readers() {
    let directory = WorkingDirectory::new();
    let (scene, file) = (scene("cermet.toml"), directory.path("run.h5"));
    let child = start(directory.command(["run", &scene, "-o", "run.h5"]));
    let samples = || RunFile::follow(&file).map_or(0, |run| run.shape("/time")[0]);
    let sampled = wait_until(|| samples() >= 2);
    kill(child);
    assert!(sampled, "no samples were written");

    let run = RunFile::follow(&file).unwrap();
    assert_eq!(run.text("state"), "running");
    let times = run.floats("/time");
    assert!(times.len() >= 2 && times.is_sorted(), "{times:?}");
    assert!(run.floats("/series/displacement").len() >= times.len());
    assert_eq!(run.floats("/map_time")[0], 0.0);
    drop(run);

    // The next run does not touch it unless told to.
    let left = directory.content();
    assert_eq!(directory.names(), ["run.h5", "run.h5.lock"]);
    let short = ["run", &scene, "-o", "run.h5", "--set", "operation.duration=0.5 s", "--set", "output.maps_at=[]"];
    directory.plateau(short).ends(2, &["--force"]);
    assert!(directory.content() == left, "the refused run changed the file");
    directory.plateau(short.iter().chain(&["--force"])).quiet_success();
    assert_eq!(RunFile::open(&file).text("state"), "finished");
    assert_eq!(directory.names(), ["run.h5", "run.h5.checkpoint"]);
}

/// Bytes of the blocks of `ulimit -f` in this system's sh.
fn block() -> u64 {
    // POSIX says 512; some shells count in kibibytes.
    let directory = WorkingDirectory::new();
    let mut shell = std::process::Command::new("sh");
    shell.current_dir(directory.path(".")).args(["-c", "ulimit -f 1; trap '' XFSZ; head -c 4096 /dev/zero > block"]);
    run(shell);
    let block = fs::metadata(directory.path("block")).unwrap().len();
    assert!(block == 512 || block == 1024, "{block}");
    block
}

#[test]
fn a_full_disc_ends_a_run_with_a_message_and_never_looks_finished() {
    let edits = [("duration = \"60 s\"", "steps = 300"), ("sample_every = \"0.1 s\"", "sample_every_steps = 1")];
    let directory = WorkingDirectory::with_scene(&edits);
    directory.plateau(["run", "scene.toml", "-o", "whole.h5"]).quiet_success();
    let (whole, block) = (fs::metadata(directory.path("whole.h5")).unwrap().len(), block());

    // From a single block to some room beyond the whole file: the file is cut in every phase of its writing.
    let room = 256 * 1024;
    let limits = (0..=24).map(|part| ((whole + room) * part / 24 / block).max(1));
    // And where the last page of the run file is missing.
    let limits = limits.chain([(whole - 4096) / block]);
    let (mut failed, mut finished) = (0, 0);
    for limit in limits {
        let arguments = ["run", "scene.toml", "-o", "run.h5"];
        let outcome = run(directory.command_after(&format!("ulimit -f {limit}"), arguments));
        let file = directory.path("run.h5");
        let what = format!("{} of {whole} bytes: {}", limit * block, outcome.stderr);
        match outcome.status {
            Some(0) => {
                finished += 1;
                assert_eq!(RunFile::open(&file).text("state"), "finished", "{what}");
            }
            Some(1) => {
                failed += 1;
                assert_eq!(outcome.stdout, "", "{what}");
                let stage = if file.exists() { "plateau: writing " } else { "plateau: setting up " };
                assert!(outcome.stderr.starts_with(stage) && outcome.stderr.contains("File too large"), "{what}");
                assert_eq!(outcome.stderr.lines().count(), 1, "{what}");
                if file.exists() {
                    let run = RunFile::follow(&file).unwrap_or_else(|error| panic!("{what}: {error}"));
                    assert_eq!(run.text("state"), "running", "{what}");
                    assert!(run.floats("/time").is_sorted(), "{what}");
                }
            }
            other => panic!("{other:?} with {what}"),
        }
        let expected: &[&str] = match (file.exists(), outcome.status) {
            (false, _) => &[],
            // What is kept of the end is smaller than the run file.
            (true, Some(0)) => &["run.h5", "run.h5.checkpoint"],
            (true, _) => &["run.h5"],
        };
        let others = ["scene.toml", "whole.h5", "whole.h5.checkpoint"];
        let names: Vec<_> = directory.names().into_iter().filter(|name| !others.contains(&name.as_str())).collect();
        assert_eq!(names, expected, "{what}");
        directory.remove("run.h5");
    }
    assert!(failed >= 10 && finished >= 1, "{failed} failed, {finished} finished");
}

#[test]
fn samples_of_before_the_first_checkpoint_stay_when_a_run_begins_anew() {
    let edits = [ENDLESS, ("sample_every = \"0.1 s\"", "sample_every_steps = 1")];
    let directory = WorkingDirectory::with_scene(&edits);
    let arguments = ["run", "scene.toml", "-o", "run.h5", "--set", "output.checkpoint_every=3600 s"];
    let samples = |name: &str| RunFile::follow(directory.path(name)).map_or(0, |run| run.shape("/time")[0]);
    let begin_and_kill = |more: &[&str]| {
        let child = start(directory.command(arguments.iter().chain(more)));
        let begun = || samples("run.h5") >= 10 && (more.is_empty() || directory.path("run.h5.before-resume").exists());
        let sampled = wait_until(begun);
        kill(child);
        assert!(sampled, "no samples were written: {:?}", directory.names());
    };
    begin_and_kill(&[]);
    let there = samples("run.h5");
    // Where there is no room to begin anew all is as it was.
    let failed = run(directory.command_after("ulimit -f 8", arguments.iter().chain(&["--resume"]))).ends(1, &[]);
    assert_eq!(directory.names(), ["run.h5", "scene.toml"], "{failed:?}");
    assert_eq!(samples("run.h5"), there);
    for _ in 0..3 {
        begin_and_kill(&["--resume"]);
        assert!(samples("run.h5.before-resume") >= there, "the samples of before are gone");
        assert!(!directory.path("run.h5.before-resume-2").exists(), "one of them is enough");
    }
    // With room for some samples and no more the message promises no checkpoint.
    fs::remove_file(directory.path("run.h5")).unwrap();
    let limit = format!("ulimit -f {}", 1024 * 1024 / block());
    let full = run(directory.command_after(&limit, arguments)).ends(1, &[]);
    assert!(full.stderr.contains("there is no checkpoint yet") && !full.stderr.contains("so is the last"), "{full:?}");
}

#[test]
fn a_run_file_that_is_gone_is_missed_once() {
    let directory = WorkingDirectory::with_scene(&[ENDLESS]);
    let arguments = ["run", "scene.toml", "-o", "run.h5", "--set", "output.checkpoint_every=0.05 s"];
    let child = start(directory.command(arguments));
    let two = wait_until(|| directory.path("run.h5.checkpoint-before").exists());
    kill(child);
    assert!(two, "there are no two checkpoints: {:?}", directory.names());
    fs::remove_file(directory.path("run.h5")).unwrap();
    let refused = directory.plateau(arguments.iter().chain(&["--resume"]));
    let said = "plateau: run.h5 is gone, though its checkpoint is there; without --resume, --force begins again\n";
    assert_eq!((refused.status, refused.stderr.as_str()), (Some(2), said));
}

#[test]
fn what_is_made_of_a_run_says_when_a_file_may_not_grow() {
    let directory = WorkingDirectory::new();
    directory.plateau(["run", &scene("quick.toml"), "-o", "run.h5"]).quiet_success();
    for made in ["r.npy", "r.sdf"] {
        let heights = ["surface", "run.h5", "--dataset", "disc/height", "--at", "0 s", "--to", made];
        let outcome = run(directory.command_after("ulimit -f 8", heights)).ends(1, &["File too large"]);
        assert!(!directory.names().iter().any(|name| name.contains(made)), "{outcome:?}");
    }
}
