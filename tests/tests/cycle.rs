//! Load and speed as a cycle, through the whole program: closed forms, pauses, events, errors, and runs that are killed.

use std::f64::consts::TAU;

use plateau_tests::program::{WorkingDirectory, go_on_through_kills, quick_scene_with, run_words, scene};
use plateau_tests::run_file::differences;
use plateau_tests::scenes::{Stream, few_or_all};
use plateau_tests::studies::Study;

/// The quick scene with other lines in place of its load, speed and duration.
fn quick_with_operation(lines: &str) -> String {
    quick_scene_with(&[
        ("normal_force = \"5 N\"\n", ""),
        ("rotational_speed = \"850 rpm\"\n", ""),
        ("duration = \"60 s\"\n", lines),
    ])
}

#[test]
fn a_cycle_that_never_changes_is_constant_operation_bit_for_bit() {
    let directory = WorkingDirectory::new();
    let plain = "normal_force = \"5 N\"\nrotational_speed = \"850 rpm\"\nduration = \"20 s\"\n";
    let rows = "[operation.cycle]\npoints = [[\"0 s\", \"5 N\", \"850 rpm\"], [\"3 s\", \"5 N\", \"850 rpm\"], [\"5 s\", \"5 N\", \"850 rpm\"]]\n\
                repeat = 4\n";
    let table = "normal_force = \"5 N\"\n[operation.cycle]\nfile = \"speed.csv\"\ninterpolation = \"hold\"\n";
    directory.write("speed.csv", "time [s],rotational_speed [rpm]\n0,850\n20,0\n");
    for (name, lines) in [("plain", plain), ("rows", rows), ("table", table)] {
        directory.write(&format!("{name}.toml"), quick_with_operation(lines));
        directory.plateau(["run", &format!("{name}.toml"), "-o", &format!("{name}.h5")]).quiet_success();
    }
    let content = |name: &str| {
        let mut content = directory.run_file(name).content();
        content.retain(|path, _| {
            let of_cycle = ["normal_force", "rotational_speed", "contact_time"];
            !path.starts_with("/event") && !of_cycle.iter().any(|series| path.ends_with(series))
        });
        content
    };
    assert_eq!(differences(&content("plain.h5"), &content("rows.h5")), [""; 0]);
    assert_eq!(differences(&content("plain.h5"), &content("table.h5")), [""; 0]);
    let run = directory.run_file("rows.h5");
    assert!(run.floats("/series/normal_force").iter().all(|force| *force == 5.0));
    assert_eq!((run.floats("/event/start"), run.floats("/event/end")), (vec![0.0], vec![20.0]));
}

/// ⌊ψ(T)/(m Δθ) + 1e-9⌋ steps, as of any other cycle.
#[test]
fn a_cycle_that_never_changes_takes_no_step_beyond_its_end() {
    let directory = WorkingDirectory::new();
    let lines = "[operation.cycle]\npoints = [[\"0 s\", \"5 N\", \"850 rpm\"], [\"3.33 s\", \"5 N\", \"850 rpm\"]]\nrepeat = 3\n";
    directory.write("scene.toml", quick_with_operation(lines));
    for m in [7, 20, 45] {
        let set = format!("numerics.time_acceleration={m}");
        let sets = ["--set", &set, "--set", "output.sample_every_steps=1"];
        directory.plateau([&["run", "scene.toml", "-o", "run.h5", "--force"][..], &sets].concat()).ends(0, &[]);
        let time = directory.run_file("run.h5").floats("/time");
        let steps = 9.99 * 850.0 / 60.0 * 690.0 / f64::from(m);
        assert_eq!(time.len() as f64, (steps + 1e-9).floor(), "m = {m}");
        assert!(time.last().is_some_and(|end| *end <= 9.99 * (1.0 + 1e-12)), "m = {m}: {:?}", time.last());
    }
}

