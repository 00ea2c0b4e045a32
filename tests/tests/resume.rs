//! Runs that are stopped, killed and gone on with end as if nothing had happened.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::thread;
use std::time::Duration;

use plateau_tests::program::{Outcome, WorkingDirectory, kill, run_words, send, start, wait_until};
use plateau_tests::run_file::{RunFile, assert_holds_start, differences};
use plateau_tests::scenes::Stream;
use plateau_tests::scenes::few_or_all;

/// A run of some seconds with many samples, some maps and a checkpoint every few hundredths of a second.
fn arguments(file: &str, more: &[&str]) -> Vec<String> {
    let sets = [
        "operation.duration=60 s",
        "numerics.time_acceleration=1",
        "output.sample_every=0.05 s",
        "output.maps_at=[\"0 s\", \"10 s\", \"40 s\", \"59.99 s\"]",
        "output.checkpoint_every=0.03 s",
    ];
    run_words("quick.toml", file, &sets, more)
}

fn run(directory: &WorkingDirectory, file: &str, more: &[&str]) -> Outcome {
    directory.plateau(arguments(file, more))
}

/// Starts a run and kills it at some moment after the state of the run before has changed.
fn start_and_kill(directory: &WorkingDirectory, more: &[&str], random: &mut Stream) {
    let state = || fs::metadata(directory.path("run.h5.checkpoint")).and_then(|file| file.modified()).ok();
    let before = state();
    let child = start(directory.command(arguments("run.h5", more)));
    wait_until(|| state() != before);
    thread::sleep(Duration::from_secs_f64(0.06 * random.uniform()));
    kill(child);
}

/// Kills as often as `PLATEAU_KILLS` says, if it does.
#[test]
fn a_run_killed_again_and_again_ends_bit_for_bit_like_an_undisturbed_one() {
    let kills = std::env::var("PLATEAU_KILLS").map_or(few_or_all(4, 1000), |kills| kills.parse().unwrap());
    let directory = WorkingDirectory::new();
    run(&directory, "whole.h5", &[]).ends(0, &[]);
    let whole = directory.run_file("whole.h5").content();
    let (mut random, mut killed, mut ended) = (Stream(8), 0, 0);
    while killed < kills || ended == 0 {
        // The end alone: threads that wait for each other take many times as long where other tests run beside them.
        let workers = if killed < kills { ["1", "2", "3"][killed % 3] } else { "1" };
        let mut child = start(directory.command(arguments("run.h5", &["--resume", "--workers", workers])));
        if killed < kills {
            thread::sleep(Duration::from_secs_f64(0.5 * random.uniform()));
        }
        let status = if killed < kills { child.try_wait().unwrap() } else { Some(child.wait().unwrap()) };
        let Some(status) = status else {
            kill(child);
            killed += 1;
            assert_holds_start(&directory, "run.h5", &whole);
            continue;
        };
        assert!(status.success(), "{status}");
        let run_file = directory.run_file("run.h5");
        assert_eq!(run_file.text("state"), "finished");
        assert_eq!(differences(&whole, &run_file.content()), [""; 0], "after {killed} kills");
        // A run that was killed before its first checkpoint is kept beside the one that began anew.
        let names: Vec<_> = directory.names().into_iter().filter(|name| name.contains("run.h5")).collect();
        let (before, own): (Vec<_>, Vec<_>) = names.iter().partition(|name| name.ends_with(".before-resume"));
        let kept = ["run.h5", "run.h5.checkpoint", "run.h5.checkpoint-before"];
        assert!(own.len() <= kept.len() && own.iter().zip(kept).all(|(own, kept)| **own == kept), "{names:?}");
        before.iter().for_each(|name| assert_holds_start(&directory, name, &whole));
        // Once more changes nothing.
        run(&directory, "run.h5", &["--resume"]).ends(0, &["is finished"]);
        ended += 1;
        directory.remove("run.h5");
    }
    println!("{killed} kills, {ended} runs to their end");
}

#[test]
fn a_run_that_chooses_its_acceleration_goes_on_too() {
    let directory = WorkingDirectory::new();
    let chosen =
        ["--set", "numerics.time_acceleration={ tolerance = 0.01, max = 1000 }", "--set", "operation.duration=600 s"];
    run(&directory, "whole.h5", &chosen).ends(0, &[]);
    let mut random = Stream(9);
    for _ in 0..4 {
        start_and_kill(&directory, &[&chosen[..], &["--resume"]].concat(), &mut random);
    }
    run(&directory, "run.h5", &[&chosen[..], &["--resume"]].concat()).ends(0, &[]);
    let content = |name| directory.run_file(name).content();
    assert_eq!(differences(&content("whole.h5"), &content("run.h5")), [""; 0]);
}

