//! A matrix of heights: each line is a profile along x, the first at y = 0.

use super::error::TextError;
use super::labels::labels;
use super::numbers::Numbers;
use super::table::Table;
use crate::surface::options::{ReadOptions, agreed_pitch};

/// The heights of a matrix, m.
pub(super) fn read(numbers: &Numbers, options: &ReadOptions) -> Result<Table, TextError> {
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
    Ok(Table { columns, rows, pitch, heights, notes, warnings, ..Table::default() })
}
