//! Where further runs teach most, and when they teach nothing that counts.

use super::Fit;
use super::likelihood::Term;

/// Parts of a range between which places of runs are told apart: places are multiples of 2/PARTS in coded units, so that
/// rounding in the last bits, which may differ from one build to another, asks for no other run.
const PARTS: f64 = 512.0;
/// A run is made at the most likely place itself where none is nearer than this, in coded units.
const NEAR: f64 = 0.1;
/// Part of a measurement's variance below which that of a process no longer counts.
pub(super) const SETTLED: f64 = 0.1;
/// Further points that are looked ahead one by one.
const LOOKED_AHEAD: usize = 24;
/// How far −2 ln of the likelihood rises in the region that has to be known so well.
const REGION: f64 = 6.0;

impl Fit {
    /// Whether the processes' part of the variance is small against the measurements' wherever the measurements are not
    /// unlikely: more runs would change little.
    pub fn is_settled(&self) -> bool {
        self.surrogate_share() <= SETTLED
    }

    /// The largest variance of a process over that of its measurement, where the measurements are not unlikely.
    pub fn surrogate_share(&self) -> f64 {
        self.share_of(&self.likelihood.terms)
    }

    /// The same if so many more points, each of so many runs, are made where they teach most, as the processes themselves
    /// expect it: what they take for scatter between runs goes on as they take it.
    pub fn expected_share(&self, count: usize, runs: usize) -> f64 {
        // Many points are few, each of more runs.
        let each = count.div_ceil(LOOKED_AHEAD).max(1);
        let (_, terms) = self.with_next(count.div_ceil(each), runs * each);
        self.share_of(&terms)
    }

    /// The same of some terms.
    pub(super) fn share_of(&self, terms: &[Term]) -> f64 {
        let likely = self.places.all.iter().filter(|(_, value)| value - self.least <= REGION);
        let share = |term: &Term, place: &[f64]| term.variance_at(place) / term.fixed_variance();
        let shares = likely.flat_map(|(place, _)| terms.iter().map(move |term| share(term, place)));
        shares.fold(0.0, f64::max)
    }

    /// At most so many places for further points, each of so many runs, in coded units: where the processes know least, as
    /// far as the measurements are likely there. None where every place that counts was run.
    ///
    /// Each place is chosen as if the runs at the ones before it had been made.
    pub fn next_points(&self, count: usize, runs: usize) -> Vec<Vec<f64>> {
        self.with_next(count, runs).0
    }

    /// These places, and the terms of the likelihood when they will have been run.
    fn with_next(&self, count: usize, runs: usize) -> (Vec<Vec<f64>>, Vec<Term>) {
        let mut terms = self.likelihood.terms.clone();
        let mut known: Vec<Vec<f64>> = terms.iter().flat_map(|term| term.process.known_points().to_vec()).collect();
        let mut candidates: Vec<(Vec<f64>, f64)> = self
            .places
            .all
            .iter()
            .map(|(place, _)| snapped(place))
            .map(|place| (self.optimism(&place), place))
            .map(|(o, p)| (p, o))
            .collect();
        let mut next = Vec::new();
        for _ in 0..count {
            candidates.retain(|(place, _)| known.iter().all(|known| distance(known, place) > 0.5 / PARTS));
            let best = snapped(&self.best);
            let is_far = known.iter().all(|known| distance(known, &best) > NEAR);
            let chosen = if is_far { Some(best) } else { most_telling(&terms, &candidates) };
            let Some(place) = chosen else { break };
            for term in &mut terms {
                if let Some(process) = term.process.with_point(&place, runs) {
                    term.process = process;
                }
            }
            known.push(place.clone());
            next.push(place);
        }
        (next, terms)
    }

    /// How likely the measurements are at a place if the unknown is on their side: the weight of the place.
    fn optimism(&self, place: &[f64]) -> f64 {
        libm::exp(-0.25 * self.likelihood.misfit(place))
    }
}

/// The place with the largest weighted variance.
fn most_telling(terms: &[Term], candidates: &[(Vec<f64>, f64)]) -> Option<Vec<f64>> {
    let unknown =
        |place: &[f64]| -> f64 { terms.iter().map(|term| term.variance_at(place) / term.fixed_variance()).sum() };
    let value = |(place, weight): &(Vec<f64>, f64)| weight * unknown(place);
    let valued = candidates.iter().map(|candidate| (value(candidate), candidate)).filter(|(value, _)| *value > 0.0);
    valued.max_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, (place, _))| place.clone())
}

/// The nearest place at which runs are made.
fn snapped(place: &[f64]) -> Vec<f64> {
    place.iter().map(|coded| (coded * 0.5 * PARTS).round() / (0.5 * PARTS)).collect()
}

/// The largest difference of two coordinates.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}
