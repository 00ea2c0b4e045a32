//! Friction, heat and emission through the whole program: closed forms, the same bits, kills, and what is refused.

use plateau_tests::program::{WorkingDirectory, go_on_through_kills, scene};
use plateau_tests::run_file::differences;
use plateau_tests::scenes::{Stream, few_or_all};
use plateau_tests::studies::Study;

/// All parts, with feedback on wear and friction that is felt at a few kelvins.
const PARTS: &str = r#"
[friction]
pressure_coefficient = 0.33
shear_strength = "0.75 MPa"
maximum = 0.6
[friction.secondary]
shear_strength = "0.9 MPa"
[friction.resin]
pressure_coefficient = 0.1
[thermal]
ambient = "23 degC"
wear_rate_factor = [["23 degC", 1.0], ["24 degC", 1.5], ["40 degC", 4.0]]
friction_factor = [["23 degC", 1.0], ["60 degC", 0.7]]
[thermal.disc]
conductivity = "50 W/(m K)"
density = "7200 kg/m^3"
specific_heat = "500 J/(kg K)"
area = "3 cm^2"
thickness = "6 mm"
cooling = "0.04 W/K"
cooling_per_speed = "0.002 J/(K rad)"
[thermal.disc.coating]
thickness = "60 um"
conductivity = "15 W/(m K)"
density = "13500 kg/m^3"
specific_heat = "250 J/(kg K)"
[thermal.pin]
conductivity = "1.5 W/(m K)"
density = "2600 kg/m^3"
specific_heat = "900 J/(kg K)"
area = "8 mm^2"
length = "12 mm"
cooling = "0.002 W/K"
[emission]
pm10_fraction = 0.4
pm25_fraction = 0.15
number_per_mass = "1e15 1/kg"
pin_density = "2600 kg/m^3"
disc_density = "7200 kg/m^3"
number_factor = [["23 degC", 1.0], ["30 degC", 10.0]]
"#;

/// A scene with all parts, laid over a shipped one.
pub fn hot(base: &str, output: &str) -> String {
    format!("version = 1\nextends = \"{}\"\n{PARTS}\n[output]\ncontact_temperature = true\n{output}\n", scene(base))
}

#[test]
fn a_scene_without_the_parts_has_nothing_of_them() {
    let directory = WorkingDirectory::new();
    directory.plateau(["run", &scene("stops.toml"), "-o", "run.h5"]).quiet_success();
    let content = directory.run_file("run.h5").content();
    let words = ["friction", "temperature", "heat", "pm10", "pm25", "particle", "emitted_mass", "work"];
    let found: Vec<_> = content.keys().filter(|path| words.iter().any(|word| path.contains(word))).collect();
    assert_eq!(found, [""; 0]);
}

#[test]
fn wear_and_contact_do_not_see_friction_and_emission() {
    let directory = WorkingDirectory::new();
    let of_table = |name: &str| PARTS.find(&format!("[{name}]")).unwrap();
    let without_heat = format!("{}{}", &PARTS[..of_table("thermal")], &PARTS[of_table("emission")..]);
    let without_heat = without_heat.replace("number_factor", "# number_factor");
    directory.write("cold.toml", format!("version = 1\nextends = \"{}\"\n{without_heat}", scene("stops.toml")));
    // With another law for build-ups they are told apart, which rounds sums in another place.
    directory.write("alike.toml", directory.text("cold.toml").replace("0.9 MPa", "0.75 MPa"));
    let run = |scene: &str, name: &str| {
        directory.plateau(["run", scene, "-o", name]).quiet_success();
        directory.run_file(name)
    };
    let (plain, cold, alike) =
        (run(&scene("stops.toml"), "plain.h5"), run("cold.toml", "cold.h5"), run("alike.toml", "alike.h5"));
    for (path, content) in plain.content() {
        assert_eq!(alike.content()[&path], content, "{path}");
    }
    for path in ["/series/worn_pin", "/series/contact_area_integral"] {
        let (one, other) = (plain.floats(path), cold.floats(path));
        assert!(one.iter().zip(&other).all(|(one, other)| (one / other - 1.0).abs() < 1e-9), "{path}");
    }
    // PM10 is a part of the emitted volume at the density of the pin, which alone wears.
    let emitted: Vec<f64> = plain.floats("/series/emitted").iter().map(|volume| 0.4 * 2600.0 * volume).collect();
    let pm10 = cold.floats("/series/pm10_mass");
    assert!(pm10.iter().zip(&emitted).all(|(found, expected)| (found / expected - 1.0).abs() < 1e-9));
    let number = cold.floats("/series/particle_number");
    assert!(number.iter().zip(&pm10).all(|(number, mass)| (number / (1e15 * mass) - 1.0).abs() < 1e-9));
}

