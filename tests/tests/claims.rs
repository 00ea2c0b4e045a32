//! One process at a time writes a run file, however many are told to.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use plateau_tests::program::{SMALL_MESH, WorkingDirectory, kill, run, run_words, send, wait_until};
use plateau_tests::run_file::{Content, RunFile, differences};
use plateau_tests::scenes::Stream;
use plateau_tests::scenes::few_or_all;

/// A run of about a second with many samples and checkpoints.
fn racer(directory: &WorkingDirectory, file: &str, more: &str) -> Command {
    let settings = [
        "disc.surface.synthetic.correlation_length=2 mm",
        "pin.surface.synthetic.correlation_length=2 mm",
        "operation.duration=60 s",
        "numerics.time_acceleration=1",
        "output.sample_every=0.05 s",
        "output.maps_at=[\"0 s\", \"20 s\"]",
        "output.checkpoint_every=0.004 s",
    ];
    directory.command(run_words("quick.toml", file, &[&SMALL_MESH[..], &settings].concat(), &[more]))
}

/// Starts a command whose standard error goes to a file.
fn begin(directory: &WorkingDirectory, mut command: Command, said: &str) -> Child {
    let said = fs::File::create(directory.path(said)).unwrap();
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(said).spawn().unwrap()
}

/// Whether a process has the run file open for writing, or one that is to become it.
fn writes(process: u32, folder: &Path) -> bool {
    let Ok(files) = fs::read_dir(format!("/proc/{process}/fd")) else { return false };
    let start = folder.join("run.h5").display().to_string();
    let hidden = folder.join(".run.h5.plateau-").display().to_string();
    files.flatten().any(|file| {
        let path = fs::read_link(file.path()).unwrap_or_default().display().to_string();
        // A handle's own permissions say how it was opened.
        let writing = || fs::symlink_metadata(file.path()).is_ok_and(|link| link.permissions().mode() & 0o200 != 0);
        (path == start || path.starts_with(&hidden)) && writing()
    })
}

/// Lets processes race as often as `PLATEAU_RACES` says, if it does.
#[test]
fn of_processes_that_go_on_at_once_one_writes_and_the_others_say_so() {
    let races = std::env::var("PLATEAU_RACES").map_or(few_or_all(4, 500), |races| races.parse().unwrap());
    let whole = {
        let directory = WorkingDirectory::new();
        run(racer(&directory, "run.h5", "--resume")).ends(0, &[]);
        directory.run_file("run.h5").content()
    };
    let (mut random, mut refused) = (Stream(17), 0);
    for race in 0..races {
        refused += let_race(&whole, race, &mut random);
    }
    println!("{races} races, {refused} processes refused");
    assert!(refused > 0, "none of {races} races was one");
}

/// One race; how many were refused.
fn let_race(whole: &BTreeMap<String, Content>, race: usize, random: &mut Stream) -> usize {
    let directory = WorkingDirectory::new();
    // Most find what a killed process left, with its lock; the others nothing.
    if !race.is_multiple_of(4) {
        let child = begin(&directory, racer(&directory, "run.h5", "--resume"), "killed");
        assert!(wait_until(|| directory.path("run.h5.checkpoint").exists()));
        thread::sleep(Duration::from_secs_f64(0.05 * random.uniform()));
        kill(child);
    }
    let ways = ["--resume", "--force"];
    let mut racers: Vec<_> = (0..2 + race % 2)
        .map(|number| {
            let way = ways[((2.0 * random.uniform()) as usize).min(1)];
            let child = begin(&directory, racer(&directory, "run.h5", way), &number.to_string());
            thread::sleep(Duration::from_secs_f64(0.004 * random.uniform()));
            child
        })
        .collect();
    let folder = directory.path("").canonicalize().unwrap();
    let numbers: Vec<u32> = racers.iter().map(Child::id).collect();
    while racers.iter_mut().any(|child| child.try_wait().unwrap().is_none()) {
        for (place, one) in numbers.iter().enumerate() {
            for other in &numbers[..place] {
                // Who writes before the other does and after it writes at the same time.
                let [one, other] = [one, other].map(|process| || writes(*process, &folder));
                assert!(!(one() && other() && one()), "race {race}: two processes write");
            }
        }
    }
    let mut refused = 0;
    for (number, child) in racers.iter_mut().enumerate() {
        let status = child.wait().unwrap().code();
        let said = fs::read_to_string(directory.path(&number.to_string())).unwrap();
        match status {
            // One that comes when all is done finds that, or with --force begins again.
            Some(0) => {}
            Some(2) => {
                let errors: Vec<_> = said.lines().filter(|line| !line.starts_with("plateau: warning:")).collect();
                let names = |other: &u32| errors[0].contains(&format!("is being written by process {other},"));
                assert!(errors.len() == 1 && numbers.iter().any(names), "race {race}: {said}");
                refused += 1;
            }
            _ => panic!("race {race}: {status:?}: {said}"),
        }
    }
    assert!(refused < numbers.len(), "race {race}: all were refused");
    assert_eq!(differences(whole, &directory.run_file("run.h5").content()), [""; 0], "race {race}");
    directory.plateau(["verify", "run.h5"]).quiet_success();
    let left = |name: &String| name.ends_with(".tmp") || name.contains(".lock");
    assert_eq!(directory.names().into_iter().find(left), None, "race {race}");
    refused
}

