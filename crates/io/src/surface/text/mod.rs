//! Heights as text: a matrix of numbers, a list of points x, y, z, or a profile.
//!
//! | file | what is in it |
//! |---|---|
//! | `dialect.rs` | the numbers of a line; what parts them, and their decimal mark |
//! | `header.rs` | what stands before the numbers: names with values, names of columns |
//! | `numbers.rs` | the whole table: where it begins, which of several is read; a matrix |
//! | `points.rs` | a list of points, or a profile |
//!
//! Each line of a matrix is a profile along x, the first at y = 0. A list is told by the names of its columns, by the
//! file's ending .xyz, or by three columns of which the first two make a grid. A profile is what the scene takes as one.
//! A separator that ends every line is no empty cell.

mod dialect;
mod error;
mod header;
mod numbers;
mod points;

pub use error::TextError;
use header::{Columns, Names};
use numbers::{Numbers, matrix};
use points::{is_list, list, profile};

use super::measured::Measured;
use super::options::ReadOptions;
use crate::delimited::{decode, lines, stated_separator};

/// A matrix of three columns or fewer and more lines than this is more likely a list of points off a grid, or a profile.
const NARROW: usize = 100;

/// Columns of a list of points, at most, that is no matrix: coordinates, height, and what else an instrument knows of a point.
const WIDEST: usize = 8;

/// Reads the whole content of a text file. `xyz` says that it is named as a list of points.
///
/// # Errors
/// [`TextError`] with the line.
pub(super) fn read(content: &[u8], xyz: bool, options: &ReadOptions) -> Result<Measured, TextError> {
    let text = decode(content);
    let stated = stated_separator(&text);
    let Some(skip) = options.skip else { return table(&Numbers::read(lines(&text), stated, options)?, xyz, options) };
    let lines = lines(&text).filter(|(line, _)| *line as u64 > skip);
    if lines.clone().next().is_none() {
        return Err(TextError::AllSkipped { skip });
    }
    table(&Numbers::read(lines, stated, options)?, xyz, options)
}

/// What a table of numbers is.
fn table(numbers: &Numbers, xyz: bool, options: &ReadOptions) -> Result<Measured, TextError> {
    let (columns, lines) = (numbers.columns, numbers.lines.len());
    if options.profile_lay.is_some() {
        return profile(numbers, options);
    }
    if let Some(names) = &numbers.header.names {
        return match names.columns {
            Columns::Points(columns) => list(numbers, names, columns, options),
            Columns::Profile(_) => Err(TextError::IsProfile { columns, lines }),
        };
    }
    let is_list = is_list(numbers);
    if xyz || is_list && columns == 3 {
        let three = Columns::Points([0, 1, 2]);
        let names = Names::first(numbers.first_line(), if xyz { columns.max(3) } else { 3 }, three);
        return list(numbers, &names, [0, 1, 2], options);
    }
    if columns < 3 && lines > NARROW {
        return Err(TextError::IsProfile { columns, lines });
    }
    if columns == 3 && lines > NARROW {
        return Err(TextError::ThreeColumns { lines });
    }
    let mut table = matrix(numbers, options)?;
    if columns == 3 {
        table.warnings.push("three columns on no grid: read as a matrix, not as a list x, y, z".to_owned());
    }
    if is_list && columns <= WIDEST {
        table.warnings.push(format!(
            "the first two of {columns} columns make a grid, but the file is read as a matrix of {columns} by {lines} heights: if it is a list of \
             points, name the columns in a line before them, such as x y z quality"
        ));
    }
    Ok(table)
}
