//! What is said where a study asks for what cannot be: numbers without rows of zeros, names with signs, and what to do next.

use std::fs;

use plateau_tests::program::{Outcome, WorkingDirectory, scene};

const FACTORS: &str = "[[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nrange = [\"5 N\", \"15 N\"]\n\
                       [[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\nrange = [0.2, 0.4]\n";

/// A study of an imported response.
fn lab() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let head = "version = 1\ntitle = \"Lab\"\ndesign = \"central-composite\"\ndirectory = \"results\"\n";
    directory.write("study.toml", format!("{head}{FACTORS}[[response]]\nname = \"y\"\nimported = true\n"));
    directory
}

fn ask(directory: &WorkingDirectory, arguments: &[&str]) -> Outcome {
    directory.plateau([&["sweep", arguments[0], "study.toml"], &arguments[1..]].concat())
}

fn said(outcome: &Outcome, status: i32, words: &str) {
    assert_eq!(outcome.status, Some(status), "{outcome:?}");
    assert!(outcome.stdout.contains(words) || outcome.stderr.contains(words), "{words}: {outcome:?}");
}

#[test]
fn what_to_do_without_results_depends_on_where_they_come_from() {
    let directory = lab();
    said(&ask(&directory, &["collect"]), 0, "plateau sweep import takes in their responses");
}

#[test]
fn numbers_beyond_all_measure_are_told_as_such() {
    let directory = WorkingDirectory::new();
    let quick = scene("quick.toml");
    for set in ["mesh.inner_radius=1e300 m", "output.maps_at=[\"1e300 s\"]"] {
        let outcome = directory.plateau(["check", &quick, "--set", set]);
        assert!(outcome.stderr.contains("1e300") && !outcome.stderr.contains("000000000"), "{outcome:?}");
    }
}

#[test]
fn keys_and_names_that_nobody_would_find_again_are_told() {
    let directory = lab();
    let text = fs::read_to_string(directory.path("study.toml")).unwrap();
    for (from, to, words) in [
        ("[[factor]]", "[[factors]]", "unknown key `factors`, expected one of `version`"),
        ("[[factor]]", "[[factors]]", "; did you mean \"factor\"?"),
        ("\"load\"", "\" load\"", "factor.name: \" load\" has a blank at an end"),
        ("\"y\"", "\"y\u{feff}\"", "response.name: \"y\\u{feff}\" has the character U+FEFF"),
        ("range = [0.2, 0.4]", "levels = [0.2, \"wet \"]", "factor.levels: \"wet \" has a blank at an end"),
    ] {
        directory.write("study.toml", text.replace(from, to));
        said(&ask(&directory, &["plan"]), 2, words);
    }
}

#[test]
fn a_plan_of_very_many_runs_says_that_it_has_not_looked_at_all() {
    let directory = WorkingDirectory::new();
    let study = |points: usize| {
        let head = format!("version = 1\nbase = \"{}\"\ndesign = \"sobol\"\npoints = {points}\n", scene("quick.toml"));
        directory.write("study.toml", format!("{head}{FACTORS}"));
        ask(&directory, &["plan"])
    };
    said(&study(20_001), 0, "20 001 runs are more than 20 000, so that their scenes are not looked at here");
    assert!(!study(8).stderr.contains("not looked at"));
}

/// A study of two loads with one response; the base scene is that of a quick run of two seconds.
fn loads(response: &str) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    fs::copy(scene("quick.toml"), directory.path("quick.toml")).unwrap();
    let head = "version = 1\nbase = \"quick.toml\"\ndesign = \"full-factorial\"\nset = [\"operation.duration = \\\"2 s\\\"\"]\n";
    let factor = "[[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nlevels = [\"5 N\", \"10 N\"]\n";
    directory.write("study.toml", format!("{head}{factor}[[response]]\nname = \"y\"\n{response}\n"));
    directory
}

