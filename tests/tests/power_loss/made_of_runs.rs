//! What is made of runs when the power is lost: a study makes the runs that it lost again, a file is whole or as it was before.

use std::fs;

use plateau_tests::power_loss::{Files, Journal};
use plateau_tests::program::{SMALL_MESH, WorkingDirectory, run_words, scene};
use plateau_tests::studies::Study;

use super::{below, losses, lot, on, run_after};

const EARLIER: &[u8] = b"what was there before";

/// A study of twelve short runs.
fn study() -> Study {
    let set = [&SMALL_MESH[..], &["operation.duration='0.5 s'"]].concat();
    Study::new(&scene("quick.toml"), "full-factorial", &format!("set = {set:?}"))
        .table("[replicates]\nkeys = [\"pin.base.synthetic.seed\"]\nseeds = [1, 2, 3, 4]")
        .load("levels = [\"5 N\", \"7 N\", \"10 N\"]")
        .response("area", "/series/contact_area", "at = \"end\"")
}

/// The table of results, which is collected anew.
fn results(directory: &WorkingDirectory) -> String {
    run_after(1, directory.command(["sweep", "collect", "study.toml", "--force"])).ends(0, &[]);
    directory.text("results/results.csv")
}

#[test]
fn a_study_makes_what_it_lost_again() {
    let directory = WorkingDirectory::with("study.toml", study());
    let sweep = |directory: &WorkingDirectory| directory.command(["sweep", "run", "study.toml", "--jobs", "2"]);
    let (outcome, journal) = Journal::of(&directory, sweep(&directory));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    let whole = results(&directory);
    let (mut random, all) = (lot(), journal.calls());
    let mut again = 0;
    for _ in 0..losses(10) {
        let calls = below(&mut random, all + 1);
        let directory = on(&journal.disk_after(calls, &mut random));
        let outcome = run_after(1, sweep(&directory));
        let what = format!("after call {calls} of {all}: {outcome:?}");
        assert_eq!(outcome.status, Some(0), "{what}");
        again += usize::from(!outcome.stdout.contains("finished before    12"));
        assert_eq!(results(&directory), whole, "{what}");
    }
    assert!(again > 0, "no loss met a run");
}

#[test]
fn files_made_of_a_run_are_whole_or_as_before() {
    let start = WorkingDirectory::new();
    let short = [&SMALL_MESH[..], &["operation.duration=0.5 s"]].concat();
    start.plateau(run_words("quick.toml", "run.h5", &short, &[])).ends(0, &[]);
    let run_file = fs::read(start.path("run.h5")).unwrap();
    let heights = ["surface", "run.h5", "--dataset", "disc/height", "--at", "0 s", "--force", "--to"];
    let mut random = lot();
    for made in ["heights.npy", "heights.h5"] {
        let directory =
            on(&Files::from([("run.h5".to_owned(), run_file.clone()), (made.to_owned(), EARLIER.to_vec())]));
        let (outcome, journal) = Journal::of(&directory, directory.command(heights.iter().chain([&made])));
        assert_eq!(outcome.status, Some(0), "{outcome:?}");
        let whole = fs::read(directory.path(made)).unwrap();
        for _ in 0..losses(20) {
            let calls = below(&mut random, journal.calls() + 1);
            let files = journal.disk_after(calls, &mut random);
            let is_right = files[made] == whole || files[made] == EARLIER;
            assert!(is_right, "{made} has {} bytes after call {calls} of {}", files[made].len(), journal.calls());
            assert!(files["run.h5"] == run_file, "what it reads has changed");
        }
    }
}
