//! A Gaussian process: a response that is smooth in the factors, without a formula for it.
//!
//! The response is a trend plus a Gaussian process with Matérn's correlation of ν = 5/2 and a length for each factor; the
//! correlation of two points is the product over the factors. Levels that are categories are alike or not: two different
//! levels of a factor have one correlation, which is fitted like a length. Each run has noise besides, what its seeds do:
//! replicates tell it, and without replicates the likelihood does. Lengths and noise are the most likely ones.
//!
//! C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (MIT Press, 2006); O. Roustant, D. Ginsbourger, Y.
//! Deville, DiceKriging, J. Stat. Softw. 51(1) (2012), doi:10.18637/jss.v051.i01.
//!
//! | what | where |
//! |---|---|
//! | settings as coordinates | `inputs` |
//! | from runs to a mean for each point, with its noise | `averages` |
//! | the correlation | `kernel` |
//! | likelihood and equations with given lengths | `solved` |
//! | the most likely lengths | `likelihood` |
//! | what it costs that they are not known | `likely_lengths` |
//! | forecasts and their slopes | `prediction` |
//! | each point as the others forecast it | `leave_one_out` |

mod averages;
mod inputs;
mod kernel;
mod leave_one_out;
mod likelihood;
mod likely_lengths;
mod prediction;
mod refitted;
mod solved;

use std::sync::OnceLock;

use thiserror::Error;

use crate::effects::{EffectsError, Factor, Observation};
use averages::Averages;
use inputs::Inputs;
pub use leave_one_out::LeftOut;
use likely_lengths::Likely;
pub use prediction::Local;
use solved::Solved;

/// Most points: the equations of more take minutes.
pub const MOST_POINTS: usize = 1000;

/// Why there is no Gaussian process.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GaussianProcessError {
    /// The observations cannot be used.
    #[error(transparent)]
    Observations(#[from] EffectsError),
    /// Fewer points than tell a trend and a variance.
    #[error("{points} different points have a response: a Gaussian process needs at least {least}")]
    TooFew {
        /// Points that have a response.
        points: usize,
        /// How many are needed.
        least: usize,
    },
    /// More points than equations can be solved for.
    #[error("{points} different points have a response: a Gaussian process takes at most {MOST_POINTS}")]
    TooMany {
        /// Points that have a response.
        points: usize,
    },
    /// The equations have no solution in floating point.
    #[error("the equations of the Gaussian process have no solution: the trend cannot be told from these points")]
    Singular,
}

/// What the process deviates from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trend {
    /// A constant (ordinary kriging).
    #[default]
    Constant,
    /// A constant and a slope for each number (universal kriging).
    Linear,
}

/// Lengths and noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Hyperparameters {
    /// Length of each factor in coded units; that of categories stands for the correlation of different levels.
    pub lengths: Vec<f64>,
    /// Variance of the noise of one run, as a part of the variance of the process.
    pub noise: f64,
}

/// How the process is fitted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// What it deviates from.
    pub trend: Trend,
    /// Lengths and noise, taken as they are; the most likely ones unless given.
    pub fixed: Option<Hyperparameters>,
    /// Where the most likely ones are looked for alone, such as those of fewer runs; everywhere unless given.
    pub near: Option<Hyperparameters>,
}

/// A Gaussian process that was fitted to the runs of a study.
#[derive(Debug, Clone)]
pub struct GaussianProcess {
    inputs: Inputs,
    trend: Trend,
    averages: Averages,
    hyperparameters: Hyperparameters,
    solved: Solved,
    /// Sets of lengths and noise that may be true; empty where the most likely one is taken for certain.
    likely: Vec<Likely>,
    /// How many times as large variances are as the process says, for it to be no more certain than its leave-one-out errors.
    calibration: f64,
    /// What [`GaussianProcess::left_out_refitted`] gives, once it was asked for.
    refitted: OnceLock<Vec<LeftOut>>,
}

impl GaussianProcess {
    /// Fits a process. Runs that are observed twice count once, runs without a response (NaN) are left out.
    ///
    /// # Errors
    /// [`GaussianProcessError`].
    pub fn fit(
        factors: &[Factor],
        observations: &[Observation],
        options: &Options,
    ) -> Result<Self, GaussianProcessError> {
        let mut inputs = Inputs::new(factors);
        let averages = Averages::new(&mut inputs, observations)?;
        let (points, least) = (averages.points.len(), options.trend.coefficients(&inputs.axes) + 2);
        if points < least {
            return Err(GaussianProcessError::TooFew { points, least });
        }
        if points > MOST_POINTS {
            return Err(GaussianProcessError::TooMany { points });
        }
        let (axes, trend) = (&inputs.axes, options.trend);
        let fitted = match &options.fixed {
            Some(fixed) => Solved::new(axes, trend, &averages, fixed).map(|solved| (fixed.clone(), solved)),
            None => likelihood::most_likely(axes, trend, &averages, options.near.as_ref()),
        };
        let (hyperparameters, solved) = fitted.ok_or(GaussianProcessError::Singular)?;
        Ok(Self {
            inputs,
            trend,
            averages,
            hyperparameters,
            solved,
            likely: Vec::new(),
            calibration: 1.0,
            refitted: OnceLock::new(),
        })
    }