/// Writes the study of a folder again, with one piece of its text replaced.
fn change(directory: &WorkingDirectory, old: &str, new: &str) {
    let text = fs::read_to_string(directory.path("study.toml")).unwrap();
    assert!(text.contains(old), "{old} in {text}");
    directory.write("study.toml", text.replace(old, new));
}

#[test]
fn a_series_that_no_run_records_is_refused_before_the_first_run() {
    for (response, lacking) in [
        ("dataset = \"/series/disc_sq\"\nat = \"end\"", "output.roughness = true"),
        ("dataset = \"/series/friction_coefficient\"\nmean = \"last tenth\"", "a law of friction, table [friction]"),
        ("dataset = \"/event/worn\"\nevent = \"last\"", "a cycle, table [operation.cycle]"),
    ] {
        let directory = loads(response);
        for command in [&["plan"][..], &["run"]] {
            let outcome = ask(&directory, command);
            said(&outcome, 2, &format!("response \"y\": /{}", response.split(['/', '"']).nth(2).unwrap()));
            said(&outcome, 2, &format!("is recorded only with {lacking}; add it to the base scene, or to `set`"));
        }
        assert_eq!(directory.names(), ["quick.toml", "study.toml"]);
    }
    // Where some runs have it the others give no value.
    let directory = loads("dataset = \"/series/disc_sq\"\nat = \"end\"");
    let switch = "[[factor]]\nname = \"told\"\nkey = \"output.roughness\"\nlevels = [false, true]\n[[response]]";
    change(&directory, "[[response]]", switch);
    said(&ask(&directory, &["run"]), 0, "output.roughness = true, which 2 of 4 runs do not have: they give no value");
}

#[test]
fn a_wrong_level_and_a_base_that_is_not_there_are_told_at_their_place() {
    let directory = loads("dataset = \"/series/contact_area\"\nat = \"end\"");
    let text = fs::read_to_string(directory.path("study.toml")).unwrap();
    for (found, given, told) in [
        ("\"10 N\"]", "10]", "study.toml:8:18: factor.levels: 10 has no unit, expected a force"),
        ("\"10 N\"]", "\"10 Nm\"]", "study.toml:8:18: factor.levels: \"10 Nm\" is an energy, expected a force"),
        ("quick.toml", "quik.toml", "study.toml:2:8: base: quik.toml: cannot read the scene"),
    ] {
        directory.write("study.toml", text.replace(found, given));
        for command in ["plan", "run"] {
            said(&ask(&directory, &[command]), 2, told);
        }
    }
}

#[test]
fn a_time_after_the_end_of_runs_is_warned_of() {
    let directory = loads("dataset = \"/series/contact_area\"\nat = \"3 s\"");
    for command in ["plan", "run"] {
        let every = "response \"y\" asks for 3 s, and every run ends at 2 s or before: none has a value of it";
        said(&ask(&directory, &[command]), 0, every);
    }
    change(&directory, "set = [\"operation.duration = \\\"2 s\\\"\"]\n", "");
    let longer = "[[factor]]\nname = \"time\"\nkey = \"operation.duration\"\nlevels = [\"2 s\", \"4 s\"]\n[[response]]";
    change(&directory, "[[response]]", longer);
    said(&ask(&directory, &["plan"]), 0, "and the shortest run ends at 2 s: runs that end before have no value of it");
}

#[test]
fn measurements_are_repeated_without_a_seed_and_runs_are_not() {
    let directory = lab();
    let study = fs::read_to_string(directory.path("study.toml")).unwrap();
    let seeds = "[replicates]\nseeds = [1, 2, 3]\n[[factor]]";
    directory.write("study.toml", study.replacen("[[factor]]", seeds, 1));
    said(&ask(&directory, &["plan"]), 0, "9 points × 3 replicates = 27");
    let directory = loads("dataset = \"/series/contact_area\"\nat = \"end\"");
    change(&directory, "[[factor]]", seeds);
    said(&ask(&directory, &["plan"]), 2, "expected at least one key and one seed");
}
