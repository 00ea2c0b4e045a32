//! A sector of a ring, measured in x and y, as arc length and radius, and which part of it was measured.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use rayon::prelude::*;

use super::error::PreparationError;
use super::heights::{change, rms};
use super::patch::neighbours;
use super::rotate::{height_at, place};
use super::{Length, Patch};

/// Tells whether each point lies within what was measured: all but the missing points that other missing points join to the edge
/// of the patch, or to the point with the index `outside`. Any other gap with measured points all round it lies within.
fn within_measurement(patch: &Patch, outside: Option<usize>) -> Vec<bool> {
    let heights = &patch.heights;
    let mut within = vec![true; heights.len()];
    let around = |index: usize| neighbours(index, patch.rows, heights.len());
    let is_outside = |index: usize| around(index).contains(&None) || outside == Some(index);
    let mut found: Vec<usize> =
        (0..heights.len()).filter(|index| heights[*index].is_nan() && is_outside(*index)).collect();
    found.iter().for_each(|index| within[*index] = false);
    while let Some(index) = found.pop() {
        for neighbour in around(index).into_iter().flatten() {
            if within[neighbour] && heights[neighbour].is_nan() {
                within[neighbour] = false;
                found.push(neighbour);
            }
        }
    }
    within
}

/// Columns and rows of a grid, as the first and the number of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rectangle {
    first: [usize; 2],
    count: [usize; 2],
}

/// The rectangle with the most points, all of them within; the first of several. `None` where no point is.
///
/// Column by column: how far the points reach back in each row makes a skyline, whose largest rectangle a stack of rising
/// heights finds in one pass (the largest rectangle in a histogram).
fn largest_rectangle(within: &[bool], rows: usize) -> Option<Rectangle> {
    let mut back = vec![0; rows];
    let mut best: Option<Rectangle> = None;
    for (column, points) in within.chunks_exact(rows).enumerate() {
        back.iter_mut().zip(points).for_each(|(back, within)| *back = if *within { *back + 1 } else { 0 });
        // Rows from which on the points reach back at least so far; both rise along the stack.
        let mut rising: Vec<(usize, usize)> = Vec::new();
        for row in 0..=rows {
            let here = back.get(row).copied().unwrap_or(0);
            let mut first = row;
            while let Some((start, depth)) = rising.pop_if(|(_, depth)| *depth >= here) {
                first = start;
                let count = [depth, row - start];
                if depth > 0 && best.is_none_or(|best| count[0] * count[1] > best.count[0] * best.count[1]) {
                    best = Some(Rectangle { first: [column + 1 - depth, start], count });
                }
            }
            rising.push((first, here));
        }
    }
    best
}

/// The longest run of columns all of whose points are within, as a rectangle of all rows; the first of several.
fn longest_run(within: &[bool], rows: usize) -> Option<Rectangle> {
    let mut best: Option<Rectangle> = None;
    let mut run = 0;
    for (column, points) in within.chunks_exact(rows).enumerate() {
        run = if points.iter().all(|within| *within) { run + 1 } else { 0 };
        if run > best.map_or(0, |best| best.count[0]) {
            best = Some(Rectangle { first: [column + 1 - run, 0], count: [run, rows] });
        }
    }
    best
}

/// Most points of the grid in which a sector is looked for, by those of the patch. A ring that fills a square patch needs
/// 1.6 times as many; more than this is a patch of which little can be used.
const MOST_POINTS: f64 = 16.0;
/// A width that is more than a whole number of pitches by less than this part of it is that many.
const ROUNDING: f64 = 1e-9;

/// Unrolling of a sector of a ring into a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unroll {
    /// Centre of the ring, m along x and y from the patch's first corner before it was cropped.
    pub centre: [f64; 2],
    /// Inner and outer radius of the part that is kept, m; without them it is the largest rectangle of arc and radius
    /// that was measured.
    pub radii: Option<[f64; 2]>,
}

