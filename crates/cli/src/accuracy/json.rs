//! What was found, as one JSON document.

use serde_json::{Map, Value, json};

use super::advice::advice;
use super::columns::{COLUMNS, TEXT_COLUMNS};
use super::report::{Report, Row};

/// The document; what is not known is null.
pub fn json(report: &Report) -> String {
    let reference = &report.reference;
    let made = &reference.provenance;
    let document = json!({
        "title": report.title,
        "reference": {
            "file": made.file.as_ref().map(|file| &file.path),
            "time_acceleration": reference.time_acceleration,
            "steps": reference.outcome.steps,
            "wall_time": reference.outcome.wall_time,
            "workers": made.workers,
        },
        "window_width": report.windows.width,
        "windows": report.windows.count,
        "runs": report.rows.iter().map(row).collect::<Vec<_>>(),
        "advice": advice(report),
        "notes": report.notes,
    });
    format!("{document:#}\n")
}

fn row(row: &Row) -> Value {
    let texts = TEXT_COLUMNS.iter().map(|column| (column.name.to_owned(), Value::from((column.value)(row))));
    // JSON has no NaN: such a number becomes null.
    let numbers = COLUMNS.iter().map(|column| (column.name.to_owned(), Value::from((column.value)(row))));
    Value::Object(texts.chain(numbers).collect::<Map<_, _>>())
}
