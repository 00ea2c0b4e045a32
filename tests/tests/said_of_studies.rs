//! What is said where a study asks for what cannot be: numbers without rows of zeros, names with signs, and what to do next.

use std::fs;

use plateau_tests::program::{Outcome, WorkingDirectory, scene};

const FACTORS: &str = "[[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nrange = [\"5 N\", \"15 N\"]\n\
                       [[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\nrange = [0.2, 0.4]\n";

/// A study of imported responses of these names, with values of all.
fn lab(names: &[&str], more: &str, value: fn(f64, f64) -> f64) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let responses: String =
        names.iter().map(|name| format!("[[response]]\nname = \"{name}\"\nimported = true\n{more}")).collect();
    let head =
        "version = 1\ntitle = \"Lab\"\ndesign = \"central-composite\"\ncentre_points = 3\ndirectory = \"results\"\n";
    directory.write("study.toml", format!("{head}{FACTORS}{responses}"));
    let places = [[5.0, 0.2], [15.0, 0.2], [5.0, 0.4], [15.0, 0.4], [5.0, 0.3], [15.0, 0.3], [10.0, 0.2], [10.0, 0.4]];
    let mut table = format!("load [N],fibres,{}\n", names.join(","));
    for (line, [load, fibres]) in places.into_iter().chain([[10.0, 0.3]; 3]).enumerate() {
        let cells = vec![format!("{:e}", value(load, fibres) * (1.0 + 0.001 * line as f64)); names.len()];
        table.push_str(&format!("{load},{fibres},{}\n", cells.join(",")));
    }
    directory.write("table.csv", table);
    directory
}

fn import(directory: &WorkingDirectory) {
    directory.plateau(["sweep", "import", "study.toml", "table.csv"]).quiet_success();
}

fn ask(directory: &WorkingDirectory, arguments: &[&str]) -> Outcome {
    directory.plateau([&["sweep", arguments[0], "study.toml"], &arguments[1..]].concat())
}

fn said(outcome: &Outcome, status: i32, words: &str) {
    assert_eq!(outcome.status, Some(status), "{outcome:?}");
    assert!(outcome.stdout.contains(words) || outcome.stderr.contains(words), "{words}: {outcome:?}");
}

#[test]
fn names_with_signs_are_goals_as_others() {
    let directory = lab(&["a", "a=b", "x<=1", "c>=d"], "", |load, fibres| load * fibres);
    import(&directory);
    for goal in [
        &["--maximize", "a=b"][..],
        &["--target", "a=b=2"],
        &["--maximize", "x<=1", "--limit", "x<=1<=4"],
        &["--minimize", "a", "--limit", "c>=d>=2", "--importance", "a=2"],
        &["--maximize", "a=b", "--maximize", "a=1..3", "--weight", "a=b=2"],
    ] {
        let outcome = ask(&directory, &[&["optimize", "--force"], goal].concat());
        assert_eq!(outcome.status, Some(0), "{goal:?}: {outcome:?}");
    }
    said(&ask(&directory, &["optimize", "--force", "--maximize", "e=1..2"]), 2, "\"e\" is not a response of the study");
}

#[test]
fn what_to_do_without_results_depends_on_where_they_come_from() {
    let directory = lab(&["y"], "", |load, fibres| load * fibres);
    said(&ask(&directory, &["collect"]), 0, "plateau sweep import takes in their responses");
}

#[test]
fn numbers_beyond_all_measure_are_told_as_such() {
    let directory = lab(&["y"], "", |load, fibres| load * fibres);
    import(&directory);
    let far = ask(&directory, &["predict", "--at", "load=1e308 N", "--extrapolate"]);
    said(&far, 2, "too far from the range, 5 N … 15 N");
    said(&ask(&directory, &["predict", "--confidence", "0.9999999999999999"]), 0, "99.99999999999999 % of means");
    let directory = lab(&["y"], "transform = \"log\"\n", |load, fibres| 1e300 * 10.0_f64.powf(load / 3.0) * fibres);
    import(&directory);
    let beyond = ask(&directory, &["predict", "--at", "load=100 N", "--extrapolate"]);
    said(&beyond, 0, "∞");
    assert!(!beyond.stdout.contains("inf"), "{beyond:?}");
    let quick = scene("quick.toml");
    for set in ["mesh.inner_radius=1e300 m", "output.maps_at=[\"1e300 s\"]"] {
        let outcome = directory.plateau(["check", &quick, "--set", set]);
        assert!(outcome.stderr.contains("1e300") && !outcome.stderr.contains("000000000"), "{outcome:?}");
    }
}

#[test]
fn a_measurement_that_no_number_fits_is_named() {
    let directory = WorkingDirectory::new();
    let study = |response: &str| {
        format!(
            "version = 1\ntitle = \"A fit\"\nbase = \"{}\"\ndesign = \"sobol\"\npoints = 5\ndirectory = \"results\"\n\
             set = [\"operation.duration = '1 s'\", \"output.sample_every = '0.1 s'\"]\n{FACTORS}\
             [[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\n{response}[fit]\nruns = 5\n",
            scene("quick.toml")
        )
    };
    for measured in
        ["at = \"end\"\nmeasured = 1e-13\nuncertainty = 1e-300\n", "at = \"end\"\nmeasured = 1e300\nuncertainty = 1\n"]
    {
        directory.write("study.toml", study(measured));
        let refused = directory.plateau(["fit", "study.toml"]);
        said(&refused, 2, "response \"worn\" was measured as");
        said(&refused, 2, "look at the units and the uncertainties");
    }
    directory.write("worn.csv", "time [s],worn [m3],uncertainty [m3]\n0.5,1e-14,1e-300\n1,2e-14,1e-300\n");
    directory.write("study.toml", study("measured_file = \"worn.csv\"\n"));
    said(
        &directory.plateau(["fit", "study.toml"]),
        2,
        "response \"worn\": what was measured and what runs give differ",
    );
}

