//! `plateau sweep predict`, `optimize` and `import`: what the results of a study answer, as its users ask.

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
    json(&directory.plateau(["sweep", command, "study.toml", "--json"].iter().chain(arguments)))
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
        ("lood=10 N", "\"lood\" is no factor of the study, expected one of load, fibres"),
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
    let arguments = ["--at", "load=14 N", "--at", "fibres=0.25", "--confirm"];
    let confirmed = ask(&directory, "predict", &arguments);
    let area = &confirmed["confirmed"][0];
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
    assert_eq!(ask(&directory, "predict", &arguments)["confirmed"], confirmed["confirmed"]);
    assert_eq!(journal("results/confirm/journal").len(), 2);
    assert_eq!(
        ask(&directory, "predict", &arguments[..4])["places"],
        confirmed["places"],
        "the fit is not made of them"
    );
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
    ]);
    assert!(text.stdout.contains("near 0.7,") && text.stdout.contains("2 figures as PNG, SVG and PDF"), "{text:?}");
    for (arguments, message) in [
        (
            &["--maximize", "area"][..],
            "\"area\" is no response of the study, expected one of \"contact area\", \"worn\"",
        ),
        (&["--maximize", "contact area=1..2"], "expected a unit of"),
        (&["--maximize", "contact area=2 mm2..1 mm2"], "expected values that ascend"),
        (&["--target", "contact area=9 mm2"], "to aim beyond them"),
        (&["--limit", "worn<=1 mm3"], "no goal"),
        (&["--maximize", "worn", "--minimize", "worn"], "has two goals"),
        (&["--maximize", "worn", "--limit", "worn=1"], "expected \"NAME<=VALUE\" or \"NAME>=VALUE\""),
        (&["--maximize", "worn", "--hold", "load=30 N"], "load is beyond 8 to 20 N"),
        (&["--maximize", "worn", "--contour", "load,load"], "two different factors"),
        (&["--maximize", "worn", "--weight", "worn=-1"], "expected a number between 0.01 and 100"),
    ] {
        let said = refused(&directory, "optimize", arguments);
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}

#[test]
fn terms_are_chosen_and_transforms_are_said() {
    let directory = studied();
    let text = directory.plateau(["sweep", "effects", "study.toml", "--terms", "aicc"]).quiet_success();
    assert!(text.contains("all results are those of log(worn, 10⁻³ mm³)"), "{text}");
    // Fibres do nothing to what is worn: their product with the load is the first to go.
    let (_, worn) = text.split_once("\nworn (m3)\n").expect("the response");
    let left_out = worn.lines().find(|line| line.starts_with("  terms left out: ")).expect("terms");
    assert!(left_out.contains("load × fibres") && !left_out.contains("load²"), "{left_out}");
    assert!(!worn.contains("load·fibres"), "{worn}");

    // A response that its transform is not for: the pin's resin does not wear in the first second, nor the disc ever.
    let wrong = study().replace("/series/worn_pin", "/series/worn_disc");
    directory.write("study.toml", &wrong);
    let said = refused(&directory, "effects", &[]);
    assert!(said.contains("response \"worn\": run 1 has the response 0") && said.contains("more than 0"), "{said}");
    directory.write("study.toml", wrong.replace("\"log\"", "\"logit\""));
    assert!(refused(&directory, "effects", &[]).contains("\"logit\" is for fractions between 0 and 1"));
    directory.write("study.toml", wrong.replace("\"log\"", "\"lug\""));
    let said = refused(&directory, "effects", &[]);
    assert!(said.contains("\"lug\", expected one of \"log\", \"square root\", \"logit\""), "{said}");
}

/// The rubber compounds of Derringer and Suich (1980), as a table that is the design, too: three keys that hold plain numbers
/// stand for silica, silane and sulphur in coded units.
const RUBBER: &str = "silica,silane,sulphur,abrasion,modulus,elongation,hardness
-1,-1,1,102,900,470,67.5
1,-1,-1,120,860,410,65
-1,1,-1,117,800,570,77.5
1,1,1,198,2294,240,74.5
-1,-1,-1,103,490,640,62.5
1,-1,1,132,1289,270,67
-1,1,1,132,1270,410,78
1,1,-1,139,1090,380,70
-1.633,0,0,102,770,590,76
1.633,0,0,154,1690,260,70
0,-1.633,0,96,700,520,63
0,1.633,0,163,1540,380,75
0,0,-1.633,116,2184,520,65
0,0,1.633,153,1784,290,71
0,0,0,133,1300,380,70
0,0,0,133,1300,380,68.5
0,0,0,140,1145,430,68
0,0,0,142,1090,430,68
0,0,0,145,1260,390,69
0,0,0,142,1344,390,70
";

