//! The rows as comma-separated values, with all digits.

use super::columns::{COLUMNS, TEXT_COLUMNS};
use super::report::Row;
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

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn values_read_back() {
        assert_eq!([number(0.1), number(1e-300), number(f64::NAN), number(20.0)], ["0.1", "1e-300", "", "20.0"]);
    }
}
