//! What others have left where files are written: it stays, also with `--force` where a study reads it.

use std::ffi::OsStr;
use std::fmt::Debug;
use std::fs;
use std::os::unix::fs::symlink;

use plateau_tests::program::{Outcome, WorkingDirectory, scene};

/// Two factors, `load` and `fibres`, at two levels each, and a response that is measured elsewhere.
const STUDY: &str = "version = 1\ntitle = \"Lab\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n\
                     [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nlevels = [\"5 N\", \"15 N\"]\n\
                     [[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\nrange = [0.2, 0.4]\n\
                     [[response]]\nname = \"y\"\nimported = true\n[[response]]\nname = \"z\"\nimported = true\n";
const TABLE: &str = "load [N],fibres,y,z\n5,0.2,1,2\n15,0.2,2,3\n5,0.4,3,5\n15,0.4,4.5,6\n";

/// The same with values of its responses.
fn lab() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write("study.toml", STUDY);
    directory.write("results/imported.csv", TABLE);
    directory
}

fn refused<A: AsRef<OsStr> + Debug>(directory: &WorkingDirectory, arguments: &[A], why: &str) {
    let outcome = directory.plateau(arguments);
    assert_eq!(outcome.status, Some(2), "{arguments:?}: {outcome:?}");
    assert!(outcome.stderr.contains(why), "{arguments:?}: {outcome:?}");
}

fn well(outcome: &Outcome) {
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
}

fn text(directory: &WorkingDirectory, name: &str) -> String {
    fs::read_to_string(directory.path(name)).unwrap()
}

/// A study of which each run takes a moment; `more` are its last tables.
fn short(more: &str) -> String {
    format!(
        "version = 1\ntitle = \"Short\"\nbase = \"{}\"\n\
         set = [\"operation.duration = '1 s'\", \"output.sample_every = '0.5 s'\"]\n\
         design = \"sobol\"\npoints = 5\ndirectory = \"results\"\n\
         [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nrange = [\"4 N\", \"12 N\"]\n{more}",
        scene("quick.toml")
    )
}

#[test]
fn a_journal_is_made_smaller_without_what_is_no_part_of_it() {
    let directory = WorkingDirectory::new();
    directory.write("study.toml", short(""));
    directory.plateau(["sweep", "run", "study.toml"]).quiet_success();
    for number in 0..10 {
        directory.write(&format!("results/journal/notes{number}.journal"), "my notes\n");
    }
    let again = directory.plateau(["sweep", "run", "study.toml"]);
    well(&again);
    assert!(again.stderr.contains("notes0.journal") && again.stderr.contains("they stay as they are"), "{again:?}");
    for number in 0..10 {
        assert_eq!(text(&directory, &format!("results/journal/notes{number}.journal")), "my notes\n");
    }
    // Records are found in spite of them.
    assert!(again.stdout.contains("finished before    5"), "{again:?}");
}

#[test]
fn what_a_study_reads_is_not_replaced_even_if_asked_to() {
    let directory = lab();
    fs::create_dir(directory.path("x")).unwrap();
    symlink("study.toml", directory.path("link.toml")).unwrap();
    let kept = ["results/imported.csv", "study.toml"].map(|name| (name, text(&directory, name)));
    for output in ["results/imported.csv", "study.toml", "./x/../study.toml", "link.toml"] {
        refused(
            &directory,
            &["sweep", "plan", "study.toml", "--csv", output, "--force"],
            "is an input and is not replaced",
        );
    }
    assert_eq!(kept.clone().map(|(name, _)| (name, text(&directory, name))), kept);

    let directory = WorkingDirectory::new();
    let series = "time [s],worn [mm3],uncertainty [mm3]\n0.5,1e-5,1e-5\n1,2e-5,1e-5\n";
    directory.write("worn.csv", series);
    let response = "[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nmeasured_file = \"worn.csv\"\n";
    directory.write("study.toml", short(response));
    directory.plateau(["sweep", "run", "study.toml"]).quiet_success();
    let journal = fs::read_dir(directory.path("results/journal")).unwrap().next().unwrap().unwrap().path();
    for output in ["worn.csv", &journal.display().to_string(), &scene("quick.toml")] {
        refused(
            &directory,
            &["sweep", "plan", "study.toml", "--csv", output, "--force"],
            "is an input and is not replaced",
        );
    }
    assert_eq!(text(&directory, "worn.csv"), series);
}

#[test]
fn a_link_in_a_folder_that_is_written_is_not_followed() {
    let directory = lab();
    directory.write("victim", "precious");
    for name in ["results.h5", "results.csv"] {
        let path = directory.path("results").join(name);
        symlink("../victim", &path).unwrap();
        refused(&directory, &["sweep", "collect", "study.toml"], &format!("results/{name} exists"));
        well(&directory.plateau(["sweep", "collect", "study.toml", "--force"]));
        assert!(!path.is_symlink() && text(&directory, "victim") == "precious", "{name}");
        for name in ["results.h5", "results.csv"] {
            fs::remove_file(directory.path("results").join(name)).unwrap();
        }
    }
    // A file that is named may be a link, as ever.
    symlink("victim", directory.path("plan.csv")).unwrap();
    well(&directory.plateau(["sweep", "plan", "study.toml", "--csv", "plan.csv", "--force"]));
    assert!(directory.path("plan.csv").is_symlink() && text(&directory, "victim").starts_with("run,load"));
}

#[test]
fn a_link_that_is_named_stays_and_what_it_leads_to_is_replaced() {
    let directory = WorkingDirectory::new();
    let quick = scene("quick.toml");
    well(&directory.plateau(["run", &quick, "-o", "run.h5", "--set", "operation.duration=1 s"]));
    let short = ["--set", "operation.duration=1 s"];
    let commands: [&[&str]; 3] =
        [&["run", &quick, short[0], short[1], "-o"], &["surface", "--prepare", &quick, "--plot"], &["new"]];
    for (number, command) in commands.iter().enumerate() {
        let ending = if command[0] == "surface" { "png" } else { "out" };
        let [real, link, lost] = ["real", "link", "lost"].map(|name| format!("{number}/{name}.{ending}"));
        directory.write(&real, "mine");
        symlink(format!("real.{ending}"), directory.path(&link)).unwrap();
        symlink("nothing", directory.path(&lost)).unwrap();
        let with = |more: &[&'static str], name: &str| {
            command.iter().chain([&name]).chain(more).map(|argument| (*argument).to_owned()).collect::<Vec<_>>()
        };
        refused(&directory, &with(&[], &link), "--force");
        assert_eq!(text(&directory, &real), "mine", "{command:?}");
        well(&directory.plateau(with(&["--force"], &link)));
        assert!(directory.path(&link).is_symlink(), "{command:?}");
        assert_ne!(fs::read(directory.path(&real)).unwrap(), b"mine", "{command:?}");
        for more in [&[][..], &["--force"]] {
            let lost = with(more, &lost);
            let said = "is a link to nothing, which is not there; remove it";
            refused(&directory, &lost, said);
        }
        assert!(directory.path(&lost).is_symlink() && !directory.path(&format!("{number}/nothing")).exists());
    }
}
