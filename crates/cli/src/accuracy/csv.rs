//! The rows as comma-separated values, with all digits.

use super::columns::{COLUMNS, TEXT_COLUMNS};
use super::report::Row;

/// A line of names and one line for each row; what is not known is empty.
pub fn csv(rows: &[Row]) -> String {
    let names = TEXT_COLUMNS.iter().map(|column| column.name).chain(COLUMNS.iter().map(|column| column.name));
    let mut text = names.collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        let texts = TEXT_COLUMNS.iter().map(|column| quoted(&(column.value)(row)));
        let numbers = COLUMNS.iter().map(|column| number((column.value)(row)));
        text.push_str(&texts.chain(numbers).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// As short as reads back as the same number.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// A text, in quotation marks where it needs them.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{number, quoted};

    #[test]
    fn values_read_back() {
        assert_eq!([number(0.1), number(1e-300), number(f64::NAN), number(20.0)], ["0.1", "1e-300", "", "20.0"]);
        assert_eq!([quoted("plain"), quoted("a, \"b\"")], ["plain", "\"a, \"\"b\"\"\""]);
    }
}
