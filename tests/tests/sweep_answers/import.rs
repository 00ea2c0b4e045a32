//! `plateau sweep import`: responses from elsewhere, with and without a scene.

use std::fs;

use plateau_tests::program::WorkingDirectory;
use plateau_tests::table::{number, rows};

use super::{ask, refused};

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
    // They were measured in the order of the table, and lie on a composite design, for which a polynomial is made.
    let residuals = rows(&fs::read_to_string(directory.path("results/effects/residuals.csv")).unwrap());
    assert!(residuals.len() == 80 && residuals.iter().all(|row| row["run"] == row["made_as"]), "{residuals:?}");
    let models = ask(&directory, "predict", &[])["models"].to_string();
    assert!(!models.contains("Gaussian"), "{models}");
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
    // It lies between the levels of the table, and is marked there.
    let contour = fs::read_to_string(directory.path("results/optimum/contour.svg")).unwrap();
    assert!(contour.contains("optimum"), "no mark at the optimum");
    // One factor less to look at has no contour: that of the call before does not stay beside the new profiler.
    assert!(directory.path("results/optimum/contour.png").is_file());
    let held = ["--maximize", "abrasion", "--hold", "silica=0", "--hold", "silane=0"];
    let said = refused(&directory, "optimize", &held);
    assert!(said.contains("results/optimum has the files of an earlier call; give --force to replace them"), "{said}");
    ask(&directory, "optimize", &held);
    assert!(!directory.path("results/optimum/contour.png").exists());
    let said = refused(&directory, "effects", &[]);
    assert!(said.contains("results/effects has the files of an earlier call; give --force"), "{said}");
    let collected = ask(&directory, "collect", &[]);
    assert_eq!((collected["finished"].as_u64(), collected["missing"].as_u64()), (Some(20), Some(0)));
    let table = rows(&fs::read_to_string(directory.path("results/results.csv")).unwrap());
    assert_eq!((table.len(), number(&table[3], "modulus")), (20, 2294.0));
}

#[test]
fn results_that_are_collected_replace_what_was_collected_and_nothing_else() {
    let directory = rubber();
    ask(&directory, "import", &["rubber.csv"]);
    ask(&directory, "collect", &[]);
    ask(&directory, "collect", &[]);
    // The lab's own table has the name that the results would have.
    fs::create_dir(directory.path("lab")).unwrap();
    directory.write("lab/results.csv", RUBBER);
    let said = refused(&directory, "collect", &["-o", "lab"]);
    assert!(said.contains("lab/results.csv exists; give --force to replace it"), "{said}");
    // It is the points of the study: not even with --force.
    let study = fs::read_to_string(directory.path("study.toml")).unwrap();
    directory.write("study.toml", study.replace("rubber.csv", "lab/results.csv"));
    let said = refused(&directory, "collect", &["-o", "lab", "--force"]);
    assert!(said.contains("lab/results.csv is an input and is not replaced"), "{said}");
    assert_eq!(fs::read_to_string(directory.path("lab/results.csv")).unwrap(), RUBBER);
    assert!(!directory.path("lab/results.h5").exists());
}

/// A lab's table of a factorial with two lines for each point: `point` gives the response at coded places and line.
fn factorial(friction: impl Fn([f64; 3], usize) -> f64) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let factors = [
        ("load", "operation.normal_force", "levels = [\"20 N\", \"60 N\"]"),
        ("speed", "operation.rotational_speed", "levels = [\"400 rpm\", \"1200 rpm\"]"),
        ("fibres", "pin.base.synthetic.fibre_fraction", "range = [0.2, 0.4]"),
    ];
    let factors =
        factors.map(|(name, key, values)| format!("[[factor]]\nname = \"{name}\"\nkey = \"{key}\"\n{values}\n"));
    let head = "version = 1\ntitle = \"Lab\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n";
    let seeds = "[replicates]\nkeys = [\"disc.surface.synthetic.seed\"]\nseeds = [1, 2]\n";
    let response = "[[response]]\nname = \"friction\"\nimported = true\n";
    directory.write("study.toml", format!("{head}{seeds}{}{response}", factors.concat()));
    let mut table = "load [N],speed [rpm],fibres,friction\n".to_owned();
    for line in 0..16 {
        let place = [4, 2, 1].map(|bit| if line & bit == 0 { -1.0 } else { 1.0 });
        let [load, speed, fibres] = [40.0 + 20.0 * place[0], 800.0 + 400.0 * place[1], 0.3 + 0.1 * place[2]];
        table.push_str(&format!("{load},{speed},{fibres:.1},{}\n", friction(place, line / 8)));
    }
    directory.write("lab.csv", table);
    ask(&directory, "import", &["lab.csv"]);
    directory
}

