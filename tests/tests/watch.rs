//! `plateau watch` follows a run to its end, says how it ended, and waits for nothing silently.

use std::fs;
use std::path::Path;
use std::process::{Child, Command};

use plateau_tests::program::{ENDLESS, WorkingDirectory, kill, quick_scene_with, send, start, wait_until};
use plateau_tests::run_file::{RunFile, set_text};

/// A run that does not end by itself while a test goes on; it has samples when this returns.
fn endless_run(directory: &WorkingDirectory, file: &str) -> Child {
    let edits = [ENDLESS, ("sample_every = \"0.1 s\"", "sample_every_steps = 100")];
    directory.write("scene.toml", quick_scene_with(&edits));
    let child = start(directory.command(["run", "scene.toml", "-o", file]));
    let path = directory.path(file);
    let sampled = wait_until(|| RunFile::follow(&path).is_ok_and(|run| run.shape("/time")[0] >= 2));
    assert!(sampled, "no samples were written");
    child
}

/// A watcher of `run.h5` that runs beside the test and writes into files.
fn watcher(directory: &WorkingDirectory, arguments: &[&str]) -> Child {
    let [lines, messages] = ["lines", "messages"].map(|name| fs::File::create(directory.path(name)).unwrap());
    let mut command = directory.command(["watch", "run.h5"].iter().chain(arguments));
    command.env_remove("LC_ALL").env("LANG", "C").stdout(lines).stderr(messages).spawn().unwrap()
}

/// How many samples a line speaks of.
fn samples(line: &str) -> u64 {
    let part = line.split(", ").find_map(|part| part.strip_suffix(" samples"));
    part.unwrap_or_else(|| panic!("{line}")).replace(' ', "").parse().unwrap()
}

#[test]
fn a_finished_run_is_told_with_its_last_sample() {
    let directory = WorkingDirectory::with_scene(&[("duration = \"60 s\"", "duration = \"5 s\"")]);
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    let run = directory.run_file("run.h5");
    let last = |name: &str| *run.floats(name).last().unwrap();
    for arguments in [&["watch", "run.h5"][..], &["watch", "run.h5", "--once"]] {
        let output = directory.plateau(arguments).quiet_success();
        let [line] = output.lines().collect::<Vec<_>>()[..] else { panic!("{output}") };
        assert!(line.starts_with("finished: 5.000 of 5.000 s (100 %), "), "{line}");
        assert_eq!(samples(line), run.shape("/time")[0] as u64);
        assert!(line.contains(&format!("contact area {:.4} mm", last("/series/contact_area") * 1e6)), "{line}");
        assert!(line.contains(&format!("revolution {:.4} mm", last("/series/contact_area_mean") * 1e6)), "{line}");
    }
}

/// Makes a finished run one that failed, as the program writes it.
fn fail(path: &Path, reason: &str) {
    set_text(path, "state", "failed");
    set_text(path, "error", reason);
}

#[test]
fn a_failed_run_is_told_with_its_reason() {
    let directory = WorkingDirectory::with_scene(&[("duration = \"60 s\"", "duration = \"1 s\"")]);
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    fail(&directory.path("run.h5"), "out of luck");
    let outcome = directory.plateau(["watch", "run.h5"]).ends(1, &[]);
    assert_eq!(outcome.stderr, "plateau: the run failed: out of luck\n");
    assert!(outcome.stdout.starts_with("failed: 1.000 of 1.000 s (100 %), "), "{}", outcome.stdout);
    assert!(directory.plateau(["watch", "run.h5", "--once"]).quiet_success().starts_with("failed: "));
}

#[test]
fn a_run_is_followed_until_it_is_stopped() {
    let directory = WorkingDirectory::new();
    let mut run = endless_run(&directory, "run.h5");
    let mut watching = watcher(&directory, &[]);
    assert!(wait_until(|| directory.text("lines").lines().count() >= 3), "{}", directory.text("messages"));
    send("INT", run.id());
    assert!(wait_until(|| watching.try_wait().unwrap().is_some()), "the watcher did not end with the run");
    assert_eq!(watching.wait().unwrap().code(), Some(1));
    let (lines, messages) = (directory.text("lines"), directory.text("messages"));
    assert!(messages.starts_with("plateau: the run was stopped at "), "{messages}");
    // Plain lines, one for each look that found something new.
    assert!(lines.bytes().all(|byte| byte == b'\n' || (b' '..=b'~').contains(&byte)), "{lines:?}");
    let (last, before) = lines.lines().collect::<Vec<_>>().split_last().map(|(l, b)| (*l, b.to_vec())).unwrap();
    assert!(before.iter().all(|line| line.starts_with("running: ")) && last.starts_with("interrupted: "), "{lines}");
    assert!(before.windows(2).all(|pair| samples(pair[0]) < samples(pair[1])), "{lines}");
    assert_eq!(samples(last), directory.run_file("run.h5").shape("/time")[0] as u64);
    run.wait().unwrap();
}

#[test]
fn a_killed_run_is_given_up_after_the_timeout() {
    let directory = WorkingDirectory::new();
    kill(endless_run(&directory, "run.h5"));
    let outcome = directory.plateau(["watch", "run.h5", "--timeout", "1"]).ends(1, &[]);
    assert!(outcome.stdout.starts_with("running: "), "{}", outcome.stdout);
    let message = "plateau: run.h5 has no new sample for 1.0 s; the run may have been killed\n";
    assert_eq!(outcome.stderr, message);

    // Written long ago: that is said at once, and watching goes on until it is stopped.
    let touched = Command::new("touch").args(["-d", "2 hours ago"]).arg(directory.path("run.h5")).status();
    assert!(touched.unwrap().success());
    for (name, status) in [("INT", 130), ("TERM", 143)] {
        let mut watching = watcher(&directory, &[]);
        let message = "plateau: warning: no new sample for 2.0 h; the run may have been killed\n";
        assert!(wait_until(|| directory.text("lines").lines().count() == 1), "{}", directory.text("messages"));
        send(name, watching.id());
        assert!(wait_until(|| watching.try_wait().unwrap().is_some()), "the watcher did not end");
        assert_eq!(watching.wait().unwrap().code(), Some(status));
        assert_eq!(directory.text("messages"), message);
    }
}

#[test]
fn a_file_that_is_not_there_yet_is_waited_for() {
    let directory = WorkingDirectory::new();
    let mut watching = watcher(&directory, &["--timeout", "50"]);
    assert!(wait_until(|| directory.text("messages") == "plateau: waiting for run.h5\n"));
    directory.write("scene.toml", quick_scene_with(&[("duration = \"60 s\"", "duration = \"1 s\"")]));
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    assert!(wait_until(|| watching.try_wait().unwrap().is_some()), "the watcher did not end with the run");
    assert_eq!(watching.wait().unwrap().code(), Some(0), "{}", directory.text("messages"));
    assert!(directory.text("lines").lines().last().unwrap().starts_with("finished: 1.000 of 1.000 s"));

    directory
        .plateau(["watch", "never.h5", "--timeout", "1"])
        .ends(2, &["cannot read never.h5: ", "none came within 1.0 s"]);
    directory.plateau(["watch", "never.h5", "--once"]).ends(2, &[]);
}
