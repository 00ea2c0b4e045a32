//! Charts: their boxes beside and below each other, and what their colours mean.

use std::ops::{Range, RangeInclusive};

use plotters::style::RGBColor;

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, TEXT};
use super::font::{lines, shortened, text_width};
use super::page::{Content, Key, KeyStyle, LINE_OF_TEXT, Page, Panel};
use super::stroke::Stroke;
use crate::colour::INK;

/// Width of a figure of one column and of two columns of a journal, pixels: 88 mm and 180 mm.
pub const COLUMN: f64 = 1056.0;
pub const TWO_COLUMNS: f64 = 2160.0;
/// Room round the page, pixels.
pub const MARGIN: f64 = 24.0;
/// Room between boxes, pixels.
const BETWEEN: f64 = 48.0;
/// Room between what colours mean and what is written above a box, pixels: else they are one text for the eye.
pub const LEGEND: f64 = 22.0;
/// Width of the sample of a colour, pixels.
const KEY: f64 = 60.0;

/// One box of a chart, before it has a place.
#[derive(Debug, Clone)]
pub struct Chart {
    /// What it shows, above it; may be empty.
    pub title: String,
    /// The axis below.
    pub x: Axis,
    /// The axis to the left.
    pub y: Axis,
    /// What is in it.
    pub contents: Vec<Content>,
}

/// One colour and what it means.
#[derive(Debug, Clone)]
pub struct Meaning {
    /// The colour.
    pub colour: RGBColor,
    /// How it is shown.
    pub style: KeyStyle,
    /// What it means.
    pub text: String,
}

impl Meaning {
    /// That of a run's lines.
    pub fn of_run(number: usize, label: &str) -> Self {
        Self::of_line(Stroke::of(number, 1), label)
    }

    /// What is said of all lines, without a sample: none of them looks like it.
    pub fn in_words(text: &str) -> Self {
        Self { colour: INK, style: KeyStyle::Words, text: text.to_owned() }
    }

    /// That of a line.
    pub fn of_line(stroke: Stroke, text: &str) -> Self {
        Self { colour: stroke.colour, style: KeyStyle::Line(stroke.dashes), text: text.to_owned() }
    }
}

/// Charts in rows of so many, each box so high, below a legend; all of the page's width.
pub fn page(width: f64, height: f64, across: usize, charts: Vec<Chart>, meanings: &[Meaning]) -> Page {
    let across = across.max(1);
    let mut rows: Vec<Vec<Chart>> = Vec::new();
    for (at, chart) in charts.into_iter().enumerate() {
        match rows.last_mut() {
            Some(row) if at % across > 0 => row.push(chart),
            _ => rows.push(vec![chart]),
        }
    }
    page_of_rows(width, height, &rows, 0..rows.len(), meanings)
}

/// The same with some of these rows, any of which may be shorter than the first. All pages with some of them have the same columns.
pub fn page_of_rows(width: f64, height: f64, rows: &[Vec<Chart>], shown: Range<usize>, meanings: &[Meaning]) -> Page {
    let across = rows.first().map_or(1, Vec::len).max(1);
    let mut page = Page { size: [width, 0.0], ..Page::default() };
    let mut top = legend(&mut page, meanings, MARGIN);
    // A column of boxes begins at one place, whichever of them has the widest numbers.
    let room = |column: usize| {
        let charts = rows.iter().filter_map(|row| row.get(column));
        charts.map(|chart| chart.y.room_beside(height)).fold(0.0, f64::max)
    };
    let rooms: Vec<f64> = (0..across).map(room).collect();
    let taken = rooms.iter().sum::<f64>() + BETWEEN * across as f64 + 2.0 * MARGIN;
    let box_width = ((width - taken) / across as f64).floor();
    for row in &rows[shown] {
        let titles: Vec<Vec<String>> = row.iter().map(|chart| title_lines(&chart.title, TEXT, box_width)).collect();
        let most_lines = titles.iter().map(Vec::len).max().unwrap_or(0);
        let titled = most_lines > 0;
        top += if titled { LINE_OF_TEXT * most_lines as f64 + 12.0 } else { 16.0 };
        if titled && !meanings.is_empty() && page.panels.is_empty() {
            top += LEGEND;
        }
        let mut left = MARGIN;
        let mut below = 0.0_f64;
        for ((chart, room), title) in row.iter().zip(&rooms).zip(titles) {
            left += room;
            let frame = Frame { x: [left, left + box_width], y: [top, top + height] };
            let count = title.len() as f64;
            for (number, line) in title.into_iter().enumerate() {
                let above = LINE_OF_TEXT * (count - number as f64) + 4.0;
                page.write(line, (left, top - above), Anchor::BelowRight, TEXT);
            }
            below = below.max(chart.x.room_below());
            let axes = Axes { frame, x: chart.x.clone(), y: chart.y.clone() };
            page.panels.push(Panel { axes, contents: chart.contents.clone() });
            left += box_width + BETWEEN;
        }
        top += height + below + 12.0;
    }
    page.size[1] = (top + MARGIN).ceil();
    page
}

