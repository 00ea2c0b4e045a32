//! Missing points: outliers by height or by slope that are made missing, and heights for those that are.

use rayon::prelude::*;

use super::Patch;
use super::heights::mean;

/// Standard deviation of a normal distribution over its median absolute deviation, 1/Φ⁻¹(¾).
const NORMAL: f64 = 1.482_602_218_505_602;

/// Makes outliers missing, heights that no surface has, as spikes and dropouts of an optical instrument: every point that
/// lies further than `limit` robust standard deviations from the median.
///
/// The robust standard deviation is 1.4826 times the median absolute deviation from the median, which up to half of the
/// points being outliers cannot carry away (Rousseeuw and Croux 1993, doi:10.1080/01621459.1993.10476408).
/// Gives the number of points and the distance from the median in m; `None`, and nothing done, when half of the points
/// or more have the median's height, so that there is no such deviation.
pub(super) fn remove_outliers(heights: &mut [f64], limit: f64) -> Option<(usize, f64)> {
    let mut sorted: Vec<f64> = heights.iter().copied().filter(|height| !height.is_nan()).collect();
    let median = median(&mut sorted)?;
    sorted.iter_mut().for_each(|height| *height = (*height - median).abs());
    let distance = limit * NORMAL * self::median(&mut sorted)?;
    if distance == 0.0 {
        return None;
    }
    let mut count = 0;
    for height in heights.iter_mut().filter(|height| (**height - median).abs() > distance) {
        *height = f64::NAN;
        count += 1;
    }
    Some((count, distance))
}

/// Median; of an even number of values the mean of the two in the middle. Reorders the values.
fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let even = values.len().is_multiple_of(2);
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = below.iter().copied().max_by(f64::total_cmp).filter(|_| even).unwrap_or(*upper);
    Some(0.5 * lower + 0.5 * *upper)
}

/// Heights for missing points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fill {
    /// The mean of the other points.
    Level,
    /// A membrane spanned over the gaps from the points around them.
    Interpolate,
}

/// Fills the missing points (NaN) of a patch that has at least one height; with `closed` its columns run round a ring.
pub(super) fn fill(patch: &mut Patch, fill: Fill, closed: bool) {
    match fill {
        Fill::Level => {
            let mean = mean(&patch.heights);
            patch.heights.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = mean);
        }
        Fill::Interpolate => {
            let across = (patch.column_pitch / patch.row_pitch) * (patch.column_pitch / patch.row_pitch);
            interpolate(&Grid { columns: patch.columns, rows: patch.rows, across, closed }, &mut patch.heights);
        }
    }
}

/// Spans a membrane over the gaps of a grid, starting from that of a grid of half as many columns and rows.
///
/// The coarser grids carry what is wider than the iterations on a finer one reach (the cascadic multigrid
/// method of Bornemann and Deuflhard, Numerische Mathematik 75, 1996), so that the cost grows as the number of points.
fn interpolate(grid: &Grid, heights: &mut [f64]) {
    let gaps: Vec<usize> = (0..heights.len()).filter(|index| heights[*index].is_nan()).collect();
    // Without any height there is nothing to span from, on no coarser grid either.
    if gaps.is_empty() || gaps.len() == heights.len() {
        return;
    }
    let (coarse, mut coarse_heights) = grid.halved(heights);
    interpolate(&coarse, &mut coarse_heights);
    gaps.iter().for_each(|gap| heights[*gap] = coarse_heights[grid.block(*gap, &coarse)]);
    span(grid, &gaps, heights);
}

/// Residual of the equations at which a membrane is taken as spanned, relative to that of the start.
const RESIDUAL: f64 = 1e-10;
/// Most iterations on one grid, enough for gaps of some 30 points across; wider ones start from a coarser grid that is
/// good enough.
const ITERATIONS: usize = 100;

/// Neighbours of points and their weights.
struct Grid {
    columns: usize,
    rows: usize,
    /// Weight of neighbours in the same column; those in the same row have 1.
    across: f64,
    closed: bool,
}

