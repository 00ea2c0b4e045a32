//! How a line is drawn: its colour, its width and its dashes.

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;

use super::brush::Place;
use super::canvas::{Canvas, FigureError, LINE};
use crate::colour::{RUNS, paler};

/// Lengths of dashes and gaps by turns, pixels; none is a line without gaps.
pub type Dashes = &'static [f64];

/// Those of a line without gaps.
pub const SOLID: Dashes = &[];

/// Those of lines that belong together, in their order: told apart in grey, too.
const IN_ORDER: [Dashes; 8] = [
    SOLID,
    &[26.0, 14.0],
    &[7.0, 11.0],
    &[26.0, 10.0, 7.0, 10.0],
    &[46.0, 14.0],
    &[14.0, 9.0],
    &[26.0, 9.0, 7.0, 9.0, 7.0, 9.0],
    &[46.0, 10.0, 14.0, 10.0],
];

/// Colour of the first moment, as a part of the run's colour.
const PALE: f64 = 0.45;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: RGBColor,
    /// Its width, pixels.
    pub width: u32,
    /// Its dashes.
    pub dashes: Dashes,
}

impl Stroke {
    /// Without gaps.
    pub const fn solid(colour: RGBColor, width: u32) -> Self {
        Self { colour, width, dashes: SOLID }
    }

    /// That of a line among so many that are named by their colours and dashes. Those that are drawn first are wider, or equal lines
    /// would hide each other.
    pub fn of(number: usize, lines: usize) -> Self {
        let after = lines.saturating_sub(number + 1) as u32;
        let step = if lines > 4 { 1 } else { 2 };
        let dashes = IN_ORDER[number % IN_ORDER.len()];
        Self { colour: RUNS[number % RUNS.len()], width: LINE + 1 + step * after, dashes }
    }

    /// The same at the first moment, which is paler, or at the last.
    pub fn at(self, first: bool) -> Self {
        if first { self.paler() } else { self }
    }

    /// The same in a paler colour.
    pub fn paler(self) -> Self {
        Self { colour: paler(self.colour, PALE), ..self }
    }

    /// Draws a line through places.
    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, places: &[Place]) -> Result<(), FigureError> {
        if self.dashes.is_empty() {
            return canvas.line(places, self.colour, self.width);
        }
        cut(places, self.dashes).iter().try_for_each(|dash| canvas.line(dash, self.colour, self.width))
    }
}

/// The dashes of a line; the last one may be short.
fn cut(places: &[Place], dashes: &[f64]) -> Vec<Vec<Place>> {
    let mut lengths = dashes.iter().copied().cycle();
    let mut left = lengths.next().unwrap_or(f64::INFINITY);
    let (mut drawn, mut open) = (Vec::new(), places.first().map(|place| vec![*place]));
    for pair in places.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                break;
            }
            let part = left / length;
            from = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
            left = lengths.next().unwrap_or(f64::INFINITY);
            open = match open {
                Some(mut dash) => {
                    dash.push(from);
                    drawn.push(dash);
                    None
                }
                None => Some(vec![from]),
            };
        }
        if let Some(dash) = &mut open {
            dash.push(to);
        }
    }
    drawn.extend(open.filter(|dash| dash.len() > 1));
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_round_corners() {
        // By hand: dashes of 4 and gaps of 2 along 5 to the right and 6 down.
        let places = [(0.0, 0.0), (5.0, 0.0), (5.0, 6.0)];
        let expected = [vec![(0.0, 0.0), (4.0, 0.0)], vec![(5.0, 1.0), (5.0, 5.0)]];
        assert_eq!(cut(&places, &[4.0, 2.0]), expected);
        // A dash that goes on round the corner has it.
        assert_eq!(cut(&places, &[7.0, 9.0]), [vec![(0.0, 0.0), (5.0, 0.0), (5.0, 2.0)]]);
        assert_eq!(cut(&places[..1], &[7.0, 9.0]), [[(0.0, 0.0); 0]; 0]);
    }

    #[test]
    fn no_two_lines_look_alike() {
        let strokes: Vec<Stroke> = (0..8).map(|number| Stroke::of(number, 8)).collect();
        for (number, one) in strokes.iter().enumerate() {
            assert!(strokes[..number].iter().all(|other| other.dashes != one.dashes && other.colour != one.colour));
            assert!(strokes[..number].iter().all(|other| other.width > one.width));
        }
    }
}
