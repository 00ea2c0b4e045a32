//! A patch turned in its plane, and its heights between its points.

use std::f64::consts::{FRAC_PI_2, TAU};

use rayon::prelude::*;

use super::Patch;
use super::heights::{change, rms};

/// Part of a pitch that is rounding: places that lie outside of the outermost points by less are on them, and a length that is shorter than
/// a whole number of pitches by less is that many.
const ROUNDING: f64 = 1e-9;
/// Angles that differ by less than this are the same, rad: what rounding makes of degrees.
const SAME_ANGLE: f64 = 1e-12;

/// Height of the patch at a place, in columns and rows, its points being at whole numbers; NaN where there is none.
///
/// Cubic convolution over the sixteen points around the place (Keys 1981, doi:10.1109/TASSP.1981.1163711, a = −½), which
/// gives back surfaces of second order. Where one of these is missing or beyond the edge, bilinear interpolation between
/// the four points around the place, which gives back planes; where one of these is missing, too, there is no height. On
/// a point it is the point's height.
pub(super) fn height_at(patch: &Patch, column: f64, row: f64) -> f64 {
    let (Some((column, along)), Some((row, across))) = (place(column, patch.columns), place(row, patch.rows)) else {
        return f64::NAN;
    };
    let cubic = weighted(patch, [column, row], 1, [keys(along), keys(across)]);
    cubic
        .or_else(|| {
            weighted(patch, [column, row], 0, [[1.0 - along, along, 0.0, 0.0], [1.0 - across, across, 0.0, 0.0]])
        })
        .unwrap_or(f64::NAN)
}

/// The point before a place, and how far behind it the place lies, 0 to 1 pitch; `None` outside of the points.
pub(super) fn place(place: f64, count: usize) -> Option<(usize, f64)> {
    let last = (count - 1) as f64;
    if !(place >= -ROUNDING && place <= last + ROUNDING) {
        return None;
    }
    let place = place.clamp(0.0, last);
    let before = libm::floor(place);
    Some((before as usize, place - before))
}

/// Weights of the points 1 before to 2 behind the one before a place, by how far behind it the place lies.
fn keys(u: f64) -> [f64; 4] {
    [
        ((-0.5 * u + 1.0) * u - 0.5) * u,
        (1.5 * u - 2.5) * u * u + 1.0,
        ((-1.5 * u + 2.0) * u + 0.5) * u,
        (0.5 * u - 0.5) * u * u,
    ]
}

/// Σ w z over up to four by four points, the first of which is `before` points before `first` in either direction;
/// `None` where one that counts is missing.
fn weighted(patch: &Patch, first: [usize; 2], before: usize, weights: [[f64; 4]; 2]) -> Option<f64> {
    let mut sum = 0.0;
    for (along, column_weight) in weights[0].iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        let column = (first[0] + along).checked_sub(before).filter(|column| *column < patch.columns)?;
        for (across, row_weight) in weights[1].iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            let row = (first[1] + across).checked_sub(before).filter(|row| *row < patch.rows)?;
            let height = patch.heights[column * patch.rows + row];
            if height.is_nan() {
                return None;
            }
            sum += column_weight * row_weight * height;
        }
    }
    Some(sum)
}

/// A turn as quarters of a turn, 0 to 3, and what is left, −π/4 to π/4 rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    pub(super) quarters: u8,
    pub(super) rest: f64,
}

impl Turn {
    /// The turn by an angle, rad, counterclockwise.
    pub(super) fn new(angle: f64) -> Self {
        let angle = angle % TAU;
        let quarters = libm::round(angle / FRAC_PI_2);
        let rest = angle - quarters * FRAC_PI_2;
        let rest = if rest.abs() < SAME_ANGLE { 0.0 } else { rest };
        Self { quarters: (quarters + 4.0) as u8 % 4, rest }
    }

    /// Tells whether every point stays one of the grid, which keeps its shape.
    pub(super) fn is_half_turns(self) -> bool {
        self.rest == 0.0 && self.quarters.is_multiple_of(2)
    }

