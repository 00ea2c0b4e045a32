//! Heights as text: a matrix of numbers, a list of points x, y, z, or a profile.
//!
//! | file | what is in it |
//! |---|---|
//! | `dialect.rs` | the numbers of a line; what parts them, and their decimal mark |
//! | `header.rs` | what stands before the numbers: names with values, names of columns |
//! | `numbers.rs` | the whole table: where it begins, which of several is read; a matrix |
//!
//! Each line of a matrix is a profile along x, the first at y = 0. A list is told by the names of its columns, by the
//! file's ending .xyz, or by three columns of which the first two make a grid. A profile is what the scene takes as one.
//! A separator that ends every line is no empty cell.

mod dialect;
mod header;
mod numbers;

use header::{Columns, Names};
use numbers::{Numbers, matrix};
use plateau_core::surface::Length;

use super::error::{TextError, short};
use super::format::Format;
use super::measured::{Measured, ReadOptions, agreed_pitch};
use crate::delimited::{decode, lines, stated_separator};

/// A matrix of three columns or fewer and more lines than this is more likely a list of points off a grid, or a profile.
const NARROW: usize = 100;

/// Columns of a list of points, at most, that is no matrix: coordinates, height, and what else an instrument knows of a point.
const WIDEST: usize = 8;

/// Reads the whole content of a text file. `xyz` says that it is named as a list of points.
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

/// Coordinates that are off by no more than this, in steps, are evenly spaced.
const OFF: f64 = 0.02;

/// Least fraction of the points of a profile that has to be there.
const COVERAGE: f64 = 0.9;

/// Evenly spaced points.
#[derive(Debug, PartialEq)]
struct Spacing {
    /// Distance of neighbours, in the unit of the coordinates.
    step: f64,
    /// Number of points, also of those that are not there.
    count: usize,
    /// The place of each coordinate, from 0.
    places: Vec<usize>,
    /// Decimal place to which the coordinates are rounded, in their unit, where that is seen.
    rounded_to: Option<f64>,
}

impl Spacing {
    /// The spacing of coordinates that grow, or fall, from point to point; `lines` are where they stand.
    ///
    /// They are on a grid within [`OFF`], or on one of which a tenth of the points is missing at most, or on one when
    /// their rounding to a decimal place is taken into account.
    fn of(coordinates: &[f64], lines: &[usize]) -> Result<Self, TextError> {
        let [first, second, ..] = coordinates else {
            return Err(TextError::ShortProfile { points: coordinates.len() });
        };
        let sign = if second < first { -1.0 } else { 1.0 };
        let along: Vec<f64> = coordinates.iter().map(|x| sign * (x - first)).collect();
        if let Some(at) = along.windows(2).position(|pair| pair[1] <= pair[0]) {
            let (found, before) = (coordinates[at + 1], coordinates[at]);
            return Err(TextError::Disorder { line: lines[at + 1], found, before });
        }
        let last = along.len() - 1;
        let step = along[last] / last as f64;
        let gaps = gaps(&along);
        let (point, off) = farthest(&along, step);
        if half_range(along.iter().enumerate().map(|(point, x)| x - step * point as f64)) <= OFF * step {
            return Ok(Self { step, count: last + 1, places: (0..=last).collect(), rounded_to: None });
        }
        if let Some(holed) = Self::with_holes(&along, gaps[gaps.len() / 2]) {
            return Ok(holed);
        }
        let rounded_to = rounding(coordinates, step, off, &gaps);
        if rounded_to.is_some() {
            return Ok(Self { step, count: last + 1, places: (0..=last).collect(), rounded_to });
        }
        Err(TextError::Uneven {
            line: lines[point],
            found: coordinates[point],
            expected: first + sign * step * point as f64,
            step,
            gaps: [gaps[0], gaps[gaps.len() - 1]],
        })
    }

    /// Points on a grid of about this step of which some are missing.
    fn with_holes(along: &[f64], step: f64) -> Option<Self> {
        let length = along.last()?;
        let steps = (length / step).round();
        if (along.len() as f64) < COVERAGE * (steps + 1.0) {
            return None;
        }
        let step = length / steps;
        let places: Vec<f64> = along.iter().map(|x| x / step).collect();
        let on_grid = half_range(places.iter().map(|place| place - place.round())) <= OFF;
        let places: Vec<usize> = places.iter().map(|place| place.round() as usize).collect();
        let apart = places.windows(2).all(|pair| pair[0] < pair[1]);
        (on_grid && apart).then(|| Self { step, count: steps as usize + 1, places, rounded_to: None })
    }
}

