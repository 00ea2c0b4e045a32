//! Words that another program answers: found beside the program or on the path, with their arguments as they are.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;

use plateau_tests::program::{Outcome, WorkingDirectory, run};

/// A program that says its name, its arguments and which program calls it.
const ANSWER: &str = "#!/bin/sh\nprintf '%s\\n' \"${0##*/}\" \"$@\" \"${PLATEAU_PROGRAM##*/}\"\nexit 7\n";

/// Calls the program where programs of these words are on the path, which answer so.
fn call_with(words: &[&str], answer: &str, arguments: &[&str]) -> Outcome {
    let directory = WorkingDirectory::new();
    for word in words {
        let name = format!("bin/plateau-{word}");
        directory.write(&name, answer);
        fs::set_permissions(directory.path(&name), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let mut command = directory.command(arguments);
    command.env("PATH", format!("{}:/usr/bin:/bin", directory.path("bin").display()));
    run(command)
}

fn call(words: &[&str], arguments: &[&str]) -> Outcome {
    call_with(words, ANSWER, arguments)
}

#[test]
fn words_of_others_are_answered_by_them() {
    for (arguments, answer) in [
        (&["fit", "study.toml", "--plan"][..], "plateau-fit\nstudy.toml\n--plan\n"),
        (&["fit", "--help"], "plateau-fit\n--help\n"),
        (
            &["-q", "compare", "a.toml", "b c.toml", "--seeds=3"],
            "plateau-compare\na.toml\nb c.toml\n--seeds=3\n--quiet\n",
        ),
        (&["sweep", "effects", "s.toml", "--set", "-1"], "plateau-sweep\neffects\ns.toml\n--set\n-1\n"),
        (&["surface", "convert", "a.al3d", "-o", "a.h5"], "plateau-surface\nconvert\na.al3d\n-o\na.h5\n"),
        (&["own-word", "-x", ""], "plateau-own-word\n-x\n\n"),
    ] {
        let outcome = call(&["fit", "compare", "sweep", "surface", "own-word"], arguments).ends(7, &[]);
        assert_eq!(outcome.stdout, format!("{answer}plateau\n"), "{arguments:?}");
    }
}

#[test]
fn who_asks_back_is_told_and_help_is_the_programs_own() {
    let asks_back = "#!/bin/sh\nexec \"$PLATEAU_PROGRAM\" fit \"$@\"\n";
    call_with(&["fit"], asks_back, &["fit"]).ends(1, &["but asks this program again"]);
    assert!(call(&["help"], &["help"]).quiet_success().contains("Usage: plateau"));
}

#[test]
fn without_who_answers_it_is_said_what_to_install() {
    for line in ["fit study.toml", "plot a.h5", "sweep effects s.toml", "surface convert a.al3d"] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let outcome = call(&[], &arguments).ends(1, &["pip install 'plateau-brake[all]'"]);
        assert_eq!(outcome.stderr.lines().count(), 1, "{outcome:?}");
    }
    // A word that nobody has is told as ever, and no word of the program is taken over.
    call(&["run"], &["rn", "scene.toml"]).ends(2, &["did you mean"]);
    call(&["run", "check"], &["check", "no.toml"]).ends(2, &["no.toml"]);
}
