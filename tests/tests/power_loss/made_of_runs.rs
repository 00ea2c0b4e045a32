//! What is made of runs when the power is lost: a study makes the runs that it lost again, a file is whole or as it was before.

use std::fs;

use plateau_tests::power_loss::{Files, Journal};
use plateau_tests::program::{WorkingDirectory, run, scene};

use super::{below, losses, lot, on, run_after};

const EARLIER: &[u8] = b"what was there before";

/// A study of twelve short runs.
fn study() -> String {
    format!(
        "version = 1\nbase = \"{}\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n\
         set = [\"mesh.rows = 8\", \"mesh.disc_columns = 160\", \"mesh.pin_columns = 16\", \"operation.duration = '0.5 s'\"]\n\
         [replicates]\nkeys = [\"pin.base.synthetic.seed\"]\nseeds = [1, 2, 3, 4]\n\
         [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nlevels = [\"5 N\", \"7 N\", \"10 N\"]\n\
         [[response]]\nname = \"area\"\ndataset = \"/series/contact_area\"\nat = \"end\"\n",
        scene("quick.toml")
    )
}

/// The table of results, which is collected anew.
fn results(directory: &WorkingDirectory) -> String {
    run_after(1, directory.command(["sweep", "collect", "study.toml", "--force"])).ends(0, &[]);
    fs::read_to_string(directory.path("results/results.csv")).unwrap()
}

#[test]
fn a_study_makes_what_it_lost_again() {
    let directory = WorkingDirectory::new();
    directory.write("study.toml", study());
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
    let sets = ["mesh.rows=8", "mesh.disc_columns=160", "mesh.pin_columns=16", "operation.duration=0.5 s"];
    let mut command = start.command(["run", &scene("quick.toml"), "-o", "run.h5"]);
    command.args(sets.iter().flat_map(|set| ["--set", set]));
    assert_eq!(run(command).status, Some(0));
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
