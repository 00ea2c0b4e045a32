//! What `plateau fit --plan` says: what is fitted to what, and what it will cost.

use plateau_io::study::collected::unit_of;
use plateau_io::study::plan::Plan;
use plateau_present::Unit;
use serde::Serialize;

use super::task::Task;
use crate::arguments::FitArguments;
use crate::failure::Failure;
use crate::number;
use crate::sweep::estimate::Estimate;
use crate::sweep::resolved::Resolved;
use crate::table::{columns, print, table};

/// The document; numbers in SI units.
#[derive(Debug, Serialize)]
struct Document<'a> {
    study: &'a str,
    keys: Vec<&'a str>,
    responses: Vec<&'a str>,
    first_runs: usize,
    runs_at_most: usize,
    /// Wall time of all runs, s.
    estimated_time: f64,
    /// Memory of the largest run, bytes.
    memory: u64,
}

/// Says what is to be done.
///
/// # Errors
/// [`Failure::Input`] when scenes or surfaces cannot be built.
pub fn say(plan: &Plan, task: &Task, arguments: &FitArguments) -> Result<(), Failure> {
    let study = plan.study();
    let estimate = Estimate::of(plan)?;
    estimate.warnings.say("runs whose surfaces were made to try");
    let resolved = Resolved::of(plan)?;
    resolved.refuse_unrecorded(study)?;
    resolved.warnings.say("runs to begin with");
    let most = study.fit.runs.max(plan.runs());
    let jobs = arguments.cores.runs_at_a_time();
    let time = estimate.mean_time * most as f64 / jobs as f64;
    if arguments.json {
        let document = Document {
            study: &study.title,
            keys: study.factors.iter().map(|factor| factor.name.as_str()).collect(),
            responses: task.responses.iter().chain(&task.series).map(|at| study.responses[*at].name.as_str()).collect(),
            first_runs: plan.runs(),
            runs_at_most: most,
            estimated_time: time,
            memory: estimate.memory,
        };
        return print(&(serde_json::to_string_pretty(&document).map_err(Failure::run)? + "\n"));
    }
    let keys = study.factors.iter().map(|factor| vec![factor.name.clone(), factor.to_string()]);
    let responses = task.responses.iter().zip(&task.measurements).map(|(at, measured)| {
        let response = &study.responses[*at];
        let unit = Unit::readable_with_differences(response.unit(unit_of(&response.series)), measured.value.abs());
        let [value, uncertainty] = [unit.value(measured.value), unit.difference(measured.uncertainty)];
        vec![response.name.clone(), unit.with_symbol(&number::with_error(value, Some(uncertainty)))]
    });
    let series = task.series.iter().filter_map(|at| {
        let (response, file) = (&study.responses[*at], study.responses[*at].measured_series()?);
        let times = file.series.times();
        let [from, to] = [times.first()?, times.last()?].map(|time| number::rounded(*time, 6));
        let points = number::count(times.len(), "point");
        Some(vec![response.name.clone(), format!("{points} from {from} to {to} s in {}", file.path.display())])
    });
    let responses = responses.chain(series);
    let mut text = columns("Looked for", &["key", "between"], &keys.collect::<Vec<_>>());
    text.push_str(&columns("\nFitted to", &["response", "measured"], &responses.collect::<Vec<_>>()));
    let rows = [
        ("first runs", number::count(plan.runs(), "run")),
        ("at most", number::count(most, "run")),
        ("estimated", format!("{} for all, {jobs} at a time", number::duration(time))),
        ("memory", format!("{} for each", number::bytes(estimate.memory))),
    ];
    text.push('\n');
    print(&(text + &table(&study.title, &rows)))
}
