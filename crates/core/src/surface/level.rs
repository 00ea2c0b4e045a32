//! Levelling: the mean or the least-squares plane is taken out.

use super::prepare::Level;

/// Takes the mean or the least-squares plane out of the heights of a grid, in place. Missing points (NaN) take no part
/// and stay missing.
///
/// Stored column by column. With `closed` the columns run round a ring: a plane then is the mean and a slope along the
/// rows only, for a slope round the ring would leave a step where it closes.
pub fn level(heights: &mut [f64], rows: usize, level: Level, closed: bool) {
    let (slope_x, slope_y) = match level {
        Level::None => return,
        Level::Mean => (false, false),
        Level::Plane => (!closed, true),
    };
    // The second pass takes out what rounding left of a large offset or tilt in the first.
    for _ in 0..2 {
        let plane = Plane::fit(heights, rows, slope_x, slope_y);
        for (index, height) in heights.iter_mut().enumerate() {
            *height = plane.residual(index, *height, rows);
        }
    }
}

/// z = z̄ + bx (x − x̄) + by (y − ȳ) over the indices x of the column and y of the row.
#[derive(Debug, Default)]
struct Plane {
    mean: [f64; 3],
    slope_x: f64,
    slope_y: f64,
}

impl Plane {
    /// Least squares over the points that are there; a slope that is not asked for, or that the points do not
    /// determine, is 0.
    fn fit(heights: &[f64], rows: usize, slope_x: bool, slope_y: bool) -> Self {
        let points = || heights.iter().enumerate().filter(|(_, z)| !z.is_nan()).map(|(i, z)| (place(i, rows), *z));
        let mut plane = Self::default();
        let mut count = 0.0;
        for ([x, y], z) in points() {
            count += 1.0;
            plane.mean.iter_mut().zip([x, y, z]).for_each(|(sum, value)| *sum += value);
        }
        if count == 0.0 {
            return plane;
        }
        plane.mean.iter_mut().for_each(|sum| *sum /= count);
        // Moments about the centre: the normal equations then do not mix the offset with the slopes.
        let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
        for ([x, y], z) in points() {
            let [x, y, z] = [x - plane.mean[0], y - plane.mean[1], z - plane.mean[2]];
            if slope_x {
                (xx, xy, xz) = (xx + x * x, xy + x * y, xz + x * z);
            }
            if slope_y {
                (yy, yz) = (yy + y * y, yz + y * z);
            }
        }
        // y made orthogonal to x; nothing is left of it where all points lie on one line.
        let share = if xx > 0.0 { xy / xx } else { 0.0 };
        let (own_yy, own_yz) = (yy - share * xy, yz - share * xz);
        if own_yy > 1e-12 * yy {
            plane.slope_y = own_yz / own_yy;
        }
        if xx > 0.0 {
            plane.slope_x = (xz - plane.slope_y * xy) / xx;
        }
        plane
    }

    fn residual(&self, index: usize, height: f64, rows: usize) -> f64 {
        let [x, y] = place(index, rows);
        (height - self.mean[2]) - (self.slope_x * (x - self.mean[0]) + self.slope_y * (y - self.mean[1]))
    }
}

/// Column and row of a point.
fn place(index: usize, rows: usize) -> [f64; 2] {
    [(index / rows) as f64, (index % rows) as f64]
}

/// Mean of the points that are there; NaN without any.
pub(super) fn mean(heights: &[f64]) -> f64 {
    let valid = || heights.iter().filter(|height| !height.is_nan());
    let count = valid().count() as f64;
    let first = valid().sum::<f64>() / count;
    // Rounding of a large offset is taken out by the mean of what is left.
    first + valid().map(|height| height - first).sum::<f64>() / count
}
