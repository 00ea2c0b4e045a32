//! Numbers on the lines of equal value of a map.

use crate::colour::GROUND;
use crate::figure::axes::{Axes, Frame};
use crate::figure::brush::Place;
use crate::figure::canvas::{Anchor, TEXT};
use crate::figure::font::text_width;
use crate::figure::page::{Key, KeyStyle, Page};

/// Least length of a line that has a number, pixels.
const SHORTEST: f64 = 70.0;
/// How far numbers are from the rim of the map if that can be, pixels.
const OFF_RIM: f64 = 14.0;
/// How far they are from the frame, pixels.
const OFF_FRAME: f64 = 8.0;
/// Room on either side of a number, pixels.
const BESIDE: f64 = 6.0;
/// Fewest ticks whose lines are tried.
const FEWEST: usize = 3;

/// A line, in the units of the axes, and the text of its value.
pub type NumberedLine = (Vec<[f64; 2]>, String);

/// A number on a line.
#[derive(Debug, Clone, PartialEq)]
pub struct LineNumber {
    text: String,
    /// Its middle on the page.
    place: Place,
}

impl LineNumber {
    /// Writes it on a ground that hides the line.
    pub fn write(self, page: &mut Page) {
        let (half, (x, y)) = (half_size(&self.text), self.place);
        let frame = Frame { x: [x - half[0], x + half[0]], y: [y - half[1], y + half[1]] };
        page.keys.push(Key { frame, colour: GROUND, style: KeyStyle::Area });
        page.write(self.text, (x - half[0] + BESIDE, y), Anchor::Right, TEXT);
    }
}

/// Lines and their numbers at the values of as many ticks as let every value have its number, at most `ticks`; where no count does,
/// those with the fewest values without one. A line that nobody can name is not drawn for its own sake.
pub fn all_numbered(
    ticks: usize,
    numbered: impl Fn(usize) -> (Vec<NumberedLine>, Vec<LineNumber>),
) -> (Vec<NumberedLine>, Vec<LineNumber>) {
    let mut best = None;
    for ticks in (FEWEST.min(ticks)..=ticks).rev() {
        let (lines, numbers) = numbered(ticks);
        let named = |text: &String| numbers.iter().any(|number| number.text == *text);
        let mut unnamed: Vec<&String> = lines.iter().map(|(_, text)| text).filter(|text| !named(text)).collect();
        unnamed.dedup();
        let missing = unnamed.len();
        // With fewer lines there may be none at all.
        if best.as_ref().is_none_or(|(least, _)| missing < *least && !lines.is_empty()) {
            best = Some((missing, (lines, numbers)));
        }
        if best.as_ref().is_some_and(|(least, _)| *least == 0) {
            break;
        }
    }
    best.map_or_else(Default::default, |(_, found)| found)
}

/// Half of the width and height that a number takes.
fn half_size(text: &str) -> [f64; 2] {
    [0.5 * text_width(text, TEXT) + BESIDE, 0.5 * f64::from(TEXT) + 2.0]
}

/// Length of a line on the page, pixels.
pub fn length_of(axes: &Axes, points: &[[f64; 2]]) -> f64 {
    let places: Vec<Place> = points.iter().map(|[x, y]| axes.place(*x, *y)).collect();
    places.windows(2).map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)).sum()
}

/// What stands on lines: away from marks and other numbers, as far from other lines as there is room, and where there are values if
/// that can be.
pub fn numbers(
    axes: &Axes,
    lines: &[NumberedLine],
    marks: &[[f64; 2]],
    is_valued: impl Fn(Place) -> bool,
) -> Vec<LineNumber> {
    let place = |point: &[f64; 2]| axes.place(point[0], point[1]);
    let mut taken: Vec<Place> = marks.iter().map(place).collect();
    let all: Vec<Vec<Place>> = lines.iter().map(|(points, _)| points.iter().map(place).collect()).collect();
    let mut written: Vec<LineNumber> = Vec::new();
    // First where no other line is covered; then, of values that stand nowhere yet, where there is room at all.
    for covering in [false, true] {
        for (at, ((points, text), places)) in lines.iter().zip(&all).enumerate() {
            if length_of(axes, points) < SHORTEST || (covering && written.iter().any(|number| number.text == *text)) {
                continue;
            }
            let half = half_size(text);
            let others = || all.iter().enumerate().filter(|(other, _)| *other != at).flat_map(|(_, places)| places);
            let is_free = |(x, y): &Place| {
                let [left, right] = axes.frame.x;
                let [top, bottom] = axes.frame.y;
                let inside = x - half[0] > left + OFF_FRAME
                    && x + half[0] < right - OFF_FRAME
                    && y - half[1] > top
                    && y + half[1] < bottom;
                let is_within = |(other_x, other_y): &Place, room: [f64; 2]| {
                    (other_x - x).abs() < room[0] && (other_y - y).abs() < room[1]
                };
                let own = [2.0 * half[0] + 6.0, 2.0 * half[1] + 6.0];
                let covers = || others().any(|other| is_within(other, [half[0] + 4.0, half[1] + 4.0]));
                inside && !taken.iter().any(|other| is_within(other, own)) && (covering || !covers())
            };
            let to_others = |(x, y): &Place| {
                others().map(|(other_x, other_y)| (other_x - x).hypot(other_y - y)).fold(f64::INFINITY, f64::min)
            };
            // How many corners of the number are off the rim, then how far it is from other lines.
            let on_map = |(x, y): &Place| {
                let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                let valued = |room: f64| {
                    let at = |(right, down): &(f64, f64)| (x + right * (half[0] + room), y + down * (half[1] + room));
                    corners.iter().filter(|corner| is_valued(at(corner))).count()
                };
                valued(0.0) + valued(OFF_RIM)
            };
            let places = places.windows(2).flat_map(|pair| {
                let middle = (0.5 * (pair[0].0 + pair[1].0), 0.5 * (pair[0].1 + pair[1].1));
                [pair[0], middle]
            });
            let free = places.filter(is_free).map(|place| (on_map(&place), to_others(&place), place));
            let best = free.max_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
            let Some((_, _, found)) = best else { continue };
            taken.push(found);
            written.push(LineNumber { text: text.clone(), place: found });
        }
    }
    written
}

#[cfg(test)]
mod tests {
    use super::{LineNumber, all_numbered};

    /// Lines at so many values, of which only the first three find room for their numbers.
    fn crowded(ticks: usize) -> (Vec<super::NumberedLine>, Vec<LineNumber>) {
        let lines = (0..ticks).map(|at| (vec![[0.0, at as f64], [1.0, at as f64]], at.to_string())).collect();
        let number = |at: usize| LineNumber { text: at.to_string(), place: (0.0, 0.0) };
        (lines, (0..ticks.min(3)).map(number).collect())
    }

    #[test]
    fn lines_are_as_many_as_have_their_numbers() {
        assert_eq!(all_numbered(9, crowded).0.len(), 3);
        assert_eq!(all_numbered(2, crowded).0.len(), 2);
        // Where no number has room, the fewest lines are drawn.
        let none = |ticks: usize| (crowded(ticks).0, Vec::new());
        assert_eq!(all_numbered(4, none).0.len(), 3);
    }
}
