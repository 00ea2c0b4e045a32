//! `plateau sweep predict`, `optimize` and `import`: what the results of a study answer, as its users ask.

mod centre_points;
mod import;
mod import_over_inputs;
mod limits;

use std::fs;

use plateau_tests::program::{Outcome, WorkingDirectory, scene};
use plateau_tests::run_file::RunFile;
use plateau_tests::table::{number, rows};
use serde_json::Value;

/// Load and fibres about a centre, two sets of surfaces: 18 runs of some milliseconds.
fn study() -> String {
    format!(
        r#"version = 1
title = "Small"
base = "{}"
set = ["operation.duration = '3 s'", "output.sample_every = '0.5 s'"]
design = "central-composite"
directory = "results"

[replicates]
keys = ["disc.surface.synthetic.seed", "pin.base.synthetic.seed"]
seeds = [1, 2]

[[factor]]
name = "load"
key = "operation.normal_force"
range = ["8 N", "20 N"]

[[factor]]
name = "fibres"
key = "pin.base.synthetic.fibre_fraction"
range = [0.2, 0.4]

[[response]]
name = "contact area"
dataset = "/series/contact_area_mean"
at = "end"

[[response]]
name = "worn"
dataset = "/series/worn_pin"
at = "end"
transform = "log"
"#,
        scene("quick.toml")
    )
}

/// A directory with a study, all of whose runs were made.
fn studied() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write("study.toml", study());
    directory.plateau(["sweep", "run", "study.toml"]).quiet_success();
    directory
}

fn json(outcome: &Outcome) -> Value {
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    serde_json::from_str(&outcome.stdout).unwrap_or_else(|error| panic!("{error}: {outcome:?}"))
}

/// `plateau sweep COMMAND study.toml ... --json`.
fn ask(directory: &WorkingDirectory, command: &str, arguments: &[&str]) -> Value {
    let force = ["effects", "optimize"].contains(&command).then_some(&"--force");
    json(&directory.plateau(["sweep", command, "study.toml", "--json"].iter().chain(arguments).chain(force)))
}

/// What is said when a command is refused.
fn refused(directory: &WorkingDirectory, command: &str, arguments: &[&str]) -> String {
    let outcome = directory.plateau(["sweep", command, "study.toml"].iter().chain(arguments));
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(2), ""), "{outcome:?}");
    outcome.stderr
}

/// The value of an equation that `effects --json` gives, where factors have these values.
fn equation(terms: &Value, load: f64, fibres: f64) -> f64 {
    let variable = |name: &str| match name {
        "" => 1.0,
        "load" => load,
        "load²" => load * load,
        "fibres" => fibres,
        "fibres²" => fibres * fibres,
        "load·fibres" => load * fibres,
        other => panic!("{other}"),
    };
    let terms = terms["terms"].as_array().expect("terms").iter();
    terms.map(|term| term["coefficient"].as_f64().unwrap() * variable(term["variables"].as_str().unwrap())).sum()
}

fn value(document: &Value, response: usize) -> f64 {
    document["places"][0]["responses"][response]["value"].as_f64().expect("a value")
}

