//! What it costs a forecast that lengths and noise are not known: the forecasts of many sets of them, each as likely as it is.
//!
//! The most likely lengths are one set among others that are hardly less likely, and with few points most of these forecast
//! something else. Here β and σ² are integrated out (with a prior of 1/σ², which gives Student's t with n − p degrees of
//! freedom), and lengths and noise are drawn: one half from a normal distribution of their logarithms about the most likely place
//! (Laplace), for there most of the probability is, the other half from what is known beforehand, for other places may be likely,
//! too. Each is weighed by its posterior density over that with which it was drawn, and some are drawn by these weights. What the
//! sets' forecasts differ by from that of the most likely one adds to the variance. Points that the process misses by more than it
//! says when they are left out widen all intervals.
//!
//! M. C. Kennedy, A. O'Hagan, Bayesian calibration of computer models, J. R. Stat. Soc. B 63, 425–464 (2001),
//! doi:10.1111/1467-9868.00294; M. S. Handcock, M. L. Stein, A Bayesian analysis of kriging, Technometrics 35, 403–410 (1993),
//! doi:10.1080/00401706.1993.10485354.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use statrs::distribution::{ContinuousCDF, Normal as StandardNormal};

use super::averages::Averages;
use super::kernel::Axis;
use super::likelihood::{ENOUGH, ROUGHLY, ends, from_logs, to_logs};
use super::solved::Solved;
use super::{GaussianProcess, Hyperparameters, LeftOut, Trend};
use crate::design::{Factor, Kind, Setting, design};
use crate::quasi_newton::minimise;

/// Median of the lengths before anything is known, in coded units: a range is 2 long.
const LENGTH: f64 = 2.0;
/// Standard deviation of their logarithms: two thirds lie within a factor of 2.7.
const LENGTH_SPREAD: f64 = 1.0;
/// The same of the noise of one run, as a part of the variance: hardly anything is known.
const NOISE: f64 = 1e-3;
const NOISE_SPREAD: f64 = 3.0;
/// Sets that are drawn at least and at most, and how many are so in between: as many as this many operations allow.
const DRAWN: [usize; 2] = [64, 512];
const OPERATIONS: f64 = 2e8;
/// Sets that are drawn with more than [`ENOUGH`] points, all about the most likely place: so many points leave no other likely.
const DRAWN_OF_MANY: usize = 20;
/// Sets that are kept.
const KEPT: usize = 48;
/// How much wider than the curvature says they are drawn.
const WIDER: f64 = 1.25;
/// Step of logarithms for second derivatives.
const STEP: f64 = 1e-3;
/// Where the gradient by logarithms is taken for nothing.
const TOLERANCE: f64 = 1e-5;

/// A set of lengths and noise that may be true.
#[derive(Debug, Clone)]
pub(super) struct Likely {
    /// Probability; those of all sets add up to 1.
    pub weight: f64,
    pub hyperparameters: Hyperparameters,
    pub solved: Solved,
}

impl GaussianProcess {
    /// The same process, whose forecasts have intervals that know how little lengths and noise are known; what is expected
    /// stays.
    #[must_use]
    pub fn with_likely_lengths(mut self) -> Self {
        self.likely = Search { axes: &self.inputs.axes, trend: self.trend, averages: &self.averages }
            .draw(&self.hyperparameters)
            .unwrap_or_default();
        self.calibration = self.promised_too_much().unwrap_or(1.0).max(1.0);
        self
    }

    /// Mean square of what the most likely process misses points by that it does not know, each as a multiple of the standard
    /// error that all sets together give it: more than 1 where the response is not what a Gaussian process is, such as steep at
    /// one end and flat elsewhere.
    fn promised_too_much(&self) -> Option<f64> {
        let unbiased = self.unbiased();
        let own = self.left_out();
        let others: Vec<_> = self.likely.iter().map(|likely| self.left_out_with(&likely.solved)).collect();
        let square = |(at, point): (usize, &LeftOut)| {
            let of = |(likely, other): (&Likely, &Vec<LeftOut>)| {
                likely.weight * (other[at].variance * unbiased + (other[at].forecast - point.forecast).powi(2))
            };
            let variance: f64 = self.likely.iter().zip(&others).map(of).sum();
            (point.observed - point.forecast).powi(2) / variance
        };
        let mean = own.iter().enumerate().map(square).sum::<f64>() / own.len() as f64;
        Some(mean).filter(|mean| mean.is_finite())
    }
}

/// What sets are drawn for.
struct Search<'a> {
    axes: &'a [Axis],
    trend: Trend,
    averages: &'a Averages,
}

