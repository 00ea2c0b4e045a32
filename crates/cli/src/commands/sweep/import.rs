//! `plateau sweep import`: responses that were measured or computed elsewhere become results of a study.

use plateau_io::number;
use plateau_io::study::imported::{self, Imported};
use serde::Serialize;

use crate::arguments::ImportArguments;
use crate::failure::Failure;
use crate::sweep;
use crate::table::{print, table};

/// Takes in a table.
pub fn import(arguments: &ImportArguments) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let taken = Imported::take_in(&plan, &arguments.table, arguments.force).map_err(Failure::input)?;
    let summary = Summary {
        study: &plan.study().title,
        lines: taken.lines,
        responses: taken.responses,
        new: taken.new,
        changed: taken.changed,
        runs: plan.runs(),
        complete: taken.complete,
        file: imported::file(plan.study()).display().to_string(),
    };
    if arguments.json {
        return print(&(serde_json::to_string_pretty(&summary).map_err(Failure::run)? + "\n"));
    }
    let rows = [
        ("read", format!("{} with {}", number::count(summary.lines, "line"), summary.responses.join(", "))),
        ("values", format!("{} new, {} changed", summary.new, summary.changed)),
        ("complete", format!("{} of {}", summary.complete, number::count(summary.runs, "run"))),
        ("kept in", summary.file.clone()),
    ];
    print(&table(summary.study, &rows))
}

/// What was taken in.
#[derive(Debug, Serialize)]
struct Summary<'a> {
    study: &'a str,
    lines: usize,
    responses: Vec<String>,
    new: usize,
    changed: usize,
    runs: usize,
    /// Runs that have all imported responses.
    complete: usize,
    file: String,
}