#[test]
fn predictions_are_those_of_the_equations() {
    let directory = studied();
    let effects = ask(&directory, "effects", &[]);
    let worn = &effects["responses"][1];
    assert_eq!((worn["transform"].as_str(), worn["fitted"].as_str()), (Some("log"), Some("log(worn, 10⁻³ mm³)")));
    let predicted =
        ask(&directory, "predict", &["--at", "load=10 N", "--at", "pin.base.synthetic.fibre_fraction=0.35"]);
    // In the units of the study, and in coded units: 10 N is a third of the way from the middle to the lower end.
    for (units, load, fibres) in [(1, 10.0, 0.35), (0, -2.0 / 3.0, 0.5)] {
        let of = |response: usize| equation(&effects["responses"][response]["equations"][units], load, fibres);
        assert!((of(0) / value(&predicted, 0) - 1.0).abs() < 1e-9);
        // A logarithm of 10⁻³ mm³.
        assert!((of(1).exp() * 1e-12 / value(&predicted, 1) - 1.0).abs() < 1e-9);
    }
    let response = &predicted["places"][0]["responses"][0];
    let ends = |interval: &str| [0, 1].map(|end| response[interval][end].as_f64().expect("an end"));
    let ([low, high], [lowest, highest]) = (ends("mean_interval"), ends("run_interval"));
    assert!(lowest < low && low < value(&predicted, 0) && value(&predicted, 0) < high && high < highest);

    // What is not given is said, and what is beyond is refused.
    let text = directory.plateau(["sweep", "predict", "study.toml", "--at", "load=10 N"]).quiet_success();
    assert!(text.contains("load = 10 N, fibres = 0.3 (not given)") && text.contains("contact area, mm²"), "{text}");
    let beyond = ["--at", "load=25 N"];
    let said = refused(&directory, "predict", &beyond);
    assert!(said.contains("load is beyond 8 to 20 N") && said.contains("--extrapolate"), "{said}");
    let outcome = directory.plateau(["sweep", "predict", "study.toml", "--extrapolate"].iter().chain(&beyond));
    let lines: Vec<&str> = outcome.stdout.lines().filter(|line| line.ends_with("load is beyond 8 to 20 N")).collect();
    assert_eq!(lines.len(), 2, "{outcome:?}");
    for (given, message) in [
        ("lood=10 N", "\"lood\" is not a factor of the study, expected one of load, fibres"),
        ("load=10", "load = 10: expected a quantity such as \"8 N\""),
        ("load=10 kg", "load = 10 kg: expected a quantity such as \"8 N\""),
        ("fibres=many", "fibres = many: expected a plain number"),
        ("load", "expected a factor and its value"),
    ] {
        let said = refused(&directory, "predict", &["--at", given]);
        assert!(said.contains(message), "{given}: {said}");
    }

    // Tables: a grid has the corners, points their lines.
    directory.plateau(["sweep", "predict", "study.toml", "--grid", "3", "-o", "grid.csv"]).quiet_success();
    let grid = rows(&fs::read_to_string(directory.path("grid.csv")).unwrap());
    assert_eq!(grid.len(), 9);
    assert_eq!([number(&grid[8], "load [N]"), number(&grid[8], "fibres")], [20.0, 0.4]);
    let corner = ask(&directory, "predict", &["--at", "load=20 N", "--at", "fibres=0.4"]);
    assert_eq!(number(&grid[8], "contact area [m2]"), value(&corner, 0));
    directory.write("points.csv", "load [kN],fibres\n0.010,0.35\n");
    directory.plateau(["sweep", "predict", "study.toml", "--points", "points.csv", "-o", "at.csv"]).quiet_success();
    let at = rows(&fs::read_to_string(directory.path("at.csv")).unwrap());
    assert!((number(&at[0], "contact area [m2]") / value(&predicted, 0) - 1.0).abs() < 1e-12);
    let said = refused(&directory, "predict", &["--points", "points.csv", "-o", "at.csv"]);
    assert!(said.contains("exists; give --force"), "{said}");
}

