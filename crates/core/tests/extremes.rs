//! What the model does at its limits: each case is run and held against bounds that are stated before. docs/stability.md has the
//! table of them.
//!
//! A case of very many steps takes a million of them here, or as many as `PLATEAU_EXTREME_STEPS` says. With
//! `UPDATE_DOCS=1` the table is written anew.
//!
//! | what | where |
//! |---|---|
//! | a simulation at a limit, and what must come of it | [`case`], all of them in [`cases`] |
//! | its surfaces | [`surfaces`] |
//! | what local debris keeps besides | [`local`] |
//! | what came of it: residuals, overshoot, readings | [`outcome`] |

mod case;
mod cases;
mod local;
mod outcome;
mod surfaces;

use std::fs;

use case::Case;
use outcome::Outcome;

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/stability.md");
const BEGIN: &str = "<!-- extremes: made by the tests -->";
const END: &str = "<!-- end of extremes -->";
const HEADER: &str = "| case | Π | steps | load residual | balance residual | overshoot | extra readings | expected | verdict |\n\
                      |---|---:|---:|---:|---:|---:|---:|---:|---:|\n";

/// Steps of the case of most steps.
fn most_steps() -> u64 {
    std::env::var("PLATEAU_EXTREME_STEPS").map_or(1_000_000, |steps| steps.parse().expect("a number of steps"))
}

#[test]
fn every_case_keeps_its_bounds() {
    let outcomes: Vec<Outcome> = cases::all(most_steps()).into_iter().map(Outcome::of).collect();
    let failed: Vec<_> = outcomes.iter().filter(|outcome| !outcome.verdict.is_pass()).map(Outcome::row).collect();
    assert_eq!(failed, [[""; 0]; 0]);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let rows: String = outcomes.iter().map(|outcome| format!("| {} |\n", outcome.row().join(" | "))).collect();
        let document = fs::read_to_string(DOCUMENT).expect("docs/stability.md");
        let (before, rest) = document.split_once(BEGIN).expect("the place of the table");
        let (_, after) = rest.split_once(END).expect("the end of the table");
        fs::write(DOCUMENT, format!("{before}{BEGIN}\n\n{HEADER}{rows}\n{END}{after}")).expect("docs/stability.md");
    }
}

#[test]
fn the_document_tells_of_every_case() {
    let document = fs::read_to_string(DOCUMENT).expect("docs/stability.md");
    let is_told =
        |case: &Case| document.contains(&format!("| {} | {:.1e} |", case.name, case.parameters.stiffness_number()));
    let cases = cases::all(1_000_000_000);
    assert!(cases.len() > 90, "{}", cases.len());
    let missing: Vec<String> = cases.into_iter().filter(|case| !is_told(case)).map(|case| case.name).collect();
    assert_eq!(missing, [""; 0], "UPDATE_DOCS=1 PLATEAU_EXTREME_STEPS=1000000000 writes the table anew");
}
