//! What a run lacks is told, and what it has done is safe: files that vanish, memory, handles, moments at which signals come.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use plateau_tests::program::{Outcome, WorkingDirectory, ended, kill, run, run_words, scene, send, start, wait_until};
use plateau_tests::run_file::RunFile;

/// A run that does not end by itself, with a checkpoint as often as that.
fn endless(file: &str, checkpoint_every: &str) -> Vec<String> {
    let every = format!("output.checkpoint_every={checkpoint_every}");
    let settings = ["operation.duration=100 h", "numerics.time_acceleration=1", "output.maps=[]", &every];
    run_words("quick.toml", file, &settings, &[])
}

fn has_samples(file: &Path) -> bool {
    wait_until(|| RunFile::follow(file).is_ok_and(|run| run.shape("/time")[0] > 1))
}

/// Runs until there are samples, lets something happen, and waits for the end.
fn disturbed(directory: &WorkingDirectory, file: &str, disturb: impl FnOnce()) -> Outcome {
    let child = start(directory.command(endless(file, "0.1 s")));
    assert!(has_samples(&directory.path(file)));
    disturb();
    ended(child)
}

#[test]
fn a_file_or_a_directory_that_vanishes_ends_the_run() {
    let directory = WorkingDirectory::new();
    disturbed(&directory, "run.h5", || fs::rename(directory.path("run.h5"), directory.path("moved.h5")).unwrap())
        .ends(1, &["run.h5 was moved, removed or replaced"]);
    // It is all that there is of the run.
    assert_eq!(RunFile::follow(directory.path("moved.h5")).unwrap().text("state"), "running");
    directory.plateau(["repair", "moved.h5"]).quiet_success();
    assert!(directory.run_file("moved.h5").shape("/time")[0] > 1);

    directory.write("folder/a file", "");
    // A checkpoint that comes just then makes the folder one that is not empty.
    let removed = || wait_until(|| fs::remove_dir_all(directory.path("folder")).is_ok());
    disturbed(&directory, "folder/run.h5", || assert!(removed()))
        .ends(1, &["folder/run.h5 was moved, removed or replaced"]);
}

#[test]
fn a_run_whose_file_was_replaced_leaves_the_checkpoints_of_the_other_alone() {
    let directory = WorkingDirectory::new();
    let content = || ["run.h5", "run.h5.checkpoint"].map(|name| fs::read(directory.path(name)).ok());
    let mut other = None;
    let outcome = disturbed(&directory, "run.h5", || {
        // As on another machine, where nobody sees that the file is being written.
        let elsewhere = WorkingDirectory::new();
        run(elsewhere.command(["run", &scene("quick.toml"), "-o", "run.h5"])).ends(0, &[]);
        for name in ["run.h5", "run.h5.checkpoint"] {
            directory.write("new", fs::read(elsewhere.path(name)).unwrap());
            fs::rename(directory.path("new"), directory.path(name)).unwrap();
            // From when its file is replaced on, the run begins no checkpoint; one that is under way comes to its end.
            std::thread::sleep(Duration::from_secs(1));
        }
        other = Some(content());
    });
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    let other = other.unwrap();
    assert!(content()[0] == other[0], "the file of the other run was changed");
    // A checkpoint that was under way may have come last; the one before is then that of the other.
    let kept = fs::read(directory.path("run.h5.checkpoint-before")).ok();
    assert!(content()[1] == other[1] || kept == other[1], "the checkpoint of the other run is gone");
}

#[test]
fn a_signal_during_the_preparation_is_heard() {
    let large = ["--set", "mesh.rows=300", "--set", "mesh.disc_columns=20700", "--set", "mesh.pin_columns=1200"];
    // Fibres that are so long that nearly all of them miss the pin: nearly as many as are placed at most.
    let fibres = ["--set", "pin.base.synthetic.fibre_length=4 m", "--set", "pin.base.synthetic.fibre_width=1e-7 m"];
    let cases = [("TERM", 143, &large[..]), ("INT", 130, &large), ("HUP", 129, &large), ("XCPU", 152, &fibres)];
    for (signal, status, sets) in cases {
        let directory = WorkingDirectory::new();
        let arguments = endless("run.h5", "1 h");
        let mut command =
            directory.command_with_hangup(arguments.iter().map(String::as_str).chain(sets.iter().copied()));
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        assert!(wait_until(|| catches_stops(child.id())), "no handler of SIGXCPU");
        send("USR1", child.id());
        send(signal, child.id());
        let mut end = None;
        let has_ended = wait_until(|| {
            end = child.try_wait().unwrap();
            end.is_some()
        });
        if !has_ended {
            kill(child);
        }
        assert_eq!(end.and_then(|end| end.code()), Some(status), "{signal}");
        assert_eq!(directory.names(), [""; 0], "{signal}");
    }
}

/// Whether a process has the last of the handlers of signals that stop it, that of SIGXCPU: in the mask, 1 is SIGHUP's bit.
fn catches_stops(process: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:").map(str::trim));
    mask.and_then(|mask| u64::from_str_radix(mask, 16).ok()).is_some_and(|mask| mask >> (24 - 1) & 1 == 1)
}