#[test]
fn a_prediction_is_confirmed_by_runs_that_are_made_once() {
    let directory = studied();
    let arguments = ["--at", "load=14 N", "--at", "fibres=0.25", "--confirm", "--jobs", "1"];
    let confirmed = ask(&directory, "predict", &arguments);
    let area = &confirmed["places"][0]["confirmed"][0];
    // The same two runs by hand.
    let areas = ["1", "2"].map(|seed| {
        let sets = [
            "operation.duration=3 s".to_owned(),
            "output.sample_every=0.5 s".to_owned(),
            "operation.normal_force=14 N".to_owned(),
            "pin.base.synthetic.fibre_fraction=0.25".to_owned(),
            format!("disc.surface.synthetic.seed={seed}"),
            format!("pin.base.synthetic.seed={seed}"),
        ];
        let file = format!("{seed}.h5");
        let mut arguments = vec!["run".to_owned(), scene("quick.toml"), "-o".to_owned(), file.clone()];
        arguments.extend(sets.into_iter().flat_map(|set| ["--set".to_owned(), set]));
        directory.plateau(arguments).quiet_success();
        *RunFile::open(directory.path(&file)).floats("/series/contact_area_mean").last().unwrap()
    });
    let mean = (areas[0] + areas[1]) / 2.0;
    assert!((area["mean"].as_f64().unwrap() / mean - 1.0).abs() < 1e-12);
    // Of two values the standard error of the mean is half their distance.
    let error = (areas[0] - areas[1]).abs() / 2.0;
    assert!((area["standard_error"].as_f64().unwrap() / error - 1.0).abs() < 1e-6);
    let interval = &confirmed["places"][0]["responses"][0]["run_interval"];
    let within = (interval[0].as_f64().unwrap()..=interval[1].as_f64().unwrap()).contains(&mean);
    assert_eq!(area["within_run_interval"].as_bool(), Some(within));

    // They are kept apart from the design, and asking again makes none.
    let journal = |folder: &str| -> Vec<String> {
        let shards = fs::read_dir(directory.path(folder))
            .unwrap()
            .map(|shard| fs::read_to_string(shard.unwrap().path()).unwrap());
        shards.flat_map(|text| text.lines().map(str::to_owned).collect::<Vec<_>>()).collect()
    };
    assert_eq!((journal("results/journal").len(), journal("results/confirm/journal").len()), (18, 2));
    assert_eq!(ask(&directory, "predict", &arguments), confirmed);
    assert_eq!(journal("results/confirm/journal").len(), 2);
    assert_eq!(
        ask(&directory, "predict", &arguments[..4])["places"][0]["responses"],
        confirmed["places"][0]["responses"],
        "the fit is not made of them"
    );

    // A table of places, with this one twice: all of them are confirmed in one call.
    directory.write("places.csv", "load [N],fibres\n14,0.25\n9,0.4\n14,0.25\n");
    let table = ["--points", "places.csv", "--confirm", "-o", "out.csv", "--jobs", "1"];
    let places = &ask(&directory, "predict", &table)["places"];
    assert_eq!(journal("results/confirm/journal").len(), 4);
    for same in [0, 2] {
        assert_eq!(places[same]["confirmed"], confirmed["places"][0]["confirmed"], "place {same}");
    }
    let [first, other] = [0, 1].map(|place| places[place]["confirmed"][0]["mean"].as_f64().unwrap());
    assert!(first != other);
    let written = fs::read_to_string(directory.path("out.csv")).unwrap();
    let mut lines = written.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let column = |name: &str| head.iter().position(|head| *head == name).unwrap_or_else(|| panic!("{name}: {head:?}"));
    let [mean, runs] = [column("contact area confirmed [m2]"), column("contact area confirmed runs")];
    let rows: Vec<Vec<&str>> = lines.collect();
    let means: Vec<f64> = rows.iter().map(|row| row[mean].parse().unwrap()).collect();
    assert_eq!(means, [first, other, first]);
    assert!(rows.iter().all(|row| row[runs] == "2"), "{rows:?}");
    let text = directory.plateau([&["sweep", "predict", "study.toml"], &table[..], &["--force"]].concat());
    assert!(text.stdout.contains("of 3") && text.stdout.contains("places within the interval of runs"), "{text:?}");
}

