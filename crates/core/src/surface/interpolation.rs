//! Heights of a patch between its points.

use super::Patch;

/// Places that lie outside of the outermost points by less than this part of a pitch are on them.
const ROUNDING: f64 = 1e-9;

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