/// As it is printed, in the table and in the warning.
#[test]
fn the_largest_acceleration_without_a_warning_gives_none() {
    let directory = WorkingDirectory::new();
    let stops = scene("stops.toml");
    for scale in ["1", "1.234", "0.771"] {
        let set = format!("operation.cycle.speed_scale={scale}");
        let check = |m: &str| {
            let m = format!("numerics.time_acceleration={m}");
            directory.plateau(["check", &stops, "--set", &set, "--set", &m])
        };
        let none = check("1");
        let row = none.stdout.lines().find(|line| line.contains("largest acceleration without a warning"));
        let printed = row.and_then(|row| row.split_whitespace().last()).unwrap();
        let many = check("1000");
        let advice = many.stderr.split(" is the largest acceleration").next().unwrap();
        assert!(advice.len() < many.stderr.len(), "{many:?}");
        for largest in [printed, advice.split_whitespace().last().unwrap()] {
            assert!(!check(largest).stderr.contains("largest acceleration"), "{scale}: {largest}");
        }
    }
}

#[test]
fn the_work_of_a_run_is_that_of_its_cycle_for_every_acceleration() {
    let directory = WorkingDirectory::new();
    // A ramp from 2 N to 6 N while the disc slows down from 600 rpm to 300 rpm in 4 s, then nothing for 2 s: Simpson's rule is exact.
    let lines = "[operation.cycle]\npoints = [[\"0 s\", \"2 N\", \"600 rpm\"], [\"4 s\", \"6 N\", \"300 rpm\"], [\"4 s\", \"0 N\", \"300 rpm\"], [\"6 s\", \"0 N\", \"0 rpm\"]]\n\
                 repeat = 3\n";
    let work = 3.0 * 4.0 * (2.0 * 600.0 + 4.0 * 4.0 * 450.0 + 6.0 * 300.0) / 6.0 * TAU / 60.0;
    let angle = 3.0 * 4.0 * 450.0 * TAU / 60.0;
    directory.write("scene.toml", quick_with_operation(lines));
    for m in [3.0, 10.0, 45.0] {
        let set = format!("numerics.time_acceleration={m}");
        let sets = ["--set", &set, "--set", "output.sample_every_steps=1"];
        let outcome =
            directory.plateau([&["run", "scene.toml", "-o", "run.h5", "--force"][..], &sets].concat()).ends(0, &[]);
        // An event has 30 revolutions.
        assert_eq!(outcome.stderr.contains("3 is the largest acceleration"), m > 3.0, "{outcome:?}");
        let run = directory.run_file("run.h5");
        let (time, force) = (run.floats("/time"), run.floats("/series/normal_force"));
        let step = m * TAU / 690.0;
        let steps = (angle / step + 1e-9).floor();
        // The end of the run lies in a pause and has a sample of its own.
        assert_eq!((time.len() as f64, time.last()), (steps + 1.0, Some(&18.0)), "m = {m}");
        let sum: f64 = force.iter().map(|force| force * step).sum();
        let rest = angle - steps * step;
        assert!(((sum + 6.0 * rest) / work - 1.0).abs() < 1e-9 + rest / angle, "m = {m}: {sum}, expected {work}");
        if rest < 1e-6 * step {
            assert!((sum / work - 1.0).abs() < 1e-9, "m = {m}: {sum}, expected {work}");
        }
        let worn: f64 = run.floats("/series/worn_pin").last().copied().unwrap();
        // κ Σ F̄ ds over the mean radius; the load lies somewhere between the radii of 20 mm and 21 mm, and films are worn through.
        assert!((worn / (5e-14 * sum * 20.5e-3) - 1.0).abs() < 0.03, "m = {m}: {worn}");
    }
}

