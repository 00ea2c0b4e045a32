//! What others have left where files are written: it stays, also with `--force` where a study reads it.

use std::ffi::OsStr;
use std::fmt::Debug;
use std::fs;
use std::os::unix::fs::symlink;
use std::process::Stdio;

use plateau_tests::program::{Outcome, WorkingDirectory, scene};

/// Two factors, `load` and `fibres`, at two levels each, and a response that is measured elsewhere.
const STUDY: &str = "version = 1\ntitle = \"Lab\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n\
                     [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nlevels = [\"5 N\", \"15 N\"]\n\
                     [[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\nrange = [0.2, 0.4]\n\
                     [[response]]\nname = \"y\"\nimported = true\n[[response]]\nname = \"z\"\nimported = true\n";
const TABLE: &str = "load [N],fibres,y,z\n5,0.2,1,2\n15,0.2,2,3\n5,0.4,3,5\n15,0.4,4.5,6\n";

/// The same with its responses.
fn lab() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write("study.toml", STUDY);
    directory.write("table.csv", TABLE);
    directory.plateau(["sweep", "import", "study.toml", "table.csv"]).quiet_success();
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
fn a_fit_replaces_what_it_wrote_itself_and_nothing_else() {
    let directory = WorkingDirectory::new();
    let measured = "[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\nmeasured = \"1e-4 mm^3\"\n\
                    uncertainty = \"1e-5 mm^3\"\n[fit]\nruns = 5\n";
    directory.write("fit.toml", short(measured));
    directory.write("out/keys.csv", "mine");
    refused(&directory, &["fit", "fit.toml", "-o", "out"], "out/keys.csv exists; give --force to replace it");
    assert_eq!(text(&directory, "out/keys.csv"), "mine");
    assert!(!directory.path("results").exists(), "no run before that is said");

    fs::create_dir(directory.path("linked")).unwrap();
    directory.write("victim", "precious");
    symlink("../victim", directory.path("linked/runs.csv")).unwrap();
    refused(&directory, &["fit", "fit.toml", "-o", "linked"], "linked/runs.csv exists");
    well(&directory.plateau(["fit", "fit.toml", "-o", "linked", "--force"]));
    assert_eq!(text(&directory, "victim"), "precious");
    assert!(!directory.path("linked/runs.csv").is_symlink());

    // Its own, again and again; a file of it that has become a link since is not its own any more.
    well(&directory.plateau(["fit", "fit.toml"]));
    assert!(text(&directory, "results/fit/files.txt").contains("\n# of fit ../../fit.toml\n"));
    directory.write("results/fit/mine.txt", "mine");
    well(&directory.plateau(["fit", "fit.toml"]));
    fs::remove_file(directory.path("results/fit/keys.csv")).unwrap();
    symlink("../../victim", directory.path("results/fit/keys.csv")).unwrap();
    refused(&directory, &["fit", "fit.toml"], "results/fit/keys.csv exists");
    assert_eq!(
        (text(&directory, "victim"), text(&directory, "results/fit/mine.txt")),
        ("precious".into(), "mine".into())
    );
    // Of another study.
    directory.write("other.toml", short(measured));
    refused(&directory, &["fit", "other.toml", "-o", "linked"], "has the files of another call, of fit ../fit.toml");
}