    /// The same process with one more point whose mean is as it is forecast, from so many runs: its variance is then what it
    /// will be when these runs are made. None where the equations have no solution.
    pub(crate) fn with_point(&self, point: &[f64], runs: usize) -> Option<Self> {
        let mut averages = self.averages.clone();
        averages.means.push(self.local_at(point).mean - averages.offset);
        averages.points.push(point.to_vec());
        averages.weights.push(1.0 / runs as f64);
        let mut solved = Solved::new(&self.inputs.axes, self.trend, &averages, &self.hyperparameters)?;
        // What was not observed tells nothing of σ².
        solved.variance = self.solved.variance;
        Some(Self { averages, solved, refitted: OnceLock::new(), ..self.clone() })
    }

    /// Lengths and noise.
    pub fn hyperparameters(&self) -> &Hyperparameters {
        &self.hyperparameters
    }

    /// Variance σ² of the process, the most likely one.
    pub fn process_variance(&self) -> f64 {
        self.solved.variance
    }

    /// Coefficients β of the trend: the constant, then the slopes in coded units.
    pub fn trend_coefficients(&self) -> Vec<f64> {
        let mut coefficients: Vec<f64> = self.solved.coefficients.iter().copied().collect();
        coefficients[0] += self.averages.offset;
        coefficients
    }

    /// Logarithm of the likelihood, of the points' means and of what replicates leave, in the unit of the response.
    pub fn log_likelihood(&self) -> f64 {
        self.solved.log_likelihood
    }

    /// Number of different points.
    pub fn points(&self) -> usize {
        self.averages.points.len()
    }

    /// Coded settings of the points, in the order in which they were first observed.
    pub(crate) fn known_points(&self) -> &[Vec<f64>] {
        &self.averages.points
    }

    /// Variance from run to run at one point that is not common to all points: noise.
    pub fn run_variance(&self) -> f64 {
        self.hyperparameters.noise * self.solved.variance
    }

    /// Variance of what the study's sets of seeds add at all points alike: more points do not lessen it, more seeds do. 0 with
    /// a single set, which does not tell it.
    pub fn seeds_variance(&self) -> f64 {
        self.averages.of_seeds / self.averages.seeds as f64
    }

    /// Standard deviation from seed to seed at one point, of both kinds; none without replicates.
    pub fn seed_deviation(&self) -> Option<f64> {
        (self.averages.freedom > 0).then(|| (self.run_variance() + self.averages.of_seeds).sqrt())
    }

    /// By how much the most likely σ², that of n, is less than the unbiased one, of n − p degrees of freedom.
    fn unbiased(&self) -> f64 {
        (self.averages.means.len() + self.averages.freedom) as f64 / self.freedom()
    }

