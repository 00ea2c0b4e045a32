//! What the cells of a line of numbers hold.

use super::error::TextError;
use crate::delimited::{Decimal, Separator};

/// What is wrong with a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    NotANumber,
    /// A decimal comma where points are expected.
    Comma,
    /// A decimal point where commas are expected.
    Point,
    /// Digits in groups of three.
    Grouped,
    Infinite,
}

impl Fault {
    pub(super) fn at(self, line: usize, column: usize, cell: &str) -> TextError {
        let found = shown(cell);
        match self {
            Self::NotANumber => TextError::Number { line, column, found },
            Self::Comma => TextError::Mark { line, column, found, mark: Decimal::Comma, beside: None },
            Self::Point => TextError::Mark { line, column, found, mark: Decimal::Point, beside: None },
            Self::Grouped => TextError::Grouped { line, column, found },
            Self::Infinite => TextError::Infinite { line, column, found },
        }
    }
}

/// The number in a cell; NaN where a point is missing.
pub(super) fn number(cell: &str, decimal: Decimal) -> Result<f64, Fault> {
    let parsed = match decimal {
        Decimal::Point => cell.parse::<f64>().ok(),
        Decimal::Comma => with_comma(cell),
    };
    match parsed {
        Some(number) if number.is_infinite() => Err(Fault::Infinite),
        Some(number) => Ok(number),
        None => missing(cell).map_or_else(
            || Err(fault(cell, decimal)),
            |infinite| {
                if infinite { Err(Fault::Infinite) } else { Ok(f64::NAN) }
            },
        ),
    }
}

/// A number with a decimal comma, or with neither comma nor point.
fn with_comma(cell: &str) -> Option<f64> {
    let Some((whole, fraction)) = cell.split_once(',') else {
        return if cell.contains('.') { None } else { cell.parse().ok() };
    };
    // "1, 2" without its blanks must not become 1 and 0.2.
    let between_digits = whole.ends_with(|digit: char| digit.is_ascii_digit())
        && fraction.starts_with(|digit: char| digit.is_ascii_digit());
    if between_digits && !cell.contains('.') { cell.replacen(',', ".", 1).parse().ok() } else { None }
}

/// Why a cell is no number.
fn fault(cell: &str, decimal: Decimal) -> Fault {
    if is_grouped(cell) {
        return Fault::Grouped;
    }
    match decimal {
        Decimal::Point if with_comma(cell).is_some() => Fault::Comma,
        Decimal::Comma if cell.parse::<f64>().is_ok() => Fault::Point,
        _ => Fault::NotANumber,
    }
}

/// Whether digits stand in groups of three, as in 1,234.5 or 1.234.567: with both marks, or one of them more than once.
fn is_grouped(cell: &str) -> bool {
    let digits = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    let Some(mark) = digits.chars().find(|character| [',', '.'].contains(character)) else { return false };
    let mut groups: Vec<&str> = digits.split(mark).collect();
    let last = groups.pop().unwrap_or_default();
    let other = if mark == ',' { '.' } else { ',' };
    let (group, fraction) = last.split_once(other).map_or((last, None), |(group, fraction)| (group, Some(fraction)));
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    is_digits(groups[0])
        && groups[0].len() <= 3
        && groups[1..].iter().chain([&group]).all(|group| group.len() == 3 && is_digits(group))
        && (groups.len() > 1 || fraction.is_some_and(is_digits))
}

