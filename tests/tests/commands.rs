//! The commands `run` and `check` as the README describes them.

use std::fs;

use plateau_core::observe::EXTRAS;
use plateau_tests::program::{WorkingDirectory, run_words, scene, sets, vector};
use plateau_tests::run_file::RunFile;
use serde_json::Value;

/// A directory with `scene.toml`: a few steps of `quick.toml`, with a sample of each.
fn short() -> WorkingDirectory {
    let edits = [("duration = \"60 s\"", "steps = 20"), ("sample_every = \"0.1 s\"", "sample_every_steps = 1")];
    WorkingDirectory::with_scene(&edits)
}

#[test]
fn a_run_tells_its_results_and_nothing_else() {
    let directory = short();
    let summary = directory.plateau(["run", "scene.toml"]).quiet_success();
    for line in ["Quick look", "simulated time", "wall time", "contact area", "disc filled", "residuals", "quick.h5"] {
        assert!(summary.contains(line), "{line} is not in {summary}");
    }
    assert!(!summary.contains('\u{1b}'), "colours for no terminal: {summary:?}");
    // The file of the scene, in the working directory.
    assert_eq!(directory.names(), ["quick.h5", "quick.h5.checkpoint", "scene.toml"]);
    let run = directory.run_file("quick.h5");
    assert_eq!((run.text("state"), run.text("title")), ("finished".into(), "Quick look".into()));
    assert_eq!(run.number("format_version"), 1.0);
    assert_eq!(run.shape("/time"), [20]);
}

#[test]
fn what_a_reader_could_take_for_a_brake_is_said_to_be_of_the_pin() {
    let directory = short();
    let law = "friction={ pressure_coefficient = 0.5, shear_strength = \"0 Pa\", maximum = 1.0 }";
    let airborne = "emission={ pm10_fraction = 0.4, pm25_fraction = 0.15, number_per_mass = \"1e15 1/kg\", \
                    pin_density = \"2600 kg/m^3\", disc_density = \"7200 kg/m^3\" }";
    let summary = directory.plateau(["run", "scene.toml", "--set", law, "--set", airborne]).quiet_success();
    for name in ["worn volume", "worn off the pin", "friction", "airborne"] {
        let line = summary.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
        assert!(line.contains("simulated pin"), "{line}");
    }
    // By hand: 40 of 690 columns of a ring between 20 mm and 21 mm.
    assert!(summary.contains(" particles of the simulated pin, 7.47 mm²\n"), "{summary}");
}

#[test]
fn a_balance_tells_the_specific_wear_rate_of_the_summary() {
    let directory = WorkingDirectory::new();
    let run = |scene: &str, settings: &[&str]| {
        let told = directory.plateau(run_words(scene, "run.h5", settings, &["--force", "--json"])).ends(0, &[]);
        (told.json(), directory.run_file("run.h5"))
    };
    let last = |run: &RunFile, name: &str| *run.floats(&format!("/series/{name}")).last().unwrap();
    let close = |found: &Value, expected: f64| {
        let found = found.as_f64().unwrap();
        assert!((found / expected - 1.0).abs() < 1e-9, "{found:e}, expected {expected:e}");
    };
    // The pin is weighed: its heights before the first step and at the end, over 40 columns and 20 rows of the mesh.
    let (summary, of_run) = run("quick.toml", &[]);
    let (radius, angle) = (of_run.floats("/radius"), of_run.floats("/pin_angle"));
    let cell = (radius[1] - radius[0]) * (angle[1] - angle[0]);
    // The pin's height grows away from the disc, so that wear raises it.
    let heights = of_run.map("/pin/height", 0).into_iter().zip(of_run.last_map("/pin/height")).enumerate();
    let lost: f64 = heights.map(|(at, (before, after))| (after - before) * radius[at % radius.len()] * cell).sum();
    let found = summary["lost_pin"].as_f64().unwrap();
    assert!((found / lost - 1.0).abs() < 1e-6, "{found:e}, {lost:e} by the heights");
    close(&summary["specific_wear_rate_whole_pin"], found / (5.0 * last(&of_run, "sliding_distance")));
    close(&summary["worn_whole_pin"], last(&of_run, "worn_pin") + last(&of_run, "worn_resin"));
    for name in ["worn_whole_pin", "lost_pin"] {
        assert_eq!(summary[name].as_f64(), Some(last(&of_run, name)), "{name}");
    }
    // Under a load that changes, and through pauses: with the same friction everywhere the work of friction is μ F s.
    let law = "friction={ pressure_coefficient = 0.5, shear_strength = \"0 Pa\", maximum = 1.0 }";
    let (summary, of_run) = run("stops.toml", &[law]);
    let expected = last(&of_run, "lost_pin") / (summary["friction_work"].as_f64().unwrap() / 0.5);
    close(&summary["specific_wear_rate_whole_pin"], expected);
}

