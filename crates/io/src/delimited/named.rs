//! A table whose first line names its columns, in CSV as programs and spreadsheets write it.
//!
//! Where a spreadsheet writes commas in numbers, it parts columns by semicolons: such a table, and one with tabs, is read too. Lines that
//! begin with # are passed over.

use std::borrow::Cow;

use super::dialect::{Decimal, Kind, Separator, lines, starts, stated_separator, unquoted};
use crate::text::short;

/// A table.
pub(crate) struct Named<'a> {
    separator: char,
    /// A separator ends every line.
    terminated: bool,
    /// The names of the columns.
    pub(crate) head: Line<'a>,
    rows: Vec<(usize, &'a str)>,
}

/// A line of a table.
pub(crate) struct Line<'a> {
    /// Its number in the file, from 1.
    pub(crate) number: usize,
    text: &'a str,
    pub(crate) cells: Vec<Cell<'a>>,
}

/// A cell of a line.
pub(crate) struct Cell<'a> {
    /// Its text, without quotation marks; numbers with a decimal point.
    pub(crate) text: Cow<'a, str>,
    /// The byte of the line at which it begins.
    at: usize,
}

/// Problem with a table; line and column of the text count from 1.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) line: usize,
    pub(crate) column: usize,
    pub(crate) message: String,
}

impl<'a> Named<'a> {
    /// The table of a text; none of one without a line.
    pub(crate) fn of(text: &'a str) -> Result<Option<Self>, Fault> {
        let is_comment = |line: &str| line.trim_start().starts_with('#');
        let mut lines = lines(text).skip_while(|(_, line)| is_comment(line));
        let Some((number, names)) = lines.next() else { return Ok(None) };
        let kind = |line: &str| match () {
            () if is_comment(line) => Kind::Comment,
            () if line.trim() == names.trim() => Kind::Header,
            () => Kind::Row,
        };
        if let Some(start) = starts(lines.clone(), kind).next() {
            let message = format!(
                "another table begins here, {}: a table has one line of names and no blank lines between its rows; take these out, or put \
                 what stands below into a file of its own",
                start.sign
            );
            return Err(Fault { line: start.line, column: 1, message });
        }
        let rows: Vec<_> = lines.filter(|(_, line)| kind(line) == Kind::Row).collect();
        let separator = stated_separator(text).unwrap_or_else(|| separator(names));
        let ends = |line: &str| Separator::Character(separator).ends(line);
        let terminated = ends(names) && rows.iter().all(|(_, line)| ends(line));
        let head = line(number, names, separator, terminated)?;
        Ok(Some(Self { separator, terminated, head, rows }))
    }

    /// The lines below the names, each with as many cells as it has.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Result<Line<'a>, Fault>> {
        // The first number with a decimal mark.
        let mut first: Option<(Decimal, String)> = None;
        self.rows.iter().map(move |(number, text)| {
            let mut line = line(*number, text, self.separator, self.terminated)?;
            for place in 0..if self.separator == ',' { 0 } else { line.cells.len() } {
                let cell = &line.cells[place].text;
                let Some(mark) = Decimal::of(cell) else { continue };
                let column = line.column(place);
                let (expected, there) = first
                    .get_or_insert_with(|| (mark, format!("\"{}\" in line {number}, column {column}", short(cell))));
                if mark != *expected {
                    let message = format!(
                        "\"{}\" and {there}: a decimal point and a decimal comma in one table; save it with one of them, and without \
                         thousands separators",
                        short(cell)
                    );
                    return Err(line.fault(place, message));
                }
                if mark == Decimal::Comma {
                    line.cells[place].text = Cow::Owned(cell.replacen(',', ".", 1));
                }
            }
            Ok(line)
        })
    }
}

impl Line<'_> {
    /// Problem with a cell, or at the end of the line where there is no such cell.
    pub(crate) fn fault(&self, place: usize, message: String) -> Fault {
        Fault { line: self.number, column: self.column(place), message }
    }

    /// The column of the text at which a cell begins, or that of the end of the line.
    fn column(&self, place: usize) -> usize {
        let at = self.cells.get(place).map_or(self.text.len(), |cell| cell.at);
        self.text[..at].chars().count() + 1
    }
}

/// The cells of a line.
fn line(number: usize, text: &str, separator: char, terminated: bool) -> Result<Line<'_>, Fault> {
    let mut line = Line { number, text, cells: Vec::new() };
    for part in Separator::Character(separator).parts(text, terminated) {
        let at = part.as_ptr().addr() - text.as_ptr().addr();
        let closed = unquoted(part);
        line.cells.push(Cell { at, text: closed.clone().unwrap_or_default() });
        if closed.is_none() {
            let message =
                "a quotation mark opens this cell, and none closes it in its line; take it out, or the line break";
            return Err(line.fault(line.cells.len() - 1, message.to_owned()));
        }
    }
    Ok(line)
}

/// Character that parts the columns of these names: semicolons only where there are more of them than commas, for names may have one.
fn separator(names: &str) -> char {
    let count = |mark: char| names.matches(mark).count();
    match (count('\t'), count(';') > count(',')) {
        (1.., _) => '\t',
        (0, true) => ';',
        (0, false) => ',',
    }
}

#[cfg(test)]
#[path = "../../tests/unit/delimited/named.rs"]
mod tests;