/// A brake in its own terms, and the same that the simulated pin sees of it, scaled by hand: 7.4692 mm² of 2 x 50 cm² of pads.
#[test]
fn a_brake_is_its_pin_in_the_ratio_of_areas_and_radii() {
    let directory = WorkingDirectory::new();
    let area = std::f64::consts::PI * (21e-3_f64.powi(2) - 20e-3_f64.powi(2)) * 40.0 / 690.0;
    let (share, mean_radius) = (area / 100e-4, 20.5e-3);
    let rows = [(0, 60.0, 300.0), (3, 30.0, 500.0), (6, 0.0, 0.0), (8, 50.0, 0.0), (9, 60.0, 200.0)];
    let table = |header: &str, row: &dyn Fn(f64, f64) -> String| {
        let rows = rows.iter().map(|(time, speed, torque)| format!("{time},{},{speed}\n", row(*speed, *torque)));
        format!("time [s],{header},road_speed [km/h]\n{}", rows.collect::<String>())
    };
    directory.write("brake.csv", table("brake_torque [N m]", &|_, torque| torque.to_string()));
    directory.write("line.csv", table("brake_pressure [bar]", &|_, torque| (torque / 100.0).to_string()));
    let pin = |speed: f64, torque: f64| {
        format!("{:e},{:e}", torque * share * mean_radius / 0.115, speed / 3.6 * 0.115 / 0.31)
    };
    directory.write("pin.csv", table("braking_torque [N m],sliding_speed [m/s]", &pin));
    // 60 cm2 of pistons press 50 cm2 of pad, with 0.9 of their force.
    let pressed = |speed: f64, torque: f64| {
        format!("{:e},{:e}", torque / 100.0 * 1e5 * 60.0 * 0.9 / 50.0, speed / 3.6 * 0.115 / 0.31)
    };
    directory.write("pressed.csv", table("nominal_pressure [Pa],sliding_speed [m/s]", &pressed));
    let of_disc = |share: f64, turns: f64| {
        let (area, cooling, per_speed) = (1000.0 * share, 9.3 * share, 0.031 * turns);
        PARTS
            .replace("area = \"3 cm^2\"", &format!("area = \"{area:e} cm^2\""))
            .replace("cooling = \"0.04 W/K\"", &format!("cooling = \"{cooling:e} W/K\""))
            .replace("\"0.002 J/(K rad)\"", &format!("\"{per_speed:e} J/(K rad)\""))
            .replace("area = \"8 mm^2\"", &format!("area = \"{:e} cm^2\"", 100.0 * share))
            .replace("cooling = \"0.002 W/K\"", &format!("cooling = \"{:e} W/K\"", 2.5 * share))
    };
    let brake = "[brake]\npad_area = \"50 cm^2\"\npad_thickness = \"10 mm\"\neffective_radius = \"115 mm\"\n\
                 wheel_radius = \"310 mm\"\npiston_area = \"60 cm^2\"\nefficiency = 0.9\n";
    let run = |name: &str, share: f64, turns: f64, brake: &str| {
        let quick = scene("quick.toml");
        let [file, run] = ["csv", "h5"].map(|ending| format!("{name}.{ending}"));
        let operation = format!("[operation]\nduration = \"9 s\"\n[operation.cycle]\nfile = \"{file}\"\n");
        let parts = of_disc(share, turns);
        let output = "[output]\nsample_every = \"0.1 s\"\nmaps_at = []\n[numerics]\ntime_acceleration = 1\n";
        let text = format!("version = 1\nextends = \"{quick}\"\n{operation}{brake}{parts}{output}");
        directory.write("scene.toml", text);
        directory.plateau(["run", "scene.toml", "-o", &run]).quiet_success();
        directory.run_file(&run)
    };
    for (whole, by_hand) in [("brake", "pin"), ("line", "pressed")] {
        let (whole, pin) = (run(whole, 1.0, 1.0, brake), run(by_hand, share, share * mean_radius / 0.115, ""));
        let same = |what: &str, found: &[f64], expected: &[f64]| {
            for (found, expected) in found.iter().zip(expected) {
                let is_close = (found - expected).abs() <= 1e-9 * expected.abs() || found.is_nan() && expected.is_nan();
                assert!(is_close, "{what}: {found} against {expected}");
            }
        };
        let of_forces = ["worn_pin", "contact_area", "friction_work", "pm10_mass"];
        for name in of_forces.into_iter().chain(["disc_temperature", "pin_temperature", "heat_lost"]) {
            let path = format!("/series/{name}");
            same(name, &whole.floats(&path), &pin.floats(&path));
        }
        let series = |name: &str| pin.floats(&format!("/series/{name}"));
        let mass: Vec<f64> = series("pm10_mass").iter().map(|mass| mass / share).collect();
        same("brake_pm10_mass", &whole.floats("/series/brake_pm10_mass"), &mass);
        let road = series("road_distance");
        let each: Vec<f64> = mass.iter().zip(&road).map(|(mass, road)| mass / road).collect();
        same("brake_pm10_per_distance", &whole.floats("/series/brake_pm10_per_distance"), &each);
        let wear: Vec<f64> = series("lost_pin").iter().map(|volume| volume / area).collect();
        same("pad_wear", &whole.floats("/series/pad_wear"), &wear);
        let life: Vec<f64> = wear.iter().zip(&road).map(|(wear, road)| 0.01 / (wear / road)).collect();
        same("pad_life", &whole.floats("/series/pad_life"), &life);
        let (forces, speeds) = (series("normal_force"), series("rotational_speed"));
        // Nothing where nothing presses, and not known where the disc stands.
        let torque = |friction: f64, force: f64, speed: f64| match (force, speed) {
            (0.0, _) => 0.0,
            (_, 0.0) => f64::NAN,
            _ => friction * force / share * 0.115,
        };
        let pairs = forces.iter().zip(&speeds);
        let torque: Vec<f64> = (series("friction_coefficient").iter().zip(pairs))
            .map(|(friction, (force, speed))| torque(*friction, *force, *speed))
            .collect();
        same("brake_torque", &whole.floats("/series/brake_torque"), &torque);
        assert!(pin.content().keys().all(|path| !path.contains("brake") && !path.contains("pad_")));
    }
}

