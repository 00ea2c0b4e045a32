//! Intervals and regions of the profile likelihood: what a key, or a pair, may be while all others are as likely as they can be.

use super::Fit;
use crate::quasi_newton::minimise;

/// Places of a profile.
const PLACES: usize = 41;
/// Places that are added where an interval is, so that a short one is seen as well as a long one.
const ADDED: usize = 20;
/// How far these reach beyond it, as a part of it.
const BEYOND: f64 = 0.5;
/// Turns in which places are added where a profile bends, each halving the steps there.
const TURNS: usize = 2;
/// Bend that is not followed further: how far a place lies from the line through its neighbours, as a part of the threshold.
const STRAIGHT: f64 = 0.01;
/// Up to which multiple of the threshold bends are followed, which is somewhat more than figures show.
const SHOWN: f64 = 3.0;
/// Places of a region along each of its two keys: where there are no other keys, and where each place is a search.
const SIDES: [usize; 2] = [61, 31];
/// Up to which multiple of the threshold profiles are within the part of the ranges in which a region is told.
const AROUND: f64 = 1.6;
/// Halvings of the step in which an interval ends.
const HALVINGS: usize = 14;
/// Where the gradient of −2 ln L by coded units is taken for nothing.
const TOLERANCE: f64 = 1e-4;
/// How near places are from which a search may begin, in coded units.
const NEAR: f64 = 0.15;

/// The profile of one key.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Values of the key, in ascending order.
    pub values: Vec<f64>,
    /// How far −2 ln of the likelihood is there above the least, with all other keys as likely as they can be.
    pub rises: Vec<f64>,
    /// What the rise stays below in the interval.
    pub threshold: f64,
    /// The interval; of several pieces where the likelihood has several hills.
    pub pieces: Vec<Piece>,
}

/// A piece of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Its ends.
    pub ends: [f64; 2],
    /// Whether it goes on beyond the lower and the upper end of the range, as far as these data tell.
    pub open: [bool; 2],
}

/// The region of two keys.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Which keys, by index.
    pub keys: [usize; 2],
    /// Values of both, in ascending order, about where the region is.
    pub values: [Vec<f64>; 2],
    /// Rises of −2 ln of the likelihood, for each value of the second key those of the first.
    pub rises: Vec<f64>,
    /// What the rise stays below in the region.
    pub threshold: f64,
}

impl Profile {
    /// Whether the interval is the whole range: the data do not determine the key.
    pub fn is_undetermined(&self) -> bool {
        matches!(self.pieces.as_slice(), [Piece { open: [true, true], .. }])
    }
}

impl Fit {
    /// A place at least as likely as the most likely one so far, which a profile may find.
    pub(super) fn polished(mut self) -> Self {
        for key in 0..self.keys.len() {
            for (_, place, value) in self.scan(key) {
                if value < self.least - 1e-6 {
                    (self.best, self.least) = (place, value);
                }
            }
        }
        self
    }

    /// The profile of a key.
    pub(super) fn profile(&self, key: usize) -> Profile {
        let mut scan = self.scan(key);
        let threshold = self.threshold(1);
        let pieces = self.pieces(key, &scan, threshold);
        for [low, high] in &pieces {
            let reach = BEYOND * (high - low);
            let (from, to) = ((low - reach).max(-1.0), (high + reach).min(1.0));
            let values = (0..=ADDED).map(|step| from + (to - from) * step as f64 / ADDED as f64);
            self.add(key, &mut scan, &values.collect::<Vec<_>>());
        }
        for _ in 0..TURNS {
            let values = bends(&scan, self.least, threshold);
            self.add(key, &mut scan, &values);
        }
        let of = &self.keys[key];
        let piece =
            |[low, high]: [f64; 2]| Piece { ends: [of.value(low), of.value(high)], open: [low <= -1.0, high >= 1.0] };
        Profile {
            values: scan.iter().map(|(coded, ..)| of.value(*coded)).collect(),
            rises: scan.iter().map(|(_, _, value)| (value - self.least).max(0.0)).collect(),
            threshold,
            pieces: pieces.into_iter().map(piece).collect(),
        }
    }

