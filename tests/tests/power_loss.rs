//! A loss of power at any moment costs no more than what came after the last checkpoint.

use std::collections::BTreeMap;
use std::process::Command;

use plateau_tests::power_loss::{Files, Journal};
use plateau_tests::program::{WorkingDirectory, run, scene};
use plateau_tests::run_file::{Content, RunFile, differences, differences_of_start};
use plateau_tests::scenes::{Stream, few_or_all};

/// A run of a part of a second with many samples, maps of three moments, and as many checkpoints as can be written.
fn run_of(directory: &WorkingDirectory, more: &[&str]) -> Command {
    let sets = [
        "mesh.rows=8",
        "mesh.disc_columns=160",
        "mesh.pin_columns=16",
        "operation.duration=8 s",
        "numerics.time_acceleration=1",
        "output.sample_every=0.05 s",
        "output.maps_at=[\"0 s\", \"4 s\"]",
        "output.checkpoint_every=0.004 s",
    ];
    let mut command = directory.command(["run", &scene("quick.toml"), "-o", "run.h5"]);
    command.args(sets.iter().flat_map(|set| ["--set", set])).args(more);
    command
}

fn on(files: &Files) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    for (name, bytes) in files {
        directory.write(name, bytes);
    }
    directory
}

#[test]
fn explore() {
    let directory = WorkingDirectory::new();
    let (outcome, journal) = Journal::of(&directory, run_of(&directory, &[]));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    let whole: BTreeMap<String, Content> = RunFile::open(directory.path("run.h5")).content();
    let mut random = Stream(1);
    let mut tally: BTreeMap<String, usize> = BTreeMap::new();
    println!("{} calls", journal.calls());
    for _ in 0..few_or_all(300, 5000) {
        let calls = (random.uniform() * journal.calls() as f64) as usize;
        let files = journal.disk_after(calls, &mut random);
        let names: Vec<&String> = files.keys().collect();
        let directory = on(&files);
        let repaired = on(&files);
        let mut what = String::new();
        if files.contains_key("run.h5") {
            let outcome = repaired.plateau(["repair", "run.h5"]);
            what += &format!(
                "repair {:?} {} ",
                outcome.status,
                outcome
                    .stderr
                    .lines()
                    .last()
                    .unwrap_or_default()
                    .chars()
                    .filter(|c| !c.is_ascii_digit())
                    .collect::<String>()
            );
            if outcome.status == Some(0) {
                let part = RunFile::open(repaired.path("run.h5")).content();
                let differ = differences_of_start(&whole, &part);
                what += &format!("{} ", differ.len());
            }
        }
        let outcome = run(run_of(&directory, &["--resume"]));
        what += &format!(
            "resume {:?} {}",
            outcome.status,
            outcome
                .stderr
                .lines()
                .filter(|l| !l.contains("correlation"))
                .collect::<Vec<_>>()
                .join("|")
                .chars()
                .filter(|c| !c.is_ascii_digit())
                .collect::<String>()
        );
        if outcome.status == Some(0) {
            let differ = differences(&whole, &RunFile::open(directory.path("run.h5")).content());
            what += &format!(" {}", differ.len());
        }
        let _ = names;
        *tally.entry(what).or_default() += 1;
    }
    for (what, count) in tally {
        println!("{count:5} {what}");
    }
}
