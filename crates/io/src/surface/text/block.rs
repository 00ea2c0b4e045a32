//! Which of the tables of a text is read: the only one, or the one that is chosen by its number.

use std::ops::Range;

use super::cells::{is_comment, shown, starts_numbers};
use super::error::TextError;
use super::header::Header;
use crate::delimited::{Decimal, Kind, starts};
use crate::surface::options::ReadOptions;

/// Between which lines the table that is read stands, with its header; and what is wrong if there are several, and none is chosen.
pub(super) fn chosen<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    options: &ReadOptions,
) -> Result<(Range<usize>, Option<TextError>), TextError> {
    let starts: Vec<_> = starts(lines, kind).collect();
    let number = number(options, starts.len() + 1)?;
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
pub(super) fn number(options: &ReadOptions, tables: usize) -> Result<usize, TextError> {
    let Some(dataset) = &options.dataset else { return Ok(1) };
    let number = dataset.parse().ok().filter(|number| (1..=tables).contains(number));
    number.ok_or_else(|| TextError::NoTable { dataset: shown(dataset), tables })
}

/// What a line is. One of words that no header has is nothing that begins a table.
fn kind(text: &str) -> Kind {
    let begins_word = |letter: char| letter.is_alphabetic() || "[(\"#%".contains(letter);
    if !text.trim_start().starts_with(begins_word) || !is_comment(text) && starts_numbers(text) {
        return Kind::Row;
    }
    if Header::default().read(0, text, Decimal::Point) { Kind::Header } else { Kind::Comment }
}
