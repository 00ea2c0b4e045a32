//! Labels beside points: as many as there is room for, none upon another or upon a point.

use super::axes::Frame;
use super::canvas::{Place, TEXT};
use super::font::text_width;

/// Half the side of a dot, pixels, with a little room round it.
const DOT: f64 = 10.0;

/// A box with points, and the room that labels have in it.
#[derive(Debug, Clone)]
pub struct Labels {
    whole: Frame,
    taken: Vec<Frame>,
}

impl Labels {
    /// Without labels so far.
    pub fn new(whole: Frame, points: impl Iterator<Item = Place>) -> Self {
        Self { whole, taken: points.map(|point| around(point, [2.0 * DOT, 2.0 * DOT])).collect() }
    }

    /// Where a text beside a point begins, if there is room for it; it has the room then.
    pub fn beside(&mut self, text: &str, (x, y): Place) -> Option<Place> {
        let size = [text_width(text, TEXT), f64::from(TEXT)];
        let [beside, above] = [0.5 * size[0] + DOT + 6.0, 0.5 * size[1] + DOT];
        let middles =
            [(beside, -above), (beside, above), (-beside, above), (-beside, -above), (beside, 0.0), (-beside, 0.0)];
        let mut frames = middles.into_iter().map(|(right, down)| around((x + right, y + down), size));
        let is_free = |frame: &Frame| !self.taken.iter().any(|other| overlap(frame, other));
        let frame = frames.find(|frame| is_within(frame, &self.whole) && is_free(frame))?;
        self.taken.push(frame);
        Some((frame.x[0], 0.5 * (frame.y[0] + frame.y[1])))
    }
}

fn around((x, y): Place, [width, height]: [f64; 2]) -> Frame {
    Frame { x: [x - 0.5 * width, x + 0.5 * width], y: [y - 0.5 * height, y + 0.5 * height] }
}

fn overlap(one: &Frame, other: &Frame) -> bool {
    let meet = |one: [f64; 2], other: [f64; 2]| one[0] < other[1] && other[0] < one[1];
    meet(one.x, other.x) && meet(one.y, other.y)
}

fn is_within(frame: &Frame, whole: &Frame) -> bool {
    let inside = |part: [f64; 2], whole: [f64; 2]| whole[0] <= part[0] && part[1] <= whole[1];
    inside(frame.x, whole.x) && inside(frame.y, whole.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_room_of_their_own() {
        let points = [(100.0, 100.0), (120.0, 105.0), (140.0, 100.0), (160.0, 110.0), (500.0, 100.0)];
        let whole = Frame { x: [0.0, 520.0], y: [0.0, 200.0] };
        let mut labels = Labels::new(whole, points.into_iter());
        let begins: Vec<_> = points.iter().map(|point| labels.beside("a label", *point)).collect();
        assert!(begins[0].is_some());
        let placed = &labels.taken[points.len()..];
        assert_eq!(placed.len(), begins.iter().flatten().count());
        for (index, one) in labels.taken.iter().enumerate().skip(points.len()) {
            assert!(is_within(one, &whole));
            assert!(!labels.taken[..index].iter().any(|other| overlap(one, other)));
        }
        // The last one has no room on its right.
        assert!(begins[4].is_some_and(|(x, _)| x < 500.0));
        assert_eq!(labels.beside(&"long ".repeat(50), points[0]), None);
    }
}