impl Grid {
    /// The grid of half as many columns and rows, with the means of the heights that there are.
    fn halved(&self, heights: &[f64]) -> (Self, Vec<f64>) {
        let coarse = Self { columns: self.columns.div_ceil(2), rows: self.rows.div_ceil(2), ..*self };
        let mut sums = vec![(0.0, 0.0); coarse.columns * coarse.rows];
        for (index, height) in heights.iter().enumerate().filter(|(_, height)| !height.is_nan()) {
            let (sum, count) = &mut sums[self.block(index, &coarse)];
            (*sum, *count) = (*sum + height, *count + 1.0);
        }
        // Without any height this is NaN: a gap of the coarse grid.
        let means = sums.into_iter().map(|(sum, count)| sum / count).collect();
        (coarse, means)
    }

    /// The point of the halved grid that stands for this one.
    fn block(&self, index: usize, coarse: &Self) -> usize {
        (index / self.rows / 2) * coarse.rows + index % self.rows / 2
    }

    /// Up to four neighbours of a point with their weights.
    fn neighbours(&self, index: usize) -> impl Iterator<Item = (usize, f64)> {
        let (column, row) = (index / self.rows, index % self.rows);
        let ring = self.columns * self.rows;
        let before = if column > 0 { Some(index - self.rows) } else { self.closed.then(|| index + ring - self.rows) };
        let last = column + 1 == self.columns;
        let after = if last { self.closed.then(|| index + self.rows - ring) } else { Some(index + self.rows) };
        let inside = (row > 0).then(|| index - 1);
        let outside = (row + 1 < self.rows).then(|| index + 1);
        let weigh = |point: Option<usize>, weight: f64| point.map(|point| (point, weight));
        [weigh(before, 1.0), weigh(after, 1.0), weigh(inside, self.across), weigh(outside, self.across)]
            .into_iter()
            .flatten()
    }

    /// Σ w (z − z of the neighbour).
    fn tension(&self, index: usize, heights: &[f64]) -> f64 {
        self.neighbours(index).map(|(neighbour, weight)| weight * (heights[index] - heights[neighbour])).sum()
    }
}

/// Makes every gap the weighted mean of its neighbours, Σ w (z − z of the neighbour) = 0 with w one over the square of
/// their distance: Laplace's equation, free at the edges of the grid. Conjugate gradients (Hestenes and Stiefel 1952).
fn span(grid: &Grid, gaps: &[usize], heights: &mut [f64]) {
    let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let mut residual: Vec<f64> = gaps.iter().map(|gap| -grid.tension(*gap, heights)).collect();
    // Zero where there is no gap.
    let mut direction = vec![0.0; heights.len()];
    gaps.iter().zip(&residual).for_each(|(gap, residual)| direction[*gap] = *residual);
    let start = square(&residual);
    let mut size = start;
    for _ in 0..ITERATIONS {
        if size <= RESIDUAL * RESIDUAL * start {
            return;
        }
        let tension: Vec<f64> = gaps.iter().map(|gap| grid.tension(*gap, &direction)).collect();
        let curvature: f64 = gaps.iter().zip(&tension).map(|(gap, tension)| direction[*gap] * tension).sum();
        let step = size / curvature;
        for ((gap, residual), tension) in gaps.iter().zip(&mut residual).zip(&tension) {
            heights[*gap] += step * direction[*gap];
            *residual -= step * tension;
        }
        let next = square(&residual);
        let share = next / size;
        gaps.iter().zip(&residual).for_each(|(gap, residual)| direction[*gap] = residual + share * direction[*gap]);
        size = next;
    }
}

/// Most points that a spike has across.
const WIDEST: usize = 3;
/// Fewest points round a window that tell anything: as many as at the corner of a patch.
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

    /// Tells whether the point is higher than all points right round the window, or lower than all.
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
