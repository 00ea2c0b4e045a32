//! One map on its page: what is written above it, and its windows below each other.

use plateau_core::model::mesh::Mesh;
use plateau_io::number;
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

/// A map that is stretched by less than this is in proportion for the eye.
const STRETCHED: f64 = 1.05;

/// How maps are fitted into a page.
#[derive(Debug, Clone, Copy)]
pub struct Fit {
    /// How much longer the windows of unrolled maps are than they mostly are.
    pub stretch: f64,
    /// The part of the width that there is for a map that it takes.
    pub size: f64,
    /// Which words say what the axes below measure: the same for all maps of a page.
    pub words: usize,
    /// Whether maps are painted, or boxes are laid out for them alone.
    pub paints: bool,
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

    /// What the axes below and to the left say: also, where the radius is drawn so many times as long as the arc, how many times. The axis to
    /// the left says it if it is so `tall` that there is room, else the one below if it is so `wide`, else a line of its own, which is last.
    fn labels(&self, words: usize, stretch: f64, tall: f64, wide: f64) -> [String; 3] {
        let (x, y) = (self.shape.x_label(words), self.shape.y_label());
        if stretch < STRETCHED {
            return [x.to_owned(), y.to_owned(), String::new()];
        }
        let stretched = format!("stretched {}\u{d7}", number::rounded(stretch, 2));
        let upward = format!("{y} ({stretched})");
        if text_width(&upward, TEXT) <= tall {
            return [x.to_owned(), upward, String::new()];
        }
        let sideways = x.replacen("mm", &format!("mm (radius {stretched})"), 1);
        if text_width(&sideways, TEXT) <= wide {
            return [sideways, y.to_owned(), String::new()];
        }
        [x.to_owned(), y.to_owned(), format!("radius {stretched}")]
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
            (inner * proportion(window)).min(inner.min(MOST_HEIGHT)).max(LEAST_HEIGHT).round()
        };
        // A higher box has more numbers, which may be longer.
        let room = windows.iter().map(|window| y.room_beside(height(window, width))).fold(0.0, f64::max);
        let begin = left + room;
        let space = (width - room).floor();
        let inner = (space * fit.size).floor();
        // A body that is as tall as boxes may be stays in proportion.
        let wide = |window: &Window| inner.min(inner.min(MOST_HEIGHT) / proportion(window)).max(LEAST_HEIGHT).round();
        let heights = || windows.iter().map(|window| height(window, inner));
        let stretches =
            windows.iter().zip(heights()).map(|(window, height)| height / (wide(window) * proportion(window)));
        let stretch = stretches.fold(1.0, f64::max);
        let between = BELOW + Axis::linear(y_range.clone(), "").room_below();
        let tall = heights().sum::<f64>() + between * (windows.len() - 1) as f64;
        let [x_label, y_label, below] = self.labels(fit.words, stretch, tall, inner);
        let mut y_top = top;
        for text in self.words(width) {
            page.write(shortened(&text, TEXT, space), (begin, y_top), Anchor::BelowRight, TEXT);
            y_top += LINE_OF_TEXT;
        }
        y_top = (top + LINE_OF_TEXT * lines as f64 + 8.0).round();
        let first = y_top;
        let last = windows.len() - 1;
        let mut box_end = [begin, y_top];
        for (number, window) in windows.iter().enumerate() {
            let height = height(window, inner);
            let wide = wide(window);
            let frame = Frame { x: [begin.round(), begin.round() + wide], y: [y_top, y_top + height] };
            let frame_end = frame.x[1];
            let label = if number == last { x_label.as_str() } else { "" };
            let x = Axis::linear(window.x.clone(), label);
            let y = Axis { label: String::new(), ..y.clone() };
            let size = [wide as usize, height as usize];
            let picture = fit.paints.then(|| self.shape.picture(self.mesh, window, &self.cells, palette, size));
            let below = x.room_below();
            // What the axis measures may be wider than the map.
            let words_end = 0.5 * (begin.round() + frame_end + text_width(&x.label, TEXT));
            page.panels
                .push(Panel { axes: Axes { frame, x, y }, contents: picture.into_iter().map(Content::Map).collect() });
            box_end = [box_end[0].max(frame_end).max(words_end), y_top + height];
            y_top = box_end[1] + below + BELOW;
        }
        for line in wrapped(&below, width) {
            page.write(line, (0.5 * (begin.round() + box_end[0]), y_top - BELOW), Anchor::Below, TEXT);
            y_top += LINE_OF_TEXT;
        }
        let beside = left + 1.1 * f64::from(TEXT);
        page.write(y_label, (beside, 0.5 * (first + box_end[1])), Anchor::Upward, TEXT);
        Placed { box_end, end: y_top }
    }
}

/// A text in lines of at most this width, broken behind commas, and between words where that is not enough.
fn wrapped(text: &str, room: f64) -> Vec<String> {
    let parts = lines(text.split_inclusive(", "), TEXT, room);
    parts.iter().flat_map(|part| lines(part.split_inclusive(' '), TEXT, room)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_above_a_map_stand_in_several_lines() {
        assert_eq!(wrapped("disc, 0 s", 400.0), ["disc, 0 s"]);
        assert_eq!(wrapped("from its mean, z = 5.57 \u{b5}m", 200.0), ["from its", "mean,", "z = 5.57", "\u{b5}m"]);
        let lines = wrapped("none 21.7, primary 29.8, secondary 48.5 %", 500.0);
        assert_eq!(lines, ["none 21.7, primary 29.8,", "secondary 48.5 %"]);
    }

    #[test]
    fn the_axis_of_a_stretched_map_says_so() {
        // A ring of 1 mm, 129 mm long: six windows of 21.5 mm, and a pin of 7.5 mm.
        let mesh = Mesh::new(20, 690, 40, 20e-3, 21e-3).unwrap();
        let labels = |columns: usize, width: f64| {
            let section = MapSection {
                title: String::new(),
                remark: String::new(),
                mesh: &mesh,
                shape: Shape::Unrolled,
                cells: vec![0; columns * mesh.rows()],
            };
            let mut page = Page::default();
            let palette = [RGBColor(0, 0, 0), RGBColor(255, 255, 255)];
            section.place(
                &mut page,
                [0.0; 2],
                width,
                Fit { stretch: 1.0, size: 1.0, words: 2, paints: true },
                &palette,
                0,
            );
            let axes = &page.panels.last().unwrap().axes;
            // How many pixels a millimetre has along the radius, over how many along the arc.
            let per_mm = |length: f64, axis: &Axis| length / (axis.range.end() - axis.range.start());
            let stretch = per_mm(axes.frame.height(), &axes.y) / per_mm(axes.frame.width(), &axes.x);
            let texts: Vec<&str> = [&axes.x.label]
                .into_iter()
                .chain(page.texts.iter().map(|words| &words.text))
                .map(String::as_str)
                .collect();
            (texts.join("|"), stretch)
        };
        let (said, stretch) = labels(690, 1800.0);
        assert_eq!(said, "arc length, mm|radius, mm");
        assert!((stretch - 1.0).abs() < 0.02, "{stretch}");
        let (said, stretch) = labels(690, 600.0);
        assert!(stretch > 2.0, "{stretch}");
        assert_eq!(said, format!("arc length, mm|radius, mm (stretched {stretch:.1}\u{d7})"));
        // A single low window has no room for it on the left, and a short one none in the label below.
        let (said, stretch) = labels(40, 300.0);
        assert!(stretch > 1.5, "{stretch}");
        assert_eq!(said, format!("arc length, mm|radius stretched|{stretch:.1}\u{d7}|radius, mm"));
    }
}