/// A study of a rig with two values of each factor and two sets of specimens, and its table.
fn two_values() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let seeds = "[replicates]\nkeys = [\"disc.surface.synthetic.seed\"]\nseeds = [1, 2]\n";
    let response = "[[response]]\nname = \"y\"\nimported = true\n";
    let head = "version = 1\ntitle = \"Two\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n";
    directory.write("study.toml", format!("{head}{seeds}{FACTORS}{response}"));
    let values = [[1.0, 1.3], [2.0, 1.95], [3.0, 3.25], [4.0, 3.95]];
    let mut table = "load [N],fibres,replicate,y\n".to_owned();
    for ([load, fibres], own) in [[5.0, 0.2], [15.0, 0.2], [5.0, 0.4], [15.0, 0.4]].into_iter().zip(values) {
        for (replicate, value) in own.into_iter().enumerate() {
            table.push_str(&format!("{load},{fibres},{},{value}\n", replicate + 1));
        }
    }
    directory.write("table.csv", table);
    import(&directory);
    directory
}

#[test]
fn two_values_of_a_factor_are_said_to_show_no_curve() {
    let directory = two_values();
    let both = "load, fibres: the runs have two values of each, so that they show no curve";
    said(&ask(&directory, &["predict"]), 0, both);
    said(&ask(&directory, &["predict", "--at", "load=5 N"]), 0, "warning: fibres: the runs have two values of it");
    let at_a_run = ask(&directory, &["predict", "--at", "load=5 N", "--at", "fibres=0.4"]);
    assert!(at_a_run.status == Some(0) && at_a_run.stderr.is_empty(), "{at_a_run:?}");
    said(&ask(&directory, &["optimize", "--maximize", "y", "--force"]), 0, both);
    let held = ask(&directory, &["optimize", "--maximize", "y", "--hold", "fibres=0.2", "--force"]);
    said(&held, 0, "warning: load: the runs have two values of it");
    let three = lab(&["y"], "", |load, fibres| load * fibres);
    import(&three);
    assert_eq!(ask(&three, &["predict", "--at", "load=7 N"]).stderr, "");
}

#[test]
fn an_interval_of_means_as_wide_as_that_of_runs_is_explained() {
    let found = ask(&two_values(), &["predict"]);
    said(&found, 0, "y: so few sets of seeds hardly tell by how much others would differ");
    let many = lab(&["y"], "", |load, fibres| load * fibres);
    import(&many);
    assert!(!ask(&many, &["predict"]).stdout.contains("sets of seeds"));
}

#[test]
fn levels_in_quotes_are_words_and_others_numbers() {
    let directory = WorkingDirectory::new();
    let factor = "[[factor]]\nname = \"grade\"\nlevels = [1, 2, 10]\n";
    let response = "[[response]]\nname = \"y\"\nimported = true\n";
    let head = "version = 1\ndesign = \"full-factorial\"\ndirectory = \"results\"\n";
    let load = &FACTORS[..FACTORS.rfind("[[factor]]").unwrap()];
    directory.write("study.toml", format!("{head}{factor}{load}{response}"));
    directory.write("table.csv", "grade,load [N],y\n1,5,1\n2,5,1.9\n10,5,10.3\n1,15,2.1\n2,15,3.2\n10,15,11\n");
    import(&directory);
    said(&ask(&directory, &["predict", "--at", "grade=2"]), 0, "grade = 2");
    let between = ask(&directory, &["predict", "--at", "grade=5"]);
    said(&between, 2, "the model knows the levels 1, 2, 10 alone; --model quadratic tells what lies between them");
    said(&ask(&directory, &["predict", "--at", "grade=5", "--model", "quadratic"]), 0, "grade = 5");
    // As words they are three that have nothing between them.
    let words =
        fs::read_to_string(directory.path("study.toml")).unwrap().replace("[1, 2, 10]", "[\"1\", \"2\", \"10\"]");
    directory.write("study.toml", words);
    import(&directory);
    said(&ask(&directory, &["predict", "--at", "grade=2"]), 0, "grade = 2");
    said(&ask(&directory, &["predict", "--at", "grade=5"]), 2, "grade = 5: expected one of 1, 2, 10");
}

#[test]
fn keys_and_names_that_nobody_would_find_again_are_told() {
    let directory = lab(&["y"], "", |load, fibres| load * fibres);
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
fn a_place_that_is_a_point_of_the_study_confirms_nothing() {
    let directory = loads("dataset = \"/series/contact_area\"\nat = \"end\"");
    change(&directory, "levels = [\"5 N\", \"10 N\"]", "range = [\"5 N\", \"10 N\"]");
    said(&ask(&directory, &["run"]), 0, "finished now");
    let known = ask(&directory, &["predict", "--at", "load=10 N", "--confirm"]);
    said(&known, 0, "the fit has used them, so they confirm nothing");
    said(&known, 0, "Compared with one extra run, which tells no error");
    let between = ask(&directory, &["predict", "--at", "load=7 N", "--confirm"]);
    assert!(between.status == Some(0) && !between.stderr.contains("confirm nothing"), "{between:?}");
}
