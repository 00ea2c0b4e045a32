//! Curves with no more places than there is to see: rounded to pixels, places close to each other would make them ragged.

use super::canvas::Place;

/// How far the simplified curve may be from a place that is left out, pixels.
const TOLERANCE: f64 = 0.75;
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
    distinct.into_iter().zip(kept).filter_map(|(place, kept)| kept.then_some(place)).collect()
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
    fn corners_and_peaks_stay() {
        let curve = [(0.0, 0.0), (50.0, 0.2), (100.0, 0.0), (101.0, 40.0), (102.0, 0.0), (200.0, 0.0), (200.0, 90.0)];
        let expected = [(0.0, 0.0), (100.0, 0.0), (101.0, 40.0), (102.0, 0.0), (200.0, 0.0), (200.0, 90.0)];
        assert_eq!(simplified(&curve), expected);
        // There and back again, to the same place.
        assert_eq!(simplified(&[(0.0, 0.0), (0.0, 9.0), (0.0, 0.0)]).len(), 3);
    }
}