impl Search<'_> {
    /// Sets near the most likely one; none where nothing can be drawn.
    fn draw(&self, most_likely: &Hyperparameters) -> Option<Vec<Likely>> {
        let (low, high) = ends(self.axes.len());
        let slope = |logs: &[f64]| {
            let hyperparameters = from_logs(logs);
            let solved = Solved::new(self.axes, self.trend, self.averages, &hyperparameters)?;
            let gradient = solved.gradient(self.axes, self.averages, &hyperparameters);
            let (prior, by_prior) = self.prior(logs);
            let gradient = gradient.iter().zip(by_prior).map(|(own, prior)| -own - prior).collect();
            Some((-solved.log_likelihood - prior, gradient))
        };
        let points = self.averages.points.len();
        let are_many = points > ENOUGH;
        let tolerance = if are_many { ROUGHLY } else { TOLERANCE };
        let best = minimise(slope, &to_logs(most_likely), &low, &high, tolerance)?;
        let root = self.root(&best.place, |logs| slope(logs).map(|(_, gradient)| gradient))?;
        let near = Normal { middle: best.place, root: WIDER * root };
        let before =
            Normal { middle: self.middles(), root: DMatrix::from_diagonal(&DVector::from_vec(self.spreads())) };
        let count = ((OPERATIONS / (points as f64).powi(3)) as usize).clamp(DRAWN[0], DRAWN[1]);
        let count = if are_many { DRAWN_OF_MANY } else { count };
        let mut drawn: Vec<(f64, Likely)> = Vec::new();
        for (number, deviates) in deviates(low.len(), count).into_iter().enumerate() {
            // Halves of the sequence are spread evenly; every other point of it would not be.
            let from = if are_many || 2 * number < count { &near } else { &before };
            let logs = from.at(deviates);
            if logs.iter().zip(low.iter().zip(&high)).any(|(log, (low, high))| !(low..=high).contains(&log)) {
                continue;
            }
            let hyperparameters = from_logs(&logs);
            let Some(solved) = Solved::new(self.axes, self.trend, self.averages, &hyperparameters) else { continue };
            let [one, other] = [near.log_density(&logs)?, before.log_density(&logs)?];
            let of_both = one.max(other) + libm::log1p(libm::exp(-(one - other).abs()));
            let density = if are_many { one } else { of_both };
            let log = self.marginal(&solved) + self.prior(&logs).0 - density;
            drawn.push((log, Likely { weight: 1.0, hyperparameters, solved }));
        }
        Some(chosen(drawn))
    }

    /// What is known beforehand of the logarithms: their medians.
    fn middles(&self) -> Vec<f64> {
        std::iter::repeat_n(libm::log(LENGTH), self.axes.len()).chain([libm::log(NOISE)]).collect()
    }

    /// The same: their standard deviations.
    fn spreads(&self) -> Vec<f64> {
        std::iter::repeat_n(LENGTH_SPREAD, self.axes.len()).chain([NOISE_SPREAD]).collect()
    }

    /// Logarithm of the prior density, but for a constant, and its derivatives.
    fn prior(&self, logs: &[f64]) -> (f64, Vec<f64>) {
        let all = logs.iter().zip(self.middles().into_iter().zip(self.spreads())).map(|(log, (middle, spread))| {
            let away = (log - middle) / spread;
            (-0.5 * away * away, -away / spread)
        });
        let all: Vec<(f64, f64)> = all.collect();
        (all.iter().map(|(value, _)| value).sum(), all.into_iter().map(|(_, slope)| slope).collect())
    }

    /// Logarithm of the likelihood with β and σ² integrated out, but for a constant: with β known to σ²G the profile's
    /// −n/2 ln σ² becomes −(n − p)/2 ln σ² + ½ ln |G|.
    fn marginal(&self, solved: &Solved) -> f64 {
        let coefficients = self.trend.coefficients(self.axes) as f64;
        let of_trend = libm::log(solved.trend_inverse.determinant());
        solved.log_likelihood + 0.5 * coefficients * libm::log(solved.variance) + 0.5 * of_trend
    }

    /// A root of the covariance of the logarithms, from the curvature where they are most likely. Where nothing is curved, that
    /// of the prior.
    fn root(&self, place: &[f64], gradient: impl Fn(&[f64]) -> Option<Vec<f64>>) -> Option<DMatrix<f64>> {
        let size = place.len();
        let mut curvature = DMatrix::zeros(size, size);
        for at in 0..size {
            let moved = |step: f64| {
                let mut place = place.to_vec();
                place[at] += step;
                gradient(&place)
            };
            let (up, down) = (moved(STEP)?, moved(-STEP)?);
            for other in 0..size {
                curvature[(at, other)] = (up[other] - down[other]) / (2.0 * STEP);
            }
        }
        let scale = self.spreads();
        let scaled = DMatrix::from_fn(size, size, |row, column| {
            0.5 * (curvature[(row, column)] + curvature[(column, row)]) * scale[row] * scale[column]
        });
        let eigen = SymmetricEigen::new(scaled);
        let roots = eigen.eigenvalues.map(|value| 1.0 / value.max(1.0).sqrt());
        let scales = DMatrix::from_diagonal(&DVector::from_vec(scale));
        Some(scales * &eigen.eigenvectors * DMatrix::from_diagonal(&roots))
    }
}

/// A normal distribution of logarithms.
struct Normal {
    middle: Vec<f64>,
    /// A root of its covariance.
    root: DMatrix<f64>,
}