    /// Adds places to a scan, each searched from where its neighbour is.
    fn add(&self, key: usize, scan: &mut Vec<(f64, Vec<f64>, f64)>, values: &[f64]) {
        let found: Vec<_> = values
            .iter()
            .map(|value| {
                let near = scan.iter().min_by(|one, other| (one.0 - value).abs().total_cmp(&(other.0 - value).abs()));
                let near = near.map_or_else(|| self.best.clone(), |(_, place, _)| place.clone());
                let (place, least) = self.best_with(&[(key, *value)], &[&near]);
                (*value, place, least)
            })
            .collect();
        scan.extend(found);
        scan.sort_by(|one, other| one.0.total_cmp(&other.0));
        scan.dedup_by(|one, other| one.0 == other.0);
    }

    /// The pieces of a range in which a profile stays below a threshold, in coded units.
    fn pieces(&self, key: usize, scan: &[(f64, Vec<f64>, f64)], threshold: f64) -> Vec<[f64; 2]> {
        let is_inside = |(_, _, value): &(f64, Vec<f64>, f64)| value - self.least <= threshold;
        let mut pieces: Vec<[f64; 2]> = Vec::new();
        let mut begin = scan.first().filter(|first| is_inside(first)).map(|_| -1.0);
        for step in scan.windows(2).filter(|step| is_inside(&step[0]) != is_inside(&step[1])) {
            let crossing = self.crossing(key, &step[0], &step[1], threshold);
            match begin.take() {
                Some(low) => pieces.push([low, crossing]),
                None => begin = Some(crossing),
            }
        }
        pieces.extend(begin.map(|low| [low, 1.0]));
        pieces
    }

    /// The region of two keys.
    pub(super) fn pair(&self, keys: [usize; 2]) -> Pair {
        let threshold = self.threshold(2);
        let side = SIDES[usize::from(self.keys.len() > 2)];
        let coded: [Vec<f64>; 2] = keys.map(|key| {
            let pieces = self.pieces(key, &self.scan(key), AROUND * threshold);
            let from = pieces.first().map_or(-1.0, |piece| piece[0]);
            let to = pieces.last().map_or(1.0, |piece| piece[1]);
            (0..side).map(|step| from + (to - from) * step as f64 / (side - 1) as f64).collect()
        });
        let mut rises = Vec::with_capacity(side * side);
        let mut last = self.best.clone();
        for row in 0..side {
            for step in 0..side {
                // There and back again, so that each search begins beside where the last one ended.
                let column = if row % 2 == 0 { step } else { side - 1 - step };
                let held = [(keys[0], coded[0][column]), (keys[1], coded[1][row])];
                let (place, value) = self.best_with(&held, &[&last]);
                last = place;
                rises.push((value - self.least).max(0.0));
            }
            if row % 2 == 1 {
                rises[row * side..].reverse();
            }
        }
        let values = [0, 1].map(|at| coded[at].iter().map(|coded| self.keys[keys[at]].value(*coded)).collect());
        Pair { keys, values, rises, threshold }
    }

    /// Coded values of a key with the most likely place and −2 ln of its likelihood: evenly over the range, with the most
    /// likely value itself among them.
    fn scan(&self, key: usize) -> Vec<(f64, Vec<f64>, f64)> {
        let mut values: Vec<f64> = (0..PLACES).map(|step| 2.0 * step as f64 / (PLACES - 1) as f64 - 1.0).collect();
        values.push(self.best[key]);
        values.sort_by(f64::total_cmp);
        values.dedup();
        let middle = values.iter().position(|value| *value == self.best[key]).unwrap_or(0);
        let outward = |values: &mut dyn Iterator<Item = f64>| {
            let mut last = self.best.clone();
            let step = |value: f64| {
                let (place, least) = self.best_with(&[(key, value)], &[&last]);
                last.clone_from(&place);
                (value, place, least)
            };
            values.map(step).collect::<Vec<_>>()
        };
        let mut scan = outward(&mut values[..middle].iter().rev().copied());
        scan.reverse();
        scan.push((self.best[key], self.best.clone(), self.least));
        scan.extend(outward(&mut values[middle + 1..].iter().copied()));
        scan
    }