impl Unroll {
    /// Unrolls the patch, whose first corner lies at `origin`, m; says what was done.
    ///
    /// x becomes the arc length at the mean radius of what is kept and runs clockwise, y the distance from the innermost
    /// radius, so that a surface seen from above stays one seen from above. Heights are interpolated. A point is kept
    /// where the points round it were measured or lie in a gap of the measurement.
    pub(super) fn unroll(&self, patch: &mut Patch, origin: [f64; 2]) -> Result<String, PreparationError> {
        self.check()?;
        let before = rms(&patch.heights);
        let centre = [0, 1].map(|axis| self.centre[axis] - origin[axis]);
        let seen = Seen::of(patch, centre)?;
        let nothing = PreparationError::UnrollNothing { wanted: self.radii, found: seen.radii };
        let pitch = patch.column_pitch.max(patch.row_pitch);
        if self.radii.is_some_and(|[inner, outer]| inner < seen.radii[0] - pitch || outer > seen.radii[1] + pitch) {
            return Err(nothing);
        }
        let grid = Polar::new(&seen, patch, centre, self.radii);
        let points = grid.columns * grid.rows;
        // It is no number where the centre is so far away that angles vanish.
        if points.is_nan() || points > MOST_POINTS * patch.heights.len() as f64 {
            return Err(PreparationError::UnrollTooLarge { points, patch: patch.heights.len(), radii: seen.radii });
        }
        let within = grid.within(patch);
        let rows = grid.rows as usize;
        let kept = if self.radii.is_some() { longest_run(&within, rows) } else { largest_rectangle(&within, rows) };
        let kept = kept.ok_or(nothing)?;
        let whole = patch.heights.len();
        *patch = grid.heights(patch, kept);
        let [inner, outer] = grid.edges(kept);
        Ok(format!(
            "unrolled about {}, {}: radii from {} to {}, {:.2} deg clockwise, x the arc at the mean radius of {}; {} x {} \
             points of {} by {} interpolated from {whole}, {} missing, {}",
            Length(self.centre[0]),
            Length(self.centre[1]),
            Length(inner),
            Length(outer),
            (kept.count[0] as f64 * grid.angle).to_degrees(),
            Length(0.5 * (inner + outer)),
            patch.columns,
            patch.rows,
            Length(patch.column_pitch),
            Length(patch.row_pitch),
            patch.missing(),
            change(before, &patch.heights)
        ))
    }

    fn check(&self) -> Result<(), PreparationError> {
        if let Some(found) = self.centre.into_iter().find(|place| !place.is_finite()) {
            return Err(PreparationError::Value { key: "unroll.centre", found, expected: "a finite length in m" });
        }
        match self.radii {
            Some([inner, outer]) if !(inner >= 0.0 && inner < outer && outer.is_finite()) => {
                Err(PreparationError::Radii { inner, outer })
            }
            _ => Ok(()),
        }
    }
}

/// Place of the measured points round the centre.
struct Seen {
    /// Smallest and largest radius, m.
    radii: [f64; 2],
    mean_radius: f64,
    /// Direction of the middle of the sector, and how far it reaches to either side of it, rad.
    middle: f64,
    reach: [f64; 2],
}

impl Seen {
    fn of(patch: &Patch, centre: [f64; 2]) -> Result<Self, PreparationError> {
        let there = || (0..patch.heights.len()).filter(|index| !patch.heights[*index].is_nan());
        let from_centre = |index: usize| {
            let place = [(index / patch.rows) as f64, (index % patch.rows) as f64];
            [(place[0] + 0.5) * patch.column_pitch - centre[0], (place[1] + 0.5) * patch.row_pitch - centre[1]]
        };
        let mut count = 0.0;
        let (mut sums, mut mean_radius, mut radii) = ([0.0; 2], 0.0, [f64::INFINITY, 0.0_f64]);
        for [x, y] in there().map(from_centre) {
            let radius = libm::hypot(x, y);
            radii = [radius.min(radii[0]), radius.max(radii[1])];
            (count, mean_radius, sums) = (count + 1.0, mean_radius + radius, [sums[0] + x, sums[1] + y]);
        }
        if count == 0.0 {
            return Err(PreparationError::AllMissing { outliers: 0, points: patch.heights.len() });
        }
        let middle = libm::atan2(sums[1], sums[0]);
        let (sine, cosine) = (libm::sin(middle), libm::cos(middle));
        let mut reach = [0.0_f64; 2];
        for [x, y] in there().map(from_centre) {
            let angle = libm::atan2(y * cosine - x * sine, x * cosine + y * sine);
            reach = [angle.min(reach[0]), angle.max(reach[1])];
        }
        Ok(Self { radii, mean_radius: mean_radius / count, middle, reach })
    }
}

/// A grid of angle, clockwise, and radius.
struct Polar {
    /// Numbers of columns and rows: whole, and perhaps larger than a computer can hold.
    columns: f64,
    rows: f64,
    /// Direction of the first column, rad, counterclockwise from x.
    first_angle: f64,
    /// Angle from column to column, rad.
    angle: f64,
    /// Radius of the first row, m.
    first_radius: f64,
    row_pitch: f64,
    /// Centre of the ring, m from the patch's first corner.
    centre: [f64; 2],
}

