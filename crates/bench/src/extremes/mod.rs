//! What the model does at its limits: each case is run and held against bounds that are stated before.
//!
//! ```text
//! case       a simulation at a limit, and what must come of it
//! surfaces   surfaces of cases
//! cases      all of them
//! local      what local debris keeps besides
//! outcome    what came of a case: residuals, overshoot, readings, and whether that is within the bounds
//! ```

mod case;
mod cases;
mod local;
mod outcome;
mod surfaces;

use std::path::PathBuf;

use clap::Parser;

use crate::build::Build;
use crate::error::BenchError;
use crate::machine::Machine;
use crate::report;
use crate::table::Table;
use outcome::Outcome;

/// What Plateau does with extreme input: every case with its residuals, and whether it keeps its bounds.
#[derive(Debug, Parser)]
#[command(name = "extremes", version, max_term_width = 100)]
#[command(after_help = "Exit status: 0 every case keeps its bounds, 1 one does not.\n\n\
                        Example:\n  extremes --into docs/stability.md")]
pub struct Arguments {
    /// A thousandth of the steps where their number is the case: a million instead of a billion
    #[arg(long)]
    quick: bool,
    /// Only cases whose name has this text
    #[arg(long, value_name = "TEXT", default_value = "")]
    only: String,
    /// Put the table into a document, between its marks, besides printing it
    #[arg(long, value_name = "MARKDOWN")]
    into: Option<PathBuf>,
}

impl Arguments {
    /// Runs the cases; whether all of them keep their bounds.
    ///
    /// # Errors
    /// When the document cannot be changed.
    pub fn perform(&self) -> Result<bool, BenchError> {
        let cases = cases::all(if self.quick { 1_000_000 } else { 1_000_000_000 });
        let outcomes: Vec<Outcome> =
            cases.into_iter().filter(|case| case.name.contains(&self.only)).map(Outcome::of).collect();
        let table = table(&outcomes);
        print!("{}", table.text());
        if let Some(document) = &self.into {
            report::replace(document, "extremes", &table.markdown())?;
        }
        let failed = outcomes.iter().filter(|outcome| !outcome.verdict.is_pass()).count();
        println!("{} passed, {failed} failed", outcomes.len() - failed);
        Ok(failed == 0)
    }
}

fn table(outcomes: &[Outcome]) -> Table {
    let header = [
        "case",
        "Π",
        "steps",
        "load residual",
        "balance residual",
        "overshoot",
        "extra readings",
        "expected",
        "verdict",
    ];
    let mut table = Table::new("Cases at the limits", &header);
    table.rows.extend(outcomes.iter().map(Outcome::row));
    let (machine, build) = (Machine::this(), Build::this());
    let revision: String = build.revision.chars().take(12).collect();
    table.notes.push(format!("{}; revision {revision}, {}, {}.", machine.processor, build.compiler, build.profile));
    table
}
