//! Warnings of what is legal and cannot be meant, through the program.

use plateau_tests::program::{Outcome, WorkingDirectory, quick_scene_with, scene};
use plateau_tests::scenes::few_or_all;
use serde_json::Value;

/// Standard output as JSON, and the lines of standard error, of a success.
fn told(outcome: Outcome) -> (Value, Vec<String>) {
    let outcome = outcome.ends(0, &[]);
    (outcome.json(), outcome.stderr.lines().map(str::to_owned).collect())
}

/// The keys of the list `warnings`, each of whose texts must be in one line of standard error.
fn keys((document, lines): &(Value, Vec<String>)) -> Vec<String> {
    let warnings = document["warnings"].as_array().expect("a list");
    assert_eq!(warnings.len(), lines.len(), "{lines:?}");
    for (warning, line) in warnings.iter().zip(lines) {
        let text = |name: &str| warning[name].as_str().unwrap_or_else(|| panic!("{name} is not in {warning}"));
        let [place, key, found, bound, advice] = ["place", "key", "found", "bound", "advice"].map(text);
        assert_eq!(*line, format!("plateau: warning: {place}: {key}: {found}, {bound}; {advice}"));
    }
    warnings.iter().map(|warning| warning["key"].as_str().expect("a key").to_owned()).collect()
}

#[test]
fn a_slip_of_the_unit_is_told_by_check_and_run_and_stops_neither() {
    let directory = WorkingDirectory::new();
    // 5 MN instead of 5 N: 5e6 N on 40 of 690 columns of a ring from 20 to 21 mm are 669.6 GPa.
    let edits = [("\"5 N\"", "\"5 MN\""), ("duration = \"60 s\"", "steps = 3"), ("sample_every = \"0.1 s\"\n", "")];
    directory.write("scene.toml", quick_scene_with(&edits));
    let expected = "plateau: warning: scene.toml:14:16: operation.normal_force: a nominal pressure of 669.6 GPa, more than a \
                    tenth of the softest plateau's modulus of 1 GPa; check the force, the size of the pin in [mesh] and \
                    the moduli in [materials]";
    let force_and_overlap = ["operation.normal_force", "contact.foundation_height"];
    for command in ["check", "run"] {
        let told = told(directory.plateau([command, "scene.toml", "--json"]));
        assert_eq!(keys(&told), force_and_overlap, "{command}");
        assert_eq!(told.1[0], expected, "{command}");
    }
    let text = directory.plateau(["run", "scene.toml", "--force"]);
    assert!(text.stderr.starts_with(expected) && text.stdout.contains("contact area"), "{}", text.stderr);
}

#[test]
fn a_run_tells_at_its_end_that_the_disc_wore_below_its_lowlands() {
    let edits = [("duration = \"60 s\"", "steps = 1380"), ("sample_every = \"0.1 s\"\n", "")];
    let directory = WorkingDirectory::with_scene(&edits);
    let run = |wear_rate: &str| {
        let wear_rate = format!("materials.disc_primary.specific_wear_rate={wear_rate}");
        let sets = ["--set", &wear_rate, "--set", "plateaus.formation=false"];
        told(directory.plateau(["run", "scene.toml", "--json", "--force"].iter().chain(&sets)))
    };
    let worn = run("5e-13 1/Pa");
    // It opens as soon as it wears anywhere but on its highest cells.
    assert!(worn.0["filled_fraction"].as_f64().expect("a number") < 0.0, "{}", worn.0);
    assert_eq!(keys(&worn), ["materials.disc_primary.specific_wear_rate"]);
    assert!(worn.1[0].contains("a filled fraction of -") && worn.1[0].contains("outside of 0 to 1"), "{}", worn.1[0]);
    let sound = run("0 1/Pa");
    assert_eq!((sound.0["filled_fraction"].as_f64(), keys(&sound)), (Some(0.0), vec![]));
}

#[test]
fn shipped_scenes_are_checked_without_a_word() {
    let scenes = std::fs::read_dir(scene("")).expect("the shipped scenes");
    let mut checked = 0;
    for path in scenes.map(|entry| entry.expect("an entry").path()) {
        // The surfaces of a whole pad take half a minute to make.
        if few_or_all(path.ends_with("pad.toml"), false) {
            println!("skipped without PLATEAU_LONG=1: {}", path.display());
            continue;
        }
        if path.extension().is_some_and(|ending| ending == "toml") {
            let told = WorkingDirectory::new().plateau(["check", &path.display().to_string(), "--json"]);
            let document = told.ends(0, &[]).json();
            assert_eq!(document["warnings"], serde_json::json!([]), "{}", path.display());
            checked += 1;
        }
    }
    assert!(checked >= 6, "{checked}");
}
