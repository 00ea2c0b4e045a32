//! Numbers of a table: where it begins, which of several is read, what all its lines hold; and a matrix of heights, of which each line is a
//! profile along x, the first at y = 0, with what stands beside one and is no height.

use std::ops::Range;

use super::dialect::{Dialect, is_comment, number, shown, starts_numbers};
use super::header::{Header, Names};
use crate::delimited::{Decimal, Kind, Separator, starts};
use crate::surface::error::{Fault, TextError};
use crate::surface::format::Format;
use crate::surface::measured::{Measured, ReadOptions, agreed, agreed_pitch};

/// Lines that are looked at: no header of an instrument is nearly as long.
const MOST_LINES: usize = 1000;

/// Lines to leave out, from the first line of the file, so that what is left is a header that is understood, if any, and a table; none
/// where no table begins within [`MOST_LINES`] lines.
///
/// The table is the most numbers in lines of equal count that follow each other; comments between them do not count.
pub(super) fn lines_before<'a>(lines: impl Iterator<Item = (usize, &'a str)> + Clone) -> Option<usize> {
    let lines = lines.take(MOST_LINES);
    let ways = |line| [Separator::of(line), Separator::Blanks, Separator::CommaAndBlank];
    let tables =
        [0, 1, 2].into_iter().filter_map(|way| largest(lines.clone().map(|(at, line)| (at, line, ways(line)[way]))));
    let table = tables.reduce(|one, other| if other.numbers > one.numbers { other } else { one })?;
    let mut header = Header::default();
    let before = lines.take_while(|(line, _)| *line < table.first);
    let odd = before.filter(|(line, text)| {
        !is_comment(text) && (starts_numbers(text) || !header.read(*line, text, Decimal::Point))
    });
    odd.last().map(|(line, _)| line)
}

/// Lines of equally many numbers that follow each other.
#[derive(Clone, Copy)]
struct Block {
    /// First line of the block.
    first: usize,
    separator: Separator,
    /// Count of numbers in a line, and in all lines.
    columns: usize,
    numbers: usize,
}

/// The block with the most numbers, the first of those.
fn largest<'a>(lines: impl Iterator<Item = (usize, &'a str, Separator)>) -> Option<Block> {
    let (mut largest, mut block): (Option<Block>, Option<Block>) = (None, None);
    for (line, text, separator) in lines.filter(|(_, text, _)| !is_comment(text)) {
        block = count(text, separator).map(|columns| match block {
            Some(block) if (block.separator, block.columns) == (separator, columns) => {
                Block { numbers: block.numbers + columns, ..block }
            }
            _ => Block { first: line, separator, columns, numbers: columns },
        });
        if let Some(block) = block.filter(|block| largest.is_none_or(|largest| block.numbers > largest.numbers)) {
            largest = Some(block);
        }
    }
    largest
}

/// Cells of a line, if each is a number or a missing point, with either decimal mark, and one at least a number.
fn count(line: &str, separator: Separator) -> Option<usize> {
    let (mut columns, mut has_number) = (0, false);
    for cell in separator.cells(line, false) {
        let found = number(cell, Decimal::Point).or_else(|_| number(cell, Decimal::Comma));
        if matches!(found, Err(fault) if fault != Fault::Infinite) {
            return None;
        }
        has_number |= found.is_ok_and(|number| !number.is_nan());
        columns += 1;
    }
    has_number.then_some(columns)
}

/// Lines of the table that is read, with its header; and what is wrong if there are several, and none is chosen.
fn chosen<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    options: &ReadOptions,
) -> Result<(Range<usize>, Option<TextError>), TextError> {
    let starts: Vec<_> = starts(lines, kind).collect();
    let number = table_number(options, starts.len() + 1)?;
    let several = starts.first().filter(|_| options.dataset.is_none()).map(|start| TextError::Several {
        line: start.line,
        sign: start.sign,
        found: shown(start.text.trim()),
        tables: starts.len() + 1,
    });
    let from = if number == 1 { 0 } else { starts[number - 2].line };
    let to = starts.get(number - 1).map_or(usize::MAX, |start| start.line);
    Ok((from..to, several))
}

/// The number of the table that is read, of so many.
fn table_number(options: &ReadOptions, tables: usize) -> Result<usize, TextError> {
    let Some(dataset) = &options.dataset else { return Ok(1) };
    let number = dataset.parse().ok().filter(|number| (1..=tables).contains(number));
    number.ok_or_else(|| TextError::NoTable { dataset: shown(dataset), tables })
}

/// Tells the kind of a line. One of words that no header has is nothing that begins a table.
fn kind(text: &str) -> Kind {
    let begins_word = |letter: char| letter.is_alphabetic() || "[(\"#%".contains(letter);
    if !text.trim_start().starts_with(begins_word) || !is_comment(text) && starts_numbers(text) {
        return Kind::Row;
    }
    if Header::default().read(0, text, Decimal::Point) { Kind::Header } else { Kind::Comment }
}

