//! The most likely lengths and noise.
//!
//! A likelihood often has two hills: a rough response without noise, and a smooth one with it. So the search begins from the best
//! places of both kinds, goes near the tops first, and follows those that are not the same to the end.

use super::averages::Averages;
use super::kernel::Axis;
use super::solved::Solved;
use super::{Hyperparameters, Trend};
use crate::design::{Factor, Kind, Setting, design};
use crate::quasi_newton::{Minimum, minimise};

/// Lengths between which the likely ones are looked for, in coded units: a range is 2 long.
const LENGTHS: [f64; 2] = [0.05, 40.0];
/// The same for where the search begins.
const STARTING_LENGTHS: [f64; 2] = [0.15, 15.0];
/// Noise of one run, as a part of the variance. The least one keeps the equations solvable.
const NOISES: [f64; 2] = [1e-8, 1e2];
const STARTING_NOISES: [f64; 2] = [1e-8, 1.0];
/// Noise above which a place is one of much noise.
const MUCH_NOISE: f64 = 1e-2;
/// Places that are looked at before the search, for each parameter: of few points, and of many, which have fewer hills and cost
/// more.
const LOOKED_AT: [usize; 2] = [24, 8];
/// From how many of them with little and with much noise it begins.
const STARTS: [usize; 2] = [6, 2];
/// Points up to which there are few.
const FEW: usize = 100;
/// How far starts are apart at least, and hills that are followed to their tops, as a part of the logarithms' box.
const APART: f64 = 0.15;
/// Where the gradient is small enough to tell hills apart.
const ROUGHLY: f64 = 0.01;
/// Where the gradient by logarithms is taken for nothing.
const TOLERANCE: f64 = 1e-6;

/// The most likely lengths and noise, and the equations solved with them; none where no start has a likelihood.
///
/// The searches are local, from the best of places that fill the box evenly, or from `near` alone where something is known of the
/// answer; they are the same for the same data.
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
    let search = |start: &[f64], tolerance: f64| minimise(slope, start, &low, &high, tolerance);
    let best = match near {
        Some(near) => search(&to_logs(near), TOLERANCE)?,
        None => {
            let many = usize::from(averages.points.len() > FEW);
            let value = |logs: &Vec<f64>| solve(logs).map(|(_, solved)| solved.log_likelihood);
            let spread = places(axes.len(), LOOKED_AT[many]).into_iter();
            let mut looked_at: Vec<(f64, Vec<f64>)> =
                spread.filter_map(|place| Some((value(&place)?, place))).collect();
            looked_at.sort_by(|one, other| other.0.total_cmp(&one.0));
            let starts = starts(&looked_at, STARTS[many]).into_iter();
            let near_tops = starts.filter_map(|start| search(start, ROUGHLY)).collect();
            let tops = distinct(near_tops).into_iter().filter_map(|near| search(&near.place, TOLERANCE));
            tops.min_by(|one, other| one.value.total_cmp(&other.value))?
        }
    };
    solve(&best.place)
}

/// Where searches begin, of places with the most likely ones first: the best with little noise and the best with much, so many of
/// each, none beside another.
fn starts(places: &[(f64, Vec<f64>)], count: usize) -> Vec<&[f64]> {
    let mut chosen: Vec<&[f64]> = Vec::new();
    for much in [false, true] {
        let most = chosen.len() + count;
        for (_, place) in places {
            let is_much = place.last().is_some_and(|noise| *noise > libm::log(MUCH_NOISE));
            if chosen.len() < most && is_much == much && chosen.iter().all(|other| apart(other, place) > APART) {
                chosen.push(place);
            }
        }
    }
    chosen
}

/// Minima without those that are beside a better one.
fn distinct(mut minima: Vec<Minimum>) -> Vec<Minimum> {
    minima.sort_by(|one, other| one.value.total_cmp(&other.value));
    let mut chosen: Vec<Minimum> = Vec::new();
    for minimum in minima {
        if chosen.iter().all(|other| apart(&other.place, &minimum.place) > APART) {
            chosen.push(minimum);
        }
    }
    chosen
}

/// The largest difference of two places along an axis, as a part of the box.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let (low, high) = ends(one.len() - 1);
    let part = |at: usize| (one[at] - other[at]).abs() / (high[at] - low[at]);
    (0..one.len()).map(part).fold(0.0, f64::max)
}

/// The ends of the box in which lengths and noise are looked for, as logarithms.
pub(super) fn ends(axes: usize) -> (Vec<f64>, Vec<f64>) {
    let end = |end: usize| std::iter::repeat_n(libm::log(LENGTHS[end]), axes).chain([libm::log(NOISES[end])]).collect();
    (end(0), end(1))
}

/// Places in the box where the search begins, so many for each parameter, spread evenly, as logarithms.
fn places(axes: usize, count: usize) -> Vec<Vec<f64>> {
    let factors = vec![Factor::Range; axes + 1];
    let Ok(spread) = design(&Kind::Sobol { points: count * (axes + 1) }, &factors) else {
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
