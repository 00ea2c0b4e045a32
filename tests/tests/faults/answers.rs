//! What is made of runs: a study, its results and a surface are each there as a whole, or as they were before.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use plateau_tests::fault::{count, strike};
use plateau_tests::program::{SMALL_MESH, WorkingDirectory, repository, run_words, scene};
use plateau_tests::run_file::{Content, RunFile, differences};
use plateau_tests::studies::Study;

use super::{few_or_all, strikes};

/// A command, and the file or folder that it makes.
pub(super) struct Case {
    pub(super) arguments: &'static [&'static str],
    makes: &'static str,
    /// Whether a file of that name stands there before.
    replaces: bool,
}

pub(super) const CASES: [Case; 3] = [
    Case { arguments: &["sweep", "run", "study.toml"], makes: "results", replaces: false },
    Case { arguments: &["sweep", "collect", "swept.toml", "--force"], makes: "swept", replaces: false },
    Case { arguments: &["surface", "patch.sdf", "--to", "patch.h5", "--force"], makes: "patch.h5", replaces: true },
];

const EARLIER: &[u8] = b"what was there before";

const DURATION: &str = "operation.duration='0.5 s'";

/// A directory with all that the commands read.
pub(super) fn prepared() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let small = [&SMALL_MESH[..], &[DURATION]].concat();
    let study = Study::new(&scene("quick.toml"), "full-factorial", &format!("title = \"Faults\"\nset = {small:?}"))
        .load("levels = [\"5 N\", \"7 N\", \"10 N\"]")
        .response("area", "/series/contact_area", "at = \"end\"")
        .text();
    directory.write("swept.toml", study.replace("\"results\"", "\"swept\""));
    directory.write("study.toml", study);
    directory.plateau(run_words("quick.toml", "run.h5", &small, &[])).ends(0, &[]);
    directory.plateau(["sweep", "run", "swept.toml"]).ends(0, &[]);
    directory.write("patch.sdf", fs::read(repository().join("data/surfaces/afm_256x256.sdf")).unwrap());
    for case in CASES.iter().filter(|case| case.replaces) {
        directory.write(case.makes, EARLIER);
    }
    directory
}

pub(super) type Files = BTreeMap<PathBuf, Option<Vec<u8>>>;

/// The files of a directory with their content, by their paths in it.
pub(super) fn files(directory: &WorkingDirectory) -> Files {
    let content = directory.content().into_iter().filter(|(path, _)| path.is_file());
    content.map(|(path, bytes)| (path.strip_prefix(directory.path("")).unwrap().to_owned(), bytes)).collect()
}

/// Whether a file is of the kind that has another name or other moments in it each time, or is gone in the end.
fn is_of_the_moment(path: &Path) -> bool {
    let has_part = |name: &str| path.iter().any(|part| part == name);
    let has_ending = |ending: &str| path.extension().is_some_and(|found| found == ending);
    has_part("journal") || has_part("under-way") || has_ending("lock") || has_ending("tmp")
}

/// Checks that what a case makes is the same in two directories; `all` says that nothing may be missing.
pub(super) fn compare(case: &Case, made: &WorkingDirectory, whole: &WorkingDirectory, all: bool, what: &str) {
    let of = |directory| {
        let mut files = files(directory);
        files.retain(|path, _| path.starts_with(case.makes) && !is_of_the_moment(path));
        files
    };
    let (made_files, whole_files) = (of(made), of(whole));
    if all {
        assert!(made_files.keys().eq(whole_files.keys()), "{what}: {:?}", made_files.keys());
    }
    for (path, bytes) in made_files.iter().filter(|(_, bytes)| all || bytes.as_deref() != Some(EARLIER)) {
        if path.extension().is_some_and(|ending| ending == "h5") {
            let [one, other] = [made, whole].map(|directory| hdf5_content(&directory.path(&path.to_string_lossy())));
            assert_eq!(one.0, other.0, "{what}: {}", path.display());
            assert_eq!(differences(&one.1, &other.1), [""; 0], "{what}: {}", path.display());
        } else if path.ends_with("files.txt") && !all {
            // It names the files before they are there, so that no other is ever taken for one of them.
        } else {
            assert!(whole_files.get(path) == Some(bytes), "{what}: {} is another", path.display());
        }
    }
}

/// The attributes of a file, but the moment at which results were collected, and its datasets.
fn hdf5_content(file: &Path) -> (BTreeMap<String, String>, BTreeMap<String, Content>) {
    let file = RunFile::open(file);
    let mut attributes = file.attributes();
    attributes.remove("collected");
    (attributes, file.content())
}

pub(super) fn copied(files: &Files) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    for (path, bytes) in files {
        directory.write(&path.to_string_lossy(), bytes.as_deref().unwrap());
    }
    directory
}

#[test]
fn what_is_made_of_runs_is_whole_or_as_before() {
    let before = files(&prepared());
    for case in &CASES {
        let command = |directory: &WorkingDirectory| directory.command(case.arguments);
        let whole = copied(&before);
        let calls = count(command(&whole));
        println!("{calls} calls of {}", case.arguments.join(" "));
        for (fault, call) in strikes(calls, few_or_all(29, 5)) {
            let directory = copied(&before);
            let outcome = strike(command(&directory), fault, call);
            let what = format!("{fault:?} at call {call} of {calls} of {:?}: {outcome:?}", case.arguments);
            let after = files(&directory);
            let mut read = before.iter().filter(|(path, _)| !path.starts_with(case.makes));
            assert!(read.all(|(path, bytes)| after.get(path) == Some(bytes)), "{what}: what it reads has changed");
            compare(case, &directory, &whole, outcome.status == Some(0), &what);
            let again = directory.plateau(case.arguments);
            assert_eq!(again.status, Some(0), "again after {what}: {again:?}");
            compare(case, &directory, &whole, true, &format!("again after {what}"));
            // Whose temporary file a killed process left nobody can tell who does not hold a lock: it may be another machine's.
            let is_left = |path: &&PathBuf| path.extension().is_some_and(|ending| ending == "tmp");
            let is_killed = outcome.status.is_none();
            assert!(
                is_killed || !files(&directory).keys().any(|path| is_left(&path)),
                "{what}: temporary files are left"
            );
        }
    }
}
