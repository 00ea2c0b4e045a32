//! Several processes that make the runs of one study in one folder, without knowing of each other.

use std::collections::BTreeSet;
use std::process::Child;

use plateau_tests::program::{WorkingDirectory, ended, kill, start, wait_until};
use serde_json::Value;

use super::{RUNS, records, results, study, sweep};

/// The study with runs that are long enough to meet.
fn longer() -> WorkingDirectory {
    WorkingDirectory::with("study.toml", study().replace("'3 s'", "'24 s'"))
}

fn begin(directory: &WorkingDirectory) -> Child {
    start(directory.command(["sweep", "run", "study.toml", "--jobs", "1", "--json"]))
}

fn end(child: Child) -> Value {
    ended(child).ends(0, &[]).json()
}

#[test]
fn two_sweeps_of_one_folder_share_its_runs() {
    let (whole, shared) = (longer(), longer());
    sweep(&whole, &["--jobs", "2"]);
    let summaries = [begin(&shared), begin(&shared)].map(end);
    let of = |key: &str| summaries.each_ref().map(|summary| summary[key].as_u64().unwrap());
    assert_eq!(of("finished").iter().sum::<u64>(), RUNS as u64, "{summaries:?}");
    assert!(of("finished").iter().all(|finished| *finished > 0), "{summaries:?}");
    // Each has waited for what the other was making.
    for place in 0..2 {
        let seen = [of("finished"), of("finished_elsewhere"), of("finished_before")].map(|counts| counts[place]);
        assert_eq!((seen.iter().sum::<u64>(), of("left")[place]), (RUNS as u64, 0), "{summaries:?}");
    }
    assert_eq!(records(&shared).len(), RUNS, "a run was made twice");
    assert_eq!(results(&shared), results(&whole));
    assert!(!shared.path("results/under-way").exists());
}

#[test]
fn what_a_killed_sweep_leaves_the_other_one_makes() {
    let (whole, shared) = (longer(), longer());
    sweep(&whole, &["--jobs", "2"]);
    let (killed, left) = (begin(&shared), begin(&shared));
    assert!(wait_until(|| records(&shared).len() > 1));
    kill(killed);
    end(left);
    let made = records(&shared);
    assert_eq!((made.len(), made.into_iter().collect::<BTreeSet<_>>().len()), (RUNS, RUNS));
    assert_eq!(results(&shared), results(&whole));
    // The next one clears away what is left.
    sweep(&shared, &[]);
    assert!(!shared.path("results/under-way").exists());
}
