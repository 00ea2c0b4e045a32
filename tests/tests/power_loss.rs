//! A loss of power at any moment costs no more than what came after the last checkpoint: what can be read is right, and a run that
//! is gone on with ends as if nothing had happened.
//!
//! Losses are drawn by lot, with what the disk has of what was not synchronised; `PLATEAU_LOSSES` says how many, `PLATEAU_SEED`
//! which.

use std::collections::BTreeMap;
use std::process::Command;

use plateau_io::run_file::checkpoint::{self, RunState};
use plateau_tests::power_loss::{Files, Journal, after_starts};
use plateau_tests::program::{Outcome, SMALL_MESH, WorkingDirectory, run, run_words};
use plateau_tests::run_file::{Content, differences, differences_of_start};
use plateau_tests::scenes::{Stream, few_or_all};

mod made_of_runs;

/// A run with many samples, maps of three moments, and as many checkpoints as can be written.
fn run_of(directory: &WorkingDirectory, more: &[&str]) -> Command {
    let settings = [
        "operation.duration=8 s",
        "numerics.time_acceleration=1",
        "output.sample_every=0.05 s",
        "output.maps_at=[\"0 s\", \"4 s\"]",
        "output.checkpoint_every=0.004 s",
    ];
    directory.command(run_words("quick.toml", "run.h5", &[&SMALL_MESH[..], &settings].concat(), more))
}

fn repair_of(directory: &WorkingDirectory) -> Command {
    directory.command(["repair", "run.h5"])
}

fn on(files: &Files) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    for (name, bytes) in files {
        directory.write(name, bytes);
    }
    directory
}

/// Runs a command on a machine that was started so many times since its files were made.
fn run_after(starts: usize, mut command: Command) -> Outcome {
    after_starts(&mut command, starts);
    run(command)
}

fn number(variable: &str) -> Option<u64> {
    std::env::var(variable).ok()?.parse().ok()
}

/// How many losses are tried, in short half as many, unless `PLATEAU_LOSSES` says so.
fn losses(few: usize) -> usize {
    number("PLATEAU_LOSSES").map_or_else(|| few_or_all(few / 2, 20 * few), |number| number as usize)
}

/// The lot, which is another one each time.
fn lot() -> Stream {
    let seed = number("PLATEAU_SEED").unwrap_or_else(|| u64::from(std::process::id()));
    println!("PLATEAU_SEED={seed}");
    Stream(seed)
}

/// A number below a bound.
fn below(random: &mut Stream, bound: usize) -> usize {
    (random.uniform() * bound as f64) as usize
}

/// An undisturbed run: what it holds in the end, and all that it did to its files.
struct Undisturbed {
    whole: BTreeMap<String, Content>,
    journal: Journal,
}

impl Undisturbed {
    fn new() -> Self {
        let directory = WorkingDirectory::new();
        let (outcome, journal) = Journal::of(&directory, run_of(&directory, &[]));
        assert_eq!(outcome.status, Some(0), "{outcome:?}");
        Self { whole: directory.run_file("run.h5").content(), journal }
    }

    /// What the run leaves when it is killed, or when the power is lost, after its first checkpoint and before its end; and how
    /// often the machine was started since.
    fn stopped(&self, random: &mut Stream) -> (Files, usize) {
        loop {
            let calls = below(random, self.journal.calls());
            let (files, starts) = match below(random, 2) {
                0 => (self.journal.killed_after(calls), 0),
                _ => (self.journal.disk_after(calls, random), 1),
            };
            if samples_kept(&on(&files)).is_some() && !files.contains_key("run.h5.before-repair") {
                return (files, starts);
            }
        }
    }
}

/// Samples of the newest checkpoint that holds, if one does.
fn samples_kept(directory: &WorkingDirectory) -> Option<usize> {
    let states = checkpoint::paths(&directory.path("run.h5")).into_iter();
    states.filter_map(|path| checkpoint::read::<RunState>(&path, None).ok()?).map(|state| state.samples).next()
}

/// What became of losses, to be told.
#[derive(Debug, Default)]
struct Tally {
    losses: usize,
    /// There was no run file yet, or no checkpoint.
    without_file: usize,
    without_checkpoint: usize,
    /// Without a checkpoint there was nothing that could be read, or the samples that could were not all right, which was said.
    unreadable: usize,
    wrong: usize,
    /// What came after the checkpoint was left out.
    left_out: usize,
}