#[test]
fn signals_leave_a_checkpoint_of_the_moment() {
    let directory = WorkingDirectory::new();
    let rarely = ["--set", "output.checkpoint_every=1 h", "--set", "operation.duration=250 s"];
    run(&directory, "whole.h5", &rarely).ends(0, &[]);
    // The end is kept, from which it can be extended.
    assert_eq!(directory.names(), ["whole.h5", "whole.h5.checkpoint"]);
    for (signal, status) in [("USR1", None), ("INT", Some(130)), ("TERM", Some(143))] {
        let file = directory.path("run.h5");
        let made = || fs::metadata(&file).map_or(0, |file| file.ino());
        let earlier = made();
        let mut child = start(directory.command(arguments("run.h5", &[&rarely[..], &["--resume"]].concat())));
        let state = || fs::metadata(directory.path("run.h5.checkpoint")).and_then(|file| file.modified()).ok();
        let before = state();
        // From then on it listens.
        assert!(wait_until(|| made() != earlier), "no run file");
        send(signal, child.id());
        assert!(wait_until(|| state() != before), "no checkpoint after {signal}");
        match status {
            None => kill(child),
            Some(status) => assert_eq!(child.wait().unwrap().code(), Some(status)),
        }
    }
    // Who gives the same command again is told that there is something to go on with, and of a run that is finished is not.
    for (file, is_offered) in [("run.h5", true), ("whole.h5", false)] {
        let again = run(&directory, file, &rarely);
        let again = again.ends(2, &[&format!("{file} exists")]);
        assert_eq!(again.stderr.contains("--resume goes on with it"), is_offered, "{again:?}");
    }
    run(&directory, "run.h5", &[&rarely[..], &["--resume"]].concat()).ends(0, &[]);
    let content = |name| directory.run_file(name).content();
    assert_eq!(differences(&content("whole.h5"), &content("run.h5")), [""; 0]);
}

#[test]
fn what_cannot_be_gone_on_with_is_refused_and_stays() {
    let directory = WorkingDirectory::new();
    let mut random = Stream(10);
    start_and_kill(&directory, &["--resume"], &mut random);
    // The lock of the killed run, and what it was just writing, are taken away by who comes next.
    let kept = || {
        let mut content = directory.content();
        let left = |path: &Path| path.extension().is_some_and(|ending| ending == "lock" || ending == "tmp");
        content.retain(|path, _| !left(path));
        content
    };
    let before = kept();
    run(&directory, "run.h5", &["--resume", "--set", "operation.normal_force=7 N"])
        .ends(2, &["operation.normal_force was \"5 N\", is \"7 N\""]);
    assert!(kept() == before);

    // A flipped bit in the newest: the one before holds.
    let [newest, older] = ["run.h5.checkpoint", "run.h5.checkpoint-before"].map(|name| directory.path(name));
    fs::copy(&newest, &older).unwrap();
    let mut bytes = fs::read(&newest).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&newest, &bytes).unwrap();
    run(&directory, "run.h5", &["--resume"]).ends(0, &["its digest does not hold", "goes on from step"]);

    // Neither holds.
    for path in [&newest, &older] {
        fs::write(path, &bytes[..middle]).unwrap();
    }
    run(&directory, "run.h5", &["--resume"]).ends(2, &["--force begins again"]);
    run(&directory, "run.h5", &["--force"]).ends(0, &[]);
}

#[test]
fn a_checkpoint_of_the_end_is_believed_only_beside_the_file_of_the_end() {
    let directory = WorkingDirectory::new();
    let [file, kept, damaged] = ["run.h5", "kept.h5", "damaged.h5"].map(|name| directory.path(name));
    start_and_kill(&directory, &["--resume"], &mut Stream(11));
    fs::copy(&file, &kept).unwrap();
    run(&directory, "run.h5", &["--resume"]).ends(0, &[]);
    let whole = RunFile::open(&file).content();
    fs::copy(&file, &damaged).unwrap();

    // The file of an earlier moment: less than any checkpoint says, or what the one before goes on from.
    fs::copy(&kept, &file).unwrap();
    let before = directory.content();
    let outcome = run(&directory, "run.h5", &["--resume"]);
    assert!(!outcome.stderr.contains("is finished"), "{outcome:?}");
    match outcome.status {
        Some(0) => assert_eq!(differences(&whole, &RunFile::open(&file).content()), [""; 0]),
        Some(2) => {
            assert!(outcome.stderr.contains("samples") && outcome.stderr.contains("expected"), "{outcome:?}");
            assert!(directory.content() == before);
        }
        _ => panic!("{outcome:?}"),
    }

    // A finished file that was damaged since.
    let mut bytes = fs::read(&damaged).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle..middle + 64].fill(0x5a);
    fs::write(&file, &bytes).unwrap();
    run(&directory, "run.h5", &["--resume"]).ends(2, &["damaged"]);
    assert!(fs::read(&file).unwrap() == bytes);
}