#[test]
fn a_run_is_known_no_better_than_the_mean_of_many() {
    // The two sets differ by a little more than the error, and there are only two of them: one degree of freedom.
    let noise = |[a, b, c]: [f64; 3]| 0.002 * (a * b * c);
    let directory = factorial(|place @ [load, speed, fibres], set| {
        0.42 - 0.03 * load - 0.02 * speed + 0.025 * fibres + noise(place) + 0.003 * set as f64
    });
    let predicted = ask(&directory, "predict", &[]);
    let interval = |which: &str| [0, 1].map(|end| predicted["places"][0]["responses"][0][which][end].as_f64().unwrap());
    let ([low, high], [run_low, run_high]) = (interval("mean_interval"), interval("run_interval"));
    assert!(run_low <= low && high <= run_high, "{predicted}");
    // Two levels and a range are not compared without a word.
    let said = directory.plateau(["sweep", "sensitivity", "study.toml"]).stderr;
    assert!(said.contains("warning: load, speed: numbers with two levels vary between these alone"), "{said}");
}

#[test]
fn a_response_that_is_the_same_everywhere_has_no_optimum() {
    let directory = factorial(|_, _| 0.4);
    let said = refused(&directory, "optimize", &["--maximize", "friction"]);
    assert!(said.contains("all runs have 0.4, so there is nothing to choose"), "{said}");
}

#[test]
fn factors_that_change_together_are_told() {
    let directory = rubber();
    let lines = "silica,silane,sulphur,abrasion\n-1,-1,1,102\n1,1,1,120\n-1,-1,-1,117\n1,1,-1,131\n0,0,0,119\n";
    directory.write("rubber.csv", lines);
    ask(&directory, "import", &["rubber.csv"]);
    for command in [
        &["predict", "study.toml"][..],
        &["optimize", "study.toml", "--maximize", "abrasion"],
        &["sensitivity", "study.toml"],
    ] {
        let said = directory.plateau(["sweep"].iter().chain(command)).stderr;
        assert!(said.contains("warning: silica and silane change together in all runs"), "{command:?}: {said}");
    }
}

