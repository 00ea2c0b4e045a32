//! What was found, as tables for people.

use super::advice::{advice, percent};
use super::report::{Measured, Report, Row};
use crate::number;
use crate::table::{columns, list, table};

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
        (
            "its wall time",
            format!(
                "{} for {} steps on {} workers",
                number::duration(reference.outcome.wall_time),
                number::grouped(reference.outcome.steps),
                made.workers
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

fn errors(rows: &[Row]) -> String {
    let names = ["run", "wall time", "steps", "contact area", "largest", "from own", "order", "filled, largest", ""];
    let line = |row: &Row, run: &Measured| {
        let area = run.comparison.contact_area;
        let order = match (row.order.is_nan(), row.order_note.is_empty()) {
            (true, _) => String::new(),
            (_, true) => format!("{:.2}", row.order),
            _ => format!("({:.2})", row.order),
        };
        vec![
            number::duration(run.wall_time),
            number::grouped(run.steps),
            percent(area.mean_square),
            percent(area.largest),
            percent(run.change),
            order,
            percent(run.comparison.filled_largest),
            if row.on_front { "*" } else { "" }.to_owned(),
        ]
    };
    let text =
        columns("Errors against the reference (* no other run is as quick and as exact)", &names, &lines(rows, line));
    let mut reasons: Vec<&str> =
        rows.iter().map(|row| row.order_note.as_str()).filter(|note| !note.is_empty()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    let why = if reasons.is_empty() { String::new() } else { format!("  (order) {}\n", reasons.join("; ")) };
    text + &why
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
    columns("Differences from the reference at the end (heights: rms)", &names, &lines(rows, line))
}

/// A line for every row, with its name; a failed run says why.
fn lines(rows: &[Row], line: impl Fn(&Row, &Measured) -> Vec<String>) -> Vec<Vec<String>> {
    let cells = |row: &Row| {
        let rest = match &row.result {
            Ok(run) => line(row, run),
            Err(failure) => vec![format!("failed: {failure}")],
        };
        std::iter::once(row.rung.name()).chain(rest).collect()
    };
    rows.iter().map(cells).collect()
}

/// A difference in per cent, with its sign.
fn signed(difference: f64) -> String {
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