#[test]
fn a_finished_run_goes_on_beyond_its_end() {
    let directory = WorkingDirectory::new();
    let told = |file: &str, more: &[&str]| run(&directory, file, &[more, &["--json"]].concat()).json();
    let short = told("run.h5", &["--set", "operation.duration=5 s"]);
    let longer = told("run.h5", &["--set", "operation.duration=5 s", "--extend-to", "15 s"]);
    run(&directory, "whole.h5", &["--set", "operation.duration=15 s"]).ends(0, &[]);
    // Its speed is that of the steps that it took itself.
    let [steps, before] = [&longer, &short].map(|summary| summary["steps"].as_u64().unwrap());
    let [speed, time] = ["steps_per_second", "wall_time"].map(|name| longer[name].as_f64().unwrap());
    assert_eq!((speed * time).round() as u64, steps - before);
    let [longer, whole] = ["run.h5", "whole.h5"].map(|name| directory.run_file(name));
    // 5 s is a multiple of the samples' time, so there is none more.
    for series in ["contact_area", "pool", "filled_fraction"] {
        let of = |run: &RunFile| run.floats(&format!("/series/{series}"));
        assert_eq!(of(&longer), of(&whole), "{series}");
    }
    assert_eq!(longer.last_map("/disc/height"), whole.last_map("/disc/height"));
}

#[test]
fn only_the_same_run_is_gone_on_with() {
    let directory = WorkingDirectory::new();
    // On a fast machine, too, it is time for more than one checkpoint.
    let short = ["--set", "operation.duration=2 s", "--set", "output.checkpoint_every=1 ms"];
    let with = |more: &[&str]| run(&directory, "run.h5", &[&short[..], more].concat());
    assert_eq!(with(&[]).status, Some(0));
    // There is nothing to do, and that is said.
    for more in [["--resume", "--json"], ["--extend-to", "2 s"]] {
        with(&more).ends(0, &["is finished"]);
    }
    with(&["--extend-to", "1 s"]).ends(2, &["has come to 2.000 s already"]);
    for name in ["run.h5.checkpoint", "run.h5.checkpoint-before"] {
        fs::remove_file(directory.path(name)).unwrap();
    }
    let before = directory.content();
    with(&["--extend-to", "3 s"]).ends(2, &["has no checkpoint"]);
    with(&["--resume", "--set", "operation.normal_force=7 N"]).ends(2, &["operation.normal_force"]);
    assert_eq!(with(&["--resume"]).status, Some(0));
    assert!(directory.content() == before);
    fs::write(directory.path("run.h5"), "notes").unwrap();
    for more in [["--resume", "--json"], ["--extend-to", "3 s"]] {
        assert_eq!(with(&more).status, Some(2));
    }
    assert_eq!(directory.text("run.h5"), "notes");
}

#[test]
fn a_run_goes_on_with_the_engine_that_began_it() {
    let directory = WorkingDirectory::new();
    let run = |file: &str, engine: &str, more: &[&str]| {
        let settings = ["operation.duration=0.1 s", "numerics.time_acceleration=1", "output.maps_at=[]"];
        directory.plateau(run_words("quick.toml", file, &settings, &[&["--engine", engine], more].concat()))
    };
    run("whole.h5", "plain", &["--set", "operation.duration=0.2 s"]).quiet_success();
    run("run.h5", "plain", &[]).quiet_success();
    let extended = ["--extend-to", "0.2 s"];
    run("run.h5", "fast", &extended).ends(2, &["it was begun with --engine plain, this is fast"]);
    run("run.h5", "plain", &extended).ends(0, &[]);
    let [whole, run] = ["whole.h5", "run.h5"].map(|name| directory.run_file(name));
    let [whole, run] =
        [whole, run].map(|file| file.last_map("/pin/height").into_iter().map(f64::to_bits).collect::<Vec<_>>());
    assert!(whole == run, "the pin differs");
}
