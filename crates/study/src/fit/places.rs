//! Places in the ranges at which the likelihood is looked at: everywhere evenly, and near the most likely one.

use nalgebra::{DMatrix, SymmetricEigen};

use super::likelihood::Likelihood;
use crate::design::{Factor, Kind, Setting, design};
use crate::quasi_newton::minimise;

/// Places everywhere, for each key, and at most.
const EVERYWHERE: usize = 128;
const MOST_EVERYWHERE: usize = 1024;
/// Places near the most likely one.
const NEAR: usize = 128;
/// How far these reach, in standard deviations of the normal distribution that the likelihood is near there.
const REACH: f64 = 3.0;
/// Places from which the most likely one is searched.
const STARTS: usize = 8;
/// Where the gradient of −2 ln L by coded units is taken for nothing.
const TOLERANCE: f64 = 1e-5;

/// Places in coded units, each with −2 ln of the likelihood.
#[derive(Debug, Clone)]
pub(super) struct Places {
    pub all: Vec<(Vec<f64>, f64)>,
}

impl Places {
    /// Places everywhere.
    pub fn new(keys: usize, likelihood: &Likelihood) -> Self {
        let mut places = spread(keys, (EVERYWHERE * keys).min(MOST_EVERYWHERE));
        places.extend(likelihood.terms.first().map(|term| term.process.known_points().to_vec()).unwrap_or_default());
        Self { all: places.into_iter().map(|place| (likelihood.value(&place), place)).map(|(v, p)| (p, v)).collect() }
    }

    /// The most likely place, from the best of these, and −2 ln of the likelihood there.
    pub fn most_likely(&self, likelihood: &Likelihood) -> Option<(Vec<f64>, f64)> {
        let mut order: Vec<&(Vec<f64>, f64)> = self.all.iter().collect();
        order.sort_by(|one, other| one.1.total_cmp(&other.1));
        let found = order.iter().take(STARTS).filter_map(|(place, _)| {
            let ends = [vec![-1.0; place.len()], vec![1.0; place.len()]];
            minimise(|place| likelihood.slope(place), place, &ends[0], &ends[1], TOLERANCE)
        });
        let best = found.min_by(|one, other| one.value.total_cmp(&other.value))?;
        Some((best.place, best.value))
    }

    /// The same with places near the most likely one, along the axes of the likelihood's curvature there.
    pub fn with_near(mut self, best: &[f64], likelihood: &Likelihood) -> Self {
        let keys = best.len();
        let slopes = likelihood.weighted_slopes(best);
        // That the range is no wider than it is counts as a deviation of 1.
        let curvature = DMatrix::from_fn(keys, keys, |row, column| {
            let sum: f64 = slopes.iter().map(|slopes| slopes[row] * slopes[column]).sum();
            sum + if row == column { 1.0 } else { 0.0 }
        });
        let axes = SymmetricEigen::new(curvature);
        let near = spread(keys, NEAR).into_iter().map(|along| {
            let place = (0..keys).map(|at| {
                let steps =
                    (0..keys).map(|axis| along[axis] * axes.eigenvectors[(at, axis)] / axes.eigenvalues[axis].sqrt());
                (best[at] + REACH * steps.sum::<f64>()).clamp(-1.0, 1.0)
            });
            place.collect::<Vec<f64>>()
        });
        self.all.extend(near.map(|place| (likelihood.value(&place), place)).map(|(value, place)| (place, value)));
        self.all.push((best.to_vec(), likelihood.value(best)));
        self
    }
}

/// Points of Sobol's sequence between −1 and 1, without the first, which is a corner.
fn spread(keys: usize, points: usize) -> Vec<Vec<f64>> {
    let Ok(design) = design(&Kind::Sobol { points: points + 1 }, &vec![Factor::Range; keys]) else { return Vec::new() };
    let coded = |setting: &Setting| if let Setting::Coded(coded) = setting { *coded } else { 0.0 };
    (1..design.points()).map(|point| design.point(point).iter().map(coded).collect()).collect()
}
