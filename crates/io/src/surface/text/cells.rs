//! Lines of numbers: how they are parted, and what their cells hold.

use super::error::TextError;

/// What parts the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    /// One of these characters; a cell may be empty.
    Character(char),
    /// Any number of blanks.
    Blanks,
}

impl Separator {
    /// The separator of a line: the first of semicolon, tab and comma that it has, else blanks.
    pub(super) fn of(line: &str) -> Self {
        [';', '\t', ','].into_iter().find(|mark| line.contains(*mark)).map_or(Self::Blanks, Self::Character)
    }

    /// The cells of a line, without blanks around them. One separator after the last cell is taken off if `terminated`.
    pub(super) fn cells(self, line: &str, terminated: bool) -> impl Iterator<Item = &str> {
        let (characters, blanks) = match self {
            Self::Character(mark) => {
                let line = line.trim_matches(|c: char| c.is_whitespace() && c != mark);
                let line = if terminated { line.strip_suffix(mark).unwrap_or(line) } else { line };
                (Some(line.split(mark)), None)
            }
            Self::Blanks => (None, Some(line.split_whitespace())),
        };
        characters.into_iter().flatten().chain(blanks.into_iter().flatten()).map(|cell| cell.trim().trim_matches('"'))
    }

    /// Whether a line ends with a separator.
    pub(super) fn ends(self, line: &str) -> bool {
        matches!(self, Self::Character(mark) if line.trim_end_matches(|c: char| c.is_whitespace() && c != mark).ends_with(mark))
    }
}

/// What is wrong with a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    NotANumber,
    DecimalComma,
    Infinite,
}

impl Fault {
    pub(super) fn at(self, line: usize, column: usize, cell: &str) -> TextError {
        let found = shown(cell);
        match self {
            Self::NotANumber => TextError::Number { line, column, found },
            Self::DecimalComma => TextError::DecimalComma { line, column, found },
            Self::Infinite => TextError::Infinite { line, column, found },
        }
    }
}

/// The number in a cell; NaN where a point is missing.
pub(super) fn number(cell: &str) -> Result<f64, Fault> {
    match cell.parse::<f64>() {
        Ok(number) if number.is_infinite() => Err(Fault::Infinite),
        Ok(number) => Ok(number),
        Err(_) if is_missing(cell) => Ok(f64::NAN),
        Err(_) if cell.matches(',').count() == 1 && cell.replace(',', ".").parse::<f64>().is_ok() => {
            Err(Fault::DecimalComma)
        }
        Err(_) => Err(Fault::NotANumber),
    }
}

/// Words that programs write for a point that was not measured.
fn is_missing(cell: &str) -> bool {
    cell.is_empty()
        || cell.bytes().all(|byte| byte == b'*')
        || cell.bytes().all(|byte| byte == b'-')
        || ["bad", "na", "n/a"].iter().any(|word| cell.eq_ignore_ascii_case(word))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_parted_by_the_strongest_separator() {
        let cells = |line: &str, terminated| {
            Separator::of(line).cells(line, terminated).map(str::to_owned).collect::<Vec<_>>().join("|")
        };
        assert_eq!(cells(" 1  2\u{a0}3 ", false), "1|2|3");
        assert_eq!(cells("1, 2 ,,4", false), "1|2||4");
        assert_eq!(cells("1;2,5; ", false), "1|2,5|");
        assert_eq!(cells("1;2,5; ", true), "1|2,5");
        assert_eq!(cells("\t1\t\t3", false), "|1||3");
        assert_eq!(cells("\"1.5\",\"2\"", false), "1.5|2");
    }

    #[test]
    fn a_cell_is_a_number_or_missing() {
        for (cell, expected) in [("1.5", 1.5), ("-2e-3", -2e-3), ("+.5", 0.5), ("1E5", 1e5), ("-0", 0.0)] {
            assert_eq!(number(cell), Ok(expected));
        }
        for cell in ["", "NaN", "nan", "BAD", "bad", "***", "*", "--", "n/a"] {
            assert!(number(cell).unwrap().is_nan(), "{cell}");
        }
        for cell in ["inf", "-Infinity", "1e999"] {
            assert_eq!(number(cell), Err(Fault::Infinite), "{cell}");
        }
        for cell in ["1,5", "-0,25", "1,5e-3"] {
            assert_eq!(number(cell), Err(Fault::DecimalComma), "{cell}");
        }
        for cell in ["1.5.2", "um", "0x10", "1,2,3", "1 2", "\0"] {
            assert_eq!(number(cell), Err(Fault::NotANumber), "{cell}");
        }
    }
}
