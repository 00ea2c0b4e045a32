//! From runs to one mean for each point, with what is known of its error.
//!
//! Replicates are made with the same seeds at all points, so a run is taken to be its point's mean, what its seeds add
//! everywhere, and chance: y = m + b + e. The means and the seeds' shares are those of least squares; what is left tells the
//! chance, and how the seeds' shares scatter tells what other seeds would have changed everywhere.

use std::collections::{BTreeMap, BTreeSet};

use super::GaussianProcessError;
use super::inputs::Inputs;
use crate::effects::{EffectsError, Observation};
use crate::shuffle::shuffle;

/// Responses beyond this have no squares.
const LARGEST_RESPONSE: f64 = 1e150;
/// Turns of the adjustment of means to seeds and of seeds to means, for runs of which some are missing.
const MOST_TURNS: usize = 1000;

/// The means of points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Averages {
    /// Coordinates, point by point.
    pub points: Vec<Vec<f64>>,
    /// Means over the seeds, less `offset`.
    pub means: Vec<f64>,
    /// What was subtracted from all means, to lose no digits.
    pub offset: f64,
    /// One over the number of runs of each point.
    pub weights: Vec<f64>,
    /// Sum of squares that means and seeds leave.
    pub within: f64,
    /// Its degrees of freedom; 0 without replicates.
    pub freedom: usize,
    /// Number of sets of seeds.
    pub seeds: usize,
    /// Mean square of the seeds' shares; 0 with a single set.
    pub of_seeds: f64,
}

impl Averages {
    /// Those of all runs that have a response, each run once.
    pub fn new(inputs: &mut Inputs, observations: &[Observation]) -> Result<Self, GaussianProcessError> {
        let mut known: BTreeSet<usize> = BTreeSet::new();
        let mut places: BTreeMap<Vec<i64>, usize> = BTreeMap::new();
        let mut seeds: BTreeMap<usize, usize> = BTreeMap::new();
        let mut points = Vec::new();
        let mut runs: Vec<(usize, usize, f64)> = Vec::new();
        for (index, each) in observations.iter().enumerate() {
            if !known.insert(each.run) || each.response.is_nan() {
                continue;
            }
            if each.response.abs() > LARGEST_RESPONSE {
                return Err(EffectsError::Response { observation: index, value: each.response }.into());
            }
            let point = inputs.observe(&each.settings)?;
            // Coordinates that differ by rounding only are the same.
            let key = point.iter().map(|coordinate| (coordinate * 1e9).round() as i64).collect();
            let place = *places.entry(key).or_insert(points.len());
            if place == points.len() {
                points.push(point);
            }
            let next = seeds.len();
            runs.push((place, *seeds.entry(each.replicate).or_insert(next), each.response));
        }
        let responses = || runs.iter().map(|(.., response)| *response);
        let (low, high) = (responses().fold(f64::INFINITY, f64::min), responses().fold(f64::NEG_INFINITY, f64::max));
        if runs.is_empty() {
            return Err(EffectsError::Empty { missing: observations.len() }.into());
        }
        if high - low <= 16.0 * f64::EPSILON * low.abs().max(high.abs()) {
            return Err(EffectsError::Constant { value: low, observations: runs.len() }.into());
        }
        let offset = responses().sum::<f64>() / runs.len() as f64;
        runs.iter_mut().for_each(|(.., response)| *response -= offset);
        Ok(Self::of(points, seeds.len(), &runs, offset))
    }

    /// So many of the points, drawn by lot, the same every time; what replicates tell of the noise stays.
    pub fn drawn(&self, count: usize) -> Self {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        shuffle(&mut order, 0);
        order.truncate(count);
        order.sort_unstable();
        let values = |all: &[f64]| order.iter().map(|at| all[*at]).collect();
        Self {
            points: order.iter().map(|at| self.points[*at].clone()).collect(),
            means: values(&self.means),
            weights: values(&self.weights),
            ..*self
        }
    }

