//! Profiles: heights along one line, with their pitch stated, or beside the distance along the line.

use super::error::{TextError, short};
use super::names::{Columns, Names};
use super::numbers::Numbers;
use super::spacing::Spacing;
use super::table::Table;
use crate::surface::options::{ReadOptions, agreed_pitch};

/// The heights of a profile, m: one row.
pub(super) fn read(numbers: &Numbers, options: &ReadOptions) -> Result<Table, TextError> {
    let (columns, lines) = (numbers.columns, numbers.lines.len());
    match &numbers.header.names {
        Some(names) => {
            numbers.check_names(names)?;
            let [distance, height] = match names.columns {
                Columns::Profile(columns) => columns,
                Columns::Points([x, y, z]) => [traced(numbers, [x, y])?, z],
            };
            beside_distances(numbers, names, [distance, height], options)
        }
        None if columns == 1 || lines == 1 && columns > 2 => alone(numbers, options),
        None if columns == 2 => {
            let names = Names::first(numbers.first_line(), 2, Columns::Profile([0, 1]));
            beside_distances(numbers, &names, [0, 1], options)
        }
        None => Err(TextError::NoProfile { columns, lines }),
    }
}

/// Which of two coordinates changes along the line of a profile in space.
fn traced(numbers: &Numbers, coordinates: [usize; 2]) -> Result<usize, TextError> {
    let changes = |column: usize| numbers.column(column).windows(2).any(|pair| pair[0] != pair[1]);
    match coordinates.map(changes) {
        [true, false] => Ok(coordinates[0]),
        [false, true] => Ok(coordinates[1]),
        _ => Err(TextError::NoProfile { columns: numbers.columns, lines: numbers.lines.len() }),
    }
}

/// Heights alone, in a line or in a column.
fn alone(numbers: &Numbers, options: &ReadOptions) -> Result<Table, TextError> {
    let count = numbers.values.len();
    if count < 2 {
        return Err(TextError::ShortProfile { points: count });
    }
    let unit = numbers.unit(numbers.header.unit, options)?;
    let stated =
        numbers.header.pitch.map(|pitch| pitch[0]).or(numbers.header.extent[0].map(|length| length / count as f64));
    let pitch = agreed_pitch(stated.map(|pitch| [pitch; 2]), options.pitch)?;
    let mut heights = numbers.values.clone();
    numbers.scale(&mut heights, unit)?;
    let notes = vec![format!("1 stands for {unit:e} m")];
    Ok(Table { columns: count, rows: 1, pitch, heights, notes, ..Table::default() })
}

/// Heights beside the distance along the line.
fn beside_distances(
    numbers: &Numbers,
    names: &Names,
    [distance, height]: [usize; 2],
    options: &ReadOptions,
) -> Result<Table, TextError> {
    let spacing = Spacing::of(&numbers.coordinates(distance)?, &numbers.lines)?;
    let unit = numbers.unit(names.units[height].or(numbers.header.unit), options)?;
    // Distances are often in mm beside heights in um, so that their unit is not taken from the heights.
    let stated = names.units[distance].or(numbers.header.lateral_unit).map(|unit| [spacing.step * unit; 2]);
    let pitch = agreed_pitch(stated, options.pitch)?.ok_or(TextError::NoDistanceUnit { step: spacing.step })?;
    let mut heights = vec![f64::NAN; spacing.count];
    spacing.places.iter().zip(numbers.heights(names, height)).for_each(|(place, height)| heights[*place] = height);
    numbers.scale(&mut heights, unit)?;
    let mut notes = vec![format!("1 stands for {unit:e} m")];
    if let Some(place) = spacing.rounded_to {
        notes.push(format!("distances rounded to {place} are taken as evenly spaced, {} apart", short(spacing.step)));
    }
    Ok(Table { columns: spacing.count, rows: 1, pitch: Some(pitch), heights, notes, ..Table::default() })
}