#[test]
fn a_pause_costs_no_step_and_reports_what_rests() {
    let directory = WorkingDirectory::new();
    directory.plateau(["run", &scene("stops.toml"), "-o", "run.h5", "--set", "output.roughness=true"]).quiet_success();
    let run = directory.run_file("run.h5");
    let time = run.floats("/time");
    let at = |series: &str, from: f64, to: f64| -> Vec<f64> {
        let values = run.floats(&format!("/series/{series}"));
        time.iter().zip(values).filter(|(time, _)| **time > from && **time < to).map(|(_, value)| value).collect()
    };
    let resting = |series: &str, from, to| {
        let values = at(series, from, to);
        assert!(values.len() > 30 && values.iter().all(|value| *value == values[0]), "{series}: {values:?}");
        values[0]
    };
    // Lifted from 10 s to 14 s.
    assert!(at("displacement", 10.05, 13.95).iter().all(|displacement| displacement.is_nan()));
    for series in ["contact_area", "contact_ratio", "mean_pressure", "max_pressure", "normal_force"] {
        assert_eq!(resting(series, 10.05, 13.95), 0.0, "{series}");
    }
    for series in ["worn_pin", "emitted", "filled_fraction", "disc_sq", "sliding_distance", "contact_area_integral"] {
        assert!(resting(series, 10.05, 13.95) > 0.0, "{series}");
    }
    // Standing from 49 s to 60 s.
    assert!(resting("contact_area", 49.05, 60.5) > 0.0 && resting("rotational_speed", 49.05, 60.5) == 0.0);
    assert_eq!(resting("normal_force", 49.05, 60.5), 10.0);
    let (integral, area) = (at("contact_area_integral", 49.05, 60.5), at("contact_area", 49.05, 60.5));
    let (span, count) = (time[time.len() - 1] - time[time.len() - area.len()], area.len() - 1);
    assert!(((integral[count] - integral[0]) / (area[0] * span) - 1.0).abs() < 1e-9);
    // The speed rises in a straight line while the pin is lifted.
    let speeds = at("rotational_speed", 17.05, 21.95);
    assert!((speeds[speeds.len() - 1] * 60.0 / TAU - 850.0).abs() < 25.0 && speeds.is_sorted());
    // 6 events; 400 rpm for 10 s and 425 rpm for 3 s at a mean radius of 20.5 mm.
    let distances = run.floats("/event/distance");
    let expected = [400.0 * 10.0, 425.0 * 3.0].map(|turns| turns / 60.0 * TAU * 20.5e-3);
    assert_eq!(distances.len(), 6);
    assert!((distances[0] / expected[0] - 1.0).abs() < 1e-12 && (distances[5] / expected[1] - 1.0).abs() < 1e-12);
    let worn: f64 = run.floats("/event/worn").iter().sum();
    let parts = ["worn_pin", "worn_resin", "worn_disc"];
    let all: f64 = parts.iter().map(|name| *run.floats(&format!("/series/{name}")).last().unwrap()).sum();
    assert!((worn / all - 1.0).abs() < 1e-12);
    directory.plateau(["verify", "run.h5"]).quiet_success();
}

#[test]
fn workers_and_instruction_sets_agree_on_a_cycle() {
    let directory = WorkingDirectory::new();
    let run = |name: &str, options: &[&str]| {
        let settings = ["operation.duration=24 s", "numerics.time_acceleration=40"];
        directory.plateau(run_words("stops.toml", name, &settings, options)).ends(0, &[]);
        directory.run_file(name).content()
    };
    let one = run("one.h5", &[]);
    for options in [["--workers", "2"], ["--workers", "3"], ["--isa", "portable"]] {
        let name = format!("{}.h5", options[1]);
        assert_eq!(differences(&one, &run(&name, &options)), [""; 0], "{options:?}");
    }
}

/// Killed at moments of pauses and events alike; most samples lie in pauses.
#[test]
fn a_run_with_a_cycle_that_is_killed_ends_like_an_undisturbed_one() {
    let directory = WorkingDirectory::new();
    let arguments = |name: &str, more: &[&str]| {
        let settings = [
            "operation.cycle.repeat=2",
            "operation.duration=116 s",
            "numerics.time_acceleration=1",
            "output.sample_every=0.01 s",
            "output.maps_at=[\"12 s\", \"16 s\", \"55 s\", \"100 s\", \"116 s\"]",
            "output.checkpoint_every=0.03 s",
        ];
        run_words("stops.toml", name, &settings, more)
    };
    let (whole, _) = go_on_through_kills(&directory, arguments, few_or_all(3, 40), 0.4, Stream(21));
    assert!(whole.contains_key("/event/worn"));
    // It goes on beyond its end, which lies in a pause, as a longer run goes on there.
    directory.plateau(arguments("run.h5", &["--extend-to", "120 s"])).ends(0, &[]);
    directory.plateau(arguments("longer.h5", &["--set", "operation.duration=120 s"])).quiet_success();
    let values = |name: &str, path: &str| directory.run_file(name).floats(path);
    for path in ["/event/worn", "/event/contact_area_end"] {
        assert_eq!(values("run.h5", path), values("longer.h5", path), "{path}");
    }
    assert_eq!(values("run.h5", "/time").last(), values("longer.h5", "/time").last());
}

