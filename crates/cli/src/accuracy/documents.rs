//! What was found, as CSV and as JSON.

use serde_json::{Map, Value, json};

use super::advice::advice;
use super::columns::{COLUMNS, TEXT_COLUMNS};
use super::report::{Report, Row};
use crate::csv_table::csv_table;

/// A line of names and one line for each row; what is not known is empty.
pub fn csv(rows: &[Row]) -> String {
    let names = TEXT_COLUMNS.iter().map(|column| column.name).chain(COLUMNS.iter().map(|column| column.name));
    let header: Vec<String> = names.map(str::to_owned).collect();
    let lines = rows.iter().map(|row| {
        let texts = TEXT_COLUMNS.iter().map(|column| (column.value)(row));
        texts.chain(COLUMNS.iter().map(|column| number((column.value)(row)))).collect()
    });
    csv_table(std::iter::once(header).chain(lines))
}

/// As short as reads back as the same number.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// One JSON document; what is not known is null.
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
            "contact_area_error": report.own_error.contact_area(),
            "opening_error": report.own_error.opening,
            "opening_end": report.own_error.end,
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

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn values_read_back() {
        assert_eq!([number(0.1), number(1e-300), number(f64::NAN), number(20.0)], ["0.1", "1e-300", "", "20.0"]);
    }
}
