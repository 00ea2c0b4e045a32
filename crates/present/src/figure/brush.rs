//! Lines in pixels: how much of each pixel a line covers, wherever its places lie between pixels.

use std::collections::BTreeMap;

/// A place on the page, pixels.
pub type Place = (f64, f64);

/// Longer pieces of a line are divided, pixels: only the pixels about each piece are looked at.
const PIECE: f64 = 24.0;

/// Pixels that a line through places covers, with the covered part of each. Its ends are flat and its corners round; a line that
/// ends where it begins has a corner there.
pub fn covered(places: &[Place], width: f64) -> BTreeMap<(i32, i32), f64> {
    let half = 0.5 * width;
    let places = sharp(places);
    let is_closed = places.len() > 2 && places.first() == places.last();
    let last = places.len().saturating_sub(2);
    let mut parts: BTreeMap<(i32, i32), f64> = BTreeMap::new();
    for (index, pair) in places.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        if length == 0.0 {
            continue;
        }
        let along = ((to.0 - from.0) / length, (to.1 - from.1) / length);
        let flat = [index == 0 && !is_closed, index == last && !is_closed];
        // How much of a pixel is beside the line by less than half its width, and between its ends.
        let part = |(x, y): (i32, i32)| {
            let (right, down) = (f64::from(x) - from.0, f64::from(y) - from.1);
            let way = right * along.0 + down * along.1;
            let beside = (right * along.1 - down * along.0).abs();
            let beyond = if way < 0.0 && !flat[0] {
                -way
            } else if way > length && !flat[1] {
                way - length
            } else {
                0.0
            };
            let inside = |room: f64| (room + 0.5).clamp(0.0, 1.0);
            let ends = (if flat[0] { inside(way) } else { 1.0 }) * (if flat[1] { inside(length - way) } else { 1.0 });
            inside(half - beside.hypot(beyond)) * ends
        };
        let pieces = (length / PIECE).ceil().max(1.0) as usize;
        for piece in 0..pieces {
            let at = |piece: usize| {
                let way = length * piece as f64 / pieces as f64;
                (from.0 + way * along.0, from.1 + way * along.1)
            };
            let (begin, end) = (at(piece), at(piece + 1));
            let reach = half + 1.0;
            let span = |one: f64, other: f64| {
                ((one.min(other) - reach).floor() as i32)..=((one.max(other) + reach).ceil() as i32)
            };
            for y in span(begin.1, end.1) {
                for x in span(begin.0, end.0) {
                    let part = part((x, y));
                    if part > 0.0 {
                        let most = parts.entry((x, y)).or_insert(0.0);
                        *most = most.max(part);
                    }
                }
            }
        }
    }
    parts
}

/// Places in whole pixels where all of a line runs along the page's sides: frames and ticks are sharp.
fn sharp(places: &[Place]) -> Vec<Place> {
    let runs_along = |pair: &[Place]| (pair[0].0 - pair[1].0).abs() < 1e-9 || (pair[0].1 - pair[1].1).abs() < 1e-9;
    if places.windows(2).all(runs_along) {
        places.iter().map(|(x, y)| (x.round(), y.round())).collect()
    } else {
        places.to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::covered;

    #[test]
    fn a_line_is_as_wide_in_every_direction() {
        for angle in 0..12 {
            let (sine, cosine) = (f64::from(angle) * 0.13).sin_cos();
            let line = [(50.3, 50.7), (50.3 + 80.0 * cosine, 50.7 + 80.0 * sine)];
            let area: f64 = covered(&line, 4.0).values().sum();
            assert!((area - 320.0).abs() < 8.0, "{angle}: {area}");
        }
    }

    #[test]
    fn frames_are_sharp_and_curves_have_no_gaps() {
        let frame = [(10.2, 10.4), (40.2, 10.4), (40.2, 30.4), (10.2, 30.4), (10.2, 10.4)];
        let parts = covered(&frame, 3.0);
        let inner = |(x, y): &(i32, i32)| (12..=38).contains(x) && *y < 20;
        assert!(parts.iter().filter(|(place, _)| inner(place)).all(|(_, part)| *part == 1.0));
        let corner = covered(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0)], 4.0);
        assert_eq!(corner.get(&(20, 0)), Some(&1.0));
        assert!(covered(&[(1.0, 1.0)], 3.0).is_empty());
    }
}
