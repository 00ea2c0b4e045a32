//! The most likely lengths and noise.

use super::averages::Averages;
use super::kernel::Axis;
use super::solved::Solved;
use super::{Hyperparameters, Trend};
use crate::design::{Factor, Kind, Setting, design};
use crate::quasi_newton::minimise;

/// Lengths between which the likely ones are looked for, in coded units: a range is 2 long.
const LENGTHS: [f64; 2] = [0.05, 40.0];
/// The same for where the search begins.
const STARTING_LENGTHS: [f64; 2] = [0.3, 10.0];
/// Noise of one run, as a part of the variance. The least one keeps the equations solvable.
const NOISES: [f64; 2] = [1e-8, 1e2];
const STARTING_NOISES: [f64; 2] = [1e-6, 0.3];
/// Places that are looked at before the search, for each parameter.
const LOOKED_AT: usize = 8;
/// How many of them it begins from.
const STARTS: usize = 4;
/// Where the gradient by logarithms is taken for nothing.
const TOLERANCE: f64 = 1e-6;

/// The most likely lengths and noise, and the equations solved with them; none where no start has a likelihood.
///
/// The search is local, from the best of a grid that fills the box evenly, and from `near` where something is known of the
/// answer; it is the same for the same data.
pub(super) fn most_likely(
    axes: &[Axis],
    trend: Trend,
    averages: &Averages,
    near: Option<&Hyperparameters>,
) -> Option<(Hyperparameters, Solved)> {
    let solve = |logs: &[f64]| {
        let hyperparameters = from_logs(logs);
        let solved = Solved::new(axes, trend, averages, &hyperparameters)?;
        Some((hyperparameters, solved))
    };
    let slope = |logs: &[f64]| {
        let (hyperparameters, solved) = solve(logs)?;
        let gradient = solved.gradient(axes, averages, &hyperparameters);
        Some((-solved.log_likelihood, gradient.into_iter().map(|value| -value).collect()))
    };
    let (low, high) = ends(axes.len());
    let starts = match near {
        Some(near) => vec![to_logs(near)],
        None => {
            let value = |logs: &Vec<f64>| solve(logs).map(|(_, solved)| solved.log_likelihood);
            let mut places: Vec<(f64, Vec<f64>)> =
                places(axes.len()).into_iter().filter_map(|place| Some((value(&place)?, place))).collect();
            places.sort_by(|one, other| other.0.total_cmp(&one.0));
            places.into_iter().take(STARTS).map(|(_, place)| place).collect()
        }
    };
    let found = starts.iter().filter_map(|start| minimise(slope, start, &low, &high, TOLERANCE));
    let best = found.min_by(|one, other| one.value.total_cmp(&other.value))?;
    solve(&best.place)
}

/// The ends of the box in which lengths and noise are looked for, as logarithms.
pub(super) fn ends(axes: usize) -> (Vec<f64>, Vec<f64>) {
    let end = |end: usize| std::iter::repeat_n(libm::log(LENGTHS[end]), axes).chain([libm::log(NOISES[end])]).collect();
    (end(0), end(1))
}

/// Places in the box where the search begins, spread evenly, as logarithms.
fn places(axes: usize) -> Vec<Vec<f64>> {
    let factors = vec![Factor::Range; axes + 1];
    let Ok(spread) = design(&Kind::Sobol { points: LOOKED_AT * (axes + 1) }, &factors) else {
        // More axes than the sequence has: one place in the middle.
        return vec![vec![0.0; axes].into_iter().chain([libm::log(1e-3)]).collect()];
    };
    let within = |[low, high]: [f64; 2], setting: Setting| {
        let Setting::Coded(coded) = setting else { return libm::log(low) };
        libm::log(low) + 0.5 * (coded + 1.0) * (libm::log(high) - libm::log(low))
    };
    // The first point is at all lower ends: correlations so short tell nothing.
    let points = (1..spread.points()).map(|point| {
        let settings = spread.point(point).iter().enumerate();
        let box_of = |at: usize| if at < axes { STARTING_LENGTHS } else { STARTING_NOISES };
        settings.map(|(at, setting)| within(box_of(at), *setting)).collect()
    });
    points.collect()
}

pub(super) fn from_logs(logs: &[f64]) -> Hyperparameters {
    let (lengths, noise) = logs.split_at(logs.len() - 1);
    Hyperparameters { lengths: lengths.iter().map(|log| libm::exp(*log)).collect(), noise: libm::exp(noise[0]) }
}

pub(super) fn to_logs(hyperparameters: &Hyperparameters) -> Vec<f64> {
    hyperparameters.lengths.iter().chain([&hyperparameters.noise]).map(|value| libm::log(*value)).collect()
}
