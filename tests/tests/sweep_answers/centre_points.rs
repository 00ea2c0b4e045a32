//! A table of two levels with centre points: what it tells, what it does not, and limits that cannot be kept.

use std::fs;

use plateau_tests::program::WorkingDirectory;
use plateau_tests::table::rows;
use serde_json::Value;

use super::ask;

/// Two numbers at two levels each with five centre points (Montgomery's example 6.7), and a response with a curve of 5.
fn centre_points() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let places =
        [(100, 0.2), (200, 0.2), (100, 0.4), (200, 0.4), (150, 0.3), (150, 0.3), (150, 0.3), (150, 0.3), (150, 0.3)];
    let yields = [39.3, 40.0, 40.9, 41.5, 40.3, 40.5, 40.7, 40.2, 40.6];
    let mut table = "load,fibres,yield,bent\n".to_owned();
    for (at, ((load, fibres), value)) in places.into_iter().zip(yields).enumerate() {
        table.push_str(&format!("{load} N,{fibres},{value},{}\n", if at < 4 { value } else { value + 5.0 }));
    }
    directory.write("points.csv", table);
    let mut study =
        "version = 1\ntitle = \"Centre\"\ndesign = \"csv\"\nfile = \"points.csv\"\ndirectory = \"results\"\n"
            .to_owned();
    for (name, key) in [("load", "operation.normal_force"), ("fibres", "pin.base.synthetic.fibre_fraction")] {
        study.push_str(&format!("[[factor]]\nname = \"{name}\"\nkey = \"{key}\"\n"));
    }
    for name in ["yield", "bent"] {
        study.push_str(&format!("[[response]]\nname = \"{name}\"\nimported = true\n"));
    }
    directory.write("study.toml", study);
    ask(&directory, "import", &["points.csv"]);
    directory
}

#[test]
fn centre_points_of_a_table_tell_a_curve_and_not_whose() {
    let directory = centre_points();
    let effects = ask(&directory, "effects", &[]);
    let of = |at: usize| &effects["responses"][at];
    let number = |value: &Value| value.as_f64().expect("a number");
    let labels = |at: usize| -> Vec<String> {
        let terms = of(at)["terms"].as_array().expect("terms");
        terms.iter().map(|term| term["label"].as_str().unwrap_or_default().to_owned()).collect()
    };
    assert_eq!(labels(0), ["load", "fibres", "load × fibres"]);
    // Published effects: 1.55 and 0.65, and their interaction −0.05; the curve 0.035 with F 0.063.
    let published = [0.65, 1.55, -0.05];
    for (term, expected) in of(0)["terms"].as_array().expect("terms").iter().zip(published) {
        assert!((number(&term["effect"]) - expected).abs() < 1e-9, "{term}");
        assert!((number(&term["variance_inflation"]) - 1.0).abs() < 1e-9, "{term}");
    }
    assert!((number(&of(0)["curvature"]["difference"]) - 0.035).abs() < 1e-9, "{effects}");
    assert!((number(&of(0)["curvature"]["f"]) - 0.0633).abs() < 1e-4, "{effects}");
    assert!(number(&of(1)["curvature"]["p"]) < 1e-4, "{effects}");
    // Squares are not advised where they cannot be told.
    assert!(of(1)["misfit"]["model_to_try"].is_null(), "{effects}");
    let text = directory.plateau(["sweep", "effects", "study.toml", "--force"]).quiet_success();
    assert!(text.contains("no curve is seen") && text.contains("the response is curved"), "{text}");
    // Leverages add up to the number of coefficients: four of each response.
    let runs = fs::read_to_string(directory.path("results/effects/residuals.csv")).unwrap();
    let sum: f64 = rows(&runs).iter().map(|row| row["leverage"].parse::<f64>().unwrap()).sum();
    assert!((sum - 8.0).abs() < 1e-9, "{runs}");

    // With squares, what is between a corner and the centre is not told.
    let at = ["--at", "load=150 N", "--at", "fibres=0.4", "--model", "quadratic"];
    let text = directory.plateau([&["sweep", "predict", "study.toml"][..], &at].concat()).quiet_success();
    assert!(text.contains("yield: the runs do not tell it here"), "{text}");
}

#[test]
fn limits_that_cannot_be_kept_are_said_with_an_exit_status() {
    let directory = centre_points();
    let limits = ["--maximize", "yield", "--limit", "yield<=39", "--limit", "bent<=60"];
    let outcome = directory.plateau([&["sweep", "optimize", "study.toml"][..], &limits].concat());
    assert_eq!(outcome.status, Some(1), "{outcome:?}");
    let text = &outcome.stdout;
    assert!(
        text.contains("no settings within the ranges keep all limits; they are missed least at load = 100 N"),
        "{text}"
    );
    assert!(
        text.contains("desirability 0\n") && text.contains("yield ≤ 39: missed; the least within the ranges is"),
        "{text}"
    );
    let keep = ["--maximize", "yield", "--limit", "yield<=41"];
    let on_mean =
        directory.plateau([&["sweep", "optimize", "study.toml"][..], &keep, &["--force"]].concat()).quiet_success();
    assert!(on_mean.contains("held back by yield ≤ 41; the predicted mean lies on it"), "{on_mean}");
    let found = ask(&directory, "optimize", &[&keep[..], &["--limit-on", "runs"]].concat());
    let interval = found["responses"][0]["run_interval"].as_array().expect("an interval");
    assert!((interval[1].as_f64().unwrap() - 41.0).abs() < 1e-3, "{found}");
    assert_eq!(found["limits"][0]["on"].as_str(), Some("runs"), "{found}");
}
