//! Limits of `plateau sweep optimize`: what keeps them, and where they are drawn.

use std::fs;

use super::{ask, refused, studied};

/// Worn volume is fitted as a logarithm, contact area as it is.
const LIMIT: f64 = 4e-12;

#[test]
fn what_is_asked_to_keep_a_limit_lies_on_it() {
    let directory = studied();
    for (on, kept) in [("mean", "value"), ("means", "mean_interval"), ("runs", "run_interval")] {
        let asked = ["--maximize", "contact area", "--limit", "worn<=4e-3 mm^3", "--limit-on", on];
        let best = ask(&directory, "optimize", &asked);
        let worn = &best["responses"][1][kept];
        let upper = if on == "mean" { worn.as_f64() } else { worn[1].as_f64() }.unwrap();
        assert!((upper / LIMIT - 1.0).abs() < 1e-5 && upper <= LIMIT * (1.0 + 1e-9), "{on}: {upper}");
        assert_eq!(best["limits"][0]["on"].as_str(), Some(on));
        assert_eq!(best["limits"][0]["holds_back"].as_bool(), Some(true));
    }
    // Where the limit lies is named in the figure.
    let contour = fs::read_to_string(directory.path("results/optimum/contour.svg")).unwrap();
    assert!(contour.contains("worn ≤ 4·10⁻³ mm³"), "the limit has no name in the figure");
}

#[test]
fn what_is_asked_wrongly_is_said_before_what_lies_in_the_way() {
    let directory = studied();
    ask(&directory, "optimize", &["--maximize", "contact area"]);
    let said = refused(&directory, "optimize", &["--maximize", "contakt area"]);
    assert!(said.contains("contakt area") && !said.contains("--force"), "{said}");
    let said = refused(&directory, "optimize", &["--maximize", "contact area"]);
    assert!(said.contains("has the files of an earlier call"), "{said}");
}