#[test]
fn names_and_words_may_have_an_equals_sign_or_a_comma_in_them() {
    let directory = studied();
    let study = fs::read_to_string(directory.path("study.toml")).unwrap();
    directory.write("study.toml", study.replace("name = \"load\"", "name = \"F=N\""));
    let at = |given: &str| ask(&directory, "predict", &["--at", given])["places"][0]["settings"][0].clone();
    assert_eq!(at("F=N=14 N")["number"].as_f64(), Some(14.0));
    assert_eq!(at(" F=N = 14 N ")["given"].as_bool(), Some(true));
    let unknown = directory.plateau(["sweep", "predict", "study.toml", "--at", "F=14 N"]);
    assert!(unknown.status == Some(2) && unknown.stderr.contains("\"F\" is not a factor"), "{unknown:?}");

    directory.write("study.toml", study.replace("name = \"load\"", "name = \"load, total\""));
    for contour in ["fibres,load, total", "load, total, fibres"] {
        ask(&directory, "optimize", &["--maximize", "contact area", "--contour", contour]);
        let figure = fs::read_to_string(directory.path("results/optimum/contour.svg")).unwrap();
        assert!(figure.contains("load, total"), "{contour}");
    }
    directory.write("study.toml", study.replace("name = \"load\"", "name = \" \""));
    assert!(refused(&directory, "plan", &[]).contains("factor.name: the name is empty, expected a word"));
}