    /// Where the profile crosses the threshold between two places of a scan, in coded units.
    fn crossing(&self, key: usize, from: &(f64, Vec<f64>, f64), to: &(f64, Vec<f64>, f64), threshold: f64) -> f64 {
        let is_inside = |value: f64| value - self.least <= threshold;
        let (mut inside, mut outside) = if is_inside(from.2) { (from.0, to.0) } else { (to.0, from.0) };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            let (_, value) = self.best_with(&[(key, middle)], &[&from.1, &to.1]);
            if is_inside(value) { inside = middle } else { outside = middle }
        }
        0.5 * (inside + outside)
    }

    /// The most likely place where some keys are held, from these places and the most likely known one nearby.
    fn best_with(&self, held: &[(usize, f64)], from: &[&Vec<f64>]) -> (Vec<f64>, f64) {
        let is_near = |place: &[f64]| held.iter().all(|(key, value)| (place[*key] - value).abs() <= NEAR);
        let nearby = self.places.all.iter().filter(|(place, _)| is_near(place));
        let nearby = nearby.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(place, _)| place);
        let starts = from.iter().copied().chain(nearby.filter(|_| held.len() < self.keys.len()));
        let found = starts.map(|start| self.search(held, start));
        found.min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or_else(|| (self.best.clone(), f64::INFINITY))
    }

    /// The same from one place alone.
    fn search(&self, held: &[(usize, f64)], from: &[f64]) -> (Vec<f64>, f64) {
        let (mut low, mut high) = (vec![-1.0; self.keys.len()], vec![1.0; self.keys.len()]);
        held.iter().for_each(|(key, value)| (low[*key], high[*key]) = (*value, *value));
        if held.len() == self.keys.len() {
            let value = self.likelihood.value(&low);
            return (low, value);
        }
        let found = minimise(|place| self.likelihood.slope(place), from, &low, &high, TOLERANCE);
        found.map_or_else(|| (low, f64::INFINITY), |found| (found.place, found.value))
    }
}

/// Middles of the steps beside places at which a profile bends, where it is not far above the threshold.
fn bends(scan: &[(f64, Vec<f64>, f64)], least: f64, threshold: f64) -> Vec<f64> {
    let mut middles = Vec::new();
    for three in scan.windows(3) {
        let [before, at, after] = [&three[0], &three[1], &three[2]].map(|(value, _, rise)| (*value, rise - least));
        let share = (at.0 - before.0) / (after.0 - before.0);
        let bend = (before.1 + share * (after.1 - before.1) - at.1).abs();
        let lowest = before.1.min(at.1).min(after.1);
        if bend > STRAIGHT * threshold && lowest < SHOWN * threshold {
            middles.extend([0.5 * (before.0 + at.0), 0.5 * (at.0 + after.0)]);
        }
    }
    middles.dedup();
    middles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_added_where_a_profile_bends() {
        // |x| bends at 0 alone; 100 + |x| is not shown.
        let scan = |lift: f64| -> Vec<(f64, Vec<f64>, f64)> {
            (-4..=4).map(|at| (f64::from(at), Vec::new(), lift + f64::from(at).abs())).collect()
        };
        assert_eq!(bends(&scan(0.0), 0.0, 4.0), [-0.5, 0.5]);
        assert_eq!(bends(&scan(100.0), 0.0, 4.0), Vec::<f64>::new());
        // x² is 1 off the line through its neighbours everywhere.
        let parabola: Vec<_> = scan(0.0).into_iter().map(|(x, place, _)| (x, place, x * x)).collect();
        assert_eq!(bends(&parabola, 0.0, 120.0).len(), 0);
        assert_eq!(bends(&parabola, 0.0, 10.0).len(), 8);
    }
}