/// Numbers that stand for no height in files of many programs.
const STAND_INS: [f64; 4] = [-9999.0, -99_999.0, -32_768.0, 9999.0];

/// The numbers of a file as they stand in it, with what its header states.
pub(super) struct Numbers {
    pub(super) header: Header,
    /// Count of numbers in a line.
    pub(super) columns: usize,
    /// Numbers line by line; NaN where a point is missing.
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
        let (range, several) = chosen(lines.clone(), options)?;
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
                (TextError::Cell { line, fault: Fault::NotANumber, .. }, Some((first, text))) if *line == first => {
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
                let wrong = |fault| {
                    let is_mark = matches!(fault, Fault::Mark(_));
                    let beside = if is_mark { beside(lines.clone(), separator, decimal) } else { None };
                    TextError::Cell { line, column: column + 1, found: shown(cell), fault, beside }
                };
                numbers.values.push(number(cell, decimal).map_err(wrong)?);
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
        heights.iter_mut().for_each(|height| *height *= unit);
        let Some(height) = heights.iter().find(|height| height.is_infinite()) else { return Ok(()) };
        let found = format!("a height of {height} m");
        Err(TextError::Cell { line: self.first_line(), column: 1, found, fault: Fault::Infinite, beside: None })
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

/// First line, if it has another number of cells than the one below, or none is below: a header may have a line such as "800 points".
fn odd_beginning<'a>(mut lines: impl Iterator<Item = (usize, &'a str)>) -> Option<(usize, &'a str)> {
    let cells = |text: &str| Separator::of(text).cells(text, false).count();
    let first = lines.next()?;
    lines.next().is_none_or(|second| cells(first.1) != cells(second.1)).then_some(first)
}

/// Fewest numbers that are looked at: four heights in a row may be evenly spaced by chance.
const FEWEST: usize = 6;
/// Numbers that are off by no more than this, in steps, are evenly spaced: labels are often rounded.
const OFF: f64 = 0.05;

/// Names labels in a matrix of columns of so many rows: the first column or line, if it counts evenly while its neighbour does not.
pub(super) fn labels(heights: &[f64], rows: usize) -> impl Iterator<Item = String> {
    let at = |column: usize, row: usize| heights[column * rows + row];
    let columns = heights.len() / rows.max(1);
    let line = move |row: usize| (1..columns).map(move |column| at(column, row)).collect::<Vec<_>>();
    // The first number of each may be the corner of both.
    let column = move |column: usize| (1..rows).map(move |row| at(column, row)).collect::<Vec<_>>();
    let told = |what: &str, numbers: Vec<f64>, beside: Vec<f64>| {
        let [first, last] = [*numbers.first()?, *numbers.last()?];
        (is_even(&numbers) && !is_even(&beside)).then(|| {
            format!(
                "the first {what} counts evenly to {last}, from {first} on, and the next does not: if it has numbers of lines or coordinates, \
                 take it out, for it is read as heights"
            )
        })
    };
    let has_next = columns > 1 && rows > 1;
    let of_column = has_next.then(|| told("column", column(0), column(1))).flatten();
    let of_line = has_next.then(|| told("line", line(0), line(1))).flatten();
    of_column.into_iter().chain(of_line)
}

/// Tells whether numbers are evenly spaced, and not all the same.
fn is_even(numbers: &[f64]) -> bool {
    let [first, .., last] = *numbers else { return false };
    let step = (last - first) / (numbers.len() - 1) as f64;
    let is_there = |(place, number): (usize, &f64)| (number - first - step * place as f64).abs() <= OFF * step.abs();
    numbers.len() >= FEWEST && step != 0.0 && numbers.iter().enumerate().all(is_there)
}

/// The heights of a matrix, m.
pub(super) fn matrix(numbers: &Numbers, options: &ReadOptions) -> Result<Measured, TextError> {
    let (columns, rows) = (numbers.columns, numbers.lines.len());
    let header = &numbers.header;
    for (what, stated, found) in [("columns", header.counts[0], columns), ("rows", header.counts[1], rows)] {
        if let Some(expected) = stated.filter(|stated| *stated != found as u64) {
            return Err(TextError::Count { what, expected, found });
        }
    }
    let unit = numbers.unit(header.unit, options)?;
    let mut heights = Vec::with_capacity(numbers.values.len());
    for column in 0..columns {
        heights.extend(numbers.values.iter().skip(column).step_by(columns));
    }
    let warnings = Numbers::stand_in(&heights).into_iter().chain(labels(&heights, rows)).collect();
    numbers.scale(&mut heights, unit)?;
    let pitch = agreed_pitch(header.matrix_pitch(columns, rows), options.pitch)?;
    let notes = vec![format!("matrix, 1 stands for {unit:e} m")];
    Ok(Measured { notes, warnings, ..Measured::new(Format::Text, [columns, rows], pitch, heights) })
}