#[test]
fn intervals_end_where_an_area_cannot_be() {
    let directory = WorkingDirectory::new();
    let response = |name: &str, unit: &str| format!("[[response]]\nname = \"{name}\"\nimported = true\n{unit}");
    let factor = "[[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\n";
    let head = "version = 1\ntitle = \"Spots\"\ndesign = \"csv\"\nfile = \"spots.csv\"\ndirectory = \"results\"\n";
    let responses = [response("spots", "unit = \"m2\"\n"), response("shift", "")].concat();
    directory.write("study.toml", format!("{head}{factor}{responses}"));
    // The same numbers as an area in mm² and as a number of which nothing is known.
    let spots = [(0.2, 0.0), (0.2, 0.1), (0.2, 1.2), (0.4, 3.0), (0.4, 5.0), (0.4, 5.5)];
    let lines = spots.map(|(fibres, spots)| format!("{fibres},{spots}e-6,{spots}\n"));
    directory.write("spots.csv", format!("fibres,spots [m2],shift\n{}", lines.concat()));
    ask(&directory, "import", &["spots.csv"]);
    let predicted = ask(&directory, "predict", &["--at", "fibres=0.2", "--model", "main"]);
    let interval = |at: usize, which: &str| {
        [0, 1].map(|end| predicted["places"][0]["responses"][at][which][end].as_f64().expect("an end"))
    };
    for which in ["mean_interval", "run_interval"] {
        let ([low, high], [free_low, free_high]) = (interval(0, which), interval(1, which));
        assert!(low == 0.0 && free_low < 0.0 && (high * 1e6 / free_high - 1.0).abs() < 1e-9, "{predicted}");
    }
    let text = directory.plateau(["sweep", "predict", "study.toml", "--at", "fibres=0.2", "--model", "main"]);
    let note = "  spots: the interval is cut at 0, for less cannot be; transform = \"log\" keeps to what can be\n";
    assert!(text.stdout.contains(note) && !text.stdout.contains("shift: the interval"), "{text:?}");
    ask(&directory, "effects", &["--model", "main"]);
    let page = fs::read_to_string(directory.path("results/effects/effects.html")).unwrap();
    assert_eq!(
        page.matches("They end where a response cannot be").count(),
        2,
        "below one figure, and as its description"
    );
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
        (
            "silica,silane,sulphur,abrasian",
            "column \"abrasian\" is neither a factor nor a response with imported = true",
        ),
        ("silica,silane,sulphur", "no column of a response with imported = true"),
        ("silica,silane,sulphur,abrasion [mm2]", "expected \"abrasion\", for the study gives it no unit"),
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

/// A test of a rig: humidity and supplier are no keys of a scene, the ambient temperature is one, in degrees Celsius.
const RIG: &str = r#"version = 1
title = "Rig"
design = "full-factorial"
directory = "results"
[[factor]]
name = "humidity"
levels = ["20 %RH", "80 %RH"]
[[factor]]
name = "supplier"
levels = ["A", "B"]
[[factor]]
name = "ambient"
key = "thermal.ambient"
range = ["0 degC", "200 degC"]
[[response]]
name = "wear"
imported = true
unit = "mm3"
"#;

#[test]
fn factors_of_a_rig_need_no_key_and_responses_may_be_in_any_unit() {
    let directory = WorkingDirectory::new();
    directory.write("study.toml", RIG);
    directory.plateau(["sweep", "plan", "study.toml", "--csv", "plan.csv"]);
    // In mm3: 1 + 0.01 humidity + 0.002 ambient, and 0.5 more for supplier B.
    let wear = |humidity: f64, supplier: &str, ambient: f64| {
        1.0 + 0.01 * humidity + 0.002 * ambient + if supplier == "B" { 0.5 } else { 0.0 }
    };
    let plan = fs::read_to_string(directory.path("plan.csv")).unwrap();
    let mut lines = plan.lines();
    let head = lines.next().unwrap();
    // In the unit that the study gives the response: that is what people fill in.
    assert_eq!(head, "run,humidity,supplier,ambient,wear [mm3]");
    let mut filled = head.to_owned() + "\n";
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells[at].split(' ').next().unwrap().parse::<f64>().unwrap();
        filled += &format!("{line}{}\n", wear(number(1), cells[2], number(3)));
    }
    directory.write("filled.csv", filled);
    let taken = ask(&directory, "import", &["filled.csv"]);
    assert_eq!(["new", "complete"].map(|key| taken[key].as_u64()), [Some(8), Some(8)]);
    let asked = ["--at", "humidity=35", "--at", "supplier=B", "--at", "ambient=60 degC", "--model", "main"];
    let predicted = ask(&directory, "predict", &asked);
    let found = predicted["places"][0]["responses"][0]["value"].as_f64().unwrap();
    assert!((found * 1e9 - wear(35.0, "B", 60.0)).abs() < 1e-9, "{found}");
    // The equation in the units of the study is that by which wear was made: degrees Celsius count from their own zero.
    let said = directory.plateau(["sweep", "effects", "study.toml", "--model", "main"]);
    assert!(said.stdout.contains("1.25000 + 0.0100000 humidity"), "{}", said.stdout);
    assert!(said.stdout.contains("0.00200000 ambient"), "{}", said.stdout);
    assert!(said.stdout.contains("humidity in %RH, ambient in degC"), "{}", said.stdout);
    // In another unit it is no humidity of this study.
    let refusal = refused(&directory, "predict", &["--at", "humidity=35 g/kg"]);
    assert!(refusal.contains("humidity = 35 g/kg: expected a quantity such as \"20 %RH\""), "{refusal}");
    // With a scene to run, every factor needs a key.
    directory.write("study.toml", RIG.replace("title", "base = \"scene.toml\"\ntitle"));
    let refusal = refused(&directory, "plan", &[]);
    assert!(refusal.contains("study.toml:7:8: factor.key: missing, expected a key of the scene"), "{refusal}");
}

#[test]
fn levels_of_a_table_are_compared_as_numbers() {
    let study = |levels: &str| {
        format!(
            "version = 1\ndesign = \"csv\"\nfile = \"points.csv\"\ndirectory = \"results\"\n\
             [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\n{levels}\n\
             [[response]]\nname = \"z\"\nimported = true\n"
        )
    };
    let directory = WorkingDirectory::new();
    directory.write("study.toml", study("levels = [\"5 N\", \"6 N\", \"8 N\"]"));
    directory.write("points.csv", "load,z\n5000 mN,1\n6.0 N,2.1\n8 N,4\n5 N,1.1\n6 N,2\n0.008 kN,4.1\n");
    ask(&directory, "import", &["points.csv"]);
    let effects = ask(&directory, "effects", &[]);
    // One-way analysis of variance by hand: sums of squares 9.3333 between and 0.015 within the levels.
    let explained = effects["responses"][0]["r_squared"].as_f64().unwrap();
    assert!((explained - (1.0 - 0.015 / 9.348_333_333_333_333)).abs() < 1e-12, "{explained}");
    directory.write("points.csv", "load,z\n5 N,1\n7 N,2\n");
    let refusal = refused(&directory, "plan", &[]);
    assert!(refusal.contains("points.csv:3: load: 7 N is none of the levels 5 N, 6 N, 8 N"), "{refusal}");
}