    /// Turns the patch counterclockwise, x to the right and y up; says what was done, if anything.
    ///
    /// Quarters of a turn move points and exchange the pitches: no height changes. What is left of the angle is done by
    /// interpolation onto points of the same pitches about the middle of the patch, of which those in the largest
    /// rectangle are kept that lies within the turned patch.
    pub(super) fn turn(self, patch: &mut Patch) -> Option<String> {
        let before = rms(&patch.heights);
        let whole = [patch.columns, patch.rows];
        match self.quarters {
            1 => *patch = quarter(patch, |x, y, _, rows| y * rows + (rows - 1 - x)),
            2 => patch.heights.reverse(),
            3 => *patch = quarter(patch, |x, y, columns, rows| (columns - 1 - y) * rows + x),
            _ => {}
        }
        let degrees = 90.0 * f64::from(self.quarters) + libm::round(1e4 * self.rest.to_degrees()) / 1e4;
        if self.rest != 0.0 {
            let missing = patch.missing();
            *patch = interpolated(patch, self.rest);
            return Some(format!(
                "turned counterclockwise by {degrees} deg, interpolated: the largest rectangle within has {} x {} of {} x \
                 {} points, {} missing ({missing} before), {}",
                patch.columns,
                patch.rows,
                whole[0],
                whole[1],
                patch.missing(),
                change(before, &patch.heights)
            ));
        }
        let exchanged = if self.quarters % 2 == 1 { ", along and across exchanged" } else { "" };
        (self.quarters != 0).then(|| format!("turned counterclockwise by {degrees} deg{exchanged}"))
    }
}

/// A patch with columns and rows exchanged; `from` gives the old index of the new column x and row y from the old numbers
/// of columns and rows.
fn quarter(patch: &Patch, from: impl Fn(usize, usize, usize, usize) -> usize) -> Patch {
    let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
    let places = (0..rows).flat_map(|x| (0..columns).map(move |y| (x, y)));
    Patch {
        columns: rows,
        rows: columns,
        column_pitch: row_pitch,
        row_pitch: column_pitch,
        heights: places.map(|(x, y)| heights[from(x, y, columns, rows)]).collect(),
    }
}

/// The largest rectangle within a patch turned by less than a quarter.
fn interpolated(patch: &Patch, angle: f64) -> Patch {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let middle = [0.5 * (patch.columns - 1) as f64, 0.5 * (patch.rows - 1) as f64];
    // Heights are known between the outermost points.
    let sides = [2.0 * middle[0] * patch.column_pitch, 2.0 * middle[1] * patch.row_pitch];
    let inner = largest_within(sides, sine.abs(), cosine);
    let points = |side: f64, pitch: f64, most: usize| ((side / pitch + ROUNDING) as usize + 1).min(most);
    let columns = points(inner[0], patch.column_pitch, patch.columns);
    let rows = points(inner[1], patch.row_pitch, patch.rows);
    let offset = |index: usize, count: usize, pitch: f64| (index as f64 - 0.5 * (count - 1) as f64) * pitch;
    let heights = (0..columns)
        .into_par_iter()
        .flat_map_iter(|column| {
            let x = offset(column, columns, patch.column_pitch);
            (0..rows).map(move |row| {
                let y = offset(row, rows, patch.row_pitch);
                let old = [cosine * x + sine * y, cosine * y - sine * x];
                height_at(patch, middle[0] + old[0] / patch.column_pitch, middle[1] + old[1] / patch.row_pitch)
            })
        })
        .collect();
    Patch { columns, rows, heights, ..*patch }
}

/// Sides of the largest upright rectangle within a rectangle of these sides that is turned by an angle of at most a right
/// one, of which sine and cosine are given.
///
/// A corner of the inner one at (u, v) from the middle lies within for u c + v s ≤ W/2 and u s + v c ≤ H/2. The product
/// u v is largest where both hold as equations, or, where the outer one is so slender that one of them is met at its best
/// point before the other matters, at that point.
fn largest_within([width, height]: [f64; 2], sine: f64, cosine: f64) -> [f64; 2] {
    // At half a right angle the last form is 0/0 for a square; where two forms meet they agree.
    let twice = 2.0 * sine * cosine * (1.0 + ROUNDING);
    if height <= width * twice {
        [0.5 * height / sine, 0.5 * height / cosine]
    } else if width <= height * twice {
        [0.5 * width / cosine, 0.5 * width / sine]
    } else {
        let double = (cosine - sine) * (cosine + sine);
        [(width * cosine - height * sine) / double, (height * cosine - width * sine) / double]
    }
}
