//! One map on its page: what is written above it, and its windows below each other.

use plateau_core::model::mesh::Mesh;
use plotters::style::RGBColor;

use super::shape::{Shape, Window};
use crate::figure::axes::{Axes, Axis, Frame};
use crate::figure::canvas::{Anchor, TEXT};
use crate::figure::font::{lines, shortened, text_width};
use crate::figure::page::{Content, LINE_OF_TEXT, Page, Panel};

/// Height of a box, at least, and at most: a map that has the page for itself is not larger than one of two beside each other.
const LEAST_HEIGHT: f64 = 64.0;
const MOST_HEIGHT: f64 = 900.0;
/// Distance of the windows of one map below each other.
const BELOW: f64 = 14.0;

/// A map of one body at one moment.
#[derive(Debug, Clone)]
pub struct MapSection<'a> {
    /// What it is, in a few words.
    pub title: String,
    /// What else is to know of it, on a line of its own; may be empty.
    pub remark: String,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// How the body is shown.
    pub shape: Shape,
    /// Number of the colour of every cell, column by column.
    pub cells: Vec<u8>,
}

/// How maps are fitted into a page.
#[derive(Debug, Clone, Copy)]
pub struct Fit {
    /// How much longer the windows of unrolled maps are than they mostly are.
    pub stretch: f64,
    /// The part of the width that there is for a map that it takes.
    pub size: f64,
}

/// Where a map lies on its page.
pub struct Placed {
    /// The lower right corner of its last box.
    pub box_end: [f64; 2],
    /// Where its text ends, from the top of the page.
    pub end: f64,
}

impl MapSection<'_> {
    /// What is written above a map with so much room for it and its axis.
    pub fn words(&self, width: f64) -> Vec<String> {
        let room = width - Axis::linear(self.shape.y_range(self.mesh), self.shape.y_label()).room_beside(width);
        let texts = [&self.title, &self.remark].into_iter().filter(|text| !text.is_empty());
        texts.flat_map(|text| wrapped(text, room)).collect()
    }

    /// Puts the map on the page with its upper left corner there, below so many lines of text.
    pub fn place(
        &self,
        page: &mut Page,
        [left, top]: [f64; 2],
        width: f64,
        fit: Fit,
        palette: &[RGBColor],
        lines: usize,
    ) -> Placed {
        let columns = self.cells.len() / self.mesh.rows();
        let y_range = self.shape.y_range(self.mesh);
        let y = Axis::linear(y_range.clone(), self.shape.y_label());
        let windows = self.shape.windows(self.mesh, columns, fit.stretch);
        let proportion = |window: &Window| (y_range.end() - y_range.start()) / (window.x.end() - window.x.start());
        let height = |window: &Window, inner: f64| {
            (inner * proportion(window)).clamp(LEAST_HEIGHT, inner.min(MOST_HEIGHT)).round()
        };
        // A higher box has more numbers, which may be longer.
        let room = windows.iter().map(|window| y.room_beside(height(window, width))).fold(0.0, f64::max);
        let begin = left + room;
        let space = (width - room).floor();
        let inner = (space * fit.size).floor();
        let mut y_top = top;
        for text in self.words(width) {
            page.write(shortened(&text, TEXT, space), (begin, y_top), Anchor::BelowRight, TEXT);
            y_top += LINE_OF_TEXT;
        }
        y_top = (top + LINE_OF_TEXT * lines as f64 + 8.0).round();
        let first = y_top;
        let last = windows.len() - 1;
        let mut box_end = [begin, y_top];
        for (number, window) in windows.into_iter().enumerate() {
            let height = height(&window, inner);
            // A body that is as tall as boxes may be stays in proportion.
            let wide = inner.min(inner.min(MOST_HEIGHT) / proportion(&window)).max(LEAST_HEIGHT).round();
            let frame = Frame { x: [begin.round(), begin.round() + wide], y: [y_top, y_top + height] };
            let frame_end = frame.x[1];
            let label = if number == last { self.shape.x_label(wide) } else { String::new() };
            let x = Axis::linear(window.x.clone(), label);
            let y = Axis { label: String::new(), ..y.clone() };
            let picture =
                self.shape.picture(self.mesh, &window, &self.cells, palette, [wide as usize, height as usize]);
            let below = x.room_below();
            // What the axis measures may be wider than the map.
            let words_end = 0.5 * (begin.round() + frame_end + text_width(&x.label, TEXT));
            page.panels.push(Panel { axes: Axes { frame, x, y }, contents: vec![Content::Map(picture)] });
            box_end = [box_end[0].max(frame_end).max(words_end), y_top + height];
            y_top = box_end[1] + below + BELOW;
        }
        let beside = left + 1.1 * f64::from(TEXT);
        page.write(self.shape.y_label(), (beside, 0.5 * (first + box_end[1])), Anchor::Upward, TEXT);
        Placed { box_end, end: y_top }
    }
}

/// A text in lines of at most this width, broken behind commas.
fn wrapped(text: &str, room: f64) -> Vec<String> {
    lines(text.split_inclusive(", "), TEXT, room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_above_a_map_stand_in_several_lines() {
        assert_eq!(wrapped("disc, 0 s", 400.0), ["disc, 0 s"]);
        let lines = wrapped("none 21.7, primary 29.8, secondary 48.5 %", 400.0);
        assert_eq!(lines, ["none 21.7, primary 29.8,", "secondary 48.5 %"]);
    }
}