#[test]
fn an_optimum_may_be_better_than_every_run() {
    // A 3 × 3 grid on a surface whose top, 1 at (0.45, 0.35), lies between the points: the best run has 0.85.
    let z = |a: f64, b: f64| 1.0 - (a - 0.45).powi(2) - (b - 0.35).powi(2) - 0.3 * (a - 0.45) * (b - 0.35);
    let mut table = "a,b,z,minus z\n".to_owned();
    for a in [-1.0, 0.0, 1.0] {
        for b in [-1.0, 0.0, 1.0] {
            table += &format!("{a},{b},{},{}\n", z(a, b), -z(a, b));
        }
    }
    let names = |table: &str, names: [&str; 2], more: &str| {
        names.map(|name| format!("[[{table}]]\nname = \"{name}\"\n{more}")).concat()
    };
    let factors = names("factor", ["a", "b"], "");
    let responses = names("response", ["z", "minus z"], "imported = true\n");
    let head = "version = 1\ndesign = \"csv\"\nfile = \"points.csv\"\ndirectory = \"results\"\n";
    let directory = WorkingDirectory::new();
    directory.write("study.toml", format!("{head}{factors}{responses}"));
    directory.write("points.csv", table);
    ask(&directory, "import", &["points.csv"]);
    for goal in [["--maximize", "z"], ["--minimize", "minus z"]] {
        let best = ask(&directory, "optimize", &[&goal[..], &["--model", "quadratic"]].concat());
        for (factor, expected) in [0.45, 0.35].into_iter().enumerate() {
            let found = best["settings"][factor]["number"].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-5, "{goal:?}: {found} in place of {expected}");
        }
    }
}

#[test]
fn what_was_measured_stays_while_the_study_does_not_ask_for_it() {
    let study = |load: &str, seeds: &str, responses: &[&str]| {
        let responses: String = responses
            .iter()
            .map(|name| format!("[[response]]\nname = \"{name}\"\nimported = true\nunit = \"mm3\"\n"))
            .collect();
        format!(
            "version = 1\ntitle = \"Lab\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n\
             [replicates]\nkeys = [\"disc.surface.synthetic.seed\"]\nseeds = {seeds}\n\
             [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nlevels = [\"20 N\", \"{load}\"]\n\
             [[factor]]\nname = \"batch\"\nlevels = [\"A\", \"1e3\"]\n{responses}"
        )
    };
    let directory = WorkingDirectory::new();
    let kept = || fs::read_to_string(directory.path("results/imported.csv")).unwrap();
    let whole = study("60 N", "[1, 2]", &["wear", "noise"]);
    directory.write("study.toml", &whole);
    let lines: String = ["20,A", "20,1e3", "60,A", "60,1e3"]
        .iter()
        .enumerate()
        .flat_map(|(at, point)| {
            [1, 2].map(|replicate| format!("{point},{replicate},{at}{replicate},{replicate}{at}\n"))
        })
        .collect();
    directory.write("lab.csv", format!("load [N],batch,replicate,wear [mm3],noise [mm3]\n{lines}"));
    assert_eq!(ask(&directory, "import", &["lab.csv"])["new"].as_u64(), Some(16));
    let before = kept();

    // A level is corrected, a response and a seed are taken out, while one value more is brought.
    directory.write("study.toml", study("65 N", "[1]", &["wear"]));
    directory.write("more.csv", "load [kN],batch,wear [mm3]\n0.065,A,7\n");
    let taken = ask(&directory, "import", &["more.csv"]);
    assert_eq!((taken["new"].as_u64(), taken["complete"].as_u64()), (Some(1), Some(3)));
    let idle: Vec<&str> = taken["idle"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
    assert_eq!(idle.len(), 6 + 1, "two lines of the second seed, four of 60 N, and a column: {idle:?}");
    assert!(idle.contains(&"line of load [N] = 60.0, batch = 1e3") && idle[6] == "column \"noise [m3]\"", "{idle:?}");
    let text = directory.plateau(["sweep", "import", "study.toml", "more.csv"]).stdout;
    assert!(text.contains("not in the study") && text.contains("column \"noise [m3]\": kept"), "{text}");
    assert_eq!(kept().lines().count(), 1 + 3 + 6);
    let said = directory.plateau(["sweep", "collect", "study.toml"]).stderr;
    assert!(said.contains("results/imported.csv: kept, but not in the study now: line of load [N] = "), "{said}");

    // The level, the response and the seed are there again, and so is all that was measured; only the order may differ.
    directory.write("study.toml", &whole);
    assert_eq!(ask(&directory, "import", &["lab.csv"])["new"].as_u64(), Some(0));
    let sorted = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    let lines: Vec<String> = sorted(&kept()).into_iter().filter(|line| !line.starts_with("65.0,")).collect();
    assert_eq!(lines, sorted(&before));
    assert!(kept().contains("65.0,A,1,7e-9,\n"), "{}", kept());
}
