//! What a Gaussian process expects where no run was made, and how that changes from place to place.

use nalgebra::DVector;

use super::GaussianProcess;
use super::kernel::{self, Axis};
use super::solved::Solved;
use crate::design::Setting;
use crate::effects::{EffectsError, t_quantile};
use crate::surrogate::{Forecast, Surrogate};

/// Mean and variance of the response at a point, of the mean over the seeds of the study.
#[derive(Debug, Clone, PartialEq)]
pub struct Local {
    /// What is expected.
    pub mean: f64,
    /// How far off that may be: the variance of the process there, with that of its trend (universal kriging).
    pub variance: f64,
}

/// The same with the derivatives by the coded settings.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Slopes {
    pub local: Local,
    pub mean: Vec<f64>,
    pub variance: Vec<f64>,
}

impl GaussianProcess {
    /// Mean and variance at settings, numbers in coded units.
    ///
    /// # Errors
    /// If the settings do not fit the factors, or a category was never observed.
    pub fn local(&self, settings: &[Setting]) -> Result<Local, EffectsError> {
        Ok(self.local_at(&self.inputs.point(settings)?))
    }

    /// The same of coordinates.
    pub(crate) fn local_at(&self, point: &[f64]) -> Local {
        self.local_with(&self.solved, point, &self.correlations(point)).0
    }

    /// The same with derivatives; those by categories are 0.
    pub(crate) fn slopes_at(&self, point: &[f64]) -> Slopes {
        let known = self.correlations(point);
        let solved = self.solved.factor.solve(&known);
        let (local, of_trend) = self.local_with(&self.solved, point, &known);
        // The variance is σ²(1 − rᵀc + hᵀGh) with c = C⁻¹r, h = f − Fᵀc and G = (FᵀC⁻¹F)⁻¹.
        let pull = &self.solved.inverse_trend * &of_trend;
        let (axes, lengths) = (&self.inputs.axes, &self.hyperparameters.lengths);
        let (mut mean, mut variance) = (vec![0.0; point.len()], vec![0.0; point.len()]);
        let mut number = 0;
        for (at, axis) in axes.iter().enumerate().filter(|(_, axis)| **axis == Axis::Number) {
            for (run, other) in self.averages.points.iter().enumerate() {
                let change = known[run] * kernel::log_derivative(lengths[at], point[at], other[at]);
                mean[at] += change * self.solved.weights[run];
                variance[at] -= 2.0 * change * (solved[run] + pull[run]);
            }
            number += 1;
            if self.trend == super::Trend::Linear && *axis == Axis::Number {
                mean[at] += self.solved.coefficients[number];
                variance[at] += 2.0 * of_trend[number];
            }
            variance[at] *= self.solved.variance;
        }
        Slopes { local, mean, variance }
    }

    /// Mean and variance, and Gh, with these equations.
    fn local_with(&self, with: &Solved, point: &[f64], known: &DVector<f64>) -> (Local, DVector<f64>) {
        let row = DVector::from_vec(self.trend.row(&self.inputs.axes, point));
        let mean = self.averages.offset + row.dot(&with.coefficients) + known.dot(&with.weights);
        let left = &row - with.inverse_trend.transpose() * known;
        let of_trend = &with.trend_inverse * &left;
        // Rounding may leave less than nothing at a point that was run.
        let share = (with.left_open(known) + left.dot(&of_trend)).max(0.0);
        (Local { mean, variance: with.variance * share }, of_trend)
    }

    /// Variances of the mean over the seeds of the study at a point, and of one more run with them: of what is expected with
    /// the most likely lengths, averaged over all lengths that may be true.
    pub(super) fn variances(&self, point: &[f64], local: &Local) -> [f64; 2] {
        let unbiased = self.unbiased();
        if self.likely.is_empty() {
            let of_mean = local.variance * unbiased;
            return [of_mean, of_mean + self.run_variance() * unbiased];
        }
        let (mut of_mean, mut of_run) = (0.0, 0.0);
        for likely in &self.likely {
            let known = self.correlations_with(&likely.hyperparameters.lengths, point);
            let (other, _) = self.local_with(&likely.solved, point, &known);
            let apart = (other.mean - local.mean).powi(2);
            of_mean += likely.weight * (other.variance * unbiased + apart);
            of_run += likely.weight * likely.hyperparameters.noise * likely.solved.variance * unbiased;
        }
        let of_mean = self.calibration * of_mean;
        [of_mean, of_mean + of_run]
    }

    /// Correlations of a point with those that were run.
    fn correlations(&self, point: &[f64]) -> DVector<f64> {
        self.correlations_with(&self.hyperparameters.lengths, point)
    }

    /// The same with other lengths.
    fn correlations_with(&self, lengths: &[f64], point: &[f64]) -> DVector<f64> {
        let axes = &self.inputs.axes;
        let points = self.averages.points.iter();
        let known = points.map(|other| kernel::between(axes, lengths, point, other));
        DVector::from_iterator(self.averages.points.len(), known)
    }
}

impl Surrogate for GaussianProcess {
    fn name(&self) -> String {
        "Gaussian process".to_owned()
    }

    fn forecast(&self, settings: &[Setting], confidence: f64) -> Result<Forecast, EffectsError> {
        if !(confidence > 0.0 && confidence < 1.0) {
            return Err(EffectsError::Confidence(confidence));
        }
        let point = self.inputs.point(settings)?;
        let local = self.local_at(&point);
        let [of_mean, of_run] = self.variances(&point, &local);
        // Sets of seeds are few, so that their variance rests on few degrees of freedom: those of the sum are Satterthwaite's.
        let interval = |own: f64, of_seeds: f64| {
            let variance = own + of_seeds;
            let spread = own * own / self.freedom() + of_seeds * of_seeds / (self.averages.seeds.max(2) - 1) as f64;
            let freedom = if spread > 0.0 { variance * variance / spread } else { self.freedom() };
            let reach = t_quantile(1.0 - confidence, freedom) * variance.sqrt();
            Some([local.mean - reach, local.mean + reach]).filter(|[low, _]| low.is_finite())
        };
        let mean_interval = interval(of_mean, self.seeds_variance());
        let run_interval = interval(of_run, self.seeds_variance() + self.averages.of_seeds);
        Ok(Forecast { value: local.mean, mean_interval, run_interval })
    }

    fn leave_one_out_error(&self) -> Option<f64> {
        let left_out = self.left_out();
        let square = |point: &super::LeftOut| (point.observed - point.forecast).powi(2);
        let mean = left_out.iter().map(square).sum::<f64>() / left_out.len() as f64;
        Some(mean.sqrt()).filter(|error| error.is_finite())
    }
}