#[test]
fn a_stopped_run_is_interrupted_with_whole_samples_and_a_checkpoint_unless_a_hangup_is_to_be_ignored() {
    let directory = WorkingDirectory::new();
    for (signal, status, ignored) in
        [("INT", 130, false), ("TERM", 143, false), ("HUP", 129, false), ("XCPU", 152, false), ("TERM", 143, true)]
    {
        let file = format!("{signal}-{ignored}.h5");
        let arguments = endless(&file, "1 h");
        let mut child = start(if ignored {
            directory.command_after("trap '' HUP", arguments)
        } else {
            directory.command_with_hangup(arguments)
        });
        assert!(has_samples(&directory.path(&file)));
        if ignored {
            let samples = RunFile::follow(directory.path(&file)).unwrap().shape("/time")[0];
            send("HUP", child.id());
            assert!(wait_until(|| {
                RunFile::follow(directory.path(&file)).is_ok_and(|run| run.shape("/time")[0] > samples)
            }));
            assert!(child.try_wait().unwrap().is_none(), "what nohup starts goes on");
        }
        send(signal, child.id());
        let stopped = ended(child).ends(status, &[]);
        let run = directory.run_file(&file);
        assert_eq!(run.text("state"), "interrupted", "{signal}");
        let samples = run.shape("/time")[0];
        assert_eq!(run.shape("/series/contact_area")[0], samples);
        let end = format!("{file} holds {samples} samples, --resume goes on from here\n");
        assert!(stopped.stderr.ends_with(&end), "{stopped:?}");
        assert!(directory.path(&format!("{file}.checkpoint")).exists(), "{signal}");
    }
}

#[test]
fn with_any_little_memory_a_run_ends_with_one_line_and_leaves_nothing_damaged() {
    for workers in ["1", "2"] {
        let mut refused = 0;
        for kibibytes in (28_000..=188_000).step_by(16_000) {
            let directory = WorkingDirectory::new();
            // What a run needs does not grow with its length.
            let short = "operation.duration=2 s";
            let arguments = ["run", &scene("quick.toml"), "-o", "run.h5", "--workers", workers, "--set", short];
            let outcome = run(directory.command_after(&format!("ulimit -c 0; ulimit -v {kibibytes}"), arguments));
            if outcome.status == Some(0) {
                directory.plateau(["verify", "run.h5"]).quiet_success();
                continue;
            }
            refused += 1;
            // A mesh that is too large is told as such.
            assert!(matches!(outcome.status, Some(1 | 2)), "{kibibytes} KiB: {outcome:?}");
            let (first, _) = outcome.stderr.split_once('\n').unwrap();
            assert!(first.starts_with("plateau: ") && first.contains("memory and "), "{kibibytes} KiB: {outcome:?}");
            assert_eq!(directory.names(), [""; 0], "{kibibytes} KiB");
        }
        assert!(refused > 0 && refused < 11, "{refused} were refused");
    }
}

#[test]
fn with_few_handles_a_run_still_ends_well_and_with_too_few_nothing_is_taken_for_damaged() {
    let directory = WorkingDirectory::new();
    for handles in 4..9 {
        let arguments = ["run", &scene("quick.toml"), "-o", "run.h5", "--force"];
        let outcome = run(directory.command_after(&format!("ulimit -n {handles}"), arguments));
        if handles == 4 {
            let outcome = outcome.ends(1, &["no file handle is left"]);
            assert!(!outcome.stderr.contains("damaged"), "{outcome:?}");
        } else {
            outcome.ends(0, &[]);
        }
        // With too few either there is no file yet, or it is whole.
        if handles > 4 || directory.path("run.h5").exists() {
            directory.plateau(["verify", "run.h5"]).quiet_success();
        }
    }
}

#[test]
fn the_name_of_a_file_decides_no_exit_status() {
    let directory = WorkingDirectory::new();
    for name in ["a (os error 24).h5", "a, errno = 12, b.h5"] {
        for arguments in [&["summary"][..], &["verify"], &["surface"], &["sweep", "plan"]] {
            directory.plateau(arguments.iter().chain(&[name])).ends(2, &[]);
        }
    }
}

#[test]
fn files_have_the_permissions_that_the_user_wants() {
    let directory = WorkingDirectory::new();
    let arguments = ["run", &scene("quick.toml"), "-o", "run.h5"];
    run(directory.command_after("umask 027", arguments)).ends(0, &[]);
    for name in ["run.h5", "run.h5.checkpoint"] {
        let mode = fs::metadata(directory.path(name)).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640, "{name}");
    }
}

#[test]
fn check_shows_where_files_really_are() {
    let directory = WorkingDirectory::new();
    fs::create_dir(directory.path("elsewhere")).unwrap();
    let text = fs::read_to_string(scene("quick.toml")).unwrap();
    directory.write("scenes/base.toml", text);
    directory.write("scenes/scene.toml", "extends = \"../scenes/base.toml\"\n");
    symlink(directory.path("elsewhere"), directory.path("results")).unwrap();
    let arguments = ["check", "scenes/scene.toml", "--all", "--set", "output.file=results/run.h5"];
    let text = directory.without_path(&directory.plateau(arguments).quiet_success());
    assert!(text.contains("scenes/../scenes/base.toml, which is [directory]/scenes/base.toml\n"), "{text}");
    assert!(text.contains("writes  results/run.h5, which is [directory]/elsewhere/run.h5\n"), "{text}");
    assert!(text.contains("reads   scenes/scene.toml\n"), "{text}");
}

#[test]
fn a_run_that_is_killed_while_it_prepares_leaves_nothing() {
    let directory = WorkingDirectory::new();
    let large = ["--set", "mesh.rows=300", "--set", "mesh.disc_columns=20700", "--set", "mesh.pin_columns=1200"];
    let child = start(directory.command(endless("run.h5", "1 h").iter().map(String::as_str).chain(large)));
    kill(child);
    assert_eq!(directory.names(), [""; 0]);
}
