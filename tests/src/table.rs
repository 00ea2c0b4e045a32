//! Tables that the program writes, and how far their numbers are apart.

use std::collections::BTreeMap;

/// A row by the names of the columns.
pub type Row = BTreeMap<String, String>;

/// The rows of a CSV text.
///
/// # Panics
/// When it is none, or a row has other than one cell for each name.
pub fn rows(csv: &str) -> Vec<Row> {
    csv::Reader::from_reader(csv.as_bytes()).deserialize().map(|row| row.expect("a row of CSV")).collect()
}

/// The number in a cell.
///
/// # Panics
/// When there is none.
pub fn number(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|error| panic!("{name} of {row:?}: {error}"))
}

/// Root mean square of the difference of values from a reference, over that of the reference.
pub fn relative_error(values: &[f64], reference: &[f64]) -> f64 {
    let differences: f64 = values.iter().zip(reference).map(|(value, reference)| (value - reference).powi(2)).sum();
    (differences / reference.iter().map(|value| value.powi(2)).sum::<f64>()).sqrt()
}