#[test]
fn an_optimum_keeps_limits_and_what_is_held() {
    let directory = studied();
    // Both load and fibres add contact area, so the most is at their upper ends.
    let best = ask(&directory, "optimize", &["--maximize", "contact area"]);
    let settings =
        |document: &Value| [0, 1].map(|factor| document["settings"][factor]["number"].as_f64().expect("a number"));
    assert_eq!(settings(&best), [20.0, 0.4]);
    let predicted = ask(&directory, "predict", &["--at", "load=20 N", "--at", "fibres=0.4"]);
    assert_eq!(best["responses"][0]["value"].as_f64(), Some(value(&predicted, 0)));
    for figure in ["profiler", "contour"] {
        for ending in ["png", "svg", "pdf"] {
            assert!(directory.path(&format!("results/optimum/{figure}.{ending}")).is_file(), "{figure}.{ending}");
        }
    }
    // Worn volume grows with the load alone: the limit binds there, and the fibres stay at their end.
    let limited = ask(&directory, "optimize", &["--maximize", "contact area", "--limit", "worn<=4e-3 mm^3"]);
    let worn = limited["responses"][1]["value"].as_f64().unwrap();
    assert!(worn <= 4e-12 && worn > 3.999e-12, "{worn}");
    assert!(limited["keeps_limits"].as_bool() == Some(true) && settings(&limited)[1] == 0.4);
    let held = ask(&directory, "optimize", &["--maximize", "contact area", "--hold", "load=9 N"]);
    assert_eq!(settings(&held), [9.0, 0.4]);
    // Two goals against each other: of geometric mean desirability, by the values that are said.
    let both =
        ask(&directory, "optimize", &["--maximize", "contact area", "--minimize", "worn", "--importance", "worn=3"]);
    let worth = [0, 1].map(|goal| both["goals"][goal]["desirability"].as_f64().unwrap());
    let mean = (worth[0] * worth[1].powi(3)).powf(0.25);
    assert!((both["desirability"].as_f64().unwrap() - mean).abs() < 1e-12);
    let text = directory.plateau([
        "sweep",
        "optimize",
        "study.toml",
        "--target",
        "contact area=0.7 mm2",
        "--contour",
        "fibres,load",
        "--force",
    ]);
    assert!(text.stdout.contains("near 0.7,") && text.stdout.contains("2 figures as PNG, SVG and PDF"), "{text:?}");
    for (arguments, message) in [
        (
            &["--maximize", "area"][..],
            "\"area\" is not a response of the study, expected one of \"contact area\", \"worn\"",
        ),
        (&["--maximize", "contact area=1..2"], "expected a unit of"),
        (&["--maximize", "contact area=2 mm2..1 mm2"], "expected values that ascend"),
        (&["--target", "contact area=9 mm2"], "to aim beyond them"),
        (&["--limit", "worn<=1 mm3"], "no goal"),
        (&["--maximize", "worn", "--minimize", "worn"], "has two goals"),
        (&["--maximize", "worn", "--limit", "worn=1"], "expected \"NAME<=VALUE\" or \"NAME>=VALUE\""),
        (&["--maximize", "worn", "--hold", "load=30 N"], "load is beyond 8 to 20 N"),
        (&["--maximize", "worn", "--contour", "load,load"], "two different factors"),
        (&["--maximize", "worn", "--contour", "load"], "expected two factors with a comma between"),
        (&["--maximize", "worn", "--weight", "worn=-1"], "expected a number between 0.01 and 100"),
    ] {
        let said = refused(&directory, "optimize", &[arguments, &["--force"]].concat());
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}

#[test]
fn terms_are_chosen_and_transforms_are_said() {
    let directory = studied();
    let text = directory.plateau(["sweep", "effects", "study.toml", "--terms", "aicc"]).quiet_success();
    assert!(text.contains("all results are those of log(worn, 10⁻³ mm³)"), "{text}");
    // Fibres do nothing to what is worn: their product with the load is the first to go.
    let (_, worn) = text.split_once("\nworn\n").expect("the response");
    let left_out = worn.lines().find(|line| line.starts_with("  terms left out: ")).expect("terms");
    assert!(left_out.contains("load × fibres") && !left_out.contains("load²"), "{left_out}");
    assert!(!worn.contains("load·fibres"), "{worn}");

    // A response that its transform is not for: the pin's resin does not wear in the first second, nor the disc ever.
    let wrong = study().replace("/series/worn_pin", "/series/worn_disc");
    directory.write("study.toml", &wrong);
    let said = refused(&directory, "effects", &["--force"]);
    assert!(said.contains("response \"worn\": run 1 has the response 0") && said.contains("more than 0"), "{said}");
    directory.write("study.toml", wrong.replace("\"log\"", "\"logit\""));
    assert!(refused(&directory, "effects", &["--force"]).contains("\"logit\" is for fractions between 0 and 1"));
    directory.write("study.toml", wrong.replace("\"log\"", "\"lug\""));
    let said = refused(&directory, "effects", &["--force"]);
    assert!(said.contains("\"lug\", expected one of \"log\", \"square root\", \"logit\""), "{said}");
}

/// A wave, which no polynomial of second order follows, and a polynomial of second order, at points all over a range.
#[test]
fn points_all_over_a_range_are_forecast_by_what_forecasts_them_better() {
    let directory = WorkingDirectory::new();
    let wave = |x: f64| (9.0 * x).sin();
    let square = |x: f64| 1.0 + 2.0 * x - 3.0 * x * x;
    let mut table = "fibres,wave,square\n".to_owned();
    for point in 0..16 {
        let x = (f64::from(point) + 0.5) / 16.0;
        table.push_str(&format!("{x},{},{}\n", wave(x), square(x)));
    }
    directory.write("points.csv", table);
    let mut study =
        "version = 1\ntitle = \"Wave\"\ndesign = \"csv\"\nfile = \"points.csv\"\ndirectory = \"results\"\n".to_owned();
    study.push_str("[[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\n");
    study
        .push_str("[[response]]\nname = \"wave\"\nimported = true\n[[response]]\nname = \"square\"\nimported = true\n");
    directory.write("study.toml", study);
    ask(&directory, "import", &["points.csv"]);
    let predicted = ask(&directory, "predict", &["--at", "fibres=0.4"]);
    assert_eq!(predicted["models"][0].as_str(), Some("Gaussian process"), "{predicted}");
    assert_ne!(predicted["models"][1].as_str(), Some("Gaussian process"), "{predicted}");
    // A sixteenth of a range is a twelfth of the wave's length: a smooth interpolation misses by far less than a hundredth.
    assert!((value(&predicted, 0) - wave(0.4)).abs() < 0.01, "{predicted}");
    assert!((value(&predicted, 1) - square(0.4)).abs() < 1e-9, "{predicted}");
    let text = directory.plateau(["sweep", "predict", "study.toml", "--at", "fibres=0.4"]).quiet_success();
    assert!(text.contains("wave: leave-one-out error: ") && text.contains("the smaller one is taken"), "{text}");
    // Who asks for a model gets it.
    let asked = ask(&directory, "predict", &["--at", "fibres=0.4", "--model", "quadratic"]);
    assert_ne!(asked["models"][0].as_str(), Some("Gaussian process"), "{asked}");
}
