//! Names that would move the cursor, begin a formula in a spreadsheet, or break a drawing: refused, or shown as the text that
//! they are.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;

use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, run, scene};
use plateau_tests::run_file::set_text;
use plateau_tests::studies::Study;

/// Clears the screen, and turns what follows.
const ODD: &str = "a\u{1b}[2J\u{202e}b";

fn assert_plain(outcome: &Outcome) {
    let said = [outcome.stdout.as_str(), &outcome.stderr].concat();
    let odd = said.chars().find(|letter| letter.is_control() && !"\n\t".contains(*letter) || *letter == '\u{202e}');
    assert_eq!(odd, None, "{outcome:?}");
}

#[test]
fn arguments_and_file_names_cannot_do_anything_to_the_terminal() {
    let directory = WorkingDirectory::new();
    let (odd, lines) = (format!("{ODD}.toml"), "a\nplateau: all is well.toml");
    fs::copy(scene("quick.toml"), directory.path(&odd)).unwrap();
    directory.write(lines, fs::read(scene("quick.toml")).unwrap());
    for arguments in [
        &["check", &odd][..],
        &["check", lines],
        &["run", &scene("quick.toml"), "-o", &odd],
        &["surface", &odd],
        &["verify", &odd],
        &["no such command \u{1b}[31m"],
        &["run", &scene("quick.toml"), "--set", &format!("{ODD}=1")],
    ] {
        let refused = directory.plateau(arguments);
        assert_eq!(refused.status, Some(2), "{arguments:?}: {refused:?}");
        assert_plain(&refused);
        assert!(!refused.stderr.contains("\nplateau: all is well"), "{refused:?}");
    }
    // TOML may have several lines.
    let lists = ["check", &scene("quick.toml"), "--set", "output.maps_at=[\n\t\"0 s\"\n]"];
    directory.plateau(lists).ends(0, &[]);
}

#[test]
fn names_in_scenes_and_studies_are_of_one_line() {
    let directory = WorkingDirectory::new();
    for (key, value) in [("title", ODD), ("output.file", ODD), ("title", "two\nlines")] {
        let value = serde_json::to_string(value).unwrap().replace('\u{202e}', "\\u202e");
        let (table, name) = key.split_once('.').unwrap_or(("", key));
        let head = if table.is_empty() { String::new() } else { format!("[{table}]\n") };
        let base = scene("quick.toml");
        directory.write("scene.toml", format!("version = 1\nextends = \"{base}\"\n{head}{name} = {value}\n"));
        let refused = directory.plateau(["check", "scene.toml"]);
        assert_eq!(refused.status, Some(2), "{key}: {refused:?}");
        assert!(refused.stderr.contains("scene.toml:") && refused.stderr.contains("take it out"), "{refused:?}");
        assert_plain(&refused);
    }
    let study = |title: &str, factor: &str, level: &str, response: &str| {
        Study::new(&scene("quick.toml"), "full-factorial", &format!("title = \"{title}\""))
            .factor(factor, "plateaus.debris", &format!("levels = [\"contact\", \"{level}\"]"))
            .response(response, "/series/pool", "at = \"end\"")
            .text()
    };
    let odd = "a\\u001b[2Jb";
    for text in [
        study(odd, "f", "local", "r"),
        study("t", odd, "local", "r"),
        study("t", "f", odd, "r"),
        study("t", "f", "local", odd),
        study("t", "f\\nplateau: all is well", "local", "r"),
    ] {
        directory.write("study.toml", &text);
        let refused = directory.plateau(["sweep", "plan", "study.toml"]);
        assert!(refused.status == Some(2) && refused.stderr.contains("take it out"), "{text}\n{refused:?}");
        assert_plain(&refused);
    }
}

