//! The example in the help of every command works as it stands.

use std::os::unix::fs::symlink;

use plateau_tests::program::{WorkingDirectory, own_commands, path, program, repository, run};

/// The lines of a help text below "Example:" or "Examples:".
fn examples(help: &str) -> Vec<&str> {
    let mut lines = help.lines().skip_while(|line| !line.starts_with("Example"));
    lines.next();
    lines.map_while(|line| line.strip_prefix("  ")).collect()
}

/// Runs an example as a shell does, in a directory that looks like the repository to it.
fn runs(directory: &WorkingDirectory, example: &str) {
    let arguments = example.strip_prefix("plateau ").unwrap_or_else(|| panic!("{example:?} does not run plateau"));
    let mut shell = std::process::Command::new("sh");
    shell.current_dir(directory.path(".")).env("PATH", path());
    shell.args(["-c", &format!("\"$0\" {arguments}")]).arg(program());
    let outcome = run(shell);
    assert_eq!((outcome.status, outcome.stderr.as_str()), (Some(0), ""), "{example}");
    assert!(!outcome.stdout.trim().is_empty(), "{example} says nothing");
}

#[test]
fn the_example_of_every_command_works() {
    let commands = own_commands();
    assert!(commands.iter().any(|name| name == "run") && commands.iter().any(|name| name == "check"), "{commands:?}");
    for command in commands {
        let help = WorkingDirectory::new().plateau([&command, "--help"]).quiet_success();
        let examples = examples(&help);
        assert!(!examples.is_empty(), "no example in {command} --help: {help}");
        // One after the other, as they are read: the first may make what the next one needs.
        let directory = WorkingDirectory::new();
        symlink(repository().join("data"), directory.path("data")).unwrap();
        for example in examples {
            runs(&directory, example);
            if command == "run" {
                let written = directory.names().into_iter().find(|name| name != "data").expect("a run file");
                assert!(example.contains(&written), "{example} wrote {written}");
                assert_eq!(directory.run_file(&written).text("state"), "finished");
            }
        }
    }
}

#[test]
fn help_and_version_go_to_standard_output() {
    let directory = WorkingDirectory::new();
    assert!(directory.plateau(["--help"]).quiet_success().contains("Usage: plateau"));
    // The revision tells builds apart; of a copy without a history none is known.
    let version = directory.plateau(["--version"]).quiet_success();
    let revision = version.strip_prefix("plateau ").and_then(|rest| rest.split_once(" (revision "));
    let revision = revision.and_then(|(_, rest)| rest.strip_suffix(")\n")).unwrap_or_else(|| panic!("{version}"));
    let hash = revision.strip_suffix("-modified").unwrap_or(revision);
    let is_hash = hash.len() == 40 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
    assert!(is_hash || revision == "unknown", "{version}");
    // Without a command there is nothing to do, which is an error, but one for which help is the answer.
    assert_eq!(directory.plateau([""; 0]).ends(2, &["Usage: plateau"]).stdout, "");
}
