//! What a run writes over: its own files, and others only where that was asked for.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;

use plateau_tests::program::{Outcome, WorkingDirectory, scene};

fn run(directory: &WorkingDirectory, more: &[&str]) -> Outcome {
    let short = ["run", &scene("quick.toml"), "-o", "run.h5", "--set", "operation.duration=2 s"];
    directory.plateau(short.iter().chain(more))
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
            let refused = run(&directory, more);
            assert!(refused.status == Some(2) && refused.stderr.contains(name), "{more:?}: {refused:?}");
        }
        assert_eq!((fs::read_to_string(&path).unwrap().as_str(), directory.names().len()), ("my notes", 1));
        directory.plateau(["check", &scene("quick.toml"), "--set", "output.file=run.h5"]).ends(0, &[name]);
        assert_eq!(run(&directory, &["--force"]).status, Some(0));
        directory.plateau(["verify", "run.h5"]).quiet_success();

        // A link is not followed, and a folder not moved.
        let other = directory.write("other", "my notes");
        fs::remove_file(&path).unwrap_or_default();
        symlink(&other, &path).unwrap();
        assert_eq!(run(&directory, &["--resume"]).status, Some(2));
        assert_eq!(run(&directory, &["--force"]).status, Some(0));
        assert_eq!(fs::read_to_string(&other).unwrap(), "my notes");
        fs::remove_file(&path).unwrap_or_default();
        fs::create_dir(&path).unwrap();
        assert_eq!(run(&directory, &["--force"]).status, Some(2));
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
    let checked = directory.plateau(["check", &scene("quick.toml"), "--set", "output.file=run.h5", "--json"]);
    let checked: serde_json::Value = serde_json::from_str(&checked.quiet_success()).unwrap();
    let files = checked["files"].as_array().unwrap().iter().filter(|file| file["access"] == "writes");
    let written: Vec<_> = files.map(|file| file["path"].as_str().unwrap()).collect();
    assert_eq!(written, ["run.h5", "run.h5.checkpoint", "run.h5.checkpoint-before", "run.h5.lock"]);
}

#[test]
fn files_that_are_replaced_keep_their_permissions() {
    let directory = WorkingDirectory::new();
    assert_eq!(run(&directory, &[]).status, Some(0));
    let files = ["run.h5", "run.h5.checkpoint"].map(|name| directory.path(name));
    for file in &files {
        fs::set_permissions(file, fs::Permissions::from_mode(0o600)).unwrap();
    }
    for more in [&["--extend-to", "4 s"][..], &["--force"]] {
        assert_eq!(run(&directory, more).status, Some(0));
        assert_eq!(mode(&files[0]), 0o600, "{more:?}");
    }
    assert_eq!(run(&directory, &["--extend-to", "4 s"]).status, Some(0));
    let path = directory.write("run.png", "");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    directory.plateau(["surface", "run.h5", "--plot", "run.png", "--force"]).quiet_success();
    assert_eq!(mode(&path), 0o640);
}
