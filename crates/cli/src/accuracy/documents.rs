//! What was found, as CSV and as JSON; docs/accuracy.md tells what the columns mean.

use plateau_io::dataset_file::now;
use plateau_io::run_file::InputFile;
use plateau_run::accuracy::{Measured, Report, Row, integrator_name};
use serde_json::{Map, Value, json};

use super::text::advice;
use crate::csv_table::csv_table;
use crate::{machine, version};

/// A number that every row has, by its name; NaN where it is not known.
pub type Column = (&'static str, fn(&Row) -> f64);

fn measured(row: &Row, value: impl Fn(&Measured) -> f64) -> f64 {
    row.result.as_ref().map_or(f64::NAN, value)
}

/// All of them.
pub const COLUMNS: &[Column] = &[
    ("value", |row| row.rung.value()),
    ("time_acceleration", |row| row.rung.numerics.time_acceleration),
    ("rows", |row| row.cells[0] as f64),
    ("disc_columns", |row| row.cells[1] as f64),
    ("pin_columns", |row| row.cells[2] as f64),
    ("perturbation", |row| row.rung.numerics.perturbation),
    ("stiffness_number", |row| row.stiffness_number),
    ("wall_time", |row| measured(row, |run| run.wall_time.unwrap_or(f64::NAN))),
    ("steps", |row| measured(row, |run| run.steps as f64)),
    ("contact_area_error", |row| measured(row, |run| run.comparison.contact_area.mean_square)),
    ("above_reference_error", |row| f64::from(u8::from(row.is_clear))),
    ("contact_area_largest_error", |row| measured(row, |run| run.comparison.contact_area.largest)),
    ("contact_area_change", |row| measured(row, |run| run.change)),
    ("order", |row| row.order),
    ("filled_fraction_error", |row| measured(row, |run| run.comparison.filled)),
    ("filled_fraction_largest_error", |row| measured(row, |run| run.comparison.filled_largest)),
    ("worn_error", |row| measured(row, |run| run.comparison.worn)),
    ("emitted_error", |row| measured(row, |run| run.comparison.emitted)),
    ("disc_height_error", |row| measured(row, |run| run.comparison.disc_height)),
    ("pin_height_error", |row| measured(row, |run| run.comparison.pin_height)),
    ("contact_ratio_error", |row| measured(row, |run| run.comparison.contact_ratio)),
    ("disc_secondary_error", |row| measured(row, |run| run.comparison.disc_secondary)),
    ("pin_secondary_error", |row| measured(row, |run| run.comparison.pin_secondary)),
    ("load_residual", |row| measured(row, |run| run.load_residual)),
    ("balance_residual", |row| measured(row, |run| run.balance_residual)),
    ("on_front", |row| f64::from(u8::from(row.on_front))),
];

/// A text that every row has, by its name.
pub type TextColumn = (&'static str, fn(&Row) -> String);

/// All of them.
pub const TEXT_COLUMNS: &[TextColumn] = &[
    ("ladder", |row| row.rung.ladder.name().to_owned()),
    ("setting", Row::setting),
    ("integrator", |row| integrator_name(row.rung.numerics.integrator).to_owned()),
    ("state", |row| if row.result.is_ok() { "finished" } else { "failed" }.to_owned()),
    ("failure", |row| row.result.as_ref().err().cloned().unwrap_or_default()),
    ("order_note", |row| row.order_note.clone()),
];

/// How the runs were made.
#[derive(Debug, Clone)]
pub struct Making {
    /// The whole resolved scene.
    pub scene: String,
    /// Files that the scene reads.
    pub inputs: Vec<InputFile>,
    /// Workers.
    pub workers: usize,
    /// Instruction set.
    pub instruction_set: &'static str,
    /// Budget, s.
    pub budget: f64,
    /// When it was started.
    pub start_time: String,
    /// Whether all runs were made: `finished`, or `interrupted`.
    pub state: &'static str,
}

/// A line of names and one line for each row; what is not known is empty.
pub fn csv(rows: &[Row]) -> String {
    let names = TEXT_COLUMNS.iter().map(|(name, _)| *name).chain(COLUMNS.iter().map(|(name, _)| *name));
    let header: Vec<String> = names.map(str::to_owned).collect();
    let lines = rows.iter().map(|row| {
        let texts = TEXT_COLUMNS.iter().map(|(_, value)| value(row));
        texts.chain(COLUMNS.iter().map(|(_, value)| number(value(row)))).collect()
    });
    csv_table(std::iter::once(header).chain(lines))
}

/// As short as reads back as the same number.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// One JSON document; what is not known is null.
pub fn json(report: &Report, making: &Making) -> String {
    let reference = &report.reference;
    let made = &reference.provenance;
    let document = json!({
        "title": report.title,
        "state": making.state,
        "reference": {
            "file": made.file.as_ref().map(|file| &file.path),
            "sha256": made.file.as_ref().map(|file| &file.sha256),
            "time_acceleration": reference.time_acceleration,
            "steps": reference.outcome.steps,
            "wall_time": reference.outcome.wall_time,
            "workers": made.workers,
            "program": made.program,
            "source_revision": made.source_revision,
            "host": made.host,
            "start_time": made.start_time,
            "contact_area_error": report.own_error.contact_area(),
            "opening_error": report.own_error.opening,
            "opening_end": report.own_error.end,
        },
        "window_width": report.windows.width,
        "windows": report.windows.count,
        "runs": report.rows.iter().map(row).collect::<Vec<_>>(),
        "advice": advice(report),
        "notes": report.notes,
        "program": version::program(),
        "source_revision": version::REVISION,
        "host": machine::host(),
        "processor": machine::processor(),
        "workers": making.workers,
        "instruction_set": making.instruction_set,
        "budget": making.budget,
        "start_time": making.start_time,
        "end_time": now(),
        "inputs": making.inputs,
        "scene": making.scene,
    });
    format!("{document:#}\n")
}

fn row(row: &Row) -> Value {
    let texts = TEXT_COLUMNS.iter().map(|(name, value)| ((*name).to_owned(), Value::from(value(row))));
    // JSON has no NaN: such a number becomes null.
    let numbers = COLUMNS.iter().map(|(name, value)| ((*name).to_owned(), Value::from(value(row))));
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