/// Whether a cell is what programs write for a point that was not measured: then, whether it is an infinite number.
fn missing(cell: &str) -> Option<bool> {
    let all = |mark: u8| cell.bytes().all(|byte| byte == mark);
    if all(b'*') || all(b'-') || ["bad", "na", "n/a", "no data"].iter().any(|word| cell.eq_ignore_ascii_case(word)) {
        return Some(false);
    }
    // What the C library of Windows prints: 1.#QNAN, -1.#IND00, 1.#INF, -nan(ind).
    let unsigned = cell.strip_prefix(['+', '-']).unwrap_or(cell).to_ascii_lowercase();
    if let Some(word) = unsigned.strip_prefix("1.#").or(unsigned.strip_prefix("1,#")) {
        return ["qnan", "snan", "ind", "inf"]
            .iter()
            .find(|known| word.starts_with(**known))
            .map(|known| *known == "inf");
    }
    unsigned.strip_prefix("nan(").filter(|rest| rest.ends_with(')')).map(|_| false)
}

/// Text of a file as it can stand in a message.
pub(super) fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    shown
}

/// Whether a line is a comment.
pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with(['#', '%'])
}

/// Whether a line has numbers: a number in its first cell that is not empty, or nothing but missing points.
pub(super) fn starts_numbers(line: &str) -> bool {
    let separator = Separator::of(line);
    let mut cells = separator.cells(line, false).filter(|cell| !cell.is_empty());
    // An infinite number and the like are told as such.
    cells.next().is_none_or(|cell| !matches!(number(cell, Decimal::Point), Err(Fault::NotANumber)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_a_number_or_missing() {
        for (cell, expected) in [("1.5", 1.5), ("-2e-3", -2e-3), ("+.5", 0.5), ("1E5", 1e5), ("-0", 0.0)] {
            assert_eq!(number(cell, Decimal::Point), Ok(expected));
        }
        for (cell, expected) in [("1,5", 1.5), ("-2,5e-3", -2.5e-3), ("7", 7.0)] {
            assert_eq!(number(cell, Decimal::Comma), Ok(expected));
        }
        let words = ["", "NaN", "nan", "BAD", "bad", "***", "*", "--", "n/a", "No Data"];
        for cell in words.into_iter().chain(["1.#QNAN", "-1.#IND00", "1.#SNAN", "-nan(ind)", "nan", "1,#QNAN"]) {
            for decimal in [Decimal::Point, Decimal::Comma] {
                assert!(number(cell, decimal).is_ok_and(f64::is_nan), "{cell}");
            }
        }
        for cell in ["inf", "-Infinity", "1e999", "1.#INF", "-1.#INF00"] {
            assert_eq!(number(cell, Decimal::Point), Err(Fault::Infinite), "{cell}");
        }
    }

    #[test]
    fn what_is_wrong_with_a_cell_is_told() {
        for (cell, point, comma) in [
            ("-0,25", Fault::Comma, None),
            ("1,5e-3", Fault::Comma, None),
            ("1.5", Fault::NotANumber, Some(Fault::Point)),
            ("1.234.567", Fault::Grouped, Some(Fault::Grouped)),
            ("-1,234.5", Fault::Grouped, Some(Fault::Grouped)),
            ("1.234,5", Fault::Grouped, Some(Fault::Grouped)),
            ("12,345,678", Fault::Grouped, Some(Fault::Grouped)),
            ("1,2,3", Fault::NotANumber, Some(Fault::NotANumber)),
            ("1,", Fault::NotANumber, Some(Fault::NotANumber)),
            (",5", Fault::NotANumber, Some(Fault::NotANumber)),
            ("1.5.2", Fault::NotANumber, Some(Fault::NotANumber)),
            ("um", Fault::NotANumber, Some(Fault::NotANumber)),
            ("0x10", Fault::NotANumber, Some(Fault::NotANumber)),
            ("1 2", Fault::NotANumber, Some(Fault::NotANumber)),
            ("1.#", Fault::NotANumber, Some(Fault::NotANumber)),
            ("\0", Fault::NotANumber, Some(Fault::NotANumber)),
        ] {
            if cell != "1.5" {
                assert_eq!(number(cell, Decimal::Point), Err(point), "{cell}");
            }
            assert_eq!(number(cell, Decimal::Comma).err(), comma, "{cell}");
        }
    }
}
