//! What a run writes over: its own files, and others only where that was asked for.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;

use plateau_tests::program::{Outcome, WorkingDirectory, run_words, scene};

fn run(directory: &WorkingDirectory, more: &[&str]) -> Outcome {
    directory.plateau(run_words("quick.toml", "run.h5", &["operation.duration=2 s"], more))
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().permissions().mode() & 0o777
}

#[test]
fn what_only_has_the_name_of_a_checkpoint_stays() {
    for name in ["run.h5.checkpoint", "run.h5.checkpoint-before"] {
        let directory = WorkingDirectory::new();
        let path = directory.write(name, "my notes");
        for more in [&[][..], &["--resume"], &["--extend-to", "3 s"]] {
            run(&directory, more).ends(2, &[name]);
        }
        assert_eq!((fs::read_to_string(&path).unwrap().as_str(), directory.names().len()), ("my notes", 1));
        directory.plateau(["check", &scene("quick.toml"), "--set", "output.file=run.h5"]).ends(0, &[name]);
        run(&directory, &["--force"]).ends(0, &[]);
        directory.plateau(["verify", "run.h5"]).quiet_success();

        // A link is not followed, and a folder not moved.
        let other = directory.write("other", "my notes");
        fs::remove_file(&path).unwrap_or_default();
        symlink(&other, &path).unwrap();
        run(&directory, &["--resume"]).ends(2, &[]);
        run(&directory, &["--force"]).ends(0, &[]);
        assert_eq!(fs::read_to_string(&other).unwrap(), "my notes");
        fs::remove_file(&path).unwrap_or_default();
        fs::create_dir(&path).unwrap();
        run(&directory, &["--force"]).ends(2, &[]);
        assert!(path.is_dir());
    }
}

#[test]
fn a_scene_is_not_replaced_by_its_own_checkpoint() {
    let directory = WorkingDirectory::new();
    let text = fs::read_to_string(scene("quick.toml")).unwrap();
    let path = directory.write("run.h5.checkpoint", &text);
    for more in ["--force", "--json"] {
        directory.plateau(["run", "run.h5.checkpoint", "-o", "run.h5", more]).ends(2, &["run.h5.checkpoint"]);
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
}

#[test]
fn check_lists_all_that_a_run_writes() {
    let directory = WorkingDirectory::new();
    let words = ["check", &scene("quick.toml"), "--set", "output.file=run.h5", "--json"];
    let checked = directory.plateau(words).ends(0, &[]).json();
    let files = checked["files"].as_array().unwrap().iter().filter(|file| file["access"] == "writes");
    let written: Vec<_> = files.map(|file| file["path"].as_str().unwrap()).collect();
    assert_eq!(written, ["run.h5", "run.h5.checkpoint", "run.h5.checkpoint-before", "run.h5.lock"]);
}

#[test]
fn files_that_are_replaced_keep_their_permissions() {
    let directory = WorkingDirectory::new();
    run(&directory, &[]).ends(0, &[]);
    let files = ["run.h5", "run.h5.checkpoint"].map(|name| directory.path(name));
    for file in &files {
        fs::set_permissions(file, fs::Permissions::from_mode(0o600)).unwrap();
    }
    for more in [&["--extend-to", "4 s"][..], &["--force"]] {
        run(&directory, more).ends(0, &[]);
        assert_eq!(mode(&files[0]), 0o600, "{more:?}");
    }
    run(&directory, &["--extend-to", "4 s"]).ends(0, &[]);
    let path = directory.write("run.png", "");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    directory.plateau(["surface", "run.h5", "--plot", "run.png", "--force"]).quiet_success();
    assert_eq!(mode(&path), 0o640);
}
