//! Lists of points: x, y and z of one point a line, in any order, on a regular grid.

use plateau_core::surface::Length;

use super::error::TextError;
use super::names::{Columns, Names};
use super::numbers::Numbers;
use super::table::Table;
use crate::surface::options::{ReadOptions, agreed_pitch};

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
    /// Column by column; NaN where the list has no point.
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
pub(super) fn read(
    numbers: &Numbers,
    names: &Names,
    columns: [usize; 3],
    options: &ReadOptions,
) -> Result<Table, TextError> {
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
    Ok(Table { columns: gridded.columns, rows: gridded.rows, pitch, is_pitch_assumed, heights, notes, warnings })
}

/// Whether the first three columns look like a list of points without names.
pub(super) fn is_likely(numbers: &Numbers) -> bool {
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

    /// Whether x and y look like coordinates: their values make a grid of which the points fill at least half.
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
            let starts = values.iter().map(|value| value - step * place(*value));
            let [least, most] = starts
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], start| [least.min(start), most.max(start)]);
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