/// Measures how far numbers are from the middle between least and greatest of them: the first point may be off its place as any other.
fn half_range(numbers: impl Iterator<Item = f64>) -> f64 {
    let [least, most] = extent(numbers);
    0.5 * (most - least)
}

/// The least and the greatest of numbers.
fn extent(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], next| [least.min(next), most.max(next)])
}

/// The point that is farthest from its place on a grid, and how far.
fn farthest(along: &[f64], step: f64) -> (usize, f64) {
    let off = along.iter().enumerate().map(|(point, x)| (point, (x - step * point as f64).abs()));
    off.fold((0, 0.0), |farthest, point| if point.1 > farthest.1 { point } else { farthest })
}

/// The decimal place to which evenly spaced coordinates are rounded: all are multiples of it, the gaps differ by no more
/// than it, and no point is off by more (half for its own rounding, half for that of the ends).
fn rounding(coordinates: &[f64], step: f64, off: f64, gaps: &[f64]) -> Option<f64> {
    /// Tolerance, as a part of the place, for the rounding of decimal numbers.
    const SAME: f64 = 1e-6;
    let exponent: i32 = format!("{step:e}").split_once('e')?.1.parse().ok()?;
    (exponent.saturating_sub(2)..=exponent).rev().find_map(|exponent| {
        let place: f64 = format!("1e{exponent}").parse().ok()?;
        let is_multiple = |x: &f64| (x / place - (x / place).round()).abs() <= SAME;
        let most = place * (1.0 + SAME);
        let fits = off <= most && gaps[gaps.len() - 1] - gaps[0] <= most && coordinates.iter().all(is_multiple);
        fits.then_some(place)
    })
}