/// A sample may be due in the part of a step before the pause within it: that takes none of the pause.
#[test]
fn every_multiple_in_a_pause_has_its_sample() {
    let directory = WorkingDirectory::new();
    for (every, m) in [(0.07, 2), (0.1, 40), (0.01, 1)] {
        let settings = [format!("output.sample_every={every} s"), format!("numerics.time_acceleration={m}")];
        let settings = settings.each_ref().map(String::as_str);
        directory.plateau(run_words("stops.toml", "run.h5", &settings, &["--force"])).ends(0, &[]);
        let times = directory.run_file("run.h5").floats("/time");
        assert!(times.is_sorted_by(|one, other| one < other), "every {every} s, m = {m}");
        for [start, end] in [[10.0, 14.0], [17.0, 22.0], [25.0, 30.0], [33.0, 38.0], [41.0, 46.0], [49.0, 60.0]] {
            let multiples = |time: f64| (time / every + 1e-9).floor();
            let due = (multiples(end - 1e-6) - multiples(start + 1e-6)) as usize;
            let found = times.iter().filter(|time| **time > start + 1e-6 && **time < end - 1e-6).count();
            assert_eq!(found, due, "every {every} s, m = {m}, from {start} s");
        }
    }
}

#[test]
fn the_table_of_a_run_is_neither_exchanged_nor_replaced() {
    let directory = WorkingDirectory::new();
    let table = "time [s],normal_force [N],rotational_speed [rpm]\n0,5,850\n2,5,0\n4,0,0\n5,0,850\n5,5,850\n8,5,0\n";
    directory.write("stops.csv", table);
    directory.write("stops.toml", quick_with_operation("[operation.cycle]\nfile = \"stops.csv\"\n"));
    let run = ["run", "stops.toml", "-o", "stops.h5", "--set", "operation.duration=3 s"];
    directory.plateau(run).ends(0, &[]);
    directory.write("stops.csv", table.replace("8,5,0", "8,9,0"));
    for options in [&["--resume"][..], &["--extend-to", "6 s"]] {
        directory.plateau([&run[..], options].concat()).ends(2, &["files that it reads have changed: ", "stops.csv"]);
    }
    directory.write("stops.csv", table);
    assert_eq!(directory.text("stops.csv"), table);
}

/// Ended in an event and in a pause, and extended: times never go back, and events are as if it had never ended.
#[test]
fn a_run_that_is_extended_again_and_again_accounts_for_every_event() {
    let directory = WorkingDirectory::new();
    let rows = "[operation.cycle]\npoints = [[\"0 s\", \"5 N\", \"600 rpm\"], [\"1 s\", \"5 N\", \"0 rpm\"], \
                [\"2 s\", \"5 N\", \"0 rpm\"], [\"2 s\", \"0 N\", \"0 rpm\"], [\"4 s\", \"0 N\", \"600 rpm\"], \
                [\"4 s\", \"5 N\", \"600 rpm\"], [\"5 s\", \"5 N\", \"600 rpm\"]]\n";
    directory.write("scene.toml", quick_with_operation(rows));
    let sets = ["--set", "output.sample_every=0.01 s", "--set", "numerics.time_acceleration=2"];
    let run = |name: &str, options: &[&str]| {
        directory.plateau([&["run", "scene.toml", "-o", name][..], &sets, options].concat()).ends(0, &[]);
    };
    run("whole.h5", &[]);
    run("run.h5", &["--set", "operation.duration=0.731 s"]);
    for end in ["1.5 s", "2.5 s", "5 s"] {
        run("run.h5", &["--extend-to", end]);
    }
    let [whole, extended] = ["whole.h5", "run.h5"].map(|name| directory.run_file(name));
    assert!(extended.floats("/time").is_sorted_by(|one, other| one < other));
    for path in ["/event/start", "/event/end", "/event/worn", "/event/contact_area_start", "/event/contact_area_end"] {
        assert_eq!(extended.floats(path), whole.floats(path), "{path}");
    }
    assert_eq!(extended.last_map("/disc/height"), whole.last_map("/disc/height"));
}

