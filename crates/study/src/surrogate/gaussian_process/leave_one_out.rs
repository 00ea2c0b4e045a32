//! What each point differs by from the forecast of the others.
//!
//! O. Dubrule, Cross validation of kriging in a unique neighborhood, Math. Geol. 15, 687–699 (1983), doi:10.1007/BF01033232:
//! with B = C⁻¹ − C⁻¹F(FᵀC⁻¹F)⁻¹FᵀC⁻¹ the error of point i is (By)ᵢ/Bᵢᵢ and its variance σ²/Bᵢᵢ. Lengths, noise and σ² are those
//! of all points; the trend is that of the others.

use super::GaussianProcess;
use super::solved::Solved;

/// A point and the forecast of it by the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// What was observed: the mean over the seeds.
    pub observed: f64,
    /// What is forecast.
    pub forecast: f64,
    /// Variance of the difference of the two.
    pub variance: f64,
}

impl GaussianProcess {
    /// Every point, in the order in which points were first observed, with the forecast of it by the others.
    pub fn left_out(&self) -> Vec<LeftOut> {
        self.left_out_with(&self.solved)
    }

    /// The same with other equations.
    pub(super) fn left_out_with(&self, solved: &Solved) -> Vec<LeftOut> {
        let diagonals = solved.factor.inverse().diagonal();
        let each = |(at, mean): (usize, &f64)| {
            let trend = solved.inverse_trend.row(at);
            let spread = (trend * &solved.trend_inverse).dot(&trend);
            let diagonal = diagonals[at] - spread;
            // By = C⁻¹(y − Fβ), for β is that of generalised least squares.
            let error = solved.weights[at] / diagonal;
            let observed = mean + self.averages.offset;
            LeftOut { observed, forecast: observed - error, variance: solved.variance / diagonal }
        };
        self.averages.means.iter().enumerate().map(each).collect()
    }

    /// Mean square of the errors of [`GaussianProcess::left_out`], each as a multiple of its standard error: 1 where the
    /// variance is right, more where the process promises too much.
    pub fn left_out_square(&self) -> f64 {
        let left_out = self.left_out();
        let square = |point: &LeftOut| (point.observed - point.forecast).powi(2) / point.variance;
        left_out.iter().map(square).sum::<f64>() / left_out.len() as f64
    }
}