    /// Those of runs, each a point, a set of seeds and a response.
    fn of(points: Vec<Vec<f64>>, seeds: usize, runs: &[(usize, usize, f64)], offset: f64) -> Self {
        let counts = |size: usize, which: fn(&(usize, usize, f64)) -> usize| {
            let mut counts = vec![0.0_f64; size];
            runs.iter().for_each(|run| counts[which(run)] += 1.0);
            counts
        };
        let (at_point, of_seed) = (counts(points.len(), |run| run.0), counts(seeds, |run| run.1));
        let (mut means, mut shares) = (vec![0.0; points.len()], vec![0.0; seeds]);
        for _ in 0..MOST_TURNS {
            let mut sums = vec![0.0; points.len()];
            runs.iter().for_each(|(point, seed, response)| sums[*point] += response - shares[*seed]);
            means = sums.iter().zip(&at_point).map(|(sum, count)| sum / count).collect();
            let mut sums = vec![0.0; seeds];
            runs.iter().for_each(|(point, seed, response)| sums[*seed] += response - means[*point]);
            let mut next: Vec<f64> = sums.iter().zip(&of_seed).map(|(sum, count)| sum / count).collect();
            let middle = next.iter().sum::<f64>() / seeds as f64;
            next.iter_mut().for_each(|share| *share -= middle);
            let change = next.iter().zip(&shares).map(|(next, before)| (next - before).abs()).fold(0.0, f64::max);
            let size = runs.iter().map(|(.., response)| response.abs()).fold(0.0, f64::max);
            shares = next;
            if change <= 1e-15 * size {
                break;
            }
        }
        let left = |(point, seed, response): &(usize, usize, f64)| response - means[*point] - shares[*seed];
        let freedom = (runs.len() + 1).saturating_sub(points.len() + seeds);
        let within = if freedom > 0 { runs.iter().map(|run| left(run) * left(run)).sum() } else { 0.0 };
        let of_seeds =
            if seeds > 1 { shares.iter().map(|share| share * share).sum::<f64>() / (seeds - 1) as f64 } else { 0.0 };
        let weights = at_point.iter().map(|count| 1.0 / count).collect();
        Self { points, means, offset, weights, within, freedom, seeds, of_seeds }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_seeds_and_chance_by_hand() {
        // Two points, three seeds: means 2 and 5, seeds −1, 0, 1, and chance of ±0.5 in the first two seeds.
        let rows = [[1.5, 1.5, 3.0], [3.5, 5.5, 6.0]];
        let runs: Vec<(usize, usize, f64)> = (0..6).map(|run| (run / 3, run % 3, rows[run / 3][run % 3])).collect();
        let averages = Averages::of(vec![vec![0.0], vec![1.0]], 3, &runs, 0.0);
        assert!((averages.means[0] - 2.0).abs() < 1e-12 && (averages.means[1] - 5.0).abs() < 1e-12);
        // Shares: means over the points less 3.5: −1, 0, 1. Left: ±0.5, four times.
        assert!((averages.of_seeds - 1.0).abs() < 1e-12);
        assert!((averages.within - 1.0).abs() < 1e-12 && averages.freedom == 2);
        assert_eq!(averages.weights, [1.0 / 3.0; 2]);
    }

    #[test]
    fn a_run_that_is_missing_does_not_shift_its_point() {
        // y = m + b exactly, so that the means come out whatever is missing: 10, 20, 40 and −3, 0, 3.
        let value = |point: usize, seed: usize| [10.0, 20.0, 40.0][point] + [-3.0, 0.0, 3.0][seed];
        let runs: Vec<(usize, usize, f64)> = (0..9)
            .filter(|run| *run != 2 && *run != 3)
            .map(|run| (run / 3, run % 3, value(run / 3, run % 3)))
            .collect();
        let averages = Averages::of((0..3).map(|at| vec![f64::from(at)]).collect(), 3, &runs, 0.0);
        for (mean, expected) in averages.means.iter().zip([10.0, 20.0, 40.0]) {
            assert!((mean - expected).abs() < 1e-9, "{averages:?}");
        }
        assert!(averages.within < 1e-18 && averages.freedom == 2);
        assert!((averages.of_seeds - 9.0).abs() < 1e-9);
    }
}