/// A title in letters of this size, in two lines at most.
pub fn title_lines(title: &str, size: u32, room: f64) -> Vec<String> {
    if title.is_empty() {
        return Vec::new();
    }
    // Broken behind a comma if that can be, else between words.
    let ways = [", ", " "].map(|end| lines(title.split_inclusive(end), size, room));
    let fits = |lines: &Vec<String>| lines.len() <= 2 && lines.iter().all(|line| text_width(line, size) <= room);
    ways.into_iter().find(fits).unwrap_or_else(|| vec![shortened(title, size, room)])
}

/// Writes what colours mean, from the top down, as many beside each other as there is room for; gives the place below.
pub fn legend(page: &mut Page, meanings: &[Meaning], top: f64) -> f64 {
    let most = page.size[0] - 2.0 * MARGIN;
    let (mut x, mut y) = (MARGIN, top);
    for Meaning { colour, style, text } in meanings {
        let key = match style {
            KeyStyle::Line(_) => KEY + 16.0,
            KeyStyle::Area => 0.6 * KEY + 16.0,
            KeyStyle::Words => 0.0,
        };
        let text = shortened(text, TEXT, most - key);
        let width = key + text_width(&text, TEXT);
        if x > MARGIN && x + width > page.size[0] - MARGIN {
            (x, y) = (MARGIN, y + LINE_OF_TEXT);
        }
        let middle = y + 0.5 * LINE_OF_TEXT;
        if *style != KeyStyle::Words {
            let frame = Frame { x: [x, x + key - 16.0], y: [middle - 13.0, middle + 13.0] };
            page.keys.push(Key { frame, colour: *colour, style: *style });
        }
        page.write(text, (x + key, middle), Anchor::Right, TEXT);
        x += width + 48.0;
    }
    if meanings.is_empty() { y } else { y + LINE_OF_TEXT + 16.0 }
}

/// From 0 to a little more than the largest value; to 1 where all values are 0.
pub fn up_from_zero(largest: f64) -> RangeInclusive<f64> {
    0.0..=if largest > 0.0 { 1.04 * largest } else { 1.0 }
}

/// From a little below the least to a little above the greatest of those values that are numbers, with a little width where
/// all are equal; from 0 to 1 where none is.
pub fn around<'a>(values: impl IntoIterator<Item = &'a f64>) -> RangeInclusive<f64> {
    let numbers = values.into_iter().copied().filter(|value| value.is_finite());
    let (low, high) =
        numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return 0.0..=1.0;
    }
    // What rounding makes of equal values is no range.
    let size = low.abs().max(high.abs());
    let margin = if high - low > 1e-9 * size { 0.05 * (high - low) } else { 0.05 * size.max(1e-3) };
    low - margin..=high + margin
}

#[cfg(test)]
mod tests {
    use super::around;

    #[test]
    fn axes_reach_a_little_beyond_the_values() {
        let ends = |values: &[f64]| (*around(values).start(), *around(values).end());
        assert_eq!(ends(&[30.0, f64::NAN, 10.0]), (9.0, 31.0));
        let (low, high) = ends(&[20.0, 20.0 + 1e-12]);
        assert!((low - 19.0).abs() < 1e-9 && (high - 21.0).abs() < 1e-9);
        assert_eq!(ends(&[f64::NAN]), (0.0, 1.0));
        let (low, high) = ends(&[0.0]);
        assert!(low < 0.0 && high > 0.0);
    }
}
