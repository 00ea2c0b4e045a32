//! Heights as text: a matrix of numbers, or a list of points x, y, z.
//!
//! Each line of a matrix is a profile along x, the first at y = 0. A list is told by the names of its columns, by the
//! file's ending .xyz, or by three columns of which the first two make a grid. Cells are parted by semicolons, tabs,
//! commas or blanks; what the first line of numbers has, holds for the whole file. A separator that ends every line is
//! no empty cell.

mod cells;
mod error;
mod header;
mod list;

use std::borrow::Cow;

use cells::{Separator, number, shown};
pub use error::TextError;
use header::{Header, Names};
use list::Points;

use super::options::{ReadOptions, agreed, agreed_pitch};

/// A matrix of three columns and more lines than this is more likely a list of points off a grid.
const THREE_COLUMNS: usize = 100;

/// Heights of a text file, m, column by column.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) pitch: Option<[f64; 2]>,
    pub(super) heights: Vec<f64>,
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
}

/// Reads the whole content of a text file. `xyz` says that it is named as a list of points.
///
/// # Errors
/// [`TextError`] with the line.
pub(super) fn read(content: &[u8], xyz: bool, options: &ReadOptions) -> Result<Table, TextError> {
    if is_utf16(content) {
        return Err(TextError::Utf16);
    }
    let content = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    // What is not UTF-8 is Latin-1 or a relative of it, in which "µ" is the byte 181.
    let text = match std::str::from_utf8(content) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(content.iter().map(|byte| char::from(*byte)).collect()),
    };
    let numbers = Numbers::read(&text)?;
    if let Some(names) = &numbers.header.names {
        return list(&numbers, names, options);
    }
    let first_three = Names {
        line: numbers.first_line(),
        count: if xyz { numbers.columns.max(3) } else { 3 },
        columns: [0, 1, 2],
        units: [None; 3],
    };
    let three = numbers.columns == 3;
    if xyz || three && numbers.points(&first_three).is_ok_and(|points| points.look_gridded()) {
        return list(&numbers, &first_three, options);
    }
    if three && numbers.lines.len() > THREE_COLUMNS {
        return Err(TextError::ThreeColumns { lines: numbers.lines.len() });
    }
    let mut table = matrix(&numbers, options)?;
    if three {
        table.warnings.push("three columns on no grid: read as a matrix, not as a list x, y, z".to_owned());
    }
    Ok(table)
}

/// Whether a text has two bytes a character, by its byte order mark.
pub(super) fn is_utf16(content: &[u8]) -> bool {
    content.starts_with(b"\xff\xfe") || content.starts_with(b"\xfe\xff")
}

/// The numbers of a file as they stand in it.
struct Numbers {
    header: Header,
    /// Numbers of a line.
    columns: usize,
    /// Line by line; NaN where a point is missing.
    values: Vec<f64>,
    /// Line of the file of every line of numbers.
    lines: Vec<usize>,
}