#[test]
fn workers_and_instruction_sets_agree_on_heat() {
    let directory = WorkingDirectory::with(
        "hot.toml",
        hot("stops.toml", "sample_every = \"0.3 s\"\nmaps_at = [\"12 s\", \"16 s\"]"),
    );
    let run = |name: &str, options: &[&str]| {
        let arguments = ["run", "hot.toml", "-o", name, "--set", "numerics.time_acceleration=20"];
        directory.plateau([&arguments[..], options].concat()).ends(0, &[]);
        directory.run_file(name).content()
    };
    let one = run("one.h5", &[]);
    assert!(one.contains_key("/pin/temperature") && one.contains_key("/event/temperature_peak"));
    for options in [["--workers", "2"], ["--workers", "3"], ["--isa", "portable"]] {
        let name = format!("{}.h5", options[1]);
        assert_eq!(differences(&one, &run(&name, &options)), [""; 0], "{options:?}");
    }
    let run = directory.run_file("one.h5");
    let contact = run.floats("/series/contact_temperature");
    // It warms up, and the feedback is felt.
    assert!(contact.iter().copied().fold(0.0, f64::max) > 300.0);
    assert!(contact.iter().any(|temperature| temperature.is_nan()), "the pin is lifted at some samples");
    let residual = run.floats("/series/heat_residual");
    assert!(residual.iter().all(|residual| residual.abs() < 1e-12), "{residual:?}");
}

/// Killed in pauses and events, in the middle of intervals of heat.
#[test]
fn a_hot_run_that_is_killed_ends_like_an_undisturbed_one() {
    let directory = WorkingDirectory::new();
    directory.write(
        "hot.toml",
        hot("stops.toml", "sample_every = \"0.05 s\"\nmaps_at = [\"12 s\", \"55 s\"]\ncheckpoint_every = \"0.03 s\""),
    );
    let arguments = |name: &'static str, more: &'static [&'static str]| {
        let sets = ["--set", "operation.cycle.repeat=2", "--set", "operation.duration=110 s"];
        [&["run", "hot.toml", "-o", name, "--set", "numerics.time_acceleration=1"][..], &sets, more].concat()
    };
    go_on_through_kills(&directory, arguments, few_or_all(3, 40), 0.6, Stream(22));
}

