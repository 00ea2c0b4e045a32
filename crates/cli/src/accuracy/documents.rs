//! What was found, as CSV and as JSON; docs/evidence/accuracy.md tells what the columns mean.

use plateau_io::dataset_file::now;
use plateau_io::run_file::InputFile;
use plateau_run::accuracy::{COMPARED, Measured, Report, Row};
use plateau_run::execution;
use serde_json::{Map, Value, json};

use super::text::advice;
use crate::table::csv_table;
use crate::version;

/// Texts of a row, by their names.
fn texts(row: &Row) -> [(&'static str, String); 4] {
    [
        ("ladder", row.rung.ladder.name().to_owned()),
        ("setting", row.rung.setting()),
        ("state", if row.result.is_ok() { "finished" } else { "failed" }.to_owned()),
        ("failure", row.result.as_ref().err().cloned().unwrap_or_default()),
    ]
}

/// Numbers of a row, by their names; NaN where one is not known.
fn numbers(row: &Row, report: &Report) -> Vec<(String, f64)> {
    let parameters = &row.rung.scene.parameters;
    let measured = |value: &dyn Fn(&Measured) -> f64| row.result.as_ref().map_or(f64::NAN, value);
    let mut numbers = vec![
        ("value".to_owned(), row.rung.value),
        ("time_acceleration".to_owned(), parameters.time_acceleration),
        ("stiffness_number".to_owned(), parameters.first_stiffness_number()),
        ("wall_time".to_owned(), measured(&|run| run.wall_time)),
        ("steps".to_owned(), measured(&|run| run.steps as f64)),
        ("error".to_owned(), report.worst(row).map_or(f64::NAN, |(error, _)| error)),
    ];
    for (one, compared) in COMPARED.iter().enumerate() {
        numbers.extend([
            (format!("{}_error", compared.name), measured(&|run| run.errors[one].mean_square)),
            (format!("{}_largest_error", compared.name), measured(&|run| run.errors[one].largest)),
            (format!("{}_end_error", compared.name), measured(&|run| run.errors[one].end)),
        ]);
    }
    numbers.push(("on_front".to_owned(), f64::from(u8::from(row.on_front))));
    numbers
}

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
}

/// A line of names and one line for each row; what is not known is empty.
pub fn csv(report: &Report) -> String {
    let lines = report.rows.iter().map(|row| {
        let texts = texts(row).map(|(name, text)| (name.to_owned(), text)).into_iter();
        texts.chain(numbers(row, report).into_iter().map(|(name, value)| (name, number(value)))).unzip()
    });
    let (names, lines): (Vec<Vec<String>>, Vec<Vec<String>>) = lines.unzip();
    csv_table(names.into_iter().take(1).chain(lines))
}

/// As short as reads back as the same number.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// One JSON document; what is not known is null. `state` is `finished`, or `interrupted` where not all runs were made.
pub fn json(report: &Report, making: &Making, state: &str) -> String {
    let (reference, made) = (&report.reference, &report.reference.provenance);
    let own = |name: &str, errors: [f64; COMPARED.len()]| {
        let named =
            COMPARED.iter().zip(errors).map(|(compared, error)| (format!("{}_{name}", compared.name), error.into()));
        named.collect::<Map<String, Value>>()
    };
    let mut document = json!({
        "title": report.title,
        "state": state,
        "reference": {
            "file": made.file.as_ref().map(|file| &file.path),
            "sha256": made.file.as_ref().map(|file| &file.sha256),
            "setting": reference.setting,
            "time_acceleration": reference.time_acceleration,
            "steps": reference.outcome.steps,
            "wall_time": reference.outcome.wall_time,
            "workers": made.workers,
            "program": made.program,
            "source_revision": made.source_revision,
            "host": made.host,
            "start_time": made.start_time,
            "error": report.own_error(),
            "opening_end": report.own.end,
        },
        "window_width": report.windows.width,
        "windows": report.windows.count,
        "quantities": report.asked,
        "runs": report.rows.iter().map(|one| row(one, report)).collect::<Vec<_>>(),
        "tolerance": report.tolerance,
        "advice": advice(report),
        "notes": report.notes,
        "program": version::program(),
        "source_revision": version::REVISION,
        "host": execution::host(),
        "processor": execution::processor(),
        "workers": making.workers,
        "instruction_set": making.instruction_set,
        "budget": making.budget,
        "start_time": making.start_time,
        "end_time": now(),
        "inputs": making.inputs,
        "scene": making.scene,
    });
    if let Some(reference) = document["reference"].as_object_mut() {
        reference.extend(own("error", report.own.whole()));
        reference.extend(own("opening_error", report.own.opening));
    }
    format!("{document:#}\n")
}

fn row(row: &Row, report: &Report) -> Value {
    let texts = texts(row).map(|(name, text)| (name.to_owned(), Value::from(text))).into_iter();
    // JSON has no NaN: such a number becomes null.
    let numbers = numbers(row, report).into_iter().map(|(name, value)| (name, Value::from(value)));
    Value::Object(texts.chain(numbers).collect())
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn values_read_back() {
        assert_eq!([number(0.1), number(1e-300), number(f64::NAN), number(20.0)], ["0.1", "1e-300", "", "20.0"]);
    }
}
