//! A box with axes round it.

use std::ops::RangeInclusive;

use plotters::prelude::DrawingBackend;

use super::brush::Place;
use super::canvas::{Anchor, Canvas, FigureError, LINE, TEXT};
use super::font::text_width;
use super::ticks::{logarithmic_ticks, minor_ticks, ticks};
use crate::colour::INK;

/// Length of a tick, pixels.
const TICK: f64 = 10.0;
/// Length of a tick without a number, pixels.
const MINOR_TICK: f64 = 5.0;
/// Room between a tick and its label, pixels.
const GAP: f64 = 6.0;
/// Pixels along an axis for one tick, at least.
const PER_TICK: [f64; 2] = [120.0, 70.0];
/// The same for an axis so short that ticks stand as close as their numbers can.
const LEAST_PER_TICK: f64 = 40.0;

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

/// How values lie along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences take equal lengths.
    Linear,
    /// Equal ratios take equal lengths; the range is positive.
    Logarithmic,
}

/// What an axis says.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Values at its ends.
    pub range: RangeInclusive<f64>,
    /// What it measures, with the unit.
    pub label: String,
    /// Whether ticks have numbers; an axis that shares those of its neighbour has none.
    pub numbered: bool,
    /// How values lie along it.
    pub scale: Scale,
    /// Places that have a tick and what it says, where that is not round numbers: levels, or names.
    pub marks: Option<Vec<(f64, String)>>,
}

impl Axis {
    /// An axis with numbers and equal differences.
    pub fn linear(range: RangeInclusive<f64>, label: impl Into<String>) -> Self {
        Self { range, label: label.into(), numbered: true, scale: Scale::Linear, marks: None }
    }

    /// An axis with numbers and equal ratios.
    pub fn logarithmic(range: RangeInclusive<f64>, label: impl Into<String>) -> Self {
        Self { scale: Scale::Logarithmic, ..Self::linear(range, label) }
    }

    /// The same without numbers and label, which a neighbour has.
    pub fn shared(self) -> Self {
        Self { numbered: false, label: String::new(), ..self }
    }

    /// Where a value lies: 0 at the begin of the range, 1 at its end.
    pub fn part(&self, value: f64) -> f64 {
        let (begin, end) = (*self.range.start(), *self.range.end());
        match self.scale {
            Scale::Linear => (value - begin) / (end - begin),
            Scale::Logarithmic => (value / begin).ln() / (end / begin).ln(),
        }
    }

    /// Places of ticks and what they say: those that are given, else at most `most` of them.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        match (&self.marks, self.scale) {
            (Some(marks), _) => marks.clone(),
            (None, Scale::Linear) => ticks(&self.range, most),
            (None, Scale::Logarithmic) => logarithmic_ticks(&self.range, most),
        }
    }

    /// Places of short ticks without numbers: 2 to 9 times the powers of ten of an axis of equal ratios, where they can be told apart.
    pub fn minor_ticks(&self) -> Vec<f64> {
        if self.scale == Scale::Linear || self.marks.is_some() { Vec::new() } else { minor_ticks(&self.range) }
    }

    /// Room that an axis of this length takes to the left of its box, with numbers and label, pixels.
    pub fn room_beside(&self, length: f64) -> f64 {
        let labels = if self.numbered { self.ticks(most_ticks_upward(length)) } else { Vec::new() };
        let widest = labels.iter().map(|(_, label)| text_width(label, TEXT)).fold(0.0, f64::max);
        let label = if self.label.is_empty() { 0.0 } else { 1.2 * f64::from(TEXT) };
        TICK + 3.0 * GAP + widest + label
    }

    /// Room that an axis takes below its box, pixels.
    pub fn room_below(&self) -> f64 {
        let letter = f64::from(TEXT);
        let label = if self.label.is_empty() { 0.0 } else { 1.2 * letter };
        TICK + 2.0 * GAP + label + if self.numbered { letter } else { 0.0 }
    }
}

/// A box with an axis below and one to the left.
#[derive(Debug, Clone, PartialEq)]
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
        let ([left, _], [_, bottom]) = (self.frame.x, self.frame.y);
        (left + self.x.part(x) * self.frame.width(), bottom - self.y.part(y) * self.frame.height())
    }

    /// The pair of values at a place.
    pub fn values(&self, (x, y): Place) -> [f64; 2] {
        let value = |axis: &Axis, part: f64| {
            let (begin, end) = (*axis.range.start(), *axis.range.end());
            match axis.scale {
                Scale::Linear => begin + part * (end - begin),
                Scale::Logarithmic => begin * (part * (end / begin).ln()).exp(),
            }
        };
        let ([left, _], [_, bottom]) = (self.frame.x, self.frame.y);
        [value(&self.x, (x - left) / self.frame.width()), value(&self.y, (bottom - y) / self.frame.height())]
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
        for (value, label) in self.x.ticks(most_ticks(self.frame.width())) {
            let x = left + self.x.part(value) * self.frame.width();
            canvas.line(&[(x, bottom), (x, bottom + TICK)], INK, LINE)?;
            if self.x.numbered {
                canvas.text(&label, (x, bottom + TICK + GAP), Anchor::Below, TEXT)?;
            }
        }
        for value in self.x.minor_ticks() {
            let x = left + self.x.part(value) * self.frame.width();
            canvas.line(&[(x, bottom), (x, bottom + MINOR_TICK)], INK, LINE)?;
        }
        for value in self.y.minor_ticks() {
            let y = bottom - self.y.part(value) * self.frame.height();
            canvas.line(&[(left - MINOR_TICK, y), (left, y)], INK, LINE)?;
        }
        let mut widest = 0.0_f64;
        for (value, label) in self.y.ticks(most_ticks_upward(self.frame.height())) {
            let y = bottom - self.y.part(value) * self.frame.height();
            canvas.line(&[(left - TICK, y), (left, y)], INK, LINE)?;
            if self.y.numbered {
                canvas.text(&label, (left - TICK - GAP, y), Anchor::Left, TEXT)?;
                widest = widest.max(text_width(&label, TEXT));
            }
        }
        let letter = f64::from(TEXT);
        let middle = [0.5 * (self.frame.x[0] + self.frame.x[1]), 0.5 * (self.frame.y[0] + self.frame.y[1])];
        let below = bottom + TICK + GAP + if self.x.numbered { GAP + letter } else { 0.0 };
        canvas.text(&self.x.label, (middle[0], below), Anchor::Below, TEXT)?;
        let beside = left - TICK - 3.0 * GAP - widest;
        canvas.text(&self.y.label, (beside, middle[1]), Anchor::Upward, TEXT)
    }
}

/// Ticks that have room on an axis from left to right.
fn most_ticks(length: f64) -> usize {
    ((length / PER_TICK[0]) as usize + 1).max(2)
}

/// Ticks that have room on an axis from below upward where they stand as close as their numbers can.
pub fn closest_ticks_upward(length: f64) -> usize {
    (length / LEAST_PER_TICK) as usize + 1
}

/// Ticks that have room on an axis from below upward.
pub fn most_ticks_upward(length: f64) -> usize {
    let each = PER_TICK[1].min(0.5 * length).max(LEAST_PER_TICK);
    ((length / each) as usize + 1).max(2)
}