#[test]
fn a_study_asks_single_events_and_all_of_them() {
    let directory = WorkingDirectory::new();
    let study = Study::new(&scene("stops.toml"), "full-factorial", "")
        .factor("load", "operation.cycle.force_scale", "levels = [1.0, 2.0]")
        .response("third", "/event/worn", "event = 3")
        .response("last", "/event/worn", "event = \"last\"")
        .response("mean", "/event/contact_area_end", "event = \"mean\"")
        .text();
    directory.write("study.toml", &study);
    directory.plateau(["sweep", "run", "study.toml", "--jobs", "1"]).quiet_success();
    directory.plateau(["sweep", "collect", "study.toml"]).quiet_success();
    let results = directory.run_file("results/results.h5");
    directory.plateau(["run", &scene("stops.toml"), "-o", "run.h5"]).quiet_success();
    let run = directory.run_file("run.h5");
    let (worn, areas) = (run.floats("/event/worn"), run.floats("/event/contact_area_end"));
    let first = |name: &str| results.floats(name)[0];
    assert_eq!((first("/third"), first("/last")), (worn[2], worn[5]));
    assert!((first("/mean") / (areas.iter().sum::<f64>() / 6.0) - 1.0).abs() < 1e-12);
    // Twice the load wears twice as much, but for films that are worn through.
    assert!((results.floats("/third")[1] / worn[2] / 2.0 - 1.0).abs() < 0.02);
    directory.write("study.toml", study.replace("event = 3", "event = \"third\""));
    let expected = "expected the number of an event, \"last\" or \"mean\"";
    directory.plateau(["sweep", "plan", "study.toml"]).ends(2, &[expected]);
}

#[test]
fn the_contact_area_of_a_cycle_is_its_mean_over_the_time_in_contact() {
    let directory = WorkingDirectory::new();
    let run = |more: &[&str]| {
        let words = run_words("stops.toml", "run.h5", &["operation.duration=44 s"], &[&["--force"], more].concat());
        directory.plateau(words)
    };
    let told = run(&["--json"]);
    let text = run(&[]).quiet_success();
    let run = directory.run_file("run.h5");
    let (time, contact, integral) =
        (run.floats("/time"), run.floats("/series/contact_time"), run.floats("/series/contact_area_integral"));
    // By hand: of 44 s the pin is lifted for 4 s, three times 5 s and 3 s.
    assert!((contact.last().unwrap() - 22.0).abs() < 1e-9, "{contact:?}");
    let at = |moment: f64| time.iter().position(|time| (time - moment).abs() < 1e-9).unwrap();
    // The last tenth has no ten revolutions, so it begins earlier.
    let window = &told.json()["contact_area_last_tenth"];
    let number = |name: &str| window[name].as_f64().unwrap();
    let (from, to) = (at(number("from")), at(number("to")));
    let in_contact = contact[to] - contact[from];
    assert!((number("contact_time") / in_contact - 1.0).abs() < 1e-12 && in_contact < time[to] - time[from]);
    let mean = (integral[to] - integral[from]) / in_contact;
    assert!((number("mean") / mean - 1.0).abs() < 1e-12, "{window}, expected {mean}");
    let counted = "in contact: the time in which the pin is lifted, and before the first step, does not count";
    assert!(text.contains(counted), "{text}");
}

