//! What others have left where files are written: it stays, also with `--force` where a study reads it.

use std::fs;
use std::os::unix::fs::symlink;

use plateau_tests::program::{WorkingDirectory, scene};
use plateau_tests::studies::Study;

const TABLE: &str = "load [N],fibres,y,z\n5,0.2,1,2\n15,0.2,2,3\n5,0.4,3,5\n15,0.4,4.5,6\n";

/// A study of two factors, each at two levels, with values of its responses.
fn lab() -> WorkingDirectory {
    let study =
        Study::lab("full-factorial").load("levels = [\"5 N\", \"15 N\"]").fibres("range = [0.2, 0.4]").imported("z");
    let directory = WorkingDirectory::with("study.toml", study);
    directory.write("results/imported.csv", TABLE);
    directory
}

/// A study of which each run takes a moment.
fn short() -> Study {
    let set = "set = [\"operation.duration = '1 s'\", \"output.sample_every = '0.5 s'\"]";
    Study::new(&scene("quick.toml"), "sobol", &format!("points = 5\n{set}")).load("range = [\"4 N\", \"12 N\"]")
}

#[test]
fn a_journal_is_made_smaller_without_what_is_no_part_of_it() {
    let directory = WorkingDirectory::with("study.toml", short());
    directory.plateau(["sweep", "run", "study.toml"]).quiet_success();
    for number in 0..10 {
        directory.write(&format!("results/journal/notes{number}.journal"), "my notes\n");
    }
    let again = directory.plateau(["sweep", "run", "study.toml"]).ends(0, &["notes0.journal", "they stay as they are"]);
    for number in 0..10 {
        assert_eq!(directory.text(&format!("results/journal/notes{number}.journal")), "my notes\n");
    }
    // Records are found in spite of them.
    assert!(again.stdout.contains("finished before    5"), "{again:?}");
}

#[test]
fn what_a_study_reads_is_not_replaced_even_if_asked_to() {
    let directory = lab();
    fs::create_dir(directory.path("x")).unwrap();
    symlink("study.toml", directory.path("link.toml")).unwrap();
    let kept = ["results/imported.csv", "study.toml"].map(|name| (name, directory.text(name)));
    let said = "is an input and is not replaced";
    for output in ["results/imported.csv", "study.toml", "./x/../study.toml", "link.toml"] {
        directory.plateau(["sweep", "plan", "study.toml", "--csv", output, "--force"]).ends(2, &[said]);
    }
    assert_eq!(kept.clone().map(|(name, _)| (name, directory.text(name))), kept);

    let directory = WorkingDirectory::new();
    let series = "time [s],worn [mm3],uncertainty [mm3]\n0.5,1e-5,1e-5\n1,2e-5,1e-5\n";
    directory.write("worn.csv", series);
    directory.write("study.toml", short().response("worn", "/series/worn_pin", "measured_file = \"worn.csv\""));
    directory.plateau(["sweep", "run", "study.toml"]).quiet_success();
    let journal = fs::read_dir(directory.path("results/journal")).unwrap().next().unwrap().unwrap().path();
    for output in ["worn.csv", &journal.display().to_string(), &scene("quick.toml")] {
        directory.plateau(["sweep", "plan", "study.toml", "--csv", output, "--force"]).ends(2, &[said]);
    }
    assert_eq!(directory.text("worn.csv"), series);
}

#[test]
fn a_link_in_a_folder_that_is_written_is_not_followed() {
    let directory = lab();
    directory.write("victim", "precious");
    for name in ["results.h5", "results.csv"] {
        let path = directory.path("results").join(name);
        symlink("../victim", &path).unwrap();
        directory.plateau(["sweep", "collect", "study.toml"]).ends(2, &[&format!("results/{name} exists")]);
        directory.plateau(["sweep", "collect", "study.toml", "--force"]).ends(0, &[]);
        assert!(!path.is_symlink() && directory.text("victim") == "precious", "{name}");
        for name in ["results.h5", "results.csv"] {
            fs::remove_file(directory.path("results").join(name)).unwrap();
        }
    }
    // A file that is named may be a link, as ever.
    symlink("victim", directory.path("plan.csv")).unwrap();
    directory.plateau(["sweep", "plan", "study.toml", "--csv", "plan.csv", "--force"]).ends(0, &[]);
    assert!(directory.path("plan.csv").is_symlink() && directory.text("victim").starts_with("run,load"));
}

#[test]
fn a_link_that_is_named_stays_and_what_it_leads_to_is_replaced() {
    let directory = WorkingDirectory::new();
    let quick = scene("quick.toml");
    directory.plateau(["run", &quick, "-o", "run.h5", "--set", "operation.duration=1 s"]).ends(0, &[]);
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
        directory.plateau(with(&[], &link)).ends(2, &["--force"]);
        assert_eq!(directory.text(&real), "mine", "{command:?}");
        directory.plateau(with(&["--force"], &link)).ends(0, &[]);
        assert!(directory.path(&link).is_symlink(), "{command:?}");
        assert_ne!(fs::read(directory.path(&real)).unwrap(), b"mine", "{command:?}");
        for more in [&[][..], &["--force"]] {
            let said = "is a link to nothing, which is not there; remove it";
            directory.plateau(with(more, &lost)).ends(2, &[said]);
        }
        assert!(directory.path(&lost).is_symlink() && !directory.path(&format!("{number}/nothing")).exists());
    }
}
