//! What one who types commands all day expects: hints, marks, quiet and talkative runs.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::process::CommandExt;

use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, run};

fn with_scene(edits: &[(&str, &str)]) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write("scene.toml", quick_scene_with(edits));
    directory
}

/// What a command that was refused for its input says.
fn refused(outcome: Outcome) -> String {
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(2), ""), "{}", outcome.stderr);
    outcome.stderr
}

#[test]
fn a_mistyped_command_gets_the_one_that_was_meant() {
    let directory = WorkingDirectory::new();
    for (typed, meant) in [("rnu", "run"), ("chekc", "check"), ("swep", "sweep")] {
        let message = refused(directory.plateau([typed]));
        assert!(message.contains(&format!("did you mean plateau {meant}?")), "{message}");
    }
    let message = refused(directory.plateau(["simulate"]));
    assert!(!message.contains("did you mean"), "{message}");
    let message = refused(directory.plateau(["sweep", "rnu", "study.toml"]));
    assert!(message.contains("did you mean plateau sweep run?"), "{message}");
    let message = refused(directory.plateau(["version"]));
    assert!(message.contains("the version: plateau --version") && !message.contains("verify"), "{message}");
}

#[test]
fn a_program_whose_path_is_no_utf_8_says_what_was_meant_too() {
    let directory = WorkingDirectory::new();
    let mut command = directory.command(["rnu"]);
    command.arg0(OsStr::from_bytes(b"/odd\xff/plateau"));
    let message = refused(run(command));
    assert!(message.contains("did you mean") && message.contains("run?"), "{message}");
}

#[test]
fn what_is_named_in_the_place_of_something_else_is_told_by_what_it_is() {
    let directory = with_scene(&[]);
    let message = refused(directory.plateau(["verify", "scene.toml"]));
    assert!(message.contains("which `plateau run scene.toml` writes"), "{message}");
    let message = refused(directory.plateau(["surface", "scene.toml", "--pitch", "0,02 mm"]));
    assert!(message.contains("decimals have a point: \"0.02 mm\""), "{message}");
    // A word that is none decides nothing over other keys.
    let message = refused(directory.plateau(["check", "scene.toml", "--set", "plateaus.debris=globl"]));
    assert!(message.contains("\"globl\" is unknown") && !message.contains("captured_fraction"), "{message}");
}

#[test]
fn what_is_wrong_is_shown_with_its_line() {
    let directory = with_scene(&[("rows = 20", "rows = \"20\"")]);
    let message = refused(directory.plateau(["check", "scene.toml"]));
    let text = fs::read_to_string(directory.path("scene.toml")).unwrap();
    let (number, line) = text.lines().enumerate().find(|(_, line)| line.contains("rows = \"20\"")).unwrap();
    let (number, column) = (number + 1, line.find("\"20\"").unwrap());
    assert!(message.contains("\"20\" is a string (write 20 without quotes)"), "{message}");
    let blank = " ".repeat(number.to_string().len());
    let shown = format!("  {number} | {}\n  {blank} | {}^", line.trim_end(), " ".repeat(column));
    assert!(message.contains(&shown), "{message}");
    assert!(!message.contains('\u{1b}'), "colours for no terminal: {message:?}");
}

#[test]
fn keys_that_are_there_twice_are_named() {
    let directory = with_scene(&[("rows = 20", "rows = 20\nrows = 41")]);
    let message = refused(directory.plateau(["check", "scene.toml"]));
    assert!(message.contains("rows is there already in this table"), "{message}");
    assert!(message.contains("| rows = 41\n"), "{message}");
}

#[test]
fn a_quiet_run_says_nothing_and_a_talkative_one_what_was_done_to_surfaces() {
    let directory = with_scene(&[("duration = \"60 s\"", "steps = 20")]);
    let quiet = directory.plateau(["run", "scene.toml", "-q", "--set", "operation.normal_force=1 MN"]);
    assert_eq!((quiet.status, quiet.stdout.as_str(), quiet.stderr.as_str()), (Some(0), "", ""));
    let plain = directory.plateau(["run", "scene.toml", "--force", "--set", "operation.normal_force=1 MN"]);
    assert!(plain.stderr.contains("plateau: warning: "), "{}", plain.stderr);
    let verbose = directory.plateau(["run", "scene.toml", "--force", "-v"]);
    assert!(!plain.stderr.contains("disc.surface: synthetic"), "{}", plain.stderr);
    assert!(verbose.stderr.contains("plateau: disc.surface: synthetic, seed"), "{}", verbose.stderr);
    assert!(refused(directory.plateau(["run", "scene.toml", "-q", "-v"])).contains("cannot be used with"));
    // Errors are said in any case.
    assert!(refused(directory.plateau(["run", "nothing.toml", "-q"])).contains("nothing.toml"));
}
