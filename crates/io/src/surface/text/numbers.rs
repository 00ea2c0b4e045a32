//! The numbers of a file as they stand in it.

use super::beginning::lines_before;
use super::block;
use super::cells::{is_comment, number, shown, starts_numbers};
use super::dialect::Dialect;
use super::error::TextError;
use super::header::Header;
use super::names::Names;
use crate::delimited::{Decimal, Separator};
use crate::surface::options::{ReadOptions, agreed};

/// Numbers that stand for no height in files of many programs.
const STAND_INS: [f64; 4] = [-9999.0, -99_999.0, -32_768.0, 9999.0];

/// The numbers of a file as they stand in it, with what its header states.
pub(super) struct Numbers {
    pub(super) header: Header,
    /// Numbers of a line.
    pub(super) columns: usize,
    /// Line by line; NaN where a point is missing.
    pub(super) values: Vec<f64>,
    /// Line of the file of every line of numbers.
    pub(super) lines: Vec<usize>,
}

impl Numbers {
    /// Reads a header and the numbers below it, of the only table, or the one that is chosen; the file may state its separator.
    pub(super) fn read<'a>(
        lines: impl Iterator<Item = (usize, &'a str)> + Clone,
        separator: Option<char>,
        options: &ReadOptions,
    ) -> Result<Self, TextError> {
        let (range, several) = block::chosen(lines.clone(), options)?;
        let below = lines.clone().skip_while(|(line, _)| *line < range.start);
        let lines = below.clone().take_while(|(line, _)| *line < range.end);
        let in_header = |text: &str| is_comment(text) || !starts_numbers(text);
        let header_lines = lines.clone().take_while(|(_, text)| in_header(text));
        let mut header = Header::default();
        for (line, text) in header_lines.clone() {
            if !header.read(line, text, Decimal::Point) && !is_comment(text) {
                return Err(TextError::Line { line, found: shown(text.trim()), skip: lines_before(below) });
            }
        }
        let numbers = lines.clone().skip_while(|(_, text)| in_header(text)).filter(|(_, text)| !is_comment(text));
        let named = header.names.as_ref().map(|names| names.count);
        let dialect = Dialect::find(numbers.clone(), separator, options.decimal, named)?;
        if dialect.decimal == Decimal::Comma {
            header = Header::default();
            header_lines.for_each(|(line, text)| _ = header.read(line, text, Decimal::Comma));
        }
        let table =
            Self::table(header, numbers.clone(), dialect).map_err(|error| match (&error, odd_beginning(numbers)) {
                (TextError::Number { line, .. }, Some((first, text))) if *line == first => {
                    TextError::Line { line: first, found: shown(text.trim()), skip: lines_before(below) }
                }
                _ => error,
            })?;
        several.map_or(Ok(table), Err)
    }

    /// Reads lines of numbers, each as long as the first.
    pub(super) fn table<'a>(
        header: Header,
        lines: impl Iterator<Item = (usize, &'a str)> + Clone,
        dialect: Dialect,
    ) -> Result<Self, TextError> {
        let Some((first, _)) = lines.clone().next() else { return Err(TextError::NoNumbers) };
        let Dialect { separator, decimal } = dialect;
        let terminated = lines.clone().all(|(_, text)| separator.ends(text));
        let mut numbers = Self { header, columns: 0, values: Vec::new(), lines: Vec::new() };
        for (line, text) in lines.clone() {
            let before = numbers.values.len();
            for (column, cell) in separator.cells(text, terminated).enumerate() {
                let value = number(cell, decimal).map_err(|fault| match fault.at(line, column + 1, cell) {
                    TextError::Mark { line, column, found, mark, .. } => {
                        let beside = beside(lines.clone(), separator, decimal);
                        TextError::Mark { line, column, found, mark, beside }
                    }
                    other => other,
                });
                numbers.values.push(value?);
            }
            let found = numbers.values.len() - before;
            if line == first {
                numbers.columns = found;
            }
            if found != numbers.columns {
                return Err(TextError::Ragged { line, found, expected: numbers.columns, first });
            }
            numbers.lines.push(line);
        }
        Ok(numbers)
    }