/// A study of it without a scene.
fn rubber() -> WorkingDirectory {
    let mut study =
        "version = 1\ntitle = \"Rubber\"\ndesign = \"csv\"\nfile = \"rubber.csv\"\ndirectory = \"results\"\n"
            .to_owned();
    let factors = [
        ("silica", "pin.base.synthetic.fibre_fraction"),
        ("silane", "plateaus.captured_fraction"),
        ("sulphur", "numerics.time_acceleration"),
    ];
    for (name, key) in factors {
        study.push_str(&format!("[[factor]]\nname = \"{name}\"\nkey = \"{key}\"\n"));
    }
    for name in ["abrasion", "modulus", "elongation", "hardness"] {
        study.push_str(&format!("[[response]]\nname = \"{name}\"\nimported = true\n"));
    }
    let directory = WorkingDirectory::new();
    directory.write("study.toml", study);
    directory.write("rubber.csv", RUBBER);
    directory
}

#[test]
fn measured_responses_are_analysed_without_a_scene() {
    let directory = rubber();
    let said = refused(&directory, "run", &[]);
    assert!(said.contains("no base scene, so there is nothing to run"), "{said}");
    let taken = ask(&directory, "import", &["rubber.csv"]);
    let counts = ["lines", "new", "changed", "runs", "complete"].map(|key| taken[key].as_u64());
    assert_eq!(counts, [20, 80, 0, 20, 20].map(Some));
    // Six runs at the centre are six measurements, not one: they tell the pure error, of five degrees of freedom.
    let effects = ask(&directory, "effects", &["--model", "quadratic"]);
    assert_eq!(effects["responses"][0]["runs"].as_u64(), Some(20));
    assert!(directory.path("results/effects/abrasion-surface.png").is_file());
    let best = ask(
        &directory,
        "optimize",
        &[
            "--model",
            "quadratic",
            "--maximize",
            "abrasion=120..170",
            "--maximize",
            "modulus=1000..1300",
            "--target",
            "elongation=400..500..600",
            "--target",
            "hardness=60..67.5..75",
        ],
    );
    // Published, rounded: (−0.05, 0.145, −0.868), 0.583.
    for (factor, published) in [-0.05, 0.145, -0.868].into_iter().enumerate() {
        let found = best["settings"][factor]["number"].as_f64().unwrap();
        assert!((found - published).abs() < 0.01, "{found} {published}");
    }
    assert!((best["desirability"].as_f64().unwrap() - 0.583).abs() < 0.0006);
    let collected = ask(&directory, "collect", &[]);
    assert_eq!((collected["finished"].as_u64(), collected["missing"].as_u64()), (Some(20), Some(0)));
    let table = rows(&fs::read_to_string(directory.path("results/results.csv")).unwrap());
    assert_eq!((table.len(), number(&table[3], "modulus")), (20, 2294.0));
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

#[test]
fn tables_that_fit_no_point_are_refused_by_line() {
    let directory = rubber();
    let head = RUBBER.lines().next().unwrap();
    for (lines, message) in [
        ("0,0,0.5,1,1,1,1", "t.csv:2: sulphur = 0.5 is in no point of the design, which has 1, -1, 0, -1.633, 1.633"),
        ("1,1,0,1,1,1,1", "t.csv:2: no point of the design has these levels together"),
        ("1,1,1,1,1,1,1\n1,1,1,2,2,2,2", "t.csv:3: the design has this point once, and lines before have it as often"),
        ("1,1,1,1,one,1,1", "t.csv:2: \"modulus\" is \"one\", expected a number"),
        ("1,1,,1,1,1,1", "t.csv:2: \"sulphur\" is empty"),
        ("1,1,1,1,1", "t.csv:2: "),
    ] {
        directory.write("t.csv", format!("{head}\n{lines}\n"));
        let said = refused(&directory, "import", &["t.csv"]);
        assert!(said.contains(message), "{lines}: {said}");
        assert!(!directory.path("results").exists(), "nothing is kept of a table that is refused");
    }
    for (head, message) in [
        ("silica,silane,abrasion", "no column of the factor \"sulphur\""),
        ("silica,silane,sulphur,abrasian", "column \"abrasian\" is no factor and no response with imported = true"),
        ("silica,silane,sulphur", "no column of a response with imported = true"),
        ("silica,silane,sulphur,abrasion [mm2]", "expected \"abrasion\", with the unit that the study gives"),
    ] {
        let cells = vec!["1"; head.split(',').count()].join(",");
        directory.write("t.csv", format!("{head}\n{cells}\n"));
        let said = refused(&directory, "import", &["t.csv"]);
        assert!(said.contains(message), "{head}: {said}");
    }
    // Part after part; a value that differs only with --force. A line that is rounded is of its point.
    directory.write("t.csv", "silica,silane,sulphur,modulus\n1,1,1,5\n-1.6330001,0,0,6\n");
    assert_eq!(ask(&directory, "import", &["t.csv"])["new"].as_u64(), Some(2));
    let said = refused(&directory, "import", &["rubber.csv"]);
    assert!(said.contains("rubber.csv:5: 5 was imported before and 2294 differs; --force replaces it"), "{said}");
    let forced = ask(&directory, "import", &["rubber.csv", "--force"]);
    assert_eq!((forced["new"].as_u64(), forced["changed"].as_u64()), (Some(78), Some(2)));
    assert_eq!(
        ask(&directory, "import", &["rubber.csv"])["changed"].as_u64(),
        Some(0),
        "the same again changes nothing"
    );
}
