//! `plateau sweep import`: responses that were measured or computed elsewhere become results of a study.

use plateau_io::study::imported::{self, Imported};
use plateau_io::{brief, number};
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
        idle: taken.idle,
        file: imported::file(plan.study()).display().to_string(),
    };
    if arguments.json {
        return print(&(serde_json::to_string_pretty(&summary).map_err(Failure::run)? + "\n"));
    }
    let mut rows = vec![
        ("read", format!("{} with {}", number::count(summary.lines, "line"), summary.responses.join(", "))),
        ("values", format!("{} new, {} changed", summary.new, summary.changed)),
        ("complete", format!("{} of {}", summary.complete, number::count(summary.runs, "run"))),
        ("kept in", summary.file.clone()),
    ];
    if !summary.idle.is_empty() {
        let what = brief::list(&summary.idle, "; ");
        rows.push(("not in the study", format!("{what}: kept, for the study may have it again")));
    }
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
    /// What is kept of points and responses that the study does not have now.
    idle: Vec<String>,
    file: String,
}
