//! What a row holds, as every file has it; docs/accuracy.md tells what the columns mean.

use super::numerics::integrator_name;
use super::report::{Measured, Row};

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
