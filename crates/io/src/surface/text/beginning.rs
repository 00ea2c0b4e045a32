//! Where the table of a text begins whose first lines no header has.

use super::cells::{Fault, is_comment, number, starts_numbers};
use super::header::Header;
use crate::delimited::{Decimal, Separator};

/// Lines that are looked at: no header of an instrument is nearly as long.
const MOST_LINES: usize = 1000;

/// Lines to leave out, from the first line of the file, so that what is left is a header that is understood, if any, and a table; none where no
/// table begins within [`MOST_LINES`] lines.
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
    /// Its first line.
    first: usize,
    separator: Separator,
    /// Numbers of a line, and of all.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delimited::lines;

    #[test]
    fn the_table_begins_below_the_last_odd_line() {
        let many = "line\n".repeat(MOST_LINES);
        for (text, expected) in [
            (
                "Protocol\nDate;12.03.2026 14:05:11\nResolution X/Y\t5,0 um\nPoints 800 x 400\nBEGIN\n1,5\t2\t***\n3\t4\t5\n",
                Some(5),
            ),
            // Counts, which are numbers themselves; a single line; blank lines and comments.
            ("Sample 7\n3 2\n1,5 2,5 3\n4 5 6\n", Some(2)),
            ("Sample 7\n1 2 3 4\n", Some(1)),
            ("Sample 7\n\n# mean\n1 2\n# more\n3 4\n", Some(1)),
            // A line that is shorter does not make the rest of the table its begin.
            ("Sample 7\n1 2\n3 4\n5 6\n7\n8 9\n", Some(1)),
            // What a header says right above the table is kept.
            ("Sample 7\nunit: um\nMeasured\npitch = 5 um\n1 2\n3 4\n", Some(3)),
            ("1,5, 2,5\n", None),
            ("Sample 7\n1,5, 2,5\n3, 4,25\n", Some(1)),
            ("Sample\nno numbers\n***\n", None),
            (&format!("{many}1 2\n3 4\n"), None),
        ] {
            assert_eq!(lines_before(lines(text)), expected, "{text}");
        }
    }
}
