//! Spikes and pits told by their slopes.

use rayon::prelude::*;

use super::Patch;

/// Most points that a spike has across.
const WIDEST: usize = 3;
/// With fewer points round a window than the corner of a patch has, nothing is told.
const FEWEST_NEIGHBOURS: usize = 3;

/// Makes spikes and pits missing; gives the number of their points.
///
/// A point is on a spike if it is in a window of 1 × 1, 2 × 2 or 3 × 3 points such that it stands higher than every point
/// right round the window by more than `limit` times their distance; in a pit it lies so much lower. Missing points round the
/// window, and places beyond the edge, are left out; fewer than three points round it tell nothing. With `closed` the
/// columns run round a ring.
///
/// At an edge some points round every window are as high as the point, along a ridge or a groove those where it enters
/// and leaves the window: these stay, whatever their slopes and directions, and so does a spike of more than three points
/// across.
///
/// That slopes beyond those of the surface tell the spikes of an optical instrument is common practice (Podulka, Pawlus,
/// Dobrzański and Lenart 2014, doi:10.1088/1742-6596/483/1/012025).
pub(super) fn remove_slope_outliers(patch: &mut Patch, limit: f64, closed: bool) -> usize {
    let surface = Surface { patch, limit, closed };
    let outliers: Vec<usize> = (0..patch.heights.len())
        .into_par_iter()
        .filter(|index| !surface.patch.heights[*index].is_nan() && surface.is_outlier(*index))
        .collect();
    outliers.iter().for_each(|index| patch.heights[*index] = f64::NAN);
    outliers.len()
}

struct Surface<'a> {
    patch: &'a Patch,
    limit: f64,
    closed: bool,
}

impl Surface<'_> {
    fn is_outlier(&self, index: usize) -> bool {
        // Every window that the point is in, by the points of the window before it.
        (1..=WIDEST).any(|width| {
            (0..width).any(|before| (0..width).any(|below| self.stands_out(index, width, [before, below])))
        })
    }

    /// Whether the point is higher than all points right round the window, or lower than all.
    fn stands_out(&self, index: usize, width: usize, before: [usize; 2]) -> bool {
        let [left, below] = before.map(|before| -(before as isize) - 1);
        let [right, above] = [left, below].map(|first| first + width as isize + 1);
        let (mut is_higher, mut is_lower, mut neighbours) = (true, true, 0);
        for dx in left..=right {
            let inner = dx != left && dx != right;
            for dy in (below..=above).step_by(if inner { width + 1 } else { 1 }) {
                let Some(there) = self.height(index, [dx, dy]) else { continue };
                let [x, y] = [dx as f64 * self.patch.column_pitch, dy as f64 * self.patch.row_pitch];
                let (rise, least) = (self.patch.heights[index] - there, self.limit * (x * x + y * y).sqrt());
                is_higher &= rise > least;
                is_lower &= -rise > least;
                if !is_higher && !is_lower {
                    return false;
                }
                neighbours += 1;
            }
        }
        neighbours >= FEWEST_NEIGHBOURS
    }

    /// The height so many columns and rows away, if there is one.
    fn height(&self, index: usize, [dx, dy]: [isize; 2]) -> Option<f64> {
        let Patch { columns, rows, ref heights, .. } = *self.patch;
        let row = (index % rows).checked_add_signed(dy).filter(|row| *row < rows)?;
        let column = index / rows;
        let column = if self.closed {
            // Rounds are added so that the place is not negative.
            (column + WIDEST * columns).checked_add_signed(dx)? % columns
        } else {
            column.checked_add_signed(dx).filter(|column| *column < columns)?
        };
        Some(heights[column * rows + row]).filter(|height| !height.is_nan())
    }
}
