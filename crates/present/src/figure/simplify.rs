//! Curves with no more places than there is to see: rounded to pixels, places close to each other would make them ragged.

use super::brush::Place;

/// How far the simplified curve may be from a place that is left out, pixels.
const TOLERANCE: f64 = 0.25;
/// Places at which a curve turns by less are no corners; its cosine. They may be moved along the curve so far, pixels.
const GENTLE: f64 = 0.94;
const MOVED: f64 = 8.0;
/// Steps in which better places are looked for along a curve, pixels.
const STEP: f64 = 0.5;
/// Places so near to the one before are left out at once, pixels.
const SAME: f64 = 0.5;

/// The places that a curve cannot do without (Ramer, Douglas and Peucker): its ends, and those that are farther than the
/// tolerance from the line between their neighbours.
pub fn simplified(places: &[Place]) -> Vec<Place> {
    let mut distinct: Vec<Place> = Vec::with_capacity(places.len());
    for place in places {
        if distinct.last().is_none_or(|last| (place.0 - last.0).hypot(place.1 - last.1) >= SAME) {
            distinct.push(*place);
        }
    }
    // A curve ends where it ends, though that be close to the place before.
    if let (Some(last), Some(end)) = (distinct.last_mut(), places.last()) {
        *last = *end;
    }
    let mut kept = vec![false; distinct.len()];
    let mut open: Vec<_> = distinct.len().checked_sub(1).map(|last| (0, last)).into_iter().collect();
    while let Some((begin, end)) = open.pop() {
        let (first, last) = (distinct[begin], distinct[end]);
        (kept[begin], kept[end]) = (true, true);
        let distances = (begin + 1..end).map(|at| (at, distance(distinct[at], first, last)));
        let farthest = distances.reduce(|most, other| if other.1 > most.1 { other } else { most });
        if let Some((at, _)) = farthest.filter(|(_, distance)| *distance > TOLERANCE) {
            open.extend([(begin, at), (at, end)]);
        }
    }
    on_pixels(&distinct, &kept)
}

/// The places that are kept. Those that are no corners are moved along the curve to where it passes through a pixel: vector
/// formats have whole pixels, and a place that is rounded far would be a kink.
fn on_pixels(distinct: &[Place], kept: &[bool]) -> Vec<Place> {
    let places: Vec<usize> = (0..distinct.len()).filter(|at| kept[*at]).collect();
    let off = |(x, y): Place| (x - x.round()).hypot(y - y.round());
    let moved = |index: usize| {
        let here = distinct[places[index]];
        let (Some(before), Some(after)) = (index.checked_sub(1), places.get(index + 1)) else { return here };
        let (before, after) = (distinct[places[before]], distinct[*after]);
        if cosine(before, here, after) < GENTLE {
            return here;
        }
        let mut best = (off(here), here);
        for (mut at, forward, end) in [(places[index], true, after), (places[index], false, before)] {
            let reach = MOVED.min(0.4 * (end.0 - here.0).hypot(end.1 - here.1));
            let mut way = 0.0;
            while way < reach {
                let next = if forward { at + 1 } else { at - 1 };
                let (from, to) = (distinct[at], distinct[next]);
                let length = (to.0 - from.0).hypot(to.1 - from.1);
                for step in 1..=((length.min(reach - way) / STEP) as usize) {
                    let part = STEP * step as f64 / length;
                    let place = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
                    if off(place) < best.0 {
                        best = (off(place), place);
                    }
                }
                (way, at) = (way + length, next);
            }
        }
        best.1
    };
    (0..places.len()).map(moved).collect()
}

/// The cosine of the angle by which a line through three places turns.
fn cosine(before: Place, here: Place, after: Place) -> f64 {
    let (one, other) = ((here.0 - before.0, here.1 - before.1), (after.0 - here.0, after.1 - here.1));
    (one.0 * other.0 + one.1 * other.1) / (one.0.hypot(one.1) * other.0.hypot(other.1))
}

/// Distance of a place from the line between two others.
fn distance(place: Place, begin: Place, end: Place) -> f64 {
    let along = (end.0 - begin.0, end.1 - begin.1);
    let length = along.0.powi(2) + along.1.powi(2);
    let part = ((place.0 - begin.0) * along.0 + (place.1 - begin.1) * along.1) / length;
    let part = if length > 0.0 { part.clamp(0.0, 1.0) } else { 0.0 };
    (place.0 - begin.0 - part * along.0).hypot(place.1 - begin.1 - part * along.1)
}

#[cfg(test)]
mod tests {
    use super::simplified;

    #[test]
    fn a_straight_line_needs_its_ends_only() {
        let line: Vec<_> = (0..1000).map(|x| (f64::from(x), 0.3 * f64::from(x))).collect();
        assert_eq!(simplified(&line), [line[0], line[999]]);
        assert_eq!(simplified(&[]), []);
        assert_eq!(simplified(&[(1.0, 2.0)]), [(1.0, 2.0)]);
        assert_eq!(simplified(&[(1.0, 2.0), (1.1, 2.0)]).len(), 1);
    }

    #[test]
    fn a_curve_stays_a_curve_when_its_places_are_rounded() {
        let curve: Vec<_> = (0..=160).map(|at| (3.0 * f64::from(at) + 0.4, 0.01 * f64::from(at * at) + 0.3)).collect();
        let rounded: Vec<_> = simplified(&curve).into_iter().map(|(x, y)| (x.round(), y.round())).collect();
        let inner = &rounded[1..rounded.len() - 1];
        let sharpest = inner.windows(3).map(|three| super::cosine(three[0], three[1], three[2])).fold(1.0, f64::min);
        // It turns by 47 degrees in all; no place has more than 4 of them.
        assert!(sharpest > f64::cos(4.0_f64.to_radians()) && rounded.len() > 12, "{sharpest}, {}", rounded.len());
        assert!(inner.iter().all(|(x, y)| (0.01 * ((x - 0.4) / 3.0).powi(2) + 0.3 - y).abs() < 1.0));
    }

    #[test]
    fn corners_and_peaks_stay() {
        let curve = [(0.0, 0.0), (50.0, 0.2), (100.0, 0.0), (101.0, 40.0), (102.0, 0.0), (200.0, 0.0), (200.0, 90.0)];
        let expected = [(0.0, 0.0), (100.0, 0.0), (101.0, 40.0), (102.0, 0.0), (200.0, 0.0), (200.0, 90.0)];
        assert_eq!(simplified(&curve), expected);
        // There and back again, to the same place.
        assert_eq!(simplified(&[(0.0, 0.0), (0.0, 9.0), (0.0, 0.0)]).len(), 3);
    }
}