impl Numbers {
    fn read(text: &str) -> Result<Self, TextError> {
        let line_end = if text.contains('\n') { '\n' } else { '\r' };
        let mut lines = text
            .split(line_end)
            .enumerate()
            .map(|(index, line)| (index + 1, line.strip_suffix('\r').unwrap_or(line)))
            .filter(|(_, line)| !line.trim().is_empty())
            .peekable();
        let mut header = Header::default();
        while let Some((line, text)) = lines.next_if(|(_, text)| is_comment(text) || !starts_numbers(text)) {
            if !header.read(line, text) && !is_comment(text) {
                return Err(TextError::Line { line, found: shown(text.trim()) });
            }
        }
        let Some((first, text)) = lines.peek().copied() else { return Err(TextError::NoNumbers) };
        let separator = Separator::of(text);
        let lines = lines.filter(|(_, text)| !is_comment(text));
        let terminated = lines.clone().all(|(_, text)| separator.ends(text));
        let mut numbers = Self { header, columns: 0, values: Vec::new(), lines: Vec::new() };
        for (line, text) in lines {
            let before = numbers.values.len();
            for (column, cell) in separator.cells(text, terminated).enumerate() {
                numbers.values.push(number(cell).map_err(|fault| fault.at(line, column + 1, cell))?);
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
    fn first_line(&self) -> usize {
        self.lines.first().copied().unwrap_or(1)
    }

    /// The columns of a list.
    fn points(&self, names: &Names) -> Result<Points, TextError> {
        if self.columns != names.count {
            let (line, found) = (self.first_line(), self.columns);
            return Err(TextError::Ragged { line, found, expected: names.count, first: names.line });
        }
        let column = |name: usize| -> Vec<f64> {
            self.values.iter().skip(names.columns[name]).step_by(self.columns).copied().collect()
        };
        let points = Points { x: column(0), y: column(1), z: column(2), lines: self.lines.clone() };
        for (name, values) in [&points.x, &points.y].into_iter().enumerate() {
            if let Some(at) = values.iter().position(|value| value.is_nan()) {
                let (line, column) = (self.lines[at], names.columns[name] + 1);
                return Err(TextError::Number { line, column, found: "NaN".to_owned() });
            }
        }
        Ok(points)
    }

    /// The unit of heights that file or scene state, m.
    fn unit(&self, stated: Option<f64>, options: &ReadOptions) -> Result<f64, TextError> {
        agreed("unit", stated, options.unit)?.ok_or(TextError::NoUnit)
    }

    /// Turns numbers into heights, m.
    fn scale(&self, heights: &mut [f64], unit: f64) -> Result<(), TextError> {
        heights.iter_mut().for_each(|height| *height *= unit);
        match heights.iter().find(|height| height.is_infinite()) {
            Some(height) => Err(TextError::Infinite {
                line: self.first_line(),
                column: 1,
                found: format!("a height of {height} m"),
            }),
            None => Ok(()),
        }
    }
}

fn matrix(numbers: &Numbers, options: &ReadOptions) -> Result<Table, TextError> {
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
    numbers.scale(&mut heights, unit)?;
    let pitch = agreed_pitch(header.matrix_pitch(columns, rows), options.pitch)?;
    let notes = vec![format!("matrix, 1 stands for {unit:e} m")];
    Ok(Table { columns, rows, pitch, heights, notes, warnings: Vec::new() })
}

fn list(numbers: &Numbers, names: &Names, options: &ReadOptions) -> Result<Table, TextError> {
    let gridded = numbers.points(names)?.grid()?;
    let [x_unit, y_unit, z_unit] = names.units;
    let unit = numbers.unit(z_unit.or(numbers.header.unit), options)?;
    // A pitch that is given says what x and y of an unstated unit are; else they have that of the heights.
    let pitch = match (x_unit, y_unit, options.pitch) {
        (Some(x), Some(y), given) => agreed_pitch(Some([gridded.steps[0] * x, gridded.steps[1] * y]), given)?,
        (_, _, Some(given)) => Some(given),
        _ => Some(gridded.steps.map(|step| step * unit)),
    };
    let mut heights = gridded.heights;
    numbers.scale(&mut heights, unit)?;
    let notes = vec![format!("list of {} points, 1 stands for {unit:e} m", numbers.lines.len())];
    Ok(Table { columns: gridded.columns, rows: gridded.rows, pitch, heights, notes, warnings: Vec::new() })
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with(['#', '%'])
}

/// Whether a line has numbers: a number in its first cell that is not empty, or nothing but missing points.
fn starts_numbers(line: &str) -> bool {
    let separator = Separator::of(line);
    let mut cells = separator.cells(line, false).filter(|cell| !cell.is_empty());
    // A decimal comma or an infinite number is told as such.
    cells.next().is_none_or(|cell| !matches!(number(cell), Err(cells::Fault::NotANumber)))
}

#[cfg(test)]
mod tests;
