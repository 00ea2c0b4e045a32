//! `plateau sweep sensitivity`: parts of the variation of a response whose function is known.
//!
//! What wears off the pin's plateaus is load × sliding distance × specific wear rate (model.md, section 8). For a product of two
//! independent factors with means m and variances v, the parts of the variance are v₁m₂², v₂m₁² and v₁v₂ for both together.

use std::fs;

use plateau_tests::figure::Figure;
use plateau_tests::program::{Outcome, WorkingDirectory, scene};
use plateau_tests::table::{number, rows};
use serde_json::Value;

/// Load from 4 to 12 N, wear rate from 2 to 8·10⁻¹⁴ 1/Pa, and a modulus that has nothing to do with wear.
fn study(design: &str) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write(
        "study.toml",
        format!(
            "version = 1\ntitle = \"Parts\"\nbase = \"{}\"\n\
             set = [\"operation.duration = '2 s'\", \"output.sample_every = '0.5 s'\"]\n{design}\ndirectory = \"results\"\n\
             [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nrange = [\"4 N\", \"12 N\"]\n\
             [[factor]]\nname = \"wear rate\"\nkey = \"materials.pin_primary.specific_wear_rate\"\n\
             range = [\"2e-14 1/Pa\", \"8e-14 1/Pa\"]\n\
             [[factor]]\nname = \"modulus\"\nkey = \"materials.pin_primary.youngs_modulus\"\nrange = [\"5e8 Pa\", \"2e9 Pa\"]\n\
             [[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\n",
            scene("quick.toml")
        ),
    );
    directory.plateau(["sweep", "run", "study.toml"]).quiet_success();
    directory
}

fn sensitivity(directory: &WorkingDirectory, arguments: &[&str]) -> Outcome {
    let outcome = directory.plateau(["sweep", "sensitivity", "study.toml", "--force"].iter().chain(arguments));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    outcome
}

#[test]
fn without_results_nothing_is_written_and_what_to_do_is_said() {
    let directory = WorkingDirectory::new();
    let scene = scene("quick.toml");
    directory.write(
        "study.toml",
        format!(
            "version = 1\ntitle = \"None\"\nbase = \"{scene}\"\ndesign = \"full-factorial\"\ndirectory = \"results\"\n\
             [[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nlevels = [\"4 N\", \"12 N\"]\n\
             [[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\n"
        ),
    );
    for command in [&["effects"][..], &["sensitivity"], &["predict"], &["optimize", "--maximize", "worn"]] {
        let outcome = directory.plateau(["sweep", command[0], "study.toml"].iter().chain(&command[1..]));
        assert_eq!(outcome.status, Some(1), "{outcome:?}");
        assert!(outcome.stderr.contains("sweep run study.toml makes the runs"), "{outcome:?}");
    }
    assert!(!directory.path("results/effects/effects.csv").exists());
    assert!(!directory.path("results/sensitivity/sensitivity.csv").exists());
}

#[test]
fn parts_of_a_product() {
    let directory = study("design = \"sobol\"\npoints = 24");
    let found: Value = serde_json::from_str(&sensitivity(&directory, &["--json"]).stdout).unwrap();
    let indices = &found["responses"][0]["indices"];
    // Means 8 N and 5e-14 1/Pa; variances of even distributions, (high − low)²/12.
    let (load, rate) = ([8.0_f64, 64.0 / 12.0], [5.0_f64, 36.0 / 12.0]);
    let parts = [load[1] * rate[0].powi(2), rate[1] * load[0].powi(2), load[1] * rate[1]];
    let all: f64 = parts.iter().sum();
    let expected = [[parts[0], parts[0] + parts[2]], [parts[1], parts[1] + parts[2]], [0.0, 0.0]];
    for (at, [first, total]) in expected.into_iter().enumerate() {
        // The sample of 2048 rows has errors of 0.02 at most, the surrogate of a product fewer.
        let near = |what: &str, part: f64| {
            let value = indices[at][what]["value"].as_f64().unwrap();
            assert!((value - part / all).abs() < 0.03, "{what} of factor {at}: {found}");
        };
        near("first_order", first);
        near("total", total);
    }
    let text = sensitivity(&directory, &[]).stdout;
    assert!(text.contains("leave-one-out error: "), "{text}");
    let table = rows(&fs::read_to_string(directory.path("results/sensitivity/sensitivity.csv")).unwrap());
    assert_eq!(number(&table[1], "total"), indices[1]["total"]["value"].as_f64().unwrap());
    let figure = fs::read_to_string(directory.path("results/sensitivity/worn-indices.svg")).unwrap();
    assert!(Figure::read(&figure).texts.iter().any(|text| text.text == "wear rate"), "{figure}");
}

#[test]
fn elementary_effects_of_a_product() {
    let directory = study("design = \"morris\"\ntrajectories = 8\nlevels = 4");
    let found: Value = serde_json::from_str(&sensitivity(&directory, &["--json"]).stdout).unwrap();
    let effects = &found["responses"][0]["elementary_effects"];
    let size = |at: usize| effects[at]["mean_size"].as_f64().unwrap();
    // Per whole range: 8 N × rate and 6e-14 1/Pa × load, each times the distance; the others are between their ends.
    let distance = std::f64::consts::TAU * 0.0205 * 850.0 / 60.0 * 2.0;
    assert!((8.0 * 2e-14 * distance..=8.0 * 8e-14 * distance).contains(&size(0)), "{found}");
    assert!((6e-14 * 4.0 * distance..=6e-14 * 12.0 * distance).contains(&size(1)), "{found}");
    assert!(size(2) < 0.02 * size(0).min(size(1)), "{found}");
    // Effects of a factor in a product differ from place to place.
    assert!(effects[0]["deviation"].as_f64().unwrap() > 0.1 * size(0), "{found}");
    assert_eq!(effects[0]["effects"].as_u64(), Some(8));
    assert!(sensitivity(&directory, &[]).stdout.contains("elementary effects per whole range"));
    assert!(directory.path("results/sensitivity/worn-effects.png").exists());
}
