//! The colour bar of a map.

use plotters::prelude::DrawingBackend;

use super::axes::{Axis, Frame, closest_ticks_upward, most_ticks_upward};
use super::canvas::{Anchor, Canvas, FigureError, LINE, TEXT};
use super::font::text_width;
use super::picture::Picture;
use crate::colour::{COLOURS, ColourMap, INK};

/// With fewer numbers colours cannot be read in between.
const LEAST_TICKS: usize = 3;

/// A bar with the values of its colours to the right.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourBar {
    /// The bar.
    pub frame: Frame,
    /// Values from the first to the last colour, and what they measure.
    pub axis: Axis,
    /// The colours.
    pub colours: ColourMap,
}

impl ColourBar {
    /// A bar with the usual colours.
    pub fn new(frame: Frame, axis: Axis) -> Self {
        Self { frame, axis, colours: ColourMap::default() }
    }

    /// The colours, the last one on top.
    pub fn strip(&self) -> Picture {
        let indices = (0..COLOURS).rev().map(|colour| colour as u8).collect();
        Picture { columns: 1, rows: COLOURS, indices, palette: self.colours.colours() }
    }

    /// Places of ticks and what they say: closer to each other where they would be too few.
    fn ticks(&self) -> Vec<(f64, String)> {
        let height = self.frame.height();
        let ticks = self.axis.ticks(most_ticks_upward(height));
        if ticks.len() >= LEAST_TICKS {
            return ticks;
        }
        let closer = self.axis.ticks(closest_ticks_upward(height));
        if closer.len() > ticks.len() { closer } else { ticks }
    }

    /// Draws all but the strip. The bar ends in points: what is beyond has the colour of its end. Nothing is below a bar that begins
    /// at 0, for what has such a bar is never negative.
    pub fn draw_scale<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), FigureError> {
        let Frame { x: [left, right], y: [top, bottom] } = self.frame;
        let (middle, point) = (0.5 * (left + right), 0.7 * self.frame.width());
        let below = if self.axis.part(0.0) == 0.0 { bottom } else { bottom + point };
        for (end, tip, value) in [(top, top - point, 1.0), (bottom, below, 0.0)] {
            if tip != end {
                canvas.area(&[(left, end), (middle, tip), (right, end)], self.colours.colour(value))?;
            }
        }
        let outline = [
            (left, top),
            (middle, top - point),
            (right, top),
            (right, bottom),
            (middle, below),
            (left, bottom),
            (left, top),
        ];
        canvas.line(&outline, INK, LINE)?;
        let mut widest = 0.0_f64;
        for (value, label) in self.ticks() {
            let y = bottom - self.axis.part(value) * self.frame.height();
            canvas.line(&[(right, y), (right + 8.0, y)], INK, LINE)?;
            canvas.text(&label, (right + 16.0, y), Anchor::Right, TEXT)?;
            widest = widest.max(text_width(&label, TEXT));
        }
        let beside = right + 16.0 + widest + 14.0 + f64::from(TEXT);
        canvas.text(&self.axis.label, (beside, 0.5 * (top + bottom)), Anchor::Upward, TEXT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_bar_has_more_than_its_ends() {
        let labels = |range| {
            let frame = Frame { x: [0.0, 40.0], y: [0.0, 260.0] };
            let bar = ColourBar::new(frame, Axis::linear(range, "pressure, MPa"));
            bar.ticks().into_iter().map(|(_, label)| label).collect::<Vec<_>>()
        };
        // Steps of 2 stand 61 pixels from each other here, letters are 33 high; steps of 5 would leave 0 and 5.
        assert_eq!(labels(0.0..=8.5), ["0", "2", "4", "6", "8"]);
        // Where there are enough they stay as far from each other as those of other axes.
        assert_eq!(labels(0.0..=14.5), ["0", "5", "10"]);
    }
}