#[test]
fn what_is_too_long_to_be_read_is_not_shown_whole() {
    let directory = WorkingDirectory::new();
    let long = "x".repeat(10_000_000);
    directory.write("cycle.csv", format!("time [s],normal_force [N],rotational_speed [rpm]\n0,{long},60\n1,5,60\n"));
    directory.write(
        "scene.toml",
        fs::read_to_string(scene("quick.toml")).unwrap() + "[operation.cycle]\nfile = \"cycle.csv\"\n",
    );
    directory.write("list.txt", format!("unit = um\n{long} 1 2\n"));
    let quantity = format!("operation.normal_force={}", &long[..100_000]);
    for arguments in [
        vec!["check", "scene.toml"],
        vec!["check", &scene("quick.toml"), "--set", &quantity],
        vec!["check", &scene("quick.toml"), "--set", "pin.base.synthetic.fibre_length=1e308 m"],
        vec!["surface", "list.txt"],
    ] {
        let outcome = directory.plateau(&arguments);
        assert_eq!(outcome.status, Some(2), "{:.1000}", outcome.stderr);
        assert!(outcome.stderr.len() < 1000, "{:.1000}", outcome.stderr);
    }
}

#[test]
fn no_table_has_a_formula() {
    let directory = WorkingDirectory::with("base.toml", quick_scene_with(&[]));
    let study = Study::new("base.toml", "full-factorial", "title = \"=1+1\"\nset = [\"operation.duration = '1 s'\"]")
        .factor("=HYPERLINK(1)", "operation.normal_force", "levels = [\"5 N\", \"6 N\"]")
        .response("@SUM(A1)", "/series/pool", "at = \"end\"")
        .response("-2+3", "/series/emitted", "at = \"end\"");
    directory.write("study.toml", study);
    directory.plateau(["sweep", "plan", "study.toml", "--csv", "plan.csv"]);
    directory.plateau(["sweep", "run", "study.toml"]).ends(0, &[]);
    directory.plateau(["sweep", "collect", "study.toml"]);
    for name in ["plan.csv", "results/results.csv"] {
        let file = fs::File::open(directory.path(name)).unwrap();
        let mut cells = 0;
        for record in csv::ReaderBuilder::new().has_headers(false).from_reader(file).records() {
            for cell in &record.unwrap() {
                let computed = cell.starts_with(['=', '+', '-', '@']) && cell.parse::<f64>().is_err();
                assert!(!computed, "{name}: {cell}");
                cells += usize::from(cell.starts_with('\''));
            }
        }
        assert!(cells > 0, "{name}: none of the names is there");
    }
}

#[test]
fn nothing_that_a_run_file_says_reaches_the_terminal() {
    let directory = WorkingDirectory::new();
    let short = ["--set", "operation.duration=1 s", "--set", "title=PLACE OF A TITLE"];
    directory.plateau(["run", &scene("quick.toml"), "-o", "run.h5"].iter().chain(&short)).ends(0, &[]);
    // A title that no scene may have: as another program could write it.
    set_text(directory.path("run.h5"), "title", "<a & \u{1b}[2J\u{1} \u{fffe}\u{202e}]]>");
    for command in [&["watch", "run.h5", "--once"][..], &["summary", "run.h5"], &["verify", "run.h5"]] {
        assert_plain(&directory.plateau(command));
    }
}

#[test]
fn a_batch_script_names_the_study_byte_for_byte() {
    let directory = WorkingDirectory::new();
    let text = Study::new(&scene("quick.toml"), "full-factorial", "").load("levels = [\"5 N\", \"6 N\"]");
    let name = OsStr::from_bytes(b"it's \xff.toml");
    fs::write(directory.path("").join(name), text).unwrap();
    let mut command = directory.command(["sweep", "slurm", "-o", "study.sbatch"]);
    command.arg(name);
    run(command).ends(0, &[]);
    // A shell takes the path out of the script as it was.
    let script = fs::read(directory.path("study.sbatch")).unwrap();
    let at = script.windows(6).position(|part| part == b"\nexec ").unwrap();
    let show = &b"show() { printf %s \"$4\"; }\nshow "[..];
    let script: Vec<u8> = [show, &script[at + 6..]].concat();
    fs::write(directory.path("show.sh"), script).unwrap();
    let shown = std::process::Command::new("sh").arg(directory.path("show.sh")).output().unwrap();
    let expected = directory.path("").canonicalize().unwrap().join(name);
    assert_eq!(OsStr::from_bytes(&shown.stdout), expected, "{shown:?}");
}
