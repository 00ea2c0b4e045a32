//! A box with axes round it.

use std::ops::RangeInclusive;

use plotters::prelude::DrawingBackend;

use super::canvas::{Anchor, Canvas, FigureError, LINE, Place, TEXT};
use super::colour::INK;
use super::ticks::ticks;

/// Length of a tick, pixels.
const TICK: f64 = 10.0;
/// Room between a tick and its label, pixels.
const GAP: f64 = 6.0;
/// Pixels along an axis for one tick, at least.
pub const PER_TICK: [f64; 2] = [100.0, 70.0];

/// A rectangle of the page, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Left and right end.
    pub x: [f64; 2],
    /// Upper and lower end.
    pub y: [f64; 2],
}

impl Frame {
    /// Its width.
    pub fn width(&self) -> f64 {
        self.x[1] - self.x[0]
    }

    /// Its height.
    pub fn height(&self) -> f64 {
        self.y[1] - self.y[0]
    }

    /// Its corners, round it.
    pub fn corners(&self) -> [Place; 4] {
        let ([left, right], [top, bottom]) = (self.x, self.y);
        [(left, top), (right, top), (right, bottom), (left, bottom)]
    }
}

/// What an axis says.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Values at its ends.
    pub range: RangeInclusive<f64>,
    /// What it measures, with the unit.
    pub label: String,
    /// Whether ticks have numbers; an axis that shares those of its neighbour has none.
    pub numbered: bool,
}

/// A box with an axis below and one to the left.
#[derive(Debug, Clone)]
pub struct Axes {
    /// The box.
    pub frame: Frame,
    /// The axis below.
    pub x: Axis,
    /// The axis to the left.
    pub y: Axis,
}

impl Axes {
    /// Place of a pair of values, which need not be in the box.
    pub fn place(&self, x: f64, y: f64) -> Place {
        let part = |value: f64, range: &RangeInclusive<f64>| (value - range.start()) / (range.end() - range.start());
        let ([left, _], [_, bottom]) = (self.frame.x, self.frame.y);
        (left + part(x, &self.x.range) * self.frame.width(), bottom - part(y, &self.y.range) * self.frame.height())
    }

    /// Place of a pair of values, moved into the box.
    pub fn place_within(&self, x: f64, y: f64) -> Place {
        self.place(
            x.clamp(*self.x.range.start(), *self.x.range.end()),
            y.clamp(*self.y.range.start(), *self.y.range.end()),
        )
    }

    /// Draws box, ticks, numbers and labels.
    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), FigureError> {
        let ([left, _], [_, bottom]) = (self.frame.x, self.frame.y);
        let mut corners = self.frame.corners().to_vec();
        corners.push(corners[0]);
        canvas.line(&corners, INK, LINE)?;
        for (value, label) in ticks(&self.x.range, most_ticks(self.frame.width(), PER_TICK[0])) {
            let (x, _) = self.place(value, 0.0);
            canvas.line(&[(x, bottom), (x, bottom + TICK)], INK, LINE)?;
            if self.x.numbered {
                canvas.text(&label, (x, bottom + TICK + GAP), Anchor::Below, TEXT)?;
            }
        }
        let mut widest = 0.0_f64;
        for (value, label) in ticks(&self.y.range, most_ticks(self.frame.height(), PER_TICK[1])) {
            let (_, y) = self.place(0.0, value);
            canvas.line(&[(left - TICK, y), (left, y)], INK, LINE)?;
            if self.y.numbered {
                canvas.text(&label, (left - TICK - GAP, y), Anchor::Left, TEXT)?;
                widest = widest.max(canvas.text_width(&label, TEXT));
            }
        }
        let letter = f64::from(TEXT);
        let middle = [0.5 * (self.frame.x[0] + self.frame.x[1]), 0.5 * (self.frame.y[0] + self.frame.y[1])];
        canvas.text(&self.x.label, (middle[0], bottom + TICK + 2.0 * GAP + letter), Anchor::Below, TEXT)?;
        let beside = left - TICK - 3.0 * GAP - widest;
        canvas.upward_text(&self.y.label, (beside, middle[1]), TEXT)
    }
}

/// Ticks that have room.
pub fn most_ticks(length: f64, per_tick: f64) -> usize {
    ((length / per_tick) as usize + 1).max(2)
}
