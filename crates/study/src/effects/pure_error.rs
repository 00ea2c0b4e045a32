//! Pure error: how much responses at the same point differ, which no model of the factors explains.

use nalgebra::{DMatrix, DVector};

use super::fit::Fit;
use super::observation::{Usable, count};

/// What differs between observations of the same point.
pub(super) struct PureError {
    /// Degrees of freedom.
    pub freedom: usize,
    /// By observation, what is left of the response without the means of points, and of blocks if there are any.
    pub residuals: DVector<f64>,
}

impl PureError {
    /// That of these responses (their mean may be taken away), in blocks or not; none without repeated points.
    ///
    /// Blocks add to the points: what they differ by is the same at all points.
    pub fn new(usable: &Usable, responses: &DVector<f64>, in_blocks: bool) -> Option<Self> {
        let (observations, points) = (responses.len(), usable.point_count());
        let mut centred = DMatrix::from_column_slice(observations, 1, responses.as_slice());
        centre(&mut centred, &usable.points, points);
        let mut fitted = 0;
        let mut residuals = centred.column(0).into_owned();
        let blocks = count(&usable.blocks);
        if in_blocks && blocks > 1 {
            let is_in = |row: usize, column: usize| f64::from(u8::from(usable.blocks[row] == column + 1));
            let mut matrix = DMatrix::from_fn(observations, blocks - 1, is_in);
            centre(&mut matrix, &usable.points, points);
            // What the points leave of the blocks is zero but for rounding where each point is in one block only.
            matrix.iter_mut().filter(|entry| entry.abs() < 1e-12).for_each(|entry| *entry = 0.0);
            let fit = Fit::new(&matrix, &residuals);
            fitted = fit.kept.len();
            residuals = fit.residuals;
        }
        let freedom = observations - points - fitted;
        (freedom > 0).then_some(Self { freedom, residuals })
    }
}

/// Takes the mean of each group from each column.
fn centre(matrix: &mut DMatrix<f64>, groups: &[usize], group_count: usize) {
    let mut sizes = vec![0.0; group_count];
    groups.iter().for_each(|group| sizes[*group] += 1.0);
    for mut column in matrix.column_iter_mut() {
        // Twice: the second time takes what rounding left.
        for _ in 0..2 {
            let mut sums = vec![0.0; group_count];
            column.iter().zip(groups).for_each(|(value, group)| sums[*group] += value);
            column.iter_mut().zip(groups).for_each(|(value, group)| *value -= sums[*group] / sizes[*group]);
        }
    }
}