impl Normal {
    fn at(&self, deviates: Vec<f64>) -> Vec<f64> {
        let moved = &self.root * DVector::from_vec(deviates);
        self.middle.iter().zip(moved.iter()).map(|(middle, by)| middle + by).collect()
    }

    /// Logarithm of the density, but for a constant of the dimension.
    fn log_density(&self, logs: &[f64]) -> Option<f64> {
        let away = DVector::from_iterator(logs.len(), logs.iter().zip(&self.middle).map(|(log, middle)| log - middle));
        let decomposed = self.root.clone().lu();
        let deviates = decomposed.solve(&away)?;
        Some(-0.5 * deviates.norm_squared() - libm::log(decomposed.determinant().abs()))
    }
}

/// So many normal deviates of this dimension, spread evenly, the same every time.
fn deviates(dimension: usize, count: usize) -> Vec<Vec<f64>> {
    let Ok(spread) = design(&Kind::Sobol { points: count + 1 }, &vec![Factor::Range; dimension]) else {
        return Vec::new();
    };
    let deviate = |setting: &Setting| {
        let Setting::Coded(coded) = setting else { return 0.0 };
        StandardNormal::standard().inverse_cdf((0.5 * (coded + 1.0)).clamp(1e-9, 1.0 - 1e-9))
    };
    // The first point is at all lower ends.
    (1..spread.points()).map(|point| spread.point(point).iter().map(deviate).collect()).collect()
}

/// Some of the sets, by their weights, whose logarithms they come with: systematic drawing, each as often as its weight says.
fn chosen(drawn: Vec<(f64, Likely)>) -> Vec<Likely> {
    let largest = drawn.iter().map(|(log, _)| *log).fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = drawn.iter().map(|(log, _)| libm::exp(log - largest)).sum();
    let mut kept = Vec::new();
    let mut before = 0.0;
    for (log, likely) in drawn {
        let after = before + libm::exp(log - largest) / total * KEPT as f64;
        let times = (after + 0.5).floor() - (before + 0.5_f64).floor();
        before = after;
        if times > 0.0 {
            kept.push(Likely { weight: times, ..likely });
        }
    }
    let sum: f64 = kept.iter().map(|likely: &Likely| likely.weight).sum();
    kept.iter_mut().for_each(|likely| likely.weight /= sum);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Factor as Analysed, FactorKind, Observation};
    use crate::surrogate::gaussian_process::Options;

    #[test]
    fn the_spread_over_lengths_is_that_of_the_whole_posterior() {
        // One factor and nine points, so that the posterior of length and noise can be summed on a grid.
        let factors = [Analysed { name: "a".into(), kind: FactorKind::Range { low: 0.0, high: 1.0 } }];
        let run = |run: usize| {
            let coded = run as f64 / 4.0 - 1.0;
            let response = libm::sin(2.5 * coded) + 0.03 * libm::cos(11.0 * run as f64);
            Observation { settings: vec![Setting::Coded(coded)], replicate: 0, run, response }
        };
        let observations: Vec<Observation> = (0..9).map(run).collect();
        let process = GaussianProcess::fit(&factors, &observations, &Options::default()).unwrap();
        let drawn = GaussianProcess { calibration: 1.0, ..process.clone().with_likely_lengths() };
        let search = Search { axes: &process.inputs.axes, trend: process.trend, averages: &process.averages };
        let (low, high) = ends(1);
        let mut grid = Vec::new();
        let count = 120;
        for at in 0..count * count {
            let part = [at % count, at / count].map(|place| (place as f64 + 0.5) / count as f64);
            let logs: Vec<f64> = (0..2).map(|axis| low[axis] + part[axis] * (high[axis] - low[axis])).collect();
            let hyperparameters = from_logs(&logs);
            let Some(solved) = Solved::new(search.axes, search.trend, search.averages, &hyperparameters) else {
                continue;
            };
            let log = search.marginal(&solved) + search.prior(&logs).0;
            grid.push((log, Likely { weight: 0.0, hyperparameters, solved }));
        }
        let largest = grid.iter().map(|(log, _)| *log).fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = grid.iter().map(|(log, _)| libm::exp(log - largest)).sum();
        let weighed = |(log, likely): (f64, Likely)| Likely { weight: libm::exp(log - largest) / total, ..likely };
        let whole = GaussianProcess { likely: grid.into_iter().map(weighed).collect(), ..process.clone() };
        for coded in [-0.83, 0.1, 0.5, 0.95] {
            let local = process.local_at(&[coded]);
            let [of_grid, of_drawn] = [&whole, &drawn].map(|process| process.variances(&[coded], &local));
            for (drawn, grid) in of_drawn.into_iter().zip(of_grid) {
                // Forty-eight sets, of some of which the variance is many times that of others: a fifth of the deviation.
                let ratio = drawn / grid;
                assert!((0.65..1.5).contains(&ratio), "{coded}: {drawn} is not {grid}");
            }
        }
    }
}
