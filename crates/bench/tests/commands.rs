//! Every subcommand runs and prints what it promises. No time is asserted: `--quick` measures nothing worth knowing.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn bench(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plateau-bench"));
    // Where there is no network, pip shall not try for minutes.
    command.env("PIP_RETRIES", "1").env("PIP_TIMEOUT", "10");
    command.args(arguments).output().expect("the program")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// Results and printed text of a quick look; none where there is no Numba.
fn quick(benchmark: &str, scene: &str) -> Option<(Value, String)> {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let path = folder.path().join("results.json");
    let scene_path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes").join(scene);
    let [json, scene_path] = [&path, &scene_path].map(|path| path.to_str().expect("a path"));
    let output = bench(&[benchmark, scene_path, "--quick", "--json", json]);
    let errors = text(&output.stderr);
    if errors.contains("no environment with Numba can be had") {
        eprintln!("skipped: {errors}");
        return None;
    }
    assert!(output.status.success(), "{benchmark}: {errors}");
    let results: Value = serde_json::from_str(&fs::read_to_string(&path).expect("results")).expect("JSON");
    let printed = text(&output.stdout).to_owned();
    expect_complete(benchmark, scene, &results, &printed);
    Some((results, printed))
}

/// What every result has: machine, build, settings, raw times, and a row of the table for each of them.
fn expect_complete(benchmark: &str, scene: &str, results: &Value, printed: &str) {
    let settings = [&results["benchmark"], &results["scene"], &results["quick"], &results["sets"][0]];
    assert_eq!(
        settings,
        [&benchmark.into(), &scene.into(), &true.into(), &Value::from("numerics.time_acceleration=1")]
    );
    let said = |part: &str, field: &str| results[part][field].as_str().filter(|text| !text.is_empty()).expect("a text");
    assert!(said("build", "compiler").starts_with("rustc "));
    let words = [
        said("machine", "processor"),
        said("machine", "system"),
        &said("build", "revision")[..7],
        said("build", "compiler"),
        said("build", "profile"),
        said("build", "target"),
        scene,
        "median of 3 blocks of about 1 ms, measured in turn",
        "the numbers mean nothing",
    ];
    let last = printed.lines().last().expect("a line below the table");
    assert!(words.iter().all(|words| last.contains(words)), "{words:?} in {last}");

    let measurements = results["measurements"].as_array().expect("measurements");
    let lines: Vec<&str> = printed.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    assert_eq!(lines.len(), measurements.len());
    for (step, line) in measurements.iter().zip(lines) {
        let raw = step["microseconds_per_step"].as_array().expect("raw times");
        assert!(raw.len() == 3 && raw.iter().all(|time| time.as_f64().is_some_and(|time| time > 0.0)), "{step}");
        let against = &measurements[step["against"].as_u64().expect("a place") as usize];
        let [name, workers, against] = [&step["name"], &step["workers"], &against["name"]];
        let cells: Vec<&str> = line.split(" | ").collect();
        assert_eq!((cells[0], cells[2]), (&*format!("| {}", name.as_str().unwrap()), &*workers.to_string()));
        assert!(cells[7].starts_with(against.as_str().expect("a name")), "{line}");
    }
}

/// Names of what was measured, in order.
fn names(results: &Value) -> Vec<&str> {
    let measurements = results["measurements"].as_array().expect("measurements");
    measurements.iter().map(|step| step["name"].as_str().expect("a name")).collect()
}

#[test]
fn kernel_times_every_instruction_set() {
    let (results, _) = quick("kernel", "cermet.toml").expect("results");
    let available: Vec<_> = plateau_core::engine::kernel::InstructionSet::available().map(|set| set.name()).collect();
    assert_eq!(names(&results)[..available.len()], available);
}

#[test]
fn scaling_times_meshes_of_growing_size() {
    let (results, _) = quick("scaling", "cermet.toml").expect("results");
    let steps = results["measurements"].as_array().expect("measurements");
    let alone = steps.iter().filter(|step| step["workers"] == 1).map(|step| step["mesh"]["rows"].as_u64());
    assert_eq!(alone.collect::<Vec<_>>(), [Some(20), Some(40)]);
    // More workers are compared with one on the same mesh, and one on a larger mesh with one on the first.
    let is_of = |step: &&Value, way: &str| step["name"].as_str().is_some_and(|name| name.starts_with(way));
    for step in steps.iter().filter(|step| is_of(step, "strong")) {
        let against = &steps[step["against"].as_u64().expect("a place") as usize];
        assert_eq!(against["workers"], 1);
        assert!(step["workers"] == 1 && against == &steps[0] || step["mesh"] == against["mesh"], "{step}");
    }
    // Columns cross boundaries between sectors, none those between bands of rows.
    for step in steps.iter().filter(|step| step["workers"] == 2) {
        let crossing = step["sharing"]["halo_bytes_per_step"].as_f64().expect("halo bytes");
        assert_eq!(crossing > 0.0, step["name"].as_str().is_some_and(|name| name.ends_with("sectors")), "{step}");
    }
}

#[test]
fn parts_times_the_scene_twice_and_every_variant() {
    let (results, _) = quick("parts", "cermet.toml").expect("results");
    let names = names(&results);
    assert_eq!(names[..2], ["the scene", "the scene once more"]);
    for name in ["no formation", "transport length of 200 um", "strength of build-up", "a sample every step"] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    // What needs friction or heat is compared with a scene that has it.
    let against = |name: &str| {
        let place = names.iter().position(|other| *other == name).expect("a row");
        names[results["measurements"][place]["against"].as_u64().expect("a place") as usize]
    };
    assert_eq!([against("braking torque"), against("lifted for 0.1 s after every 10 steps")], ["friction", "heat"]);
}

#[test]
fn peers_agree_before_they_are_timed() {
    if std::env::var_os("PLATEAU_LONG").is_none() {
        println!("skipped without PLATEAU_LONG=1: it installs Numba, of 100 MB");
        return;
    }
    let Some((results, printed)) = quick("peers", "cermet.toml") else { return };
    assert_eq!(names(&results), ["Plateau", "Numba loops"]);
    // At the scene's time acceleration and at a large one.
    for acceleration in [1, 1000] {
        let found = printed.lines().find(|line| line.contains(&format!(" at time acceleration {acceleration}: ")));
        assert!(found.is_some_and(|line| line.contains("displacement ") && line.contains("heights ")), "{printed}");
    }
}

#[test]
fn what_is_wrong_is_said() {
    let fraction = "plateaus.captured_fraction=0.06";
    for (sets, what) in [
        (&["plateaus.debris=track", fraction][..], "pooled debris"),
        (&["plateaus.formation=false"], "no formation"),
        (&["plateaus.captured_resin_fraction=0.5"], "a captured fraction of its own for resin"),
        (&["numerics.integrator=exponential"], "exponential wear"),
    ] {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let output = bench(&["peers", "--quick"].into_iter().chain(sets).collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(1), "{what}");
        assert!(text(&output.stderr).contains(&format!("the scene asks for {what}")), "{}", text(&output.stderr));
    }
    let output = bench(&["peers", "--quick", "--worn-in", "10 s"]);
    assert!(text(&output.stderr).contains("asks for surfaces that have worn in"), "{}", text(&output.stderr));
    let output = bench(&["kernel", "--quick", "--set", "output.sample_every=fast"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("output.sample_every"), "{}", text(&output.stderr));
}