#[test]
fn a_pin_that_stands_before_the_first_step_counts_for_nothing_in_the_mean() {
    let directory = WorkingDirectory::new();
    // The same brake after 5 s of standing under its load: the same steps, so the same mean.
    let summary = |name: &str, stands: f64| {
        let row = |time: f64, speed: u32| format!("[\"{} s\", \"5 N\", \"{speed} rpm\"]", time + stands);
        let begins = if stands > 0.0 { "[\"0 s\", \"5 N\", \"0 rpm\"], " } else { "" };
        let rows = [row(0.0, 0), row(0.0, 850), row(10.0, 850), row(10.0, 0), row(12.0, 0)].join(", ");
        let lines = format!("[operation.cycle]\npoints = [{begins}{rows}]\n");
        directory.write(&format!("{name}.toml"), quick_with_operation(&lines));
        // A sample every 0.5 s; 7.08 revolutions, so the window is the whole run.
        let arguments = ["--json", "--set", "numerics.time_acceleration=20", "--set", "output.sample_every=0.5 s"];
        let [scene, file] = ["toml", "h5"].map(|ending| format!("{name}.{ending}"));
        let told = directory.plateau([&["run", &scene, "-o", &file][..], &arguments].concat()).ends(0, &[]);
        told.json()["contact_area_last_tenth"].clone()
    };
    let (stands, moves) = (summary("stands", 5.0), summary("moves", 0.0));
    for name in ["mean", "standard_error"] {
        let (found, expected) = (stands[name].as_f64().unwrap(), moves[name].as_f64().unwrap());
        assert!((found / expected - 1.0).abs() < 1e-9, "{name}: {found:e}, expected {expected:e}");
    }
    assert_eq!((stands["from"].as_f64(), stands["to"].as_f64()), (Some(0.0), Some(17.0)));
    assert!((stands["contact_time"].as_f64().unwrap() - 12.0).abs() < 1e-9, "{stands}");
    let times = directory.run_file("stands.h5").floats("/series/contact_time");
    assert!(times[..9].iter().all(|time| *time == 0.0), "{times:?}");
}

#[test]
fn a_run_with_a_cycle_says_why_its_running_in_is_not_told() {
    let directory = WorkingDirectory::new();
    let text = directory.plateau(["run", &scene("stops.toml"), "-o", "run.h5"]).quiet_success();
    let line = |name: &str| text.lines().find_map(|line| line.trim().strip_prefix(name)).unwrap().trim().to_owned();
    assert_eq!(line("running in "), "cannot be told: with a cycle the contact area follows load and speed");
    assert!(line("running-in time ").starts_with("not defined: "), "{text}");
    let summary = directory.plateau(["summary", "run.h5"]).quiet_success();
    for (name, key) in [("running in ", "running_in"), ("running-in time ", "running_in_time")] {
        assert!(summary.contains(&format!("\"{key}\": \"{}\"", line(name))), "{summary}");
    }
}

#[test]
fn the_end_of_a_cycle_is_a_time_of_its_run() {
    let directory = WorkingDirectory::new();
    // It ends within a step: the speed falls to nothing at 30 s.
    let operation = "[operation.cycle]\npoints = [[\"0 s\", \"5 N\", \"850 rpm\"], [\"30 s\", \"5 N\", \"0 rpm\"]]\n";
    directory.write("scene.toml", quick_with_operation(operation));
    let set = "set = [\"output.sample_every = '0.5 s'\", \"numerics.time_acceleration = 1\"]";
    let study = Study::new("scene.toml", "full-factorial", set)
        .factor("height", "contact.foundation_height", "levels = [\"40 um\", \"50 um\"]")
        .response("at", "/series/filled_fraction", "at = \"30 s\"")
        .response("end", "/series/filled_fraction", "at = \"end\"")
        .response("mean", "/series/contact_area", "mean = [\"10 s\", \"30 s\"]")
        .response("late", "/series/filled_fraction", "at = \"31 s\"")
        .response("runs in", "/series/worn_pin", "reaches = 0.9");
    directory.write("study.toml", study);
    let rises = "response \"runs in\" has no value: not defined: still rises at the end, by ";
    let made = directory.plateau(["sweep", "run", "study.toml", "--jobs", "1"]);
    made.ends(0, &[rises, "(so in 2 of 2 runs that were made now)"]);
    let late = "response \"late\" has no value: the run ends at 30 s, before 31 s (so in 2 of 2 finished runs)";
    let collected = directory.plateau(["sweep", "collect", "study.toml"]).ends(0, &[rises, late]);
    assert!(!collected.stderr.contains("\"at\"") && !collected.stderr.contains("\"mean\""), "{}", collected.stderr);
    let results = directory.run_file("results/results.h5");
    assert_eq!(results.floats("/at"), results.floats("/end"));
    assert!(results.floats("/mean").iter().all(|area| *area > 0.0));
}