#[test]
fn the_mean_contact_area_is_that_of_the_last_tenth() {
    let directory = WorkingDirectory::new();
    // A revolution at 850 rpm stands for five, 0.353 s: ten of them take less than 6 s. A pulse takes 6 % of its time.
    let run_of =
        |file: &str, settings: &[&str], more: &[&str]| directory.plateau(run_words("quick.toml", file, settings, more));
    let thin = "materials.pin_resin.wear_height=0.3 um";
    let summary = run_of("run.h5", &["numerics.time_acceleration=5", thin], &["--json"]).ends(0, &[]).json();
    let run = directory.run_file("run.h5");
    let (time, integral) = (run.floats("/time"), run.floats("/series/contact_area_integral"));
    let last = time.len() - 1;
    let first = time.iter().rposition(|time| *time <= 54.0 * (1.0 + 1e-9)).unwrap();
    let window = &summary["contact_area_last_tenth"];
    assert_eq!((window["from"].as_f64(), window["to"].as_f64()), (Some(time[first]), Some(time[last])));
    let mean = (integral[last] - integral[first]) / (time[last] - time[first]);
    assert_eq!(window["mean"].as_f64(), Some(mean));
    assert!((window["revolutions"].as_f64().unwrap() - 6.0 * 850.0 / 60.0 / 5.0).abs() < 0.01, "{window}");
    // More than that of independent samples, for neighbours are alike, and less than they differ by.
    let areas: Vec<f64> =
        (first..last).map(|at| (integral[at + 1] - integral[at]) / (time[at + 1] - time[at])).collect();
    let deviation = (areas.iter().map(|area| (area - mean).powi(2)).sum::<f64>() / areas.len() as f64).sqrt();
    let error = window["standard_error"].as_f64().unwrap();
    assert!(deviation / (areas.len() as f64).sqrt() < error && error < deviation, "{error} {deviation}");
    // From the half to three quarters, and from there to the end.
    let at = |part: f64| {
        let after = time.iter().position(|time| *time >= 60.0 * part).unwrap();
        let share = (60.0 * part - time[after - 1]) / (time[after] - time[after - 1]);
        integral[after - 1] + share * (integral[after] - integral[after - 1])
    };
    let (third, fourth) = (at(0.75) - at(0.5), integral[last] - at(0.75));
    let change = summary["contact_area_drift"]["change"].as_f64().unwrap();
    assert!((change - (fourth / third - 1.0)).abs() < 1e-3, "{change}");
    // A quarter is 15 s, a pulse of 5 µm 24.9 s or more (below).
    let pulses = summary["contact_area_drift"]["pulses"].as_f64().unwrap();
    assert!((0.06 * pulses - 15.0 / 24.9).abs() < 0.002, "{pulses}");
    let long = ["numerics.time_acceleration=20", "operation.duration=300 s"];
    let text = run_of("long.h5", &long, &[]).quiet_success();
    assert!(text.contains("  running in               ") && text.contains(" s to 225 … 300 s\n"), "{text}");
    let text = run_of("again.h5", &[], &[]).quiet_success();
    let too_short = "cannot be told: a quarter of the run has at most 0.6 pulses of the contact area, 3 are needed";
    assert!(text.contains(&format!("  running in               {too_short}\n")), "{text}");
    for part in [" mm² (mean of the last 14.", "too few samples or pulses for an error"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // With so few pulses there is no running-in time either, and neither is there with chance that hides a change.
    let time_of = |text: &str| {
        let line = text.lines().find_map(|line| line.trim().strip_prefix("running-in time")).unwrap();
        line.trim().to_owned()
    };
    let few = "not defined: a quarter of the run has at most 0.6 pulses of the contact area, 3 are needed";
    assert_eq!(time_of(&text), few);
    let long = ["numerics.time_acceleration=100", "operation.duration=1500 s"];
    let hidden = run_of("hidden.h5", &long, &[]).quiet_success();
    assert!(hidden.contains("cannot be told from a run of this length: +"), "{hidden}");
    assert!(time_of(&hidden).starts_with("not defined: cannot be told from a run of this length"), "{hidden}");
    // Of the run file the same is said.
    let found = text.lines().find_map(|line| line.trim().strip_prefix("running in")).unwrap().trim();
    let summary = directory.plateau(["summary", "again.h5"]).quiet_success();
    assert!(summary.contains(&format!("\"running_in\": \"{found}\"")), "{summary}");
    assert!(summary.contains(&format!("\"running_in_time\": \"{few}\"")), "{summary}");
    // By hand: 5 µm of 0.3043 of 7.467 mm² at 5e-14 1/Pa, 5 N and 1.825 m/s are 24.9 s; no five of them are in 6 s.
    let scene = scene("quick.toml");
    let checked = directory.plateau(["check", &scene, "--set", "output.file=other.h5"]).quiet_success();
    for part in ["the shortest pulse takes 24.9 s", "a mean needs at least 5"] {
        assert!(checked.contains(part), "{part}: {checked}");
    }
    // 6900 steps are ten revolutions.
    for (steps, said) in [(6900, "the last 14.12 s"), (3450, "all 7.059 s, only 5 simulated revolutions")] {
        let settings = [&format!("operation.steps={steps}"), thin];
        let text = run_of(&format!("{steps}.h5"), &settings, &[]).quiet_success();
        assert!(text.contains(&format!(" mm² (mean of {said}, ± standard error)")), "{text}");
    }
}

#[test]
fn outputs_are_found_from_the_working_directory_and_surfaces_from_the_scene() {
    let directory = WorkingDirectory::new();
    for file in ["scene.toml", "init.h5"] {
        directory.write(&format!("scenes/{file}"), fs::read(vector("flat", file)).unwrap());
    }
    directory.write("scenes/derived/scene.toml", "version = 1\nextends = \"../scene.toml\"\n");
    fs::create_dir(directory.path("results")).unwrap();
    directory.plateau(["run", "scenes/scene.toml", "-o", "results/one.h5"]).quiet_success();
    directory.plateau(["run", "scenes/derived/scene.toml", "--set", "output.file=results/two.h5"]).quiet_success();
    directory.plateau(["run", "scenes/scene.toml"]).quiet_success();
    let content = |name| directory.run_file(name).content();
    assert!(content("results/one.h5") == content("results/two.h5") && content("results/one.h5") == content("run.h5"));
    assert_eq!(directory.names(), ["results", "run.h5", "run.h5.checkpoint", "scenes"]);
    assert_eq!(fs::read_dir(directory.path("scenes")).unwrap().count(), 3);

    // An input that --set names is found from the scene that is run, too; the dataset stays the one named before.
    fs::rename(directory.path("scenes/init.h5"), directory.path("scenes/moved.h5")).unwrap();
    let moved = ["disc.surface.file=../moved.h5", "pin.surface.file=../moved.h5", "pin.base.file=../moved.h5"];
    let run = ["run", "scenes/derived/scene.toml", "-o", "moved.h5"];
    directory.plateau([&run, &sets(&moved)[..]].concat()).quiet_success();
    assert!(content("moved.h5") == content("run.h5"));
}

#[test]
fn set_overrides_the_scene_and_o_overrides_set() {
    let directory = short();
    let given = ["operation.normal_force=20 N", "operation.normal_force=0.03 kN", "output.file=set.h5", "title=Other"];
    directory.plateau([&["run", "scene.toml", "-o", "run.h5"], &sets(&given)[..]].concat()).quiet_success();
    assert_eq!(directory.names(), ["run.h5", "run.h5.checkpoint", "scene.toml"]);
    let run = directory.run_file("run.h5");
    assert_eq!(run.text("title"), "Other");
    assert!(run.text("scene").contains("normal_force = \"30 N\""), "{}", run.text("scene"));
    // The load that is carried, within load_tolerance.
    for (pressure, area) in run.floats("/series/mean_pressure").iter().zip(run.floats("/series/contact_area")) {
        assert!((pressure * area / 30.0 - 1.0).abs() < 2e-9, "{pressure} Pa on {area} m²");
    }
}

#[test]
fn the_scene_in_a_run_file_gives_the_run_again() {
    let directory = short();
    directory.plateau(["run", "scene.toml", "-o", "one.h5", "--set", "operation.normal_force=7 N"]).quiet_success();
    let one = directory.run_file("one.h5");
    directory.write("again.toml", one.text("scene"));
    directory.plateau(["run", "again.toml", "-o", "two.h5"]).quiet_success();
    let two = directory.run_file("two.h5");
    assert!(one.content() == two.content());
    assert_eq!(one.text("scene"), two.text("scene"));
}

#[test]
fn json_is_one_document() {
    let directory = short();
    let run = directory.plateau(["run", "scene.toml", "-o", "run.h5", "--json"]).ends(0, &[]).json();
    assert_eq!((&run["steps"], &run["file"]), (&20.into(), &"run.h5".into()));
    let file = directory.run_file("run.h5");
    for name in ["contact_area", "max_pressure", "filled_fraction", "emitted"] {
        let (told, written) = (run[name].as_f64().unwrap(), *file.floats(&format!("/series/{name}")).last().unwrap());
        // The reader of JSON may miss the last digit.
        assert!((told / written - 1.0).abs() < 1e-15, "{name}: {told} and {written}");
    }
    assert_eq!(run["file_size"], fs::metadata(directory.path("run.h5")).unwrap().len());
    let check = directory.plateau(["check", "scene.toml", "--json"]).ends(0, &[]).json();
    assert_eq!((&check["steps"], &check["rows"], &check["samples"]), (&20.into(), &20.into(), &20.into()));
    assert_eq!(directory.names(), ["run.h5", "run.h5.checkpoint", "scene.toml"], "a check writes nothing");
}

#[test]
fn a_check_tells_what_a_run_takes() {
    let (directory, scene) = (WorkingDirectory::new(), scene("cermet.toml"));
    let text = directory.plateau(["check", &scene, "--all"]).quiet_success();
    // Δt = 60 s/(850 · 2764); 3000 s / (100 Δt) = 1 174 700 steps; Π = κ k m r Δθ by hand:
    // 5e-14 · 1.0679e9/50e-6 · 100 · 23.975e-3 · 2π/2764 = 5.82e-3.
    for words in ["1 174 700", "12 880 pin cells", "memory", "estimated time", "Π = 0.00582", "rms_height = \"3 um\""]
    {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    let (_, parts) = text.split_once("\nNeeded\n").expect("what is needed");
    let (needed, left_out) = parts.split_once("\nLeft out\n").expect("what is left out");
    // What matters comes first, in ten lines and a word about the rest; warnings before all.
    let short = directory.plateau(["check", &scene]).quiet_success();
    let lines: Vec<&str> = short.lines().collect();
    assert!(lines.len() <= 12 && lines[1].split_whitespace().eq(["warnings", "none"]), "{short}");
    assert!(lines.iter().any(|line| line.ends_with("; writes cermet.h5")) && short.ends_with("--all\n"), "{short}");
    for part in ["wear of the resin", "formation of plateaus", "map disc_height"] {
        assert!(needed.contains(part) && !left_out.contains(part), "{part}");
    }
    for part in ["wear of the disc", "exponential wear", "destruction of plateaus", "debris pool"] {
        assert!(left_out.contains(part) && !needed.contains(part), "{part}");
    }
    let track = ["plateaus.debris=track", "plateaus.captured_fraction=0.06"];
    let given = [&track[..], &["plateaus.formation=false", "output.maps=[\"pressure\"]"]].concat();
    let text = directory.plateau([&["check", &scene, "--all"], &sets(&given)[..]].concat()).quiet_success();
    let (needed, left_out) = text.split_once("\nLeft out\n").expect("what is left out");
    assert!(needed.contains("one debris pool per track") && needed.contains("map pressure"), "{text}");
    assert!(left_out.contains("formation of plateaus") && left_out.contains("map disc_height"), "{text}");
    assert!(directory.names().is_empty());
}

#[test]
fn a_check_lists_every_part_that_a_scene_can_do_without() {
    let parts = |settings: &[&str], list: &str| -> Vec<String> {
        let directory = WorkingDirectory::new();
        let quick = scene("quick.toml");
        let report =
            directory.plateau([&["check", &quick, "--json"], &sets(settings)[..]].concat()).ends(0, &[]).json();
        let parts = report[list].as_array().unwrap().iter();
        parts.map(|part| part["part"].as_str().unwrap().to_owned()).collect()
    };
    let mut listed = String::new();
    let mut list = |name: &str, settings: &[&str]| {
        for which in ["needed", "left_out"] {
            listed.push_str(&format!("# {name}: {which}\n{}\n", parts(settings, which).join("\n")));
        }
    };
    let least = [
        "materials.pin_primary.specific_wear_rate=0 1/Pa",
        "pin.base.uniform=primary",
        "plateaus.formation=false",
        "numerics.time_acceleration=1",
        "output.maps=[]",
    ];
    list("the least", &least);
    let most = [
        "materials.disc_primary.specific_wear_rate=1e-16 1/Pa",
        "materials.pin_secondary.youngs_modulus=2e9 Pa",
        "materials.pin_secondary.strength=5 MPa",
        "numerics.integrator=exponential",
        "numerics.workers=2",
        "operation.cycle.points=[[\"0 s\", \"5 N\", \"850 rpm\"], [\"60 s\", \"9 N\", \"850 rpm\"]]",
        "friction.pressure_coefficient=0.3",
        "thermal.ambient=23 degC",
        "thermal.disc={ conductivity = \"50 W/(m K)\", density = \"7200 kg/m^3\", specific_heat = \"500 J/(kg K)\", \
         area = \"7 cm^2\", thickness = \"6 mm\" }",
        "thermal.pin={ conductivity = \"1.5 W/(m K)\", density = \"2600 kg/m^3\", specific_heat = \"900 J/(kg K)\", \
         area = \"7.5 mm^2\", length = \"12 mm\" }",
        "emission={ pin_density = \"2600 kg/m^3\", disc_density = \"7200 kg/m^3\" }",
    ];
    let requested = EXTRAS.iter().filter(|extra| extra.request.is_some());
    let switches: Vec<String> = requested.map(|extra| format!("output.{}=true", extra.name)).collect();
    let most: Vec<&str> = most.into_iter().chain(switches.iter().map(String::as_str)).collect();
    // Pools have no transport length, run on one worker, and have what local debris has not.
    list("local debris with all", &[&most[..], &["plateaus.transport_length=200 um"]].concat());
    list("pools with all", &[&most[..], &["plateaus.debris=track", "plateaus.captured_fraction=0.06"]].concat());
    insta::assert_snapshot!(listed);
}

#[test]
fn a_check_warns_of_large_stiffness_numbers_of_the_explicit_rule() {
    let directory = WorkingDirectory::new();
    let check = |acceleration: &str, integrator: &str| -> (f64, String) {
        let m = format!("numerics.time_acceleration={acceleration}");
        let integrator = format!("numerics.integrator={integrator}");
        let words = ["check", &scene("quick.toml"), "--json", "--set", &m, "--set", &integrator];
        let outcome = directory.plateau(words).ends(0, &[]);
        (outcome.json()["stiffness_number"].as_f64().unwrap(), outcome.stderr)
    };
    // Π = κ k m r Δθ at the outermost row.
    let stiffness = 1.0 / ((1.0 - 0.27 * 0.27) * (1.0 / 1e9 + 1.0 / 1e11) * 50e-6);
    let one = 5e-14 * stiffness * 20.975e-3 * std::f64::consts::TAU / 690.0;
    for (acceleration, warns) in [("480", false), ("500", true), ("5000", true)] {
        let (number, stderr) = check(acceleration, "explicit");
        let expected = one * acceleration.parse::<f64>().unwrap();
        assert!((number / expected - 1.0).abs() < 1e-12, "{number}, expected {expected}");
        assert_eq!(expected > 0.1, warns);
        assert_eq!(stderr.contains("stiffness number"), warns, "Π = {number}: {stderr}");
        assert_eq!(stderr.lines().count(), usize::from(warns), "{stderr}");
        assert_eq!(check(acceleration, "exponential"), (number, String::new()));
    }
}

#[test]
fn warnings_do_not_stop_a_run() {
    let directory = short();
    let words = ["run", "scene.toml", "--set", "output.maps_at=[\"0 s\", \"70 s\"]"];
    let outcome = directory.plateau(words).ends(0, &["70 s"]);
    assert!(outcome.stderr.starts_with("plateau: warning: "), "{}", outcome.stderr);
    assert_eq!(directory.run_file("quick.h5").shape("/map_time"), [2]);
    // A check tells beforehand that the output is there.
    directory.plateau(["check", "scene.toml"]).ends(0, &["quick.h5 exists"]);
}
