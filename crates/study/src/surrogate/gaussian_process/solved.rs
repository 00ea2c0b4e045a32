//! A Gaussian process with given lengths and noise: its likelihood, and the equations that forecasts need, solved.
//!
//! The means y of n points are Fβ + a Gaussian process of variance σ² and correlation R + noise. With C = R + g·diag(1/runs),
//! β is that of generalised least squares, and both it and σ² are the most likely ones for C, so that the likelihood depends
//! on lengths and g alone. Where there are replicates, their sum of squares S with ν degrees of freedom tells the noise g·σ²,
//! too: the likelihood is that of means and replicates together.
//!
//! Forecasts decide which runs are made, so their bits are to be the same on every processor. Factors and what is solved with them are
//! sums in one order in nalgebra; products of two matrices are not, for they use what the processor has, and are dot products here.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::averages::Averages;
use super::kernel::{self, Axis};
use super::{Hyperparameters, Trend};

/// Logarithm of 2π.
const LOG_TWO_PI: f64 = 1.837_877_066_409_345_3;

/// The equations of a process, solved.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    /// L of C = LLᵀ: what is nearly known loses fewer digits by it than by C⁻¹.
    pub factor: Cholesky<f64, Dyn>,
    /// C⁻¹F.
    pub inverse_trend: DMatrix<f64>,
    /// (FᵀC⁻¹F)⁻¹.
    pub trend_inverse: DMatrix<f64>,
    /// β.
    pub coefficients: DVector<f64>,
    /// C⁻¹(y − Fβ).
    pub weights: DVector<f64>,
    /// σ².
    pub variance: f64,
    /// Logarithm of the likelihood, of the means and of what replicates leave, with its constants.
    pub log_likelihood: f64,
}

impl Solved {
    /// Solves the equations; none where lengths and noise leave C without an inverse in floating point.
    pub fn new(axes: &[Axis], trend: Trend, averages: &Averages, hyperparameters: &Hyperparameters) -> Option<Self> {
        let correlation = correlation(axes, &averages.points, &averages.weights, hyperparameters);
        let factor = Cholesky::new(correlation)?;
        let log_determinant = 2.0 * factor.l_dirty().diagonal().map(libm::log).sum();
        let basis = trend.matrix(axes, &averages.points);
        let means = DVector::from_column_slice(&averages.means);
        let inverse_trend = factor.solve(&basis);
        let trend_factor = Cholesky::new(basis.tr_mul(&inverse_trend))?;
        let coefficients = trend_factor.solve(&inverse_trend.tr_mul(&means));
        let left = &means - &basis * &coefficients;
        let weights = factor.solve(&left);
        let (noise, freedom) = (hyperparameters.noise, averages.freedom as f64);
        let count = averages.means.len() as f64 + freedom;
        let of_replicates = if averages.freedom > 0 { averages.within / noise } else { 0.0 };
        let variance = (left.dot(&weights) + of_replicates) / count;
        if variance.is_nan() || variance <= 0.0 {
            return None;
        }
        let log_noise = if averages.freedom > 0 { freedom * libm::log(noise) } else { 0.0 };
        let log_likelihood = -0.5 * (count * (LOG_TWO_PI + libm::log(variance) + 1.0) + log_determinant + log_noise);
        let solved = Self {
            factor,
            inverse_trend,
            trend_inverse: trend_factor.inverse(),
            coefficients,
            weights,
            variance,
            log_likelihood,
        };
        log_likelihood.is_finite().then_some(solved)
    }

    /// 1 − rᵀC⁻¹r for correlations r with the points: what a point leaves open, as a part of the variance.
    pub fn left_open(&self, known: &DVector<f64>) -> f64 {
        let half = self.factor.l_dirty().solve_lower_triangular(known);
        half.map_or(f64::NAN, |half| 1.0 - half.norm_squared())
    }

    /// Derivatives of the likelihood's logarithm by the logarithms of the lengths, and of the noise.
    pub fn gradient(&self, axes: &[Axis], averages: &Averages, hyperparameters: &Hyperparameters) -> Vec<f64> {
        let (points, lengths, noise) = (&averages.points, &hyperparameters.lengths, hyperparameters.noise);
        let mut gradient = vec![0.0; lengths.len() + 1];
        let inverse = self.factor.inverse();
        for (row, one) in points.iter().enumerate() {
            for (column, other) in points[..row].iter().enumerate() {
                let pull = self.weights[row] * self.weights[column] / self.variance - inverse[(row, column)];
                // Once for each of the two places that the pair has in C, times the half in front.
                let share = pull * kernel::between(axes, lengths, one, other);
                for at in 0..lengths.len() {
                    gradient[at] += share * kernel::slope(axes[at].distance(one[at], other[at]) / lengths[at]);
                }
            }
            let pull = self.weights[row] * self.weights[row] / self.variance - inverse[(row, row)];
            gradient[lengths.len()] += 0.5 * noise * averages.weights[row] * pull;
        }
        if averages.freedom > 0 {
            let of_replicates = averages.within / (noise * self.variance) - averages.freedom as f64;
            gradient[lengths.len()] += 0.5 * of_replicates;
        }
        gradient
    }
}

/// The lower triangle of C: correlations, with the noise of each mean on the diagonal.
fn correlation(axes: &[Axis], points: &[Vec<f64>], weights: &[f64], hyperparameters: &Hyperparameters) -> DMatrix<f64> {
    let count = points.len();
    let mut correlation = DMatrix::zeros(count, count);
    // The rest is not looked at by what factors it.
    for column in 0..count {
        for row in column..count {
            correlation[(row, column)] = if row == column {
                1.0 + hyperparameters.noise * weights[row]
            } else {
                kernel::between(axes, &hyperparameters.lengths, &points[row], &points[column])
            };
        }
    }
    correlation
}

impl Trend {
    /// What the trend has at a point: 1, and with a linear one the numbers.
    pub(super) fn row(self, axes: &[Axis], point: &[f64]) -> Vec<f64> {
        let numbers = axes.iter().zip(point).filter(|(axis, _)| self == Self::Linear && **axis == Axis::Number);
        std::iter::once(1.0).chain(numbers.map(|(_, coordinate)| *coordinate)).collect()
    }

    /// Number of coefficients.
    pub(super) fn coefficients(self, axes: &[Axis]) -> usize {
        match self {
            Self::Constant => 1,
            Self::Linear => 1 + axes.iter().filter(|axis| **axis == Axis::Number).count(),
        }
    }

    /// F: a row for each point.
    fn matrix(self, axes: &[Axis], points: &[Vec<f64>]) -> DMatrix<f64> {
        let rows: Vec<f64> = points.iter().flat_map(|point| self.row(axes, point)).collect();
        DMatrix::from_row_slice(points.len(), self.coefficients(axes), &rows)
    }
}