#[test]
fn the_program_and_the_model_as_it_is_read_agree_on_heat() {
    let directory = WorkingDirectory::with("hot.toml", hot("stops.toml", "sample_every = \"0.7 s\""));
    let run = |engine: &str| {
        let name = format!("{engine}.h5");
        let arguments = ["run", "hot.toml", "-o", &name, "--set", "numerics.time_acceleration=50", "--engine", engine];
        directory.plateau(arguments).ends(0, &[]);
        directory.run_file(&name)
    };
    let (fast, plain) = (run("fast"), run("plain"));
    for path in fast.content().keys().filter(|path| path.starts_with("/series/") || path.starts_with("/event/")) {
        let (one, other) = (fast.floats(path), plain.floats(path));
        let scale = other.iter().copied().filter(|value| value.is_finite()).map(f64::abs).fold(0.0, f64::max);
        let agree = |(one, other): (&f64, &f64)| (one - other).abs() <= 1e-9 * scale || one.is_nan() && other.is_nan();
        // Residuals are what rounding leaves.
        assert!(path.ends_with("residual") || one.iter().zip(&other).all(agree), "{path}");
    }
}

/// What grows over a run, and the events that it is made of, whatever the run ends with: after a step, in a pause within a step that is
/// not taken any more, or after an event without a step.
#[test]
fn events_add_up_to_the_run() {
    let directory = WorkingDirectory::new();
    // 5.9 s of load, lifted for 2 s, 6.3 s of load, standing for 2.1 s, 0.02 s of load, lifted.
    let operation = "[operation]\nduration = \"20 s\"\n[operation.cycle]\npoints = [[\"0 s\", \"5 N\", \"300 rpm\"], [\"5.9 s\", \"5 N\", \"200 rpm\"], \
                     [\"5.9 s\", \"0 N\", \"200 rpm\"], [\"7.9 s\", \"0 N\", \"150 rpm\"], [\"7.9 s\", \"4 N\", \"150 rpm\"], [\"14.2 s\", \"6 N\", \"0 rpm\"], \
                     [\"16.3 s\", \"6 N\", \"0 rpm\"], [\"16.32 s\", \"6 N\", \"40 rpm\"], [\"16.32 s\", \"0 N\", \"40 rpm\"], [\"21 s\", \"0 N\", \"0 rpm\"]]\n";
    let scene = hot("quick.toml", "sample_every = \"0.5 s\"")
        .replace("number_factor = [[\"23 degC\", 1.0], [\"30 degC\", 10.0]]\n", "");
    directory.write("scene.toml", scene + operation);
    for m in [1, 3, 7, 20, 49] {
        for (end, rests) in [("20 s", true), ("15 s", true), ("16.31 s", false), ("12 s", false), ("6.5 s", true)] {
            let sets = [format!("operation.duration={end}"), format!("numerics.time_acceleration={m}")];
            let words = ["run", "scene.toml", "-o", "run.h5", "--force", "--set", &sets[0], "--set", &sets[1]];
            directory.plateau(words).ends(0, &[]);
            let (run, what) = (directory.run_file("run.h5"), format!("m = {m} until {end}"));
            let last = |names: &[&str]| -> f64 {
                names.iter().map(|name| *run.floats(&format!("/series/{name}")).last().unwrap()).sum()
            };
            let event = |name: &str| run.floats(&format!("/event/{name}"));
            let worn = ["worn_pin", "worn_resin", "worn_disc"];
            let sums: [(&str, &[&str]); 6] = [
                ("worn", &worn),
                ("emitted", &["emitted"]),
                ("work", &["friction_work"]),
                ("pm10_mass", &["pm10_mass"]),
                ("particle_number", &["particle_number"]),
                ("distance", &["sliding_distance"]),
            ];
            for (quantity, series) in sums {
                // What is left of the cycle after the last step is slid in the event, and in no step.
                let tolerance = if quantity == "distance" && !rests { f64::from(m) / 690.0 } else { 1e-12 };
                let (found, all): (f64, f64) = (event(quantity).iter().sum(), last(series));
                assert!((found - all).abs() <= tolerance * all, "{what}, {quantity}: {found:e}, expected {all:e}");
            }
            let (worn, peaks) = (event("worn"), event("temperature_peak"));
            let contact = run.floats("/series/contact_temperature");
            for (place, (number, mass)) in event("particle_number").iter().zip(event("pm10_mass")).enumerate() {
                let is_closed = rests || place + 1 < worn.len();
                // No factor: 1e15 for each kilogramme, of every event that a pause has ended.
                assert!(!is_closed || (number - 1e15 * mass).abs() <= 1e-12 * number, "{what}: event {place}");
                assert!(!is_closed || peaks[place].is_nan() == (worn[place] == 0.0), "{what}: event {place}");
            }
            let warmest = contact.iter().copied().fold(f64::NAN, f64::max);
            assert!(peaks.iter().copied().fold(f64::NAN, f64::max) >= warmest, "{what}: {peaks:?}, {warmest}");
        }
    }
}

