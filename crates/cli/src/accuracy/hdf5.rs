//! All that was found, as an HDF5 file with units and provenance.

use plateau_io::dataset_file::{Attribute, Content, Coordinate, Values, Variable, now};

use super::advice::advice;
use super::columns::{COLUMNS, TEXT_COLUMNS};
use super::history::History;
use super::report::{Report, Row};
use crate::{machine, version};

const RUNG: &str = "rung";
const WINDOW: &str = "window_end";

/// How the runs were made.
#[derive(Debug, Clone)]
pub struct Making {
    /// The whole resolved scene.
    pub scene: String,
    /// Files that the scene reads, as JSON.
    pub inputs: String,
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

/// What the file holds.
pub fn content(report: &Report, making: &Making) -> Content {
    let rows = &report.rows;
    let along = |values: Vec<f64>, name: &'static str, unit: &'static str, long_name: &'static str| Coordinate {
        name,
        unit: unit.into(),
        long_name: long_name.into(),
        values,
    };
    let ends = report.windows.ends().collect();
    let texts = TEXT_COLUMNS.iter().map(|column| Variable {
        name: column.name.into(),
        dimensions: vec![RUNG],
        unit: "".into(),
        long_name: column.long_name.into(),
        values: Values::Text(rows.iter().map(column.value).collect()),
    });
    let numbers = COLUMNS.iter().map(|column| Variable {
        name: column.name.into(),
        dimensions: vec![RUNG],
        unit: column.unit.into(),
        long_name: column.long_name.into(),
        values: Values::Float(rows.iter().map(column.value).collect()),
    });
    Content {
        attributes: attributes(report, making),
        dimensions: vec![
            along((0..rows.len()).map(|row| row as f64).collect(), RUNG, "1", "number of the run"),
            along(ends, WINDOW, "s", "physical time at the end of a window"),
        ],
        variables: texts.chain(numbers).chain(histories(report)).collect(),
    }
}

fn attributes(report: &Report, making: &Making) -> Vec<(&'static str, Attribute)> {
    let text = |text: &str| Attribute::Text(text.to_owned());
    let reference = &report.reference;
    let made = &reference.provenance;
    let (file, sha256) = made.file.as_ref().map_or(("", ""), |file| (&file.path, &file.sha256));
    vec![
        ("title", text(&report.title)),
        ("state", text(making.state)),
        ("program", Attribute::Text(version::program())),
        ("source_revision", text(version::REVISION)),
        ("scene", text(&making.scene)),
        ("inputs", text(&making.inputs)),
        ("host", Attribute::Text(machine::host())),
        ("processor", Attribute::Text(machine::processor())),
        ("workers", Attribute::Integer(making.workers as i64)),
        ("instruction_set", text(making.instruction_set)),
        ("budget", Attribute::Number(making.budget)),
        ("start_time", text(&making.start_time)),
        ("end_time", Attribute::Text(now())),
        ("window_width", Attribute::Number(report.windows.width)),
        ("notes", Attribute::Text(report.notes.join("\n"))),
        ("reference_file", text(file)),
        ("reference_sha256", text(sha256)),
        ("reference_time_acceleration", Attribute::Number(reference.time_acceleration)),
        ("reference_contact_area_error", Attribute::Number(report.own_error.contact_area())),
        ("reference_opening_error", Attribute::Number(report.own_error.opening)),
        ("reference_opening_end", Attribute::Number(report.own_error.end)),
        ("advice", Attribute::Text(advice(report).join("\n"))),
        ("reference_steps", Attribute::Integer(reference.outcome.steps as i64)),
        ("reference_wall_time", Attribute::Number(reference.outcome.wall_time)),
        ("reference_workers", Attribute::Integer(made.workers as i64)),
        ("reference_program", text(&made.program)),
        ("reference_source_revision", text(&made.source_revision)),
        ("reference_host", text(&made.host)),
        ("reference_start_time", text(&made.start_time)),
    ]
}

/// Contact area and filled fraction over the windows.
fn histories(report: &Report) -> Vec<Variable> {
    let windows = &report.windows;
    let of_rows = |values: fn(&History) -> Vec<f64>| {
        let of_row = |row: &Row| match &row.result {
            Ok(measured) => values(&measured.history.at(windows)),
            Err(_) => vec![f64::NAN; windows.count],
        };
        Values::Float(report.rows.iter().flat_map(of_row).collect())
    };
    let reference = report.reference.outcome.history.at(windows);
    type Text = &'static str;
    let variable = |name: Text, dimensions: &[Text], unit: Text, long_name: Text, values| Variable {
        name: name.into(),
        dimensions: dimensions.to_vec(),
        unit: unit.into(),
        long_name: long_name.into(),
        values,
    };
    vec![
        variable(
            "contact_area",
            &[RUNG, WINDOW],
            "m2",
            "mean contact area of the window",
            of_rows(History::mean_areas),
        ),
        variable(
            "filled_fraction",
            &[RUNG, WINDOW],
            "1",
            "filled fraction at the end of the window",
            of_rows(|history| history.filled().to_vec()),
        ),
        variable(
            "reference_contact_area",
            &[WINDOW],
            "m2",
            "mean contact area of the window in the reference",
            Values::Float(reference.mean_areas()),
        ),
        variable(
            "reference_filled_fraction",
            &[WINDOW],
            "1",
            "filled fraction at the end of the window in the reference",
            Values::Float(reference.filled().to_vec()),
        ),
    ]
}
