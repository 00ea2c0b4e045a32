//! What the model does at its limits: each case is run and held against bounds that are stated before. `extremes/results.md` has the
//! table of them, docs/evidence/stability.md the largest values.
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
//! | single steps against the plain model over twenty decades | [`scales`] |

mod case;
mod cases;
mod local;
mod outcome;
mod scales;
mod surfaces;

use std::fs;
use std::sync::Mutex;

use case::Case;
use outcome::Outcome;

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/extremes/results.md");
const BEGIN: &str = "<!-- extremes: made by the tests -->";
const END: &str = "<!-- end of extremes -->";
const SCALES: &str = "<!-- scales: made by the tests -->";
const END_OF_SCALES: &str = "<!-- end of scales -->";
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
    let rows: String = outcomes.iter().map(|outcome| format!("| {} |\n", outcome.row().join(" | "))).collect();
    update([BEGIN, END], &format!("{HEADER}{rows}"));
}

#[test]
fn residuals_and_volumes_are_those_of_the_plain_model_over_twenty_decades() {
    let scales = scales::all();
    let wrong: Vec<_> = scales.iter().flat_map(|scale| &scale.wrong).collect();
    assert_eq!(wrong, [""; 0]);
    let rows: String = scales.iter().map(scales::Scale::row).collect();
    update([SCALES, END_OF_SCALES], &format!("{}{rows}", scales::HEADER));
}

/// Writes a table of the document anew, if that is asked for.
fn update([begin, end]: [&str; 2], table: &str) {
    if std::env::var_os("UPDATE_DOCS").is_some() {
        // Tests run at the same time.
        static WRITES: Mutex<()> = Mutex::new(());
        let _turn = WRITES.lock();
        let document = fs::read_to_string(DOCUMENT).expect(DOCUMENT);
        let (before, rest) = document.split_once(begin).expect("the place of the table");
        let (_, after) = rest.split_once(end).expect("the end of the table");
        fs::write(DOCUMENT, format!("{before}{begin}\n\n{table}\n{end}{after}")).expect(DOCUMENT);
    }
}

#[test]
fn the_document_tells_of_every_case() {
    let document = fs::read_to_string(DOCUMENT).expect(DOCUMENT);
    let is_told =
        |case: &Case| document.contains(&format!("| {} | {:.1e} |", case.name, case.parameters.stiffness_number()));
    let cases = cases::all(100_000_000);
    assert!(cases.len() > 90, "{}", cases.len());
    let missing: Vec<String> = cases.into_iter().filter(|case| !is_told(case)).map(|case| case.name).collect();
    assert_eq!(missing, [""; 0], "UPDATE_DOCS=1 PLATEAU_EXTREME_STEPS=100000000 writes the table anew");
}