#[test]
fn a_study_asks_friction_and_events_are_exported() {
    let directory = WorkingDirectory::with("hot.toml", hot("stops.toml", "sample_every = \"1 s\""));
    let study = Study::new("hot.toml", "full-factorial", "")
        .factor("load", "operation.cycle.force_scale", "levels = [1.0, 2.0]")
        .factor("strength", "friction.shear_strength", "levels = [\"0.5 MPa\", \"1 MPa\"]")
        .response("friction", "/series/friction_coefficient_mean", "at = \"end\"")
        .response("peak", "/event/temperature_peak", "event = \"last\"")
        .response("work", "/event/work", "event = \"mean\"");
    directory.write("study.toml", study);
    directory.plateau(["sweep", "run", "study.toml", "--jobs", "1"]).quiet_success();
    directory.plateau(["sweep", "collect", "study.toml"]).quiet_success();
    let results = directory.run_file("results/results.h5");
    let friction = results.floats("/friction");
    // The first factor changes first: friction falls with load and rises with the shear strength.
    let [falls, rises] = [[(0, 1), (2, 3)], [(0, 2), (1, 3)]];
    assert!(falls.iter().all(|(one, other)| friction[*one] > friction[*other]), "{friction:?}");
    assert!(rises.iter().all(|(one, other)| friction[*one] < friction[*other]), "{friction:?}");
    assert!(results.floats("/peak").iter().all(|peak| *peak > 296.15));
    directory.plateau(["run", "hot.toml", "-o", "run.h5"]).quiet_success();
    let run = directory.run_file("run.h5");
    // What the events did is what was done in all.
    let of_events: f64 = run.floats("/event/work").iter().sum();
    assert!((of_events / run.floats("/series/friction_work").last().unwrap() - 1.0).abs() < 1e-12);
    directory.plateau(["verify", "run.h5"]).quiet_success();
}

#[test]
fn a_run_whose_heat_is_no_number_any_more_has_failed() {
    let directory = WorkingDirectory::with("hot.toml", hot("stops.toml", "sample_every = \"1 s\""));
    let set = "thermal.friction_factor=[[\"24 degC\", 1.0], [\"25 degC\", 1e308]]";
    directory.plateau(["run", "hot.toml", "-o", "run.h5", "--set", set]).ends(1, &["the work of friction"]);
    assert_eq!(directory.run_file("run.h5").text("state"), "failed");
}

#[test]
fn a_stiffness_number_that_grows_with_temperature_is_warned_of() {
    let directory = WorkingDirectory::with("hot.toml", hot("quick.toml", "maps = []"));
    // By hand: Π = κ k m r Δθ = 5e-14 1/Pa · (1e9 Pa/(1 − 0.27²) in series with 1e11 Pa/(1 − 0.27²) over 50 µm) · 20 · 20.975 mm · 2π/690.
    let modulus = 1.0 / ((1.0 - 0.27_f64.powi(2)) * (1e-9 + 1e-11));
    let cold = 5e-14 * modulus / 50e-6 * 20.0 * 20.975e-3 * std::f64::consts::TAU / 690.0;
    let run = |factors: &str| {
        let factors = format!("thermal.wear_rate_factor={factors}");
        let arguments =
            ["run", "hot.toml", "-o", "run.h5", "--force", "--set", &factors, "--set", "operation.duration=20 s"];
        let outcome = directory.plateau(arguments).ends(0, &[]);
        outcome.stderr
    };
    assert!(cold < 0.1 && !run("[['23 degC', 1.0], ['400 degC', 2.0]]").contains("stiffness number"), "{cold}");
    // From the start on.
    let factor = 0.2 / cold;
    let from_start = run(&format!("[['23 degC', {factor}]]"));
    assert!(from_start.contains("warning: the stiffness number is 0.2"), "{from_start}");
    assert_eq!(from_start.matches("stiffness number").count(), 1, "{from_start}");
    // When it has become warm.
    let later = run(&format!("[['23 degC', 1.0], ['24 degC', {factor}]]"));
    assert!(later.contains("warning: with the wear rates of the temperature after "), "{later}");
    assert_eq!(later.matches("stiffness number").count(), 1, "{later}");
}
