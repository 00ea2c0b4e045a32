//! The numbers of a row, as every file has them.

use super::report::{Measured, Row};

/// A number that every row has; NaN where it is not known.
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// What it is, in words.
    pub long_name: &'static str,
    /// The number.
    pub value: fn(&Row) -> f64,
}

macro_rules! columns {
    ($($name:literal, $unit:literal, $long_name:literal, $value:expr;)*) => {
        &[$(Column { name: $name, unit: $unit, long_name: $long_name, value: $value }),*]
    };
}

fn measured(row: &Row, value: impl Fn(&Measured) -> f64) -> f64 {
    row.result.as_ref().map_or(f64::NAN, value)
}

/// All of them.
pub const COLUMNS: &[Column] = columns! {
    "value", "1",
        "what the ladder changes: time acceleration, cells of the scene's mesh along one, load tolerance, perturbation",
        |row| row.rung.value();
    "time_acceleration", "1",
        "revolutions that a simulated one stands for",
        |row| row.rung.numerics.time_acceleration;
    "rows", "1",
        "rows of the mesh",
        |row| row.cells[0] as f64;
    "disc_columns", "1",
        "columns of the ring",
        |row| row.cells[1] as f64;
    "pin_columns", "1",
        "columns of the pin",
        |row| row.cells[2] as f64;
    "load_tolerance", "1",
        "load tolerance",
        |row| row.rung.numerics.load_tolerance;
    "perturbation", "1",
        "part of themselves by which the initial heights of the disc are changed",
        |row| row.rung.numerics.perturbation;
    "stiffness_number", "1",
        "stiffness number of a step: above 1 the explicit rule overshoots, above 2 it is unstable",
        |row| row.stiffness_number;
    "wall_time", "s",
        "wall time of the steps",
        |row| measured(row, |run| run.wall_time);
    "steps", "1",
        "steps",
        |row| measured(row, |run| run.steps as f64);
    "contact_area_error", "1",
        "error of the contact area over the windows, root mean square, relative",
        |row| measured(row, |run| run.comparison.contact_area.mean_square);
    "above_reference_error", "1",
        "1 where that error is at least three times the reference's own, else 0",
        |row| f64::from(u8::from(row.is_clear));
    "contact_area_largest_error", "1",
        "largest error of the contact area of any window, relative",
        |row| measured(row, |run| run.comparison.contact_area.largest);
    "contact_area_change", "1",
        "error of the contact area over the windows against the scene's own run, root mean square, relative",
        |row| measured(row, |run| run.change);
    "order", "1",
        "observed order of convergence from the next finer rung",
        |row| row.order;
    "filled_fraction_error", "1",
        "difference of the filled fraction at the end",
        |row| measured(row, |run| run.comparison.filled);
    "filled_fraction_largest_error", "1",
        "largest difference of the filled fraction at the end of any window",
        |row| measured(row, |run| run.comparison.filled_largest);
    "worn_error", "1",
        "difference of the worn volume at the end, relative",
        |row| measured(row, |run| run.comparison.worn);
    "emitted_error", "1",
        "difference of the emitted volume at the end, relative",
        |row| measured(row, |run| run.comparison.emitted);
    "disc_height_error", "m",
        "rms difference of the disc's heights at the end",
        |row| measured(row, |run| run.comparison.disc_height);
    "pin_height_error", "m",
        "rms difference of the pin's heights about their means at the end",
        |row| measured(row, |run| run.comparison.pin_height);
    "contact_ratio_error", "1",
        "difference of the contact ratio in the last window",
        |row| measured(row, |run| run.comparison.contact_ratio);
    "disc_secondary_error", "1",
        "difference of the disc's coverage with secondary plateau at the end",
        |row| measured(row, |run| run.comparison.disc_secondary);
    "pin_secondary_error", "1",
        "difference of the pin's coverage with secondary plateau at the end",
        |row| measured(row, |run| run.comparison.pin_secondary);
    "load_residual", "1",
        "largest load residual of any step",
        |row| measured(row, |run| run.load_residual);
    "balance_residual", "1",
        "debris balance residual at the end",
        |row| measured(row, |run| run.balance_residual);
    "on_front", "1",
        "1 where no other run is as quick and as exact, else 0",
        |row| f64::from(u8::from(row.on_front));
};

/// A text that every row has.
pub struct TextColumn {
    /// Its name.
    pub name: &'static str,
    /// What it is, in words.
    pub long_name: &'static str,
    /// The text.
    pub value: fn(&Row) -> String,
}

/// All of them.
pub const TEXT_COLUMNS: &[TextColumn] = &[
    TextColumn { name: "ladder", long_name: "what is changed", value: |row| row.rung.ladder.name().to_owned() },
    TextColumn { name: "setting", long_name: "keys and values that make the run", value: Row::setting },
    TextColumn {
        name: "integrator",
        long_name: "integrator of wear",
        value: |row| super::numerics::integrator_name(row.rung.numerics.integrator).to_owned(),
    },
    TextColumn {
        name: "state",
        long_name: "finished or failed",
        value: |row| if row.result.is_ok() { "finished" } else { "failed" }.to_owned(),
    },
    TextColumn {
        name: "failure",
        long_name: "why the run failed",
        value: |row| row.result.as_ref().err().cloned().unwrap_or_default(),
    },
    TextColumn { name: "order_note", long_name: "why the order means nothing", value: |row| row.order_note.clone() },
];
