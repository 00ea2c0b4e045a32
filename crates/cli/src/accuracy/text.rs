//! What was found, as tables and sentences for people.

use plateau_core::model::parameters::Integrator;
use plateau_run::accuracy::{Advice, Measured, OwnError, Report, Row, judge};

use crate::number::{self, percent};
use crate::table::{columns, list, table};

/// Errors of the contact area for which runs are advised.
const ERRORS: [f64; 3] = [1e-2, 5e-3, 2e-3];

/// Reference, errors, advice and notes.
pub fn text(report: &Report) -> String {
    let parts = [
        reference(report),
        errors(&report.rows),
        ends(&report.rows),
        list("Advice", &advice(report)),
        if report.notes.is_empty() { String::new() } else { list("Notes", &report.notes) },
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn reference(report: &Report) -> String {
    let reference = &report.reference;
    let made = &reference.provenance;
    let source = made.file.as_ref().map_or("run here".to_owned(), |file| file.path.clone());
    let rows = [
        ("reference", format!("time_acceleration = {}, {source}", reference.time_acceleration)),
        ("its own error", own_error(&report.own_error)),
        (
            "its wall time",
            format!(
                "{} for {} steps on {}",
                // A run that had not ended when it became a reference tells none.
                reference.outcome.wall_time.map_or("not recorded,".to_owned(), number::duration),
                number::grouped(reference.outcome.steps),
                number::count(made.workers as usize, "worker")
            ),
        ),
        (
            "windows",
            format!(
                "{} of {} s, over which contact areas are compared",
                report.windows.count,
                number::short(report.windows.width)
            ),
        ),
    ];
    table(&report.title, &rows)
}

fn own_error(own: &OwnError) -> String {
    if *own == OwnError::NONE {
        return "none, it is the model itself".to_owned();
    }
    let (opening, end) = (percent(own.opening), number::short(own.end));
    let growth = match own.growth {
        1.0 => String::new(),
        growth => format!(", and errors grow to {} times that", number::rounded(growth, 2)),
    };
    let later = if own.comes_late { ", more later" } else { "" };
    let whole = percent(own.contact_area());
    format!("about {whole} in contact area: {opening} against 1 over the first {end} s{growth}{later}")
}

fn errors(rows: &[Row]) -> String {
    let names = ["run", "wall time", "steps", "contact area", "largest", "by itself", "order", "filled, largest", ""];
    let line = |row: &Row, run: &Measured| {
        let area = run.comparison.contact_area;
        let order = match (row.order.is_nan(), row.order_note.is_empty()) {
            (true, _) => String::new(),
            (_, true) => number::with_minus(&format!("{:.2}", row.order)),
            _ => format!("({})", number::with_minus(&format!("{:.2}", row.order))),
        };
        vec![
            number::duration(run.wall_time.unwrap_or(f64::NAN)),
            number::grouped(run.steps),
            if row.is_clear { percent(area.mean_square) } else { format!("({})", percent(area.mean_square)) },
            percent(area.largest),
            percent(run.change),
            order,
            percent(run.comparison.filled_largest),
            if row.on_front { "*" } else { "" }.to_owned(),
        ]
    };
    let heading =
        "Errors against the reference (* no other run is both quicker and more exact; filled: percentage points)";
    columns(heading, &names, &lines(rows, line)) + &remarks(rows)
}

/// What the table of errors cannot say in a few letters.
fn remarks(rows: &[Row]) -> String {
    let mut remarks = Vec::new();
    if rows.iter().any(|row| row.result.is_ok() && !row.is_clear) {
        remarks.push("(contact area) in brackets: the reference's own error is of that size".to_owned());
    }
    let changed = |row: &Row| row.result.as_ref().is_ok_and(|run| !run.change.is_nan());
    if rows.iter().any(changed) {
        remarks.push(
            "(by itself) contact area against the scene's own run, from which it differs in nothing else".to_owned(),
        );
    }
    let mut reasons: Vec<&str> = rows.iter().map(|row| row.order_note.as_str()).filter(|why| !why.is_empty()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    if !reasons.is_empty() {
        remarks.push(format!("(order) in brackets: {}", reasons.join("; ")));
    }
    let overshoots = |row: &&Row| row.rung.numerics.integrator == Integrator::Explicit && row.stiffness_number > 1.0;
    remarks.extend(rows.iter().filter(overshoots).map(|row| {
        let (name, stiffness) = (row.rung.full_name(), number::short(row.stiffness_number));
        format!(
            "{name}: the stiffness number is {stiffness}, above 1 the explicit rule overshoots, above 2 it is unstable"
        )
    }));
    let failed = |row: &Row| row.result.as_ref().err().map(|why| format!("{} failed: {why}", row.rung.full_name()));
    remarks.extend(rows.iter().filter_map(failed));
    remarks.into_iter().map(|remark| format!("  {remark}\n")).collect()
}

fn ends(rows: &[Row]) -> String {
    let names = [
        "run",
        "filled",
        "worn",
        "emitted",
        "disc heights",
        "pin heights",
        "contact ratio",
        "disc secondary",
        "pin secondary",
    ];
    let line = |_: &Row, run: &Measured| {
        let found = &run.comparison;
        vec![
            signed(found.filled),
            signed(found.worn),
            signed(found.emitted),
            nanometres(found.disc_height),
            nanometres(found.pin_height),
            signed(found.contact_ratio),
            signed(found.disc_secondary),
            signed(found.pin_secondary),
        ]
    };
    columns(
        "Differences from the reference at the end (heights: rms; filled, ratio and secondary: percentage points)",
        &names,
        &lines(rows, line),
    )
}

/// A line for every row, with its name; a failed run has no numbers.
fn lines(rows: &[Row], line: impl Fn(&Row, &Measured) -> Vec<String>) -> Vec<Vec<String>> {
    let cells = |row: &Row| {
        let rest = match &row.result {
            Ok(run) => line(row, run),
            Err(_) => vec!["failed".to_owned()],
        };
        std::iter::once(row.rung.name()).chain(rest).collect()
    };
    rows.iter().map(cells).collect()
}

/// A difference in per cent, with its sign.
fn signed(difference: f64) -> String {
    // Sums of areas are rounded.
    let difference = if difference.abs() < 1e-12 { 0.0 } else { difference };
    let sign = if difference > 0.0 {
        "+"
    } else if difference < 0.0 {
        "\u{2212}"
    } else {
        ""
    };
    format!("{sign}{}", percent(difference.abs()))
}

fn nanometres(length: f64) -> String {
    if length.is_nan() { "–".to_owned() } else { format!("{} nm", number::significant(length * 1e9, 3)) }
}

/// A sentence for each of the errors, or one for all of them.
pub fn advice(report: &Report) -> Vec<String> {
    let own = report.own_error;
    if own.comes_late {
        return vec![format!(
            "no setting is advised: on a disc as smooth as this one the error of every time_acceleration above 1 grows late, \
             and the reference has {}",
            report.reference.time_acceleration
        )];
    }
    let costs = report.choices();
    let clear: Vec<bool> = report.rows.iter().map(|row| row.is_clear).collect();
    let found = ERRORS.map(|error| (error, judge(error, &costs, own.contact_area(), &clear)));
    let all_same = found.iter().all(|(_, advice)| *advice == found[0].1);
    let reference = report.reference.outcome.wall_time;
    let instead = reference.map_or(String::new(), |time| format!(" instead of {}", number::duration(time)));
    let of = |index: usize| (report.rows[index].setting(), number::duration(costs[index].time), costs[index].error);
    let sentence = |(error, advice): (f64, Advice)| match advice {
        Advice::Use(index) => {
            let (name, time, _) = of(index);
            format!("for {} error in contact area use {name}: {time}{instead}", percent(error))
        }
        Advice::Missed(index) => {
            let (name, time, least) = of(index);
            let least = percent(least);
            format!("no run reaches {} error in contact area; the best has {least}: {name}, {time}", percent(error))
        }
        Advice::ReferenceInexact => {
            let wanted =
                if all_same { String::new() } else { format!(" for {} error in contact area", percent(error)) };
            let own = percent(own.contact_area());
            format!(
                "no setting is advised{wanted}: the reference's own error, about {own}, is of the size of the errors compared"
            )
        }
        Advice::NoChoice => "no setting is advised: no other run is quicker than the reference".to_owned(),
    };
    let mut advice = found.map(sentence).to_vec();
    advice.dedup();
    advice
}
