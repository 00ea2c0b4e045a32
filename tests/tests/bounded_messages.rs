//! Messages are no longer than anybody reads, however much is wrong and however long the names are, and come in one piece.

use std::fs;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixDatagram;

use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, run_words, scene};
use plateau_tests::run_file::set_text;
use plateau_tests::studies::Study;

/// Bytes of a message in all, and more than the longest of these has.
const LONGEST: usize = 6000;

fn refused(directory: &WorkingDirectory, arguments: &[&str], said: &str) -> Outcome {
    let outcome = directory.plateau(arguments);
    assert!(matches!(outcome.status, Some(1 | 2)), "{arguments:?}: {:.2000}", outcome.stderr);
    assert!(outcome.stderr.contains(said), "{arguments:?}, expected {said:?}: {:.2000}", outcome.stderr);
    assert!(outcome.stderr.len() < LONGEST, "{arguments:?}: {} bytes: {:.500}", outcome.stderr.len(), outcome.stderr);
    outcome
}

#[test]
fn of_many_mistakes_in_a_scene_the_first_are_told() {
    let directory = WorkingDirectory::new();
    let key = |number: usize| format!("{}{number} = 1\n", "k".repeat(400));
    directory.write("many.toml", (0..300).map(key).collect::<String>() + &quick_scene_with(&[]));
    for command in ["check", "run"] {
        let said = refused(&directory, &[command, "many.toml"], " more, at least\n").stderr;
        assert!(said.contains("many.toml:1:1: kkk"), "{said}");
    }
    let short: String = (0..30).map(|number| format!("k{number} = 1\n")).collect();
    directory.write("short.toml", short + &quick_scene_with(&[]));
    let said = refused(&directory, &["check", "short.toml"], "").stderr;
    // Twenty with their lines of the file have room, or nearly.
    assert!(said.matches("unknown key").count() > 10 && said.ends_with(" more\n"), "{said}");
    // A tangle of scenes names some of its files.
    let long = "l".repeat(200);
    for number in 0..50 {
        let base = format!("{long}{}.toml", (number + 1) % 50);
        directory.write(&format!("{long}{number}.toml"), format!("extends = \"{base}\"\n"));
    }
    refused(&directory, &["check", &format!("{long}0.toml")], "in a circle");
    // A key that is there twice, and one that says next to nothing of itself.
    let twice = "t".repeat(100_000);
    directory.write("twice.toml", format!("{twice} = 1\n{twice} = 2\n"));
    refused(&directory, &["check", "twice.toml"], "is there already");
    let choice = format!("plateaus.debris=\"{twice}\"");
    refused(&directory, &["check", &scene("quick.toml"), "--set", &choice], "is unknown, expected");
}

#[test]
fn of_many_mistakes_in_a_study_the_first_are_told() {
    let directory = WorkingDirectory::new();
    let study = |keys: &str| Study::new(&scene("quick.toml"), "full-factorial", keys);
    let with_factor = |study: Study, name: &str| study.factor(name, &format!("nothing.{name}"), "levels = [1, 2]");
    let names = (0..150).map(|number| format!("{}{number} ", "n".repeat(5000)));
    directory.write("study.toml", names.fold(study(""), |study, name| with_factor(study, &name)));
    let said = refused(&directory, &["sweep", "plan", "study.toml"], " more, at least\n").stderr;
    assert!(said.contains("has a blank at an end"), "{said}");
    let long = "w".repeat(100_000);
    for (line, expected) in [
        (format!("{long} = 1\n"), "unknown key `www"),
        (format!("order = \"{long}\"\n"), "expected \"random\""),
        (format!("version = \"{long}\"\n"), "version"),
        (format!("series = [\"{long}\"]\n"), "is not a series"),
    ] {
        directory.write("study.toml", with_factor(study(&line), "f"));
        refused(&directory, &["sweep", "plan", "study.toml"], expected);
    }
}

#[test]
fn the_state_of_a_strangers_run_is_cut_where_it_is_shown() {
    let directory = WorkingDirectory::new();
    directory.plateau(run_words("quick.toml", "run.h5", &["operation.duration=1 s"], &[])).quiet_success();
    set_text(directory.path("run.h5"), "state", &"S".repeat(3_000_000));
    let said = "its state is \"SSSSSS";
    for arguments in [&["summary", "run.h5"][..], &["surface", "run.h5"], &["watch", "run.h5", "--once"]] {
        let outcome = refused(&directory, arguments, said);
        assert!(outcome.stderr.len() < 1000, "{}", outcome.stderr);
    }
    let verified = directory.plateau(["verify", "run.h5"]);
    assert!(verified.stdout.contains(said) && verified.stdout.len() < 1000, "{:.2000}", verified.stdout);
    assert!(fs::metadata(directory.path("run.h5")).unwrap().len() > 3_000_000);
}

#[test]
fn a_message_is_written_in_one_piece() {
    // One call writes one datagram: ranks of a job share the place where their messages go.
    let (ours, theirs) = UnixDatagram::pair().unwrap();
    let directory = WorkingDirectory::new();
    let status = directory.command(["run", "none.toml"]).stderr(OwnedFd::from(theirs)).status().unwrap();
    ours.set_nonblocking(true).unwrap();
    let mut message = [0; LONGEST];
    let length = ours.recv(&mut message).unwrap();
    let message = String::from_utf8_lossy(&message[..length]);
    assert!(message.starts_with("plateau: none.toml") && message.ends_with('\n'), "{message:?}");
    assert_eq!(status.code(), Some(2));
}