#[test]
fn imports_at_the_same_time_lose_nothing() {
    for _ in 0..5 {
        let directory = WorkingDirectory::new();
        directory.write("study.toml", STUDY);
        let places = [(5, "0.2"), (15, "0.2"), (5, "0.4"), (15, "0.4")];
        let mut children = Vec::new();
        for (place, (load, fibres)) in places.iter().enumerate() {
            for response in ["y", "z"] {
                let table = format!("{response}{place}.csv");
                directory.write(&table, format!("load [N],fibres,{response}\n{load},{fibres},{}\n", 10 + place));
                let mut command = directory.command(["sweep", "import", "study.toml", &table]);
                children.push(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
            }
        }
        for mut child in children {
            assert!(child.wait().unwrap().success());
        }
        let kept = text(&directory, "results/imported.csv");
        for place in 0..4 {
            assert!(kept.contains(&format!(",{0}.0,{0}.0\n", 10 + place)), "{kept}");
        }
        assert_eq!(fs::read_dir(directory.path("results")).unwrap().count(), 1, "the table alone");
    }
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
    directory.write("points.csv", "load [N],fibres\n5,0.2\n15,0.4\n");
    fs::create_dir(directory.path("x")).unwrap();
    symlink("points.csv", directory.path("link.csv")).unwrap();
    let kept = ["points.csv", "results/imported.csv", "study.toml"].map(|name| (name, text(&directory, name)));
    for output in ["points.csv", "./x/../points.csv", "link.csv", "results/imported.csv", "study.toml"] {
        let arguments = ["sweep", "predict", "study.toml", "--points", "points.csv", "-o", output, "--force"];
        refused(&directory, &arguments, "is an input and is not replaced");
    }
    for output in ["results/imported.csv", "study.toml"] {
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
    directory.plateau(["sweep", "effects", "study.toml"]).quiet_success();
    for name in ["files.txt", "effects.csv"] {
        let path = directory.path("results/effects").join(name);
        fs::remove_file(&path).unwrap();
        symlink("../../victim", &path).unwrap();
        well(&directory.plateau(["sweep", "effects", "study.toml", "--force"]));
        assert!(!path.is_symlink() && text(&directory, "victim") == "precious", "{name}");
    }
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
    let commands: [&[&str]; 6] = [
        &["run", &quick, short[0], short[1], "-o"],
        &["export", "run.h5", "--to", "csv", "-o"],
        &["export", "run.h5", "--to", "npz", "-o"],
        &["report", "run.h5", "-o"],
        &["surface", "--prepare", &quick, "--plot"],
        &["new"],
    ];
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

#[test]
fn imported_values_are_kept_as_text_and_read_as_they_were() {
    let directory = WorkingDirectory::new();
    let names = ["=a", "+b", "@d", "-c"];
    let responses: String =
        names.iter().map(|name| format!("[[response]]\nname = \"{name}\"\nimported = true\n")).collect();
    let study = STUDY.split("[[response]]").next().unwrap();
    directory.write("study.toml", format!("{study}{responses}"));
    directory.write("table.csv", format!("load [N],fibres,{}\n5,0.2,1,2,3,4\n", names.join(",")));
    directory.plateau(["sweep", "import", "study.toml", "table.csv"]).quiet_success();
    let kept = text(&directory, "results/imported.csv");
    assert!(kept.starts_with("load [N],fibres,replicate,'=a,'+b,'@d,'-c\n5.0,0.2,1,1.0,2.0,3.0,4.0\n"), "{kept}");
    // What is kept is read again, by the program and as a table of one's own; so is the plan that is to be filled in.
    let again = directory.plateau(["sweep", "import", "study.toml", "results/imported.csv"]);
    assert!(again.stdout.contains("0 new, 0 changed"), "{again:?}");
    well(&directory.plateau(["sweep", "plan", "study.toml", "--csv", "plan.csv"]));
    well(&directory.plateau(["sweep", "import", "study.toml", "plan.csv"]));
}

#[test]
fn a_link_to_itself_is_no_table_that_is_not_there_yet() {
    let directory = lab();
    fs::remove_file(directory.path("results/imported.csv")).unwrap();
    symlink("imported.csv", directory.path("results/imported.csv")).unwrap();
    for command in [&["sweep", "import", "study.toml", "table.csv"][..], &["sweep", "effects", "study.toml"]] {
        let outcome = directory.plateau(command);
        assert!(matches!(outcome.status, Some(1 | 2)), "{outcome:?}");
        assert!(outcome.stderr.contains("results/imported.csv: Too many levels of symbolic links"), "{outcome:?}");
    }
}