    /// The first line of numbers.
    pub(super) fn first_line(&self) -> usize {
        self.lines.first().copied().unwrap_or(1)
    }

    /// The numbers of a column.
    pub(super) fn column(&self, place: usize) -> Vec<f64> {
        self.values.iter().skip(place).step_by(self.columns).copied().collect()
    }

    /// The numbers of a column of coordinates, none of which may be missing.
    pub(super) fn coordinates(&self, place: usize) -> Result<Vec<f64>, TextError> {
        let values = self.column(place);
        match values.iter().position(|value| value.is_nan()) {
            None => Ok(values),
            Some(at) => Err(TextError::NoCoordinate { line: self.lines[at], column: place + 1 }),
        }
    }

    /// The heights of a column, as the file has them.
    pub(super) fn heights(&self, names: &Names, place: usize) -> Vec<f64> {
        let mut heights = self.column(place);
        if let Some(valid) = names.valid {
            let invalid = heights.iter_mut().zip(self.column(valid)).filter(|(_, valid)| *valid == 0.0);
            invalid.for_each(|(height, _)| *height = f64::NAN);
        }
        heights
    }

    /// Refuses names that do not fit the columns. Beyond the names columns may be empty.
    pub(super) fn check_names(&self, names: &Names) -> Result<(), TextError> {
        let more = self.values.chunks_exact(self.columns).flat_map(|line| line.iter().skip(names.count));
        if self.columns == names.count || self.columns > names.count && more.into_iter().all(|value| value.is_nan()) {
            return Ok(());
        }
        let (line, found) = (self.first_line(), self.columns);
        Err(TextError::Ragged { line, found, expected: names.count, first: names.line })
    }

    /// Says that numbers which programs write where there is no height are among these, which are far from them.
    pub(super) fn stand_in(heights: &[f64]) -> Option<String> {
        STAND_INS.into_iter().find_map(|number| {
            let count = heights.iter().filter(|height| **height == number).count();
            let beside = |height: &&f64| height.is_finite() && **height != number;
            let farthest = heights.iter().filter(beside).map(|height| height.abs()).fold(0.0, f64::max);
            (count > 0 && farthest < 0.5 * number.abs()).then(|| {
                format!(
                    "{number} is there {count} times, far from all other heights, as many programs write it where there is none: if so, write NaN in its place"
                )
            })
        })
    }

    /// The unit of heights that file or scene state, m.
    pub(super) fn unit(&self, stated: Option<f64>, options: &ReadOptions) -> Result<f64, TextError> {
        agreed("unit", stated, options.unit)?.ok_or(TextError::NoUnit)
    }

    /// Turns numbers into heights, m.
    pub(super) fn scale(&self, heights: &mut [f64], unit: f64) -> Result<(), TextError> {
        scale(heights, unit, self.first_line())
    }
}

/// Turns numbers into heights, m; `line` is where they begin.
pub(super) fn scale(heights: &mut [f64], unit: f64, line: usize) -> Result<(), TextError> {
    heights.iter_mut().for_each(|height| *height *= unit);
    match heights.iter().find(|height| height.is_infinite()) {
        Some(height) => Err(TextError::Infinite { line, column: 1, found: format!("a height of {height} m") }),
        None => Ok(()),
    }
}

/// The first number with this decimal mark, and its place.
fn beside<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
    separator: Separator,
    decimal: Decimal,
) -> Option<Box<str>> {
    lines.find_map(|(line, text)| {
        let mut cells = separator.cells(text, false).zip(1..);
        let (cell, column) = cells.find(|(cell, _)| Decimal::of(cell) == Some(decimal))?;
        Some(format!("\"{}\" in line {line}, column {column}", shown(cell)).into())
    })
}

/// The first line, if it has another number of cells than the one below, or none is below: a line of a header may begin with a number, as "800 points" does.
fn odd_beginning<'a>(mut lines: impl Iterator<Item = (usize, &'a str)>) -> Option<(usize, &'a str)> {
    let cells = |text: &str| Separator::of(text).cells(text, false).count();
    let first = lines.next()?;
    lines.next().is_none_or(|second| cells(first.1) != cells(second.1)).then_some(first)
}
