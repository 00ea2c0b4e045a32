//! The colour bar of a map.

use std::ops::RangeInclusive;

use plotters::prelude::DrawingBackend;

use super::axes::{Frame, PER_TICK, most_ticks};
use super::canvas::{Anchor, Canvas, FigureError, LINE, TEXT};
use super::colour::{INK, viridis};
use super::ticks::ticks;

/// A bar with the values of its colours to the right.
#[derive(Debug, Clone)]
pub struct ColourBar {
    /// The bar.
    pub frame: Frame,
    /// Values of the first and the last colour.
    pub range: RangeInclusive<f64>,
    /// What they measure, with the unit.
    pub label: String,
}

impl ColourBar {
    /// Draws bar, numbers and label. The bar ends in points: what is beyond has the colour of its end.
    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), FigureError> {
        let Frame { x: [left, right], y: [top, bottom] } = self.frame;
        let height = self.frame.height().max(1.0) as u32;
        let width = self.frame.width() as u32;
        let mut bytes = Vec::with_capacity(3 * width as usize * height as usize);
        for line in 0..height {
            let colour = viridis(1.0 - f64::from(line) / f64::from(height));
            (0..width).for_each(|_| bytes.extend([colour.0, colour.1, colour.2]));
        }
        canvas.bitmap((left, top), (width, height), bytes)?;
        let (middle, point) = (0.5 * (left + right), 0.7 * self.frame.width());
        for (end, tip, value) in [(top, top - point, 1.0), (bottom, bottom + point, 0.0)] {
            canvas.area(&[(left, end), (middle, tip), (right, end)], viridis(value))?;
        }
        let outline = [
            (left, top),
            (middle, top - point),
            (right, top),
            (right, bottom),
            (middle, bottom + point),
            (left, bottom),
            (left, top),
        ];
        canvas.line(&outline, INK, LINE)?;
        let mut widest = 0.0_f64;
        for (value, label) in ticks(&self.range, most_ticks(self.frame.height(), PER_TICK[1])) {
            let part = (value - self.range.start()) / (self.range.end() - self.range.start());
            let y = bottom - part * self.frame.height();
            canvas.line(&[(right, y), (right + 8.0, y)], INK, LINE)?;
            canvas.text(&label, (right + 16.0, y), Anchor::Right, TEXT)?;
            widest = widest.max(canvas.text_width(&label, TEXT));
        }
        let beside = right + 16.0 + widest + 14.0 + f64::from(TEXT);
        canvas.upward_text(&self.label, (beside, 0.5 * (top + bottom)), TEXT)
    }
}