impl Polar {
    fn new(seen: &Seen, patch: &Patch, centre: [f64; 2], radii: Option<[f64; 2]>) -> Self {
        // In the middle of the sector the arc runs nearer to x or nearer to y.
        let turned = libm::fabs(libm::fabs(seen.middle) - 0.5 * PI) > FRAC_PI_4;
        let (along, across) =
            if turned { (patch.row_pitch, patch.column_pitch) } else { (patch.column_pitch, patch.row_pitch) };
        let mean_radius = radii.map_or(seen.mean_radius, |[inner, outer]| 0.5 * (inner + outer));
        let mut angle = along / mean_radius;
        let span = seen.reach[1] - seen.reach[0];
        // Points of a whole ring leave no gap wider than two pitches, at the innermost radius.
        let is_whole = TAU - span <= 2.0 * along / seen.radii[0];
        let (columns, first_angle) = if is_whole {
            let columns = libm::ceil(TAU / angle * (1.0 - ROUNDING));
            angle = TAU / columns;
            (columns, seen.middle + PI)
        } else {
            let columns = libm::floor(span / angle + ROUNDING) + 1.0;
            let middle = seen.middle + 0.5 * (seen.reach[0] + seen.reach[1]);
            (columns, middle + 0.5 * (columns - 1.0) * angle)
        };
        let (rows, row_pitch, first_radius) = match radii {
            Some([inner, outer]) => {
                let rows = libm::ceil((outer - inner) / across * (1.0 - ROUNDING)).max(1.0);
                let row_pitch = (outer - inner) / rows;
                (rows, row_pitch, inner + 0.5 * row_pitch)
            }
            None => {
                let rows = libm::floor((seen.radii[1] - seen.radii[0]) / across + ROUNDING) + 1.0;
                let middle = 0.5 * (seen.radii[0] + seen.radii[1]);
                (rows, across, middle - 0.5 * (rows - 1.0) * across)
            }
        };
        Self { columns, rows, first_angle, angle, first_radius, row_pitch, centre }
    }

    /// Cosine and sine of a column's direction.
    fn direction(&self, column: usize) -> [f64; 2] {
        let angle = self.first_angle - column as f64 * self.angle;
        [libm::cos(angle), libm::sin(angle)]
    }

    /// Column and row of the patch at a row of the grid.
    fn place(&self, patch: &Patch, direction: [f64; 2], row: usize) -> [f64; 2] {
        let radius = self.first_radius + row as f64 * self.row_pitch;
        let pitches = [patch.column_pitch, patch.row_pitch];
        [0, 1].map(|axis| (self.centre[axis] + radius * direction[axis]) / pitches[axis] - 0.5)
    }

    /// Tells whether the four points of the patch round each point of the grid lie within what was measured.
    fn within(&self, patch: &Patch) -> Vec<bool> {
        // The middle of a ring is outside, too, though there are points all round it.
        let middle = [
            place(self.centre[0] / patch.column_pitch - 0.5, patch.columns),
            place(self.centre[1] / patch.row_pitch - 0.5, patch.rows),
        ];
        let middle = match middle {
            [Some((column, _)), Some((row, _))] => Some(column * patch.rows + row),
            _ => None,
        };
        let measured = within_measurement(patch, middle);
        let (columns, rows) = (self.columns as usize, self.rows as usize);
        let is_within = |[column, row]: [f64; 2]| {
            let (Some((column, _)), Some((row, _))) = (place(column, patch.columns), place(row, patch.rows)) else {
                return false;
            };
            let next = [(column + 1).min(patch.columns - 1), (row + 1).min(patch.rows - 1)];
            [column, next[0]].iter().all(|column| [row, next[1]].iter().all(|row| measured[column * patch.rows + row]))
        };
        (0..columns)
            .into_par_iter()
            .flat_map_iter(|column| {
                let direction = self.direction(column);
                (0..rows).map(move |row| self.place(patch, direction, row))
            })
            .map(is_within)
            .collect()
    }

    /// Inner and outer edge of the rows that are kept, m.
    fn edges(&self, kept: Rectangle) -> [f64; 2] {
        [0, kept.count[1]].map(|rows| self.first_radius + ((kept.first[1] + rows) as f64 - 0.5) * self.row_pitch)
    }

    fn heights(&self, patch: &Patch, kept: Rectangle) -> Patch {
        let [inner, outer] = self.edges(kept);
        let heights = (kept.first[0]..kept.first[0] + kept.count[0])
            .into_par_iter()
            .flat_map_iter(|column| {
                let direction = self.direction(column);
                (kept.first[1]..kept.first[1] + kept.count[1]).map(move |row| {
                    let [column, row] = self.place(patch, direction, row);
                    height_at(patch, column, row)
                })
            })
            .collect();
        Patch {
            columns: kept.count[0],
            rows: kept.count[1],
            column_pitch: self.angle * (0.5 * (inner + outer)),
            row_pitch: self.row_pitch,
            heights,
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/surface/unroll.rs"]
mod tests;
