//! What one who types commands all day expects: hints, quiet and talkative runs.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::process::CommandExt;

use plateau_tests::program::{WorkingDirectory, run};

#[test]
fn a_program_whose_path_is_no_utf_8_says_what_was_meant_too() {
    let directory = WorkingDirectory::new();
    let mut command = directory.command(["rnu"]);
    command.arg0(OsStr::from_bytes(b"/odd\xff/plateau"));
    run(command).ends(2, &["did you mean", "run?"]);
}

#[test]
fn a_quiet_run_says_nothing_and_a_talkative_one_what_was_done_to_surfaces() {
    let directory = WorkingDirectory::with_scene(&[("duration = \"60 s\"", "steps = 20")]);
    let quiet = directory.plateau(["run", "scene.toml", "-q", "--set", "operation.normal_force=1 MN"]);
    assert_eq!((quiet.status, quiet.stdout.as_str(), quiet.stderr.as_str()), (Some(0), "", ""));
    let plain = directory.plateau(["run", "scene.toml", "--force", "--set", "operation.normal_force=1 MN"]);
    assert!(plain.stderr.contains("plateau: warning: "), "{}", plain.stderr);
    let verbose = directory.plateau(["run", "scene.toml", "--force", "-v"]);
    assert!(!plain.stderr.contains("disc.surface: synthetic"), "{}", plain.stderr);
    assert!(verbose.stderr.contains("plateau: disc.surface: synthetic, seed"), "{}", verbose.stderr);
}
