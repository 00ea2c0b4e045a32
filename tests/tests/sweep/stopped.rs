//! Studies that are stopped or killed, and gone on with.

use std::collections::BTreeSet;
use std::fs;
use std::thread;
use std::time::Duration;

use plateau_tests::program::{WorkingDirectory, ended, kill, scene, send, start, wait_until};
use plateau_tests::scenes::Stream;
use plateau_tests::scenes::few_or_all;
use plateau_tests::studies::Study;

use super::{directory, records, results, study, sweep};

/// The study with four runs of which each takes some tenths of a second and keeps its state on the way.
fn long() -> String {
    study()
        .replace("'3 s'\"", "'40 s'\", \"numerics.time_acceleration = 1\", \"output.checkpoint_every = '0.05 s'\"")
        .replace("\"10 N\", \"20 N\"", "\"10 N\"")
        .replace("levels = [0.2, 0.3, 0.4]", "levels = [0.2, 0.3]")
        .replace("seeds = [7, 8, 9]", "seeds = [7]")
}

#[test]
fn a_sweep_killed_again_and_again_ends_like_an_undisturbed_one() {
    let (kills, seeds) = few_or_all((12, 10), (500, 60));
    let (undisturbed, killed) = (directory(), directory());
    let seeds: Vec<String> = (1..=seeds).map(|seed: u32| seed.to_string()).collect();
    let runs = 9 * seeds.len();
    let study = study().replace("7, 8, 9", &seeds.join(", "));
    for directory in [&undisturbed, &killed] {
        directory.write("study.toml", &study);
    }
    sweep(&undisturbed, &["--jobs", "2"]);
    let expected = results(&undisturbed);
    let mut random = Stream(1);
    let (mut before, mut met) = (0, 0);
    for _ in 0..kills {
        let child = start(killed.command(["sweep", "run", "study.toml", "--jobs", "2"]));
        // At some moment after its first results, for as long as there are any.
        wait_until(|| before == runs || records(&killed).len() > before);
        thread::sleep(Duration::from_secs_f64(0.02 * random.uniform()));
        kill(child);
        let records = records(&killed);
        let different: BTreeSet<_> = records.iter().collect();
        assert_eq!(records.len(), different.len(), "a run was made twice");
        assert!(different.len() >= before, "a result was lost");
        met += u32::from(different.len() < runs);
        before = different.len();
    }
    assert!(met > kills / 5, "only {met} of the kills met a sweep at work");
    let last = sweep(&killed, &[]);
    assert_eq!(last["finished_before"].as_u64(), Some(before as u64));
    assert_eq!(results(&killed), expected);
}

#[test]
fn an_interrupted_sweep_says_what_is_left() {
    let directory = directory();
    let long = study().replace("duration = '3 s'", "duration = '300 s'");
    directory.write("study.toml", long);
    let child = start(directory.command(["sweep", "run", "study.toml", "--jobs", "2"]));
    thread::sleep(Duration::from_millis(400));
    send("INT", child.id());
    ended(child).ends(130, &["are left, the same command goes on"]);
}

#[test]
fn what_was_kept_of_a_run_that_has_ended_goes() {
    let directory = directory();
    directory.write("study.toml", long());
    let child = start(directory.command(["sweep", "run", "study.toml", "--jobs", "1"]));
    let folder = directory.path("results/under-way");
    let state = || fs::read_dir(&folder).ok()?.flatten().find(|entry| entry.file_name().len() == 64);
    assert!(wait_until(|| state().is_some()));
    kill(child);
    let state = state().unwrap();
    let (name, content) = (state.file_name().into_string().unwrap(), fs::read(state.path()).unwrap());
    sweep(&directory, &["--jobs", "1"]);
    assert!(!folder.exists());
    // As a process leaves it that is killed between keeping the result and forgetting the state.
    directory.write(&format!("results/under-way/{name}"), &content);
    let stranger = directory.write(&format!("results/under-way/{}", "0".repeat(64)), &content);
    let notes = directory.write("results/under-way/notes", "mine");
    directory.plateau(["sweep", "run", "study.toml"]).ends(0, &["1 state of runs that the study no longer has"]);
    assert!(!folder.join(&name).exists() && stranger.exists() && notes.exists());
    fs::remove_file(stranger).unwrap();
    fs::remove_file(notes).unwrap();
    sweep(&directory, &[]);
    assert!(!folder.exists());
}

#[test]
fn a_long_run_that_was_stopped_or_killed_goes_on() {
    let [whole, directory] = [(), ()].map(|()| WorkingDirectory::with("study.toml", long()));
    let words = ["sweep", "run", "study.toml", "--jobs", "2"];
    whole.plateau(words).ends(0, &[]);
    stop_and_kill(&directory, &words, |_| ());
    directory.plateau(words).ends(0, &["a run that was stopped goes on from step "]);
    assert_eq!(results(&directory), results(&whole));
    assert!(!directory.path("results/under-way").exists(), "what was kept is of no more use");
}

/// Starts a sweep, stops it when a run is under way, and kills it when it has been started again; what is there is looked at each time.
pub(super) fn stop_and_kill(directory: &WorkingDirectory, words: &[&str], look: impl Fn(&str)) {
    let is_state = |entry: &fs::DirEntry| entry.file_name().len() == 64;
    let folder = directory.path("results/under-way");
    let states = || fs::read_dir(&folder).map_or(0, |entries| entries.flatten().filter(is_state).count());
    for signal in ["TERM", "KILL"] {
        let mut child = start(directory.command(words));
        thread::sleep(Duration::from_millis(100));
        assert!(wait_until(|| states() > 0), "no run is under way");
        send(signal, child.id());
        child.wait().unwrap();
        assert!(states() > 0, "nothing was kept after {signal}");
        look(signal);
    }
}

#[test]
fn a_signal_ends_runs_that_are_prepared_while_others_keep_their_state() {
    // The second run has fibres that are so long that nearly all of them miss the pin: its preparation takes many seconds.
    let set = "'operation.duration = \"10 h\"', 'numerics.time_acceleration = 1', 'pin.base.synthetic.fibre_width = \"1e-7 m\"'";
    let keys = format!("set = [{set}]\norder = \"standard\"");
    let study = Study::new(&scene("quick.toml"), "full-factorial", &keys)
        .factor("length", "pin.base.synthetic.fibre_length", "levels = [\"400 um\", \"4 m\"]")
        .response("contact area", "/series/contact_area_mean", "at = \"end\"");
    let directory = WorkingDirectory::with("study.toml", study);
    for (jobs, kept) in [("2", 1), ("1", 0)] {
        // With one job, of the second run alone.
        let task = if kept == 0 { &["--task", "2/2"][..] } else { &[] };
        let mut child = start(directory.command(["sweep", "run", "study.toml", "--jobs", jobs].iter().chain(task)));
        thread::sleep(Duration::from_millis(700));
        assert!(child.try_wait().unwrap().is_none(), "both runs take long");
        send("TERM", child.id());
        if !wait_until(|| child.try_wait().unwrap().is_some()) {
            kill(child);
            panic!("the preparation does not hear the signal");
        }
        let outcome = ended(child).ends(143, &[]);
        // No lock is left either.
        let states = fs::read_dir(directory.path("results/under-way")).map_or(0, Iterator::count);
        assert_eq!(states, kept, "{outcome:?}");
        let _ = fs::remove_dir_all(directory.path("results"));
    }
}
