//! The rim of places: the smallest convex polygon with all of them in it.

/// How far a place is from a line that it lies on, as twice the area of the triangle with its ends.
const ALONG: f64 = 1e-6;

/// Twice the area of a triangle; positive where its corners go round against the clock.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The smallest convex polygon with all places in it, against the clock (Andrew's chain); none of places along a line.
pub fn hull(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = places.to_vec();
    sorted.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
    sorted.dedup();
    let half = |places: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for place in places {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], place) <= ALONG {
                chain.pop();
            }
            chain.push(place);
        }
        chain.pop();
        chain
    };
    let hull = [half(&mut sorted.iter().copied()), half(&mut sorted.iter().rev().copied())].concat();
    if hull.len() > 2 { hull } else { Vec::new() }
}

/// Whether a place is within a polygon against the clock, or beyond its rim by no more than this.
pub fn is_within(polygon: &[[f64; 2]], place: [f64; 2], beyond: f64) -> bool {
    polygon.iter().zip(polygon.iter().cycle().skip(1)).all(|(one, other)| turn(*one, *other, place) > -beyond)
}

#[cfg(test)]
mod tests {
    use super::{hull, is_within};

    #[test]
    fn the_rim_of_a_central_composite_is_an_octagon() {
        let far = std::f64::consts::SQRT_2;
        let places = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [-1.0, 1.0],
            [1.0, 1.0],
            [-far, 0.0],
            [far, 0.0],
            [0.0, -far],
            [0.0, far],
            [0.0, 0.0],
        ];
        let rim = hull(&places);
        assert_eq!(rim.len(), 8);
        let is_within = |place: [f64; 2]| is_within(&rim, place, 1e-6);
        assert!(places.into_iter().all(is_within));
        assert!(!is_within([far, far]) && !is_within([1.2, 0.9]));
        assert!(hull(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).is_empty());
    }
}
