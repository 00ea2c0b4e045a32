//! Lengths and their units, as headers and the names of columns state them.

use crate::delimited::Decimal;
use crate::units::{self, Dimension};

/// A number that a length can have.
pub(super) fn positive(number: Option<f64>) -> Option<f64> {
    number.filter(|number| *number > 0.0 && number.is_finite())
}

/// A length, m.
pub(super) fn length(text: &str, decimal: Decimal) -> Option<f64> {
    let point = match decimal {
        Decimal::Point => text.to_owned(),
        Decimal::Comma if text.contains('.') => return None,
        Decimal::Comma => text.replacen(',', ".", 1),
    };
    positive(units::parse(&point, Dimension::Length).ok())
}

/// A unit of length, or a length.
pub(super) fn length_unit(text: &str) -> Option<f64> {
    length(text, Decimal::Point).or_else(|| unit_word(text))
}

/// A unit of length by its symbol or name, also a German, French, Italian or Spanish one.
pub(super) fn unit_word(text: &str) -> Option<f64> {
    match text.to_lowercase().trim_end_matches('s') {
        "micron" | "micrometer" | "micrometre" | "mikrometer" | "micromètre" | "micrometro" | "micrómetro" => {
            Some(1e-6)
        }
        "nanometer" | "nanometre" | "nanomètre" | "nanometro" | "nanómetro" => Some(1e-9),
        "millimeter" | "millimetre" | "millimètre" | "millimetro" | "milímetro" => Some(1e-3),
        _ => length(&format!("1 {text}"), Decimal::Point),
    }
}

/// One or two lengths, parted by a comma (unless that is the decimal mark), a semicolon or "x".
pub(super) fn pitch(text: &str, decimal: Decimal) -> Option<[f64; 2]> {
    let marks: &[char] = if decimal == Decimal::Point { &[',', ';', 'x'] } else { &[';', 'x'] };
    match text.split_once(marks) {
        Some((x, y)) => Some([length(x.trim(), decimal)?, length(y.trim(), decimal)?]),
        None => length(text, decimal).map(|pitch| [pitch; 2]),
    }
}
