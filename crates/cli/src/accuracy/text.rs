//! What was found, as a table and a sentence for people.

use plateau_core::model::parameters::Integrator;
use plateau_run::accuracy::{Advice, COMPARED, OwnError, Report, Row};

use crate::table::{columns, list, table};
use plateau_io::number::{self, percent};

/// Reference, errors, advice and notes.
pub fn text(report: &Report) -> String {
    let notes = notes(report);
    let parts = [
        reference(report),
        errors(report),
        list("Advice", &[advice(report)]),
        if notes.is_empty() { String::new() } else { list("Notes", &notes) },
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn reference(report: &Report) -> String {
    let (reference, made) = (&report.reference, &report.reference.provenance);
    let source = made.file.as_ref().map_or("run here".to_owned(), |file| file.path.clone());
    // A run that had not ended when it became a reference tells no time.
    let wall_time = reference.outcome.wall_time.map_or("not recorded,".to_owned(), number::duration);
    let (steps, workers) = (number::grouped(reference.outcome.steps), number::count(made.workers as usize, "worker"));
    let (count, width) = (report.windows.count, number::short(report.windows.width));
    let rows = [
        ("reference", format!("{}, {source}", reference.setting)),
        ("its own error", own_error(report)),
        ("its wall time", format!("{wall_time} for {steps} steps on {workers}")),
        ("windows", format!("{count} of {width} s, over whose means runs are compared")),
    ];
    table(&report.title, &rows)
}

fn own_error(report: &Report) -> String {
    if report.own == OwnError::NONE {
        return "none, it is the model itself".to_owned();
    }
    let whole = report.own.whole();
    let errors: Vec<String> =
        report.counted().map(|(one, compared)| format!("{} {}", compared.words, percent(whole[one]))).collect();
    let mut sources = Vec::new();
    if report.own.cells != OwnError::NONE.cells {
        sources.push("of its cells, as much as the change from cells twice as long".to_owned());
    }
    if report.own.end > 0.0 {
        let end = number::short(report.own.end);
        sources.push(format!("from a run with 1 over the first {end} s, growing as the other errors do"));
    }
    format!("about {}: {}", errors.join(", "), sources.join("; "))
}

fn errors(report: &Report) -> String {
    let words = COMPARED.map(|compared| compared.words);
    let names = [&["run", "wall time", "steps"], &words[..], &["worst window", ""]].concat();
    let line = |row: &Row| {
        let Ok(run) = &row.result else { return vec![row.rung.setting(), "failed".to_owned()] };
        let worst = report.counted().map(|(one, _)| run.errors[one].largest).fold(0.0, f64::max);
        let mut cells = vec![row.rung.setting(), number::duration(run.wall_time), number::grouped(run.steps)];
        cells.extend(run.errors.iter().map(|error| percent(error.mean_square)));
        cells.extend([percent(worst), if row.on_front { "*" } else { "" }.to_owned()]);
        cells
    };
    let heading = "Errors against the reference, root mean square over the windows (* no other run is both quicker and more exact)";
    columns(heading, &names, &report.rows.iter().map(line).collect::<Vec<_>>())
}

/// What the table cannot say.
fn notes(report: &Report) -> Vec<String> {
    let mut notes = report.notes.clone();
    for row in &report.rows {
        let (setting, parameters) = (row.rung.setting(), &row.rung.scene.parameters);
        if let Err(why) = &row.result {
            notes.push(format!("{setting} failed: {why}"));
        }
        let stiffness = parameters.first_stiffness_number();
        if parameters.integrator == Integrator::Explicit && stiffness > 1.0 {
            let stiffness = number::short(stiffness);
            notes.push(format!(
                "{setting}: the stiffness number is {stiffness}, above 1 the explicit rule overshoots, above 2 it is unstable"
            ));
        }
    }
    notes
}

/// One sentence: the setting for the permitted error, or the least error that there is.
pub fn advice(report: &Report) -> String {
    let tolerance = percent(report.tolerance);
    let time = report.reference.outcome.wall_time;
    let instead = time.map_or(String::new(), |time| format!(" instead of {}", number::duration(time)));
    let of = |index: usize| {
        let row: &Row = &report.rows[index];
        let time = row.result.as_ref().map_or(f64::NAN, |run| run.wall_time);
        let (error, quantity) = report.worst(row).map_or((f64::NAN, ""), |(error, compared)| (error, compared.words));
        let own = match report.own_error() {
            0.0 => String::new(),
            own => format!(", and the reference's own error is about {}", percent(own)),
        };
        (row.rung.setting(), number::duration(time), format!("{} ({quantity}){own}", percent(error)))
    };
    match report.advice() {
        Advice::Use(index) => {
            let (setting, time, error) = of(index);
            format!("for {tolerance} error use {setting}: {time}{instead}; its largest error is {error}")
        }
        Advice::Missed(index) => {
            let (setting, time, error) = of(index);
            let others = if report.asked.len() > 1 { "; --quantity asks for single quantities" } else { "" };
            format!(
                "no run has at most {tolerance} error: the least is {error}, with {setting}, {time}{instead}{others}"
            )
        }
        Advice::NoChoice => "no setting is advised: no other run is quicker than the reference".to_owned(),
    }
}