#[test]
fn a_lock_goes_with_its_run_however_that_ends() {
    let directory = WorkingDirectory::new();
    let endless = |more: &str| {
        let mut command = racer(&directory, "run.h5", more);
        command.args(["--set", "operation.duration=100 h"]);
        command
    };
    // A run writes when its file has taken the place of the one before, and it has kept a state of its own.
    let is_running = || RunFile::follow(directory.path("run.h5")).is_ok_and(|run| run.text("state") == "running");
    let state = || fs::metadata(directory.path("run.h5.checkpoint")).and_then(|file| file.modified()).ok();
    for (signal, status) in [("INT", 130), ("TERM", 143)] {
        let before = state();
        let mut child = begin(&directory, endless("--resume"), "said");
        assert!(wait_until(|| is_running() && state() != before && directory.path("run.h5.lock").exists()));
        // Also who only wants to close the file, or to begin anew, is refused, and changes nothing.
        let lock = fs::read(directory.path("run.h5.lock")).unwrap();
        directory.plateau(["repair", "run.h5"]).ends(2, &["is being written by process"]);
        assert_eq!(fs::read(directory.path("run.h5.lock")).unwrap(), lock);
        send(signal, child.id());
        assert_eq!(child.wait().unwrap().code(), Some(status));
        assert!(!directory.path("run.h5.lock").exists(), "after {signal}");
    }
    let before = state();
    let child = begin(&directory, endless("--resume"), "said");
    assert!(wait_until(|| is_running() && state() != before && directory.path("run.h5.lock").exists()));
    kill(child);
    assert!(directory.path("run.h5.lock").exists(), "a killed process leaves its lock");
    directory.plateau(["repair", "run.h5"]).quiet_success();
    assert!(!directory.path("run.h5.lock").exists());
}

#[test]
fn a_lock_of_another_machine_is_left_to_the_user() {
    let directory = WorkingDirectory::new();
    let mut child = begin(&directory, racer(&directory, "run.h5", "--resume"), "said");
    assert!(wait_until(|| directory.path("run.h5.lock").exists()));
    let lock = directory.text("run.h5.lock");
    child.wait().unwrap();
    let mut lock: serde_json::Value = serde_json::from_str(&lock).unwrap();
    lock["writer"]["machine"]["host"] = "node17".into();
    directory.write("run.h5.lock", format!("{lock}\n"));
    let before = directory.content();
    for more in ["--resume", "--force"] {
        run(racer(&directory, "run.h5", more)).ends(2, &["of the machine node17", "remove run.h5.lock"]);
    }
    assert!(directory.content() == before);
    fs::remove_file(directory.path("run.h5.lock")).unwrap();
    run(racer(&directory, "run.h5", "--force")).ends(0, &[]);
}

/// Only the superuser can be another user: elsewhere this tests nothing.
#[test]
fn what_another_user_may_be_writing_is_not_repaired() {
    const NOBODY: u32 = 65_534;
    let directory = WorkingDirectory::new();
    fs::set_permissions(directory.path(""), fs::Permissions::from_mode(0o777)).unwrap();
    let child = begin(&directory, racer(&directory, "run.h5", "--resume"), "said");
    assert!(wait_until(|| directory.path("run.h5.checkpoint").exists()));
    kill(child);
    let lock = fs::read(directory.path("run.h5.lock")).unwrap();
    if fs::metadata(directory.path("run.h5")).unwrap().uid() != 0 {
        println!("not tried: this is not a superuser");
        return;
    }
    let as_nobody = |arguments: &[&str]| {
        let mut command = directory.command(arguments);
        command.uid(NOBODY).gid(NOBODY);
        run(command)
    };
    if as_nobody(&["--version"]).status != Some(0) {
        println!("not tried: another user cannot start the program");
        return;
    }
    // Without the lock nobody knows whether a process of the file's owner still has it open.
    fs::remove_file(directory.path("run.h5.lock")).unwrap();
    let before = directory.content();
    as_nobody(&["repair", "run.h5"]).ends(2, &["belongs to another user"]);
    assert!(directory.content() == before);
    // With it everybody knows that its process has ended.
    directory.write("run.h5.lock", lock);
    as_nobody(&["repair", "run.h5"]).quiet_success();
}
