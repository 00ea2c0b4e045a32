//! Every subcommand runs and writes what it promises. No time is asserted: `--quick` measures nothing worth knowing.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const BENCHMARKS: [&str; 5] = ["kernel", "scaling", "parts", "costs", "peers"];

fn bench(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plateau-bench"));
    // Where there is no network, pip shall not try for minutes.
    command.env("PIP_RETRIES", "1").env("PIP_TIMEOUT", "10");
    command.args(arguments).output().expect("the program")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// The results of a quick look, and where they are; the table has been printed.
fn quick(folder: &TempDir, benchmark: &str) -> (Value, PathBuf) {
    let path = folder.path().join(format!("{benchmark}.json"));
    let output = bench(&[benchmark, "--quick", "--json", path.to_str().expect("a path")]);
    assert!(output.status.success(), "{benchmark}: {}", text(&output.stderr));
    assert!(text(&output.stdout).contains("the numbers mean nothing"), "{benchmark}: {}", text(&output.stdout));
    let results = serde_json::from_str(&fs::read_to_string(&path).expect("results")).expect("JSON");
    (results, path)
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary directory")
}

/// A number above 0.
fn positive(value: &Value) -> bool {
    value.as_f64().is_some_and(|number| number > 0.0)
}

/// What every result has: machine, build, settings, and raw times whose spread is what is given as the time.
fn expect_complete(benchmark: &str, results: &Value) {
    expect_complete_for("cermet.toml", benchmark, results);
}

fn expect_complete_for(scene: &str, benchmark: &str, results: &Value) {
    assert_eq!(results["benchmark"], benchmark);
    assert_eq!(results["format"], 1);
    assert!(positive(&results["began"]));
    for field in ["processor", "system"] {
        assert!(results["machine"][field].as_str().is_some_and(|text| !text.is_empty()), "machine.{field}");
    }
    assert!(positive(&results["machine"]["cores"]));
    assert!(results["machine"]["caches"].is_array());
    let build = &results["build"];
    assert!(build["compiler"].as_str().is_some_and(|compiler| compiler.starts_with("rustc ")), "{build}");
    assert_eq!(build["version"], env!("CARGO_PKG_VERSION"));
    for field in ["revision", "profile", "optimization", "target"] {
        assert!(build[field].as_str().is_some_and(|text| !text.is_empty()), "build.{field}");
    }
    let settings = &results["settings"];
    assert_eq!(settings["scene"], scene);
    assert_eq!(settings["time_acceleration"], 1.0);
    assert_eq!(settings["quick"], true);

    let measurements = results["measurements"].as_array().expect("measurements");
    assert!(!measurements.is_empty());
    for step in measurements {
        let raw = step["raw_microseconds_per_step"].as_array().expect("raw times");
        assert_eq!(Some(raw.len() as u64), settings["repeats"].as_u64());
        let mut sorted: Vec<f64> = raw.iter().map(|time| time.as_f64().expect("a time")).collect();
        sorted.sort_by(f64::total_cmp);
        let spread = &step["microseconds_per_step"];
        // Three repeats: least, middle and largest are all there is.
        let given = ["minimum", "median", "maximum"].map(|name| spread[name].as_f64().expect("a time"));
        assert_eq!(sorted, given, "{step}");
        assert!(sorted[0] > 0.0 && positive(&step["nanoseconds_per_cell"]) && positive(&step["steps_per_block"]));
        assert!(positive(&step["workers"]) && positive(&step["mesh"]["rows"]), "{step}");
    }
}

/// Names of what was measured, in order.
fn names(results: &Value) -> Vec<&str> {
    let measurements = results["measurements"].as_array().expect("measurements");
    measurements.iter().map(|step| step["name"].as_str().expect("a name")).collect()
}

#[test]
fn kernel_times_every_instruction_set() {
    let (results, _) = quick(&folder(), "kernel");
    expect_complete("kernel", &results);
    let available: Vec<_> = plateau_core::engine::kernel::InstructionSet::available().map(|set| set.name()).collect();
    assert_eq!(names(&results)[..available.len()], available);
}

#[test]
fn scaling_times_meshes_of_growing_size() {
    let (results, _) = quick(&folder(), "scaling");
    expect_complete("scaling", &results);
    let steps = results["measurements"].as_array().expect("measurements");
    let alone = steps.iter().filter(|step| step["workers"] == 1).map(|step| step["mesh"]["rows"].as_u64());
    assert_eq!(alone.collect::<Vec<_>>(), [Some(20), Some(40)]);
}

#[test]
fn parts_times_the_scene_twice_and_every_variant() {
    let (results, _) = quick(&folder(), "parts");
    expect_complete("parts", &results);
    let names = names(&results);
    assert_eq!(names[..2], ["the scene", "the scene once more"]);
    for name in ["no formation", "one debris pool, no destruction", "one debris pool per track", "a sample every step"]
    {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
}

/// It runs the program `plateau`, which must have been built in the same profile.
#[test]
fn costs_runs_the_program_once_for_every_variant() {
    let (results, _) = quick(&folder(), "costs");
    assert_eq!((&results["benchmark"], &results["settings"]["scene"]), (&"costs".into(), &"quick.toml".into()));
    assert!(results["build"]["revision"].as_str().is_some_and(|text| !text.is_empty()));
    let runs = results["runs"].as_array().expect("runs");
    let names: Vec<_> = runs.iter().map(|run| run["name"].as_str().expect("a name")).collect();
    for name in [
        "the scene once more",
        "no maps",
        "no maps, two workers",
        "no maps, one debris pool, no destruction",
        "no maps, acceleration 8, by tolerance instead",
    ] {
        assert_eq!(names.iter().filter(|other| **other == name).count(), 1, "{name} in {names:?}");
    }
    let named = |name: &str| runs.iter().find(|run| run["name"] == name).expect("a variant");
    for run in runs {
        assert!(names.contains(&run["against"].as_str().expect("a name")), "{run}");
        assert!(positive(&run["steps"]) && positive(&run["file_bytes"]), "{run}");
        for number in ["minimum", "median", "maximum"] {
            assert!(positive(&run["microseconds_per_step"][number]), "{run}");
        }
        let raw = run["raw_microseconds_per_step"].as_array().expect("raw times");
        assert_eq!(Some(raw.len() as u64), results["settings"]["repeats"].as_u64(), "{run}");
    }
    // One revolution of the ring, and three.
    assert_eq!(named("no maps, one revolution")["steps"], 690);
    assert_eq!(named("no maps")["steps"], 3 * 690);
    let size = |name: &str| named(name)["file_bytes"].as_u64().expect("a size");
    assert!(size("no maps") < size("the scene") && size("the scene") < size("maps at nine times"));
    assert!(size("no maps, one revolution") < size("no maps, one revolution, a sample every step"));
}

#[test]
fn costs_says_what_is_wrong_with_its_program_and_its_scenes() {
    let output = bench(&["costs", "--quick", "--program", "nowhere/plateau"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("nowhere/plateau: found no program"), "{}", text(&output.stderr));
    let output = bench(&["costs", "--quick", "--set", "output.sample_every=fast"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("output.sample_every"), "{}", text(&output.stderr));
}

/// Checks results of the peers for a scene, which says which rule debris follows; skipped where there is no Numba.
fn expect_agreement(scene: &str, quantities: &[&str], without: Option<&str>) {
    let folder = folder();
    let path = folder.path().join("peers.json");
    let scene_path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes").join(scene);
    let [results, scene_path] = [&path, &scene_path].map(|path| path.to_str().expect("a path"));
    let output = bench(&["peers", scene_path, "--quick", "--json", results]);
    let errors = text(&output.stderr);
    if errors.contains("no environment with Numba can be had") {
        eprintln!("skipped: {errors}");
        return;
    }
    assert!(output.status.success(), "{errors}");
    let results: Value = serde_json::from_str(&fs::read_to_string(&path).expect("results")).expect("JSON");
    expect_complete_for(scene, "peers", &results);
    let names = names(&results);
    assert_eq!(names, ["Plateau", "Numba loops"]);
    let agreements = results["agreements"].as_array().expect("agreements");
    // At the scene's time acceleration and at a large one.
    assert_eq!(agreements.len(), 2);
    for peer in agreements {
        for quantity in quantities {
            assert!(peer[quantity].as_f64().is_some_and(|difference| difference <= 1e-10), "{quantity} of {peer}");
        }
        assert!(without.is_none_or(|quantity| peer.get(quantity).is_none()), "{peer}");
    }
}

#[test]
fn peers_agree_before_they_are_timed() {
    expect_agreement("cermet.toml", &["displacement", "contact_area", "deposited", "heights"], Some("pool"));
}

#[test]
fn peers_agree_where_debris_has_a_pool() {
    expect_agreement("cermet-pooled.toml", &["displacement", "contact_area", "pool", "deposited", "heights"], None);
}

#[test]
fn peers_refuse_a_scene_that_they_do_not_compute() {
    let fraction = "plateaus.captured_fraction=0.06";
    for (sets, what) in [
        (&["plateaus.debris=track", fraction][..], "one pool per track"),
        (&["plateaus.debris=contact", fraction, "plateaus.destruction=false"], "no destruction"),
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
}

#[test]
fn a_report_changes_the_tables_of_a_document_and_nothing_else() {
    let folder = folder();
    let (_, path) = quick(&folder, "kernel");
    let document = folder.path().join("performance.md");
    let [begin, end] = ["<!-- kernel: made by plateau-bench report -->", "<!-- end of kernel -->"];
    fs::write(&document, format!("By hand.\n{begin}\nold\n{end}\nMore by hand.\n")).expect("a document");
    let [path, into] = [&path, &document].map(|path| path.to_str().expect("a path"));

    let output = bench(&["report", "--into", into, path]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = bench(&["report", path]);
    let table = text(&printed.stdout);
    assert!(table.contains("| instructions | workers |"), "{table}");
    let expected = format!("By hand.\n{begin}\n\n{table}\n{end}\nMore by hand.\n");
    assert_eq!(fs::read_to_string(&document).expect("the document"), expected);

    let output = bench(&["report", path, path]);
    assert!(text(&output.stderr).contains("results of kernel were already given"), "{}", text(&output.stderr));
    fs::write(&document, "no marks").expect("a document");
    let output = bench(&["report", "--into", into, path]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains(begin), "{}", text(&output.stderr));
}

/// docs/performance.md holds the tables of the results in docs/performance, and says so where there are none.
#[test]
fn the_documented_tables_are_those_of_the_results() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let documented = fs::read_to_string(docs.join("performance.md")).expect("docs/performance.md");
    let folder = folder();
    let copy = folder.path().join("performance.md");
    fs::write(&copy, &documented).expect("a copy");
    for benchmark in BENCHMARKS {
        let results = docs.join("performance").join(format!("{benchmark}.json"));
        if results.is_file() {
            let output =
                bench(&["report", "--into", copy.to_str().expect("a path"), results.to_str().expect("a path")]);
            assert!(output.status.success(), "{}", text(&output.stderr));
        } else {
            let nothing = format!(
                "<!-- {benchmark}: made by plateau-bench report -->\n\nNot measured yet.\n\n<!-- end of {benchmark} -->"
            );
            assert!(documented.contains(&nothing), "{benchmark}: no results, but a table in docs/performance.md");
        }
    }
    let advice = "docs/performance.md differs from the results: plateau-bench report --into docs/performance.md";
    assert!(fs::read_to_string(&copy).expect("the copy") == documented, "{advice} docs/performance/*.json");
}