    /// Degrees of freedom of σ².
    pub(crate) fn freedom(&self) -> f64 {
        let count = self.averages.means.len() + self.averages.freedom;
        (count - self.trend.coefficients(&self.inputs.axes)) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Setting;
    use crate::effects::FactorKind;
    use crate::surrogate::Surrogate;

    fn range(name: &str) -> Factor {
        Factor { name: name.into(), kind: FactorKind::Range { low: 0.0, high: 1.0 } }
    }

    fn observe(points: &[Vec<f64>], response: impl Fn(&[f64], usize) -> f64, seeds: usize) -> Vec<Observation> {
        let run = |at: usize| Observation {
            settings: points[at / seeds].iter().map(|coded| Setting::Coded(*coded)).collect(),
            replicate: at % seeds,
            run: at,
            response: response(&points[at / seeds], at % seeds),
        };
        (0..points.len() * seeds).map(run).collect()
    }

    fn grid() -> Vec<Vec<f64>> {
        (0..20).map(|at| vec![f64::from(at % 5) / 2.0 - 1.0, f64::from(at / 5) / 1.5 - 1.0]).collect()
    }

    #[test]
    fn slopes_of_the_likelihood_are_its_differences() {
        let observations =
            observe(&grid(), |x, seed| x[0] * x[0] + x[1] + 0.1 * libm::sin(9.0 * x[0] + seed as f64), 3);
        let mut inputs = Inputs::new(&[range("a"), range("b")]);
        let averages = Averages::new(&mut inputs, &observations).unwrap();
        let at = Hyperparameters { lengths: vec![0.8, 1.7], noise: 0.02 };
        let solve = |at: &Hyperparameters| Solved::new(&inputs.axes, Trend::Linear, &averages, at).unwrap();
        let gradient = solve(&at).gradient(&inputs.axes, &averages, &at);
        // Central differences: errors of step² and of rounding over step, together below 1e-6 of the value.
        for (which, expected) in gradient.iter().enumerate() {
            let moved = |step: f64| {
                let mut at = at.clone();
                let value = at.lengths.get_mut(which).unwrap_or(&mut at.noise);
                *value *= libm::exp(step);
                solve(&at).log_likelihood
            };
            let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((difference - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{which}: {difference} {expected}");
        }
    }

    #[test]
    fn slopes_of_a_forecast_are_its_differences() {
        let observations = observe(&grid(), |x, _| libm::sin(2.0 * x[0]) + x[1] * x[0], 1);
        for trend in [Trend::Constant, Trend::Linear] {
            let fixed = Hyperparameters { lengths: vec![0.9, 1.4], noise: 1e-4 };
            let options = Options { trend, fixed: Some(fixed), ..Options::default() };
            let process = GaussianProcess::fit(&[range("a"), range("b")], &observations, &options).unwrap();
            let place = [0.13, -0.41];
            let slopes = process.slopes_at(&place);
            for axis in 0..2 {
                let moved = |step: f64| {
                    let mut place = place;
                    place[axis] += step;
                    process.local_at(&place)
                };
                let (up, down) = (moved(1e-5), moved(-1e-5));
                let mean = (up.mean - down.mean) / 2e-5;
                let variance = (up.variance - down.variance) / 2e-5;
                assert!((mean - slopes.mean[axis]).abs() < 1e-7, "{mean} {slopes:?}");
                assert!((variance - slopes.variance[axis]).abs() < 1e-7, "{variance} {slopes:?}");
            }
        }
    }

    #[test]
    fn runs_are_met_where_there_is_no_noise() {
        let observations = observe(&grid(), |x, _| libm::exp(x[0]) + x[1] * x[0], 1);
        let factors = [range("a"), range("b")];
        let process = GaussianProcess::fit(&factors, &observations, &Options::default()).unwrap();
        for each in &observations {
            let forecast = process.forecast(&each.settings, 0.95).unwrap();
            // What noise is left, the least that keeps the equations solvable, is a few times its deviation at most.
            let noise = process.run_variance().sqrt();
            let away = (forecast.value - each.response).abs();
            assert!(away < 3.0 * noise && noise < 1e-2, "{forecast:?} {each:?} {noise}");
        }
        // Between them it is near the function, by definition of smooth: the largest error of a tensor of splines with
        // these knots is some 0.01.
        let between = process.local(&[Setting::Coded(0.25), Setting::Coded(0.0)]).unwrap();
        assert!((between.mean - libm::exp(0.25)).abs() < 0.01, "{between:?}");
    }

    #[test]
    fn one_more_point_lessens_the_variance_and_moves_nothing() {
        let observations = observe(&grid()[..12], |x, _| libm::sin(3.0 * x[0]) + x[1], 1);
        let factors = [range("a"), range("b")];
        let process = GaussianProcess::fit(&factors, &observations, &Options::default()).unwrap();
        let more = process.with_point(&[0.3, 0.9], 1).unwrap();
        let (before, after) = (process.local_at(&[0.35, 0.8]), more.local_at(&[0.35, 0.8]));
        assert!(after.variance < 0.5 * before.variance, "{before:?} {after:?}");
        assert!((after.mean - before.mean).abs() < 1e-6 * before.variance.sqrt().max(1e-3));
    }

    #[test]
    fn what_cannot_be_fitted_is_refused() {
        let factors = [range("a")];
        let few = observe(&[vec![-1.0], vec![1.0]], |x, _| x[0], 2);
        let error = GaussianProcess::fit(&factors, &few, &Options::default()).unwrap_err();
        assert_eq!(error, GaussianProcessError::TooFew { points: 2, least: 3 });
        let same = observe(&[vec![-1.0], vec![0.0], vec![1.0]], |_, _| 3.0, 1);
        let error = GaussianProcess::fit(&factors, &same, &Options::default()).unwrap_err();
        assert!(matches!(error, GaussianProcessError::Observations(EffectsError::Constant { .. })));
        let none = observe(&[vec![-1.0]], |_, _| f64::NAN, 1);
        let error = GaussianProcess::fit(&factors, &none, &Options::default()).unwrap_err();
        assert!(matches!(error, GaussianProcessError::Observations(EffectsError::Empty { missing: 1 })));
    }
}