/// The heights of a profile, m: one row.
fn profile(numbers: &Numbers, options: &ReadOptions) -> Result<Measured, TextError> {
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

/// Finds the column of the one of two coordinates that changes along the line of a profile in space.
fn traced(numbers: &Numbers, coordinates: [usize; 2]) -> Result<usize, TextError> {
    let changes = |column: usize| numbers.column(column).windows(2).any(|pair| pair[0] != pair[1]);
    match coordinates.map(changes) {
        [true, false] => Ok(coordinates[0]),
        [false, true] => Ok(coordinates[1]),
        _ => Err(TextError::NoProfile { columns: numbers.columns, lines: numbers.lines.len() }),
    }
}

/// Heights alone, in a line or in a column.
fn alone(numbers: &Numbers, options: &ReadOptions) -> Result<Measured, TextError> {
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
    Ok(Measured { notes, ..Measured::new(Format::Text, [count, 1], pitch, heights) })
}

/// Heights beside the distance along the line.
fn beside_distances(
    numbers: &Numbers,
    names: &Names,
    [distance, height]: [usize; 2],
    options: &ReadOptions,
) -> Result<Measured, TextError> {
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
    Ok(Measured { notes, ..Measured::new(Format::Text, [spacing.count, 1], Some(pitch), heights) })
}

/// A point is off the grid if it is farther from it than this, in steps of the grid; coordinates are printed with few
/// digits.
const OFF_GRID: f64 = 0.02;

/// Distances of coordinates between lines of a grid are at least so many times those within a line, of which each point is off by
/// [`OFF_GRID`] at most: (1 - 2 · 0.02)/(2 · 0.02) = 24, and less for what is rounded.
const APART: f64 = 20.0;

/// A list fills at least one in so many points of its grid.
const SPARSEST: usize = 16;

/// Coordinates that differ by less than this, in units of their range, are the same.
const SAME: f64 = 1e-9;

/// Points with the lines that they stand in.
struct Points {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    lines: Vec<usize>,
}

/// Points on a grid, in the file's unit.
struct Gridded {
    columns: usize,
    rows: usize,
    steps: [f64; 2],
    /// Heights column by column; NaN where the list has no point.
    heights: Vec<f64>,
}

impl Gridded {
    /// Says that x and y were taken in the unit of the heights, m, and what to give if they are in mm.
    fn assumed(&self, unit: f64) -> String {
        let pitch = |unit: f64| self.steps.map(|step| Length(step * unit));
        let ([x, y], [x_in_mm, y_in_mm]) = (pitch(unit), pitch(1e-3));
        format!(
            "the file does not say the unit of x and y, and they are taken in that of the heights: points {x} by {y} apart, {} by {} in \
             all; if they are in mm, say pitch = [\"{x_in_mm}\", \"{y_in_mm}\"], else give the right pitch, or name the columns, such as \
             x [mm], y [mm], z [um]",
            Length(self.steps[0] * unit * self.columns as f64),
            Length(self.steps[1] * unit * self.rows as f64),
        )
    }
}

/// The heights of a list, m, on its grid.
fn list(numbers: &Numbers, names: &Names, columns: [usize; 3], options: &ReadOptions) -> Result<Measured, TextError> {
    let gridded = Points::of(numbers, names, columns)?.grid()?;
    let header = &numbers.header;
    let [x_unit, y_unit, z_unit] = columns.map(|column| names.units[column]);
    // Both are distances: what one of them says holds for the other.
    let (x_unit, y_unit) = (x_unit.or(y_unit), y_unit.or(x_unit));
    let unit = numbers.unit(z_unit.or(header.unit), options)?;
    // A pitch that is given says what x and y of an unstated unit are; else they have that of the heights. Where that is not the unit
    // that the file states for all its numbers, nor m, they may well be in mm, as of many instruments.
    let (mut is_pitch_assumed, mut warnings) = (false, Vec::new());
    let pitch = match (x_unit.or(header.lateral_unit), y_unit.or(header.lateral_unit), options.pitch) {
        (Some(x), Some(y), given) => agreed_pitch(Some([gridded.steps[0] * x, gridded.steps[1] * y]), given)?,
        (_, _, Some(given)) => Some(given),
        _ => {
            is_pitch_assumed = unit != 1.0 && header.unit != Some(unit);
            Some(gridded.steps.map(|step| step * unit))
        }
    };
    if is_pitch_assumed {
        warnings.push(gridded.assumed(unit));
    }
    let mut heights = gridded.heights;
    warnings.extend(Numbers::stand_in(&heights));
    numbers.scale(&mut heights, unit)?;
    let notes = vec![format!("list of {} points, 1 stands for {unit:e} m", numbers.lines.len())];
    let plain = Measured::new(Format::Text, [gridded.columns, gridded.rows], pitch, heights);
    Ok(Measured { is_pitch_assumed, notes, warnings, ..plain })
}

/// Tells whether the first three columns look like a list of points without names.
fn is_list(numbers: &Numbers) -> bool {
    let columns = [0, 1, 2];
    let names = Names::first(numbers.first_line(), numbers.columns, Columns::Points(columns));
    numbers.columns >= 3 && Points::of(numbers, &names, columns).is_ok_and(|points| points.look_gridded())
}

impl Points {
    /// The columns of a list.
    fn of(numbers: &Numbers, names: &Names, columns: [usize; 3]) -> Result<Self, TextError> {
        numbers.check_names(names)?;
        let [x, y, z] = columns;
        Ok(Self {
            x: numbers.coordinates(x)?,
            y: numbers.coordinates(y)?,
            z: numbers.heights(names, z),
            lines: numbers.lines.clone(),
        })
    }

    /// Tells whether x and y look like coordinates: their values make a grid of which the points fill at least half.
    fn look_gridded(&self) -> bool {
        let points = self.z.len();
        let fits = |[columns, rows]: [usize; 2]| {
            let grid = columns.saturating_mul(rows);
            columns >= 2 && rows >= 2 && points >= 4 && points <= grid && grid <= 2 * points
        };
        let exact = [&self.x, &self.y].map(|values| distinct(values).len());
        let grouped = |axis: usize| Axis::grouped([&self.x, &self.y][axis]).map_or(exact[axis], |axis| axis.count);
        fits(exact) || fits([grouped(0), grouped(1)])
    }

    /// Puts the points on their grid.
    fn grid(&self) -> Result<Gridded, TextError> {
        let points = self.z.len();
        let places = |x: &Axis, y: &Axis| {
            x.count.checked_mul(y.count).filter(|places| *places <= points.saturating_mul(SPARSEST))
        };
        let (x, y) = match (Axis::find('x', &self.x, &self.lines), Axis::find('y', &self.y, &self.lines)) {
            (Ok(x), Ok(y)) if places(&x, &y).is_some() => (x, y),
            (x, y) => (Axis::grouped(&self.x).map_or(x, Ok)?, Axis::grouped(&self.y).map_or(y, Ok)?),
        };
        let (columns, rows) = (x.count, y.count);
        let Some(places) = places(&x, &y) else { return Err(TextError::Sparse { points, grid: (columns, rows) }) };
        let place = |point: usize| x.index(self.x[point]) * rows + y.index(self.y[point]);
        let mut heights = vec![f64::NAN; places];
        let mut taken = vec![false; places];
        for (point, (height, line)) in self.z.iter().zip(&self.lines).enumerate() {
            let at = place(point);
            if taken[at] {
                let first = (0..point).find(|other| place(*other) == at).unwrap_or(point);
                return Err(TextError::Twice { line: *line, first: self.lines[first] });
            }
            taken[at] = true;
            heights[at] = *height;
        }
        Ok(Gridded { columns, rows, steps: [x.step, y.step], heights })
    }
}

/// The values in increasing order, each once.
fn distinct(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let range = sorted.last().zip(sorted.first()).map_or(0.0, |(last, first)| last - first);
    sorted.dedup_by(|a, b| *a - *b <= SAME * range);
    sorted
}

/// Distances of neighbours, in increasing order.
fn gaps(sorted: &[f64]) -> Vec<f64> {
    let mut gaps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
    gaps.sort_unstable_by(f64::total_cmp);
    gaps
}

/// Equidistant coordinates.
struct Axis {
    first: f64,
    step: f64,
    count: usize,
}

impl Axis {
    fn find(name: char, values: &[f64], lines: &[usize]) -> Result<Self, TextError> {
        let sorted = distinct(values);
        let (Some(&first), true) = (sorted.first(), sorted.len() >= 2) else {
            return Err(TextError::Profile { axis: name });
        };
        let gaps = gaps(&sorted);
        let most = values.len().saturating_mul(SPARSEST);
        for axis in Self::through(&sorted, &gaps) {
            if axis.count <= most && sorted.iter().all(|value| axis.holds(*value)) {
                return Ok(axis);
            }
        }
        let axis = Self { first, step: gaps[gaps.len() / 2], count: 0 };
        let off = values.iter().position(|value| !axis.holds(*value)).unwrap_or(0);
        Err(TextError::Irregular { line: lines[off], axis: name, found: values[off], first, step: axis.step })
    }

    /// Axes that these coordinates, in increasing order with increasing gaps, may have.
    fn through(sorted: &[f64], gaps: &[f64]) -> impl Iterator<Item = Self> {
        let (first, last) = (sorted[0], sorted[sorted.len() - 1]);
        // All lines of the grid are there, or most neighbours, or at least one pair of neighbours. The whole range tells
        // the step best.
        let steps = [(sorted.len() - 1) as f64, (last - first) / gaps[gaps.len() / 2], (last - first) / gaps[0]];
        let axis =
            move |count: f64| Self { first, step: (last - first) / count, count: (count as usize).saturating_add(1) };
        steps.map(f64::round).into_iter().map(axis)
    }

    /// The axis of coordinates of which each has its own distance from the grid: those that are close to each other are of one line of
    /// it. None if they are off any such grid by more than [`OFF_GRID`].
    fn grouped(values: &[f64]) -> Option<Self> {
        let sorted = distinct(values);
        let all = gaps(&sorted);
        let most = values.len().saturating_mul(SPARSEST);
        all.windows(2).rev().filter(|pair| pair[0] * APART <= pair[1]).find_map(|pair| {
            let groups = sorted.chunk_by(|one, next| next - one < pair[1]);
            let centres: Vec<f64> = groups.map(|group| group.iter().sum::<f64>() / group.len() as f64).collect();
            let gaps = gaps(&centres);
            Self::through(&centres, &gaps).filter(|axis| axis.count <= most).find_map(|axis| axis.fitted(values))
        })
    }

    /// The axis that is nearest to coordinates that lie about this one, by least squares; none where they are off every axis.
    fn fitted(&self, values: &[f64]) -> Option<Self> {
        let mean = |of: &dyn Fn(f64) -> f64| values.iter().map(|value| of(*value)).sum::<f64>() / values.len() as f64;
        let place = |value: f64| self.index(value) as f64;
        let (mean_place, mean_value) = (mean(&place), mean(&|value| value));
        let spread = mean(&|value| (place(value) - mean_place).powi(2));
        let step = mean(&|value| (place(value) - mean_place) * (value - mean_value)) / spread;
        // Where an axis of this step begins that has the points equally far to both sides, and how far.
        let strip = |step: f64| {
            let [least, most] = extent(values.iter().map(|value| value - step * place(*value)));
            (0.5 * (least + most), 0.5 * (most - least))
        };
        // Another step may have all points nearer: how far the farthest is has one minimum over the step.
        let [mut low, mut high] =
            [-1.0, 1.0].map(|side| step * (1.0 + side * 4.0 * OFF_GRID / (self.count - 1) as f64));
        while strip(step).1 > OFF_GRID * step && high - low > 1e-9 * step {
            let [one, other] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if strip(one).1 < strip(other).1 { high = other } else { low = one }
        }
        let is_near = strip(step).1 <= OFF_GRID * step || strip(low).1 <= OFF_GRID * low;
        is_near.then_some(Self { first: strip(step).0, step, count: self.count })
    }

    fn holds(&self, value: f64) -> bool {
        let place = (value - self.first) / self.step;
        (place - place.round()).abs() <= OFF_GRID
    }

    fn index(&self, value: f64) -> usize {
        (((value - self.first) / self.step).round() as usize).min(self.count - 1)
    }
}
