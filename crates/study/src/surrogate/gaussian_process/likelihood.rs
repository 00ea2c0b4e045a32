//! The most likely lengths and noise.
//!
//! A likelihood often has two hills: a rough response without noise, and a smooth one with it. So the search begins from the best
//! places of both kinds, goes near the tops first, and follows those that are not the same to the end. Of many points some, drawn by
//! lot, tell where the hills are; the search on the best of them ends with all points.

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
/// Points that are enough to tell hills apart: what a look costs grows with their cube.
pub(super) const ENOUGH: usize = 300;
/// How far starts are apart at least, and hills that are followed to their tops, as a part of the logarithms' box.
const APART: f64 = 0.15;
/// Where the gradient is small enough to tell hills apart. With more than [`ENOUGH`] points it is small enough for everything: rounding
/// leaves hardly less of it, and lengths are known better than it moves them.
pub(super) const ROUGHLY: f64 = 0.01;
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
    let hill = Hill { axes, trend, averages };
    let tolerance = if averages.points.len() > ENOUGH { ROUGHLY } else { TOLERANCE };
    let best = match near {
        Some(near) => hill.climb(&to_logs(near), tolerance)?.place,
        None if averages.points.len() <= ENOUGH => {
            let tops = hill.feet().into_iter().filter_map(|near| hill.climb(&near.place, tolerance));
            tops.min_by(|one, other| one.value.total_cmp(&other.value))?.place
        }
        None => {
            let some = averages.drawn(ENOUGH);
            let feet = Hill { averages: &some, ..hill }.feet().into_iter();
            let known = feet.filter_map(|foot| Some((hill.solve(&foot.place)?.1.log_likelihood, foot.place)));
            let (_, highest) = known.max_by(|one, other| one.0.total_cmp(&other.0))?;
            hill.climb(&highest, tolerance)?.place
        }
    };
    hill.solve(&best)
}

/// The likelihood of lengths and noise.
#[derive(Clone, Copy)]
struct Hill<'a> {
    axes: &'a [Axis],
    trend: Trend,
    averages: &'a Averages,
}

impl Hill<'_> {
    fn solve(&self, logs: &[f64]) -> Option<(Hyperparameters, Solved)> {
        let hyperparameters = from_logs(logs);
        let solved = Solved::new(self.axes, self.trend, self.averages, &hyperparameters)?;
        Some((hyperparameters, solved))
    }

    /// The top that is above a place, as a minimum of the negative.
    fn climb(&self, start: &[f64], tolerance: f64) -> Option<Minimum> {
        let (low, high) = ends(self.axes.len());
        let slope = |logs: &[f64]| {
            let (hyperparameters, solved) = self.solve(logs)?;
            let gradient = solved.gradient(self.axes, self.averages, &hyperparameters);
            Some((-solved.log_likelihood, gradient.into_iter().map(|value| -value).collect()))
        };
        minimise(slope, start, &low, &high, tolerance)
    }

    /// Places near the tops of all hills that are found, one on each.
    fn feet(&self) -> Vec<Minimum> {
        let many = usize::from(self.averages.points.len() > FEW);
        let spread = places(self.axes.len(), LOOKED_AT[many]).into_iter();
        let value = |place: &Vec<f64>| self.solve(place).map(|(_, solved)| solved.log_likelihood);
        let mut looked_at: Vec<(f64, Vec<f64>)> = spread.filter_map(|place| Some((value(&place)?, place))).collect();
        looked_at.sort_by(|one, other| other.0.total_cmp(&one.0));
        let starts = starts(&looked_at, STARTS[many]).into_iter();
        distinct(starts.filter_map(|start| self.climb(start, ROUGHLY)).collect())
    }
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

#[cfg(test)]
mod tests {
    use super::super::inputs::Inputs;
    use super::*;
    use crate::effects::{Factor as Analysed, FactorKind, Observation};

    #[test]
    fn hills_that_some_points_show_are_climbed_with_all() {
        // Two factors, 340 points all over, and noise: a smooth hill with noise, and a rough one without it.
        let run = |run: usize| {
            let part = |step: f64| 2.0 * ((run as f64 + 0.5) * step).fract() - 1.0;
            let place = [part(0.754_877_666), part(0.569_840_290)];
            let response = libm::sin(3.0 * place[0]) + place[1] * place[1] + 0.1 * libm::cos(1e4 * run as f64 * 0.618);
            Observation { settings: place.map(Setting::Coded).to_vec(), replicate: 0, run, response }
        };
        let observations: Vec<Observation> = (0..ENOUGH + 40).map(run).collect();
        let factor = |name: &str| Analysed { name: name.into(), kind: FactorKind::Range { low: -1.0, high: 1.0 } };
        let mut inputs = Inputs::new(&[factor("a"), factor("b")]);
        let averages = Averages::new(&mut inputs, &observations).unwrap();
        let some = averages.drawn(ENOUGH);
        assert!((some.points.len(), some.means.len(), some.weights.len()) == (ENOUGH, ENOUGH, ENOUGH));
        assert!(some.points.iter().zip(&some.means).all(|(point, mean)| {
            averages.points.iter().position(|own| own == point).is_some_and(|at| averages.means[at] == *mean)
        }));
        let (found, solved) = most_likely(&inputs.axes, Trend::Constant, &averages, None).unwrap();
        // A top: no slope but where a length is at its end, and nothing is higher among places all over.
        let gradient = solved.gradient(&inputs.axes, &averages, &found);
        assert!(gradient.iter().all(|slope| slope.abs() <= ROUGHLY), "{gradient:?} {found:?}");
        let hill = Hill { axes: &inputs.axes, trend: Trend::Constant, averages: &averages };
        for place in places(2, LOOKED_AT[1]) {
            assert!(hill.solve(&place).is_none_or(|(_, other)| other.log_likelihood < solved.log_likelihood));
        }
        // Half the square of the noise's amplitude is its variance.
        assert!((found.noise * solved.variance / 0.005 - 1.0).abs() < 0.2, "{found:?} {}", solved.variance);
    }
}
