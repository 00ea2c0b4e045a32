//! Nothing is lost, whichever of the calls that change files is the last of the program, or fails: what was complete can be
//! read, and a run that is gone on with ends as if nothing had happened.
//!
//! Here a part of the calls is looked at, in turn with each fault; `PLATEAU_FAULTS=all` has every call with every fault, a number those
//! from that call on.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use plateau_tests::fault::{Fault, count, strike};
use plateau_tests::program::{SMALL_MESH, WorkingDirectory, run, run_words};
use plateau_tests::run_file::{Content, RunFile, differences, differences_of_start};
use plateau_tests::scenes::few_or_all;

mod answers;
mod clock;

/// A short run with many samples, maps of three moments, and as many checkpoints as can be written.
fn short_run(directory: &WorkingDirectory, more: &[&str]) -> Command {
    let settings = [
        "operation.duration=2 s",
        "numerics.time_acceleration=1",
        "output.sample_every=0.02 s",
        "output.maps_at=[\"0 s\", \"1 s\"]",
        "output.checkpoint_every=0.004 s",
    ];
    directory.command(run_words("quick.toml", "run.h5", &[&SMALL_MESH[..], &settings].concat(), more))
}

/// The calls to look at, each with a fault: unless all are asked for every `step`th, which is no multiple of the number of faults.
fn strikes(calls: usize, step: usize) -> Vec<(Fault, usize)> {
    let asked = std::env::var("PLATEAU_FAULTS").ok();
    let first = asked.as_ref().and_then(|first| first.parse().ok()).unwrap_or(1);
    let all = (first..=calls).flat_map(|call| Fault::ALL.map(|fault| (fault, call)));
    all.step_by(if asked.is_some() { 1 } else { step }).collect()
}

/// The content of an undisturbed run.
fn whole() -> BTreeMap<String, Content> {
    let directory = WorkingDirectory::new();
    run(short_run(&directory, &[])).ends(0, &[]);
    directory.run_file("run.h5").content()
}

/// Checks that what is there can be read and gone on with.
fn check(directory: &WorkingDirectory, whole: &BTreeMap<String, Content>, what: &str) {
    let run_file = directory.path("run.h5");
    if run_file.exists() {
        for command in ["repair", "verify"] {
            let outcome = directory.plateau([command, "run.h5"]);
            assert_eq!(outcome.status, Some(0), "{command} after {what}: {outcome:?}");
        }
        let there = RunFile::open(&run_file).content();
        assert_eq!(differences_of_start(whole, &there), [""; 0], "after {what}");
    }
    let states = ["run.h5.checkpoint", "run.h5.checkpoint-before"].map(|name| directory.path(name).exists());
    let outcome = run(short_run(directory, &["--resume"]));
    assert_eq!(outcome.status, Some(0), "--resume after {what}: {outcome:?}");
    let said = |text| outcome.stderr.contains(text);
    let expected = if states.contains(&true) { "goes on from step" } else { "begins from the beginning" };
    assert!(said(expected) || said("is finished"), "{what}: {outcome:?}");
    assert_eq!(differences(whole, &RunFile::open(&run_file).content()), [""; 0], "--resume after {what}");
    let verified = directory.plateau(["verify", "run.h5"]);
    assert_eq!(verified.status, Some(0), "{what}: {verified:?}");
    let left = directory.names().into_iter().find(|name| name.ends_with(".tmp") && !process_lives(name));
    assert_eq!(left, None, "after {what}");
}

/// Whether there is a process of the number in the name of a temporary file: by chance, a later one.
fn process_lives(name: &str) -> bool {
    let process = name.split("plateau-").nth(1).and_then(|rest| rest.split('-').next()).unwrap_or_default();
    Path::new("/proc").join(process).exists()
}

#[test]
fn a_run_loses_nothing() {
    let whole = whole();
    let calls = count(short_run(&WorkingDirectory::new(), &[]));
    println!("{calls} calls of a run");
    for (fault, call) in strikes(calls, few_or_all(307, 47)) {
        let directory = WorkingDirectory::new();
        let outcome = strike(short_run(&directory, &[]), fault, call);
        let what = format!("{fault:?} at call {call} of {calls}: {outcome:?}");
        if outcome.status == Some(0) {
            assert_eq!(differences(&whole, &directory.run_file("run.h5").content()), [""; 0], "{what}");
        }
        check(&directory, &whole, &what);
    }
}

/// A directory with what a killed run has left, again and again.
struct Killed {
    files: Vec<(String, Vec<u8>)>,
}

impl Killed {
    fn new() -> Self {
        let calls = count(short_run(&WorkingDirectory::new(), &[]));
        // How many calls there are depends on how many checkpoints the disk takes.
        for call in (1..calls).rev() {
            let directory = WorkingDirectory::new();
            let outcome = strike(short_run(&directory, &[]), Fault::Kill, call);
            let samples = outcome.status.is_none()
                && RunFile::follow(directory.path("run.h5"))
                    .is_ok_and(|run| run.shape("/time")[0] > 0 && run.text("state") == "running");
            if samples && directory.path("run.h5.checkpoint").exists() {
                let read = |name: String| (name.clone(), fs::read(directory.path(&name)).unwrap());
                return Self { files: directory.names().into_iter().map(read).collect() };
            }
        }
        panic!("no call of {calls} leaves a run to go on with");
    }

    fn directory(&self) -> WorkingDirectory {
        let directory = WorkingDirectory::new();
        for (name, content) in &self.files {
            directory.write(name, content);
        }
        directory
    }
}

#[test]
fn going_on_loses_nothing() {
    let (whole, killed) = (whole(), Killed::new());
    let calls = count(short_run(&killed.directory(), &["--resume"]));
    println!("{calls} calls of --resume");
    for (fault, call) in strikes(calls, few_or_all(307, 47)) {
        let directory = killed.directory();
        let outcome = strike(short_run(&directory, &["--resume"]), fault, call);
        check(&directory, &whole, &format!("{fault:?} at call {call} of {calls} of --resume: {outcome:?}"));
    }
}

#[test]
fn repairing_loses_nothing() {
    let (whole, killed) = (whole(), Killed::new());
    let repair = |directory: &WorkingDirectory| directory.command(["repair", "run.h5"]);
    let calls = count(repair(&killed.directory()));
    println!("{calls} calls of repair");
    let samples = |directory: &WorkingDirectory| RunFile::follow(directory.path("run.h5")).unwrap().shape("/time");
    let expected = samples(&killed.directory());
    for (fault, call) in strikes(calls, few_or_all(307, 47)) {
        let directory = killed.directory();
        let outcome = strike(repair(&directory), fault, call);
        let what = format!("{fault:?} at call {call} of {calls} of repair: {outcome:?}");
        assert_eq!(samples(&directory), expected, "{what}");
        check(&directory, &whole, &what);
    }
}