impl Tally {
    /// Checks that what a loss of power has left can be repaired and gone on with.
    fn check(
        &mut self,
        files: &Files,
        starts: usize,
        whole: &BTreeMap<String, Content>,
        random: &mut Stream,
        what: &str,
    ) {
        self.losses += 1;
        let kept = samples_kept(&on(files));
        self.without_file += usize::from(!files.contains_key("run.h5"));
        self.without_checkpoint += usize::from(kept.is_none());
        let directory = on(files);
        if files.contains_key("run.h5") {
            self.repair(&directory, starts, kept, whole, what);
        }
        // What was repaired can be gone on with, and so can what was not.
        let directory = if kept.is_some() && below(random, 4) == 0 { directory } else { on(files) };
        let outcome = run_after(starts, run_of(&directory, &["--resume"]));
        assert_eq!(outcome.status, Some(0), "--resume {what}: {outcome:?}");
        let begins = outcome.stderr.contains("begins from the beginning");
        assert!(!begins || kept.is_none(), "{what}: {outcome:?}");
        assert_eq!(differences(whole, &directory.run_file("run.h5").content()), [""; 0], "--resume {what}");
        let verified = run_after(starts, directory.command(["verify", "run.h5"]));
        assert_eq!(verified.status, Some(0), "{what}: {verified:?}");
    }

    fn repair(
        &mut self,
        directory: &WorkingDirectory,
        starts: usize,
        kept: Option<usize>,
        whole: &BTreeMap<String, Content>,
        what: &str,
    ) {
        let outcome = run_after(starts, repair_of(directory));
        if kept.is_none() && outcome.status == Some(2) {
            self.unreadable += 1;
            return;
        }
        assert_eq!(outcome.status, Some(0), "repair {what}: {outcome:?}");
        self.left_out += usize::from(outcome.stderr.contains("is left out"));
        let verified = run_after(starts, directory.command(["verify", "run.h5"]));
        assert_eq!(verified.status, Some(0), "{what}: {verified:?}");
        let there = directory.run_file("run.h5").content();
        let samples = there["/time"].shape[0];
        assert!(samples >= kept.unwrap_or(0), "{what}: {samples} samples of {kept:?}: {outcome:?}");
        if differences_of_start(whole, &there).is_empty() {
            return;
        }
        assert!(kept.is_none() && outcome.stderr.contains("may not have reached the disk"), "{what}: {outcome:?}");
        self.wrong += 1;
    }
}

#[test]
fn a_run_loses_nothing_that_its_checkpoint_has() {
    let (undisturbed, mut random, mut tally) = (Undisturbed::new(), lot(), Tally::default());
    let all = undisturbed.journal.calls();
    for _ in 0..losses(20) {
        let calls = below(&mut random, all + 1);
        let files = undisturbed.journal.disk_after(calls, &mut random);
        tally.check(&files, 1, &undisturbed.whole, &mut random, &format!("after call {calls} of {all} of a run"));
    }
    println!("{tally:?}");
}

/// What the tests above are about does happen: without it they would fail.
#[test]
fn without_the_image_in_the_checkpoint_a_loss_may_cost_the_run() {
    // How many checkpoints a run writes, and so what can be torn, depends on how busy the machine is: several runs, some losses each.
    const RUNS: usize = 8;
    const LOSSES: usize = 100;
    let mut random = lot();
    let costs_a_run = |random: &mut Stream| {
        let undisturbed = Undisturbed::new();
        (0..LOSSES).any(|_| loss_without_image(&undisturbed, random) == Some(2))
    };
    assert!((0..RUNS).any(|_| costs_a_run(&mut random)), "no loss cost the run");
}

/// The status with which a run is gone on with after a loss, if its checkpoints had no image; none where there is no checkpoint.
fn loss_without_image(undisturbed: &Undisturbed, random: &mut Stream) -> Option<i32> {
    let calls = below(random, undisturbed.journal.calls() + 1);
    let directory = on(&undisturbed.journal.disk_after(calls, random));
    for path in checkpoint::paths(&directory.path("run.h5")) {
        if let Ok(Some(mut state)) = checkpoint::read::<RunState>(&path, None) {
            state.images.clear();
            checkpoint::keep(&path, &state).unwrap();
        }
    }
    samples_kept(&directory)?;
    run_after(1, run_of(&directory, &["--resume"])).status
}

/// Losses during a command that is given a run which was stopped.
fn losses_during(name: &str, command: impl Fn(&WorkingDirectory) -> Command) {
    let (undisturbed, mut random, mut tally) = (Undisturbed::new(), lot(), Tally::default());
    let count = losses(12);
    while tally.losses < count {
        let (files, starts) = undisturbed.stopped(&mut random);
        let directory = on(&files);
        let mut command = command(&directory);
        after_starts(&mut command, starts);
        let (outcome, journal) = Journal::of(&directory, command);
        assert_eq!(outcome.status, Some(0), "{outcome:?}");
        for _ in 0..(count - tally.losses).min(3) {
            let calls = below(&mut random, journal.calls() + 1);
            let files = journal.disk_after(calls, &mut random);
            let what = format!("after call {calls} of {} of {name}, {starts} starts", journal.calls());
            tally.check(&files, starts + 1, &undisturbed.whole, &mut random, &what);
        }
    }
    println!("{tally:?}");
}

#[test]
fn going_on_loses_nothing_that_its_checkpoint_has() {
    losses_during("--resume", |directory| run_of(directory, &["--resume"]));
}

#[test]
fn repairing_loses_nothing_that_a_checkpoint_has() {
    losses_during("repair", repair_of);
}
