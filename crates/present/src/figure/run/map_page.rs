//! A page of maps: bodies below each other, moments or runs beside each other, with the colour bars they share.

use plotters::style::RGBColor;

use super::map_section::{Fit, MapSection};
use crate::figure::axes::{Axis, Frame};
use crate::figure::canvas::{Anchor, TEXT, TITLE};
use crate::figure::chart::{LEGEND, MARGIN, Meaning, legend, title_lines};
use crate::figure::colour_bar::ColourBar;
use crate::figure::font::text_width;
use crate::figure::page::{LINE_OF_TEXT, Page};

/// Room on the right for a colour bar with numbers and label, pixels.
pub const BAR_ROOM: f64 = 280.0;
/// Width of a colour bar, and its distance from the maps.
const BAR: f64 = 40.0;
pub(super) const BESIDE: f64 = 36.0;
/// Length of a colour bar, pixels.
const SHORTEST_BAR: f64 = 260.0;
const LONGEST_BAR: f64 = 900.0;
/// Height of a line of a name, pixels.
const LINE_OF_NAME: f64 = 1.25 * TITLE as f64;
/// Distance of maps beside each other.
const BETWEEN: f64 = 40.0;

/// Maps that share a colour scale, in rows; a place may be empty.
#[derive(Debug, Clone, Default)]
pub struct MapGroup<'a> {
    /// The rows, from the top.
    pub rows: Vec<Vec<Option<MapSection<'a>>>>,
    /// The colours; the last one is that of what is no cell.
    pub palette: Vec<RGBColor>,
    /// The scale of the colours, if they are those of a range.
    pub scale: Option<Axis>,
}

/// The maps of a few runs beside each other, at a few moments.
#[derive(Debug, Clone, Default)]
pub struct MapBlock<'a> {
    /// What the runs are called.
    pub names: Vec<String>,
    /// Their maps.
    pub groups: Vec<MapGroup<'a>>,
}

/// What all pages of a figure have in common.
#[derive(Debug, Clone, Copy)]
pub struct Sheet<'a> {
    /// Width, pixels.
    pub width: f64,
    /// What colours mean.
    pub meanings: &'a [Meaning],
    /// Runs beside each other, at most: all runs have boxes of one size, also those of the last row.
    pub across: usize,
    /// Whether the figure is of several runs, also where a page has one of them.
    pub several: bool,
}

impl Sheet<'_> {
    /// The page with these maps, fitted in this way.
    pub fn page(&self, blocks: &[MapBlock], fit: Fit) -> Page {
        let mut page = Page { size: [self.width, 0.0], ..Page::default() };
        let scaled = blocks.iter().flat_map(|block| &block.groups).any(|group| group.scale.is_some());
        let width = self.width - MARGIN - if scaled { BAR_ROOM } else { MARGIN };
        // What colours mean stands below the name of the one run, but above the names of several.
        let mut top = MARGIN;
        let meanings_at = |page: &mut Page, top| {
            legend(page, self.meanings, top) + if self.meanings.is_empty() { 0.0 } else { LEGEND }
        };
        if self.several {
            top = meanings_at(&mut page, top);
        }
        let each = width / self.across as f64;
        let mut named: &[String] = &[];
        for block in blocks {
            // Further moments of the same runs stand below the first ones.
            if named != block.names {
                let mut most_lines = 1;
                for (column, name) in block.names.iter().enumerate() {
                    let lines = title_lines(name, TITLE, each - BETWEEN);
                    most_lines = most_lines.max(lines.len());
                    for (line, text) in lines.into_iter().enumerate() {
                        let place = (MARGIN + column as f64 * each, top + line as f64 * LINE_OF_NAME);
                        page.write(text, place, Anchor::BelowRight, TITLE);
                    }
                }
                top += 0.25 * f64::from(TITLE) + most_lines as f64 * LINE_OF_NAME;
                if !self.several {
                    top = meanings_at(&mut page, top);
                }
            }
            named = &block.names;
            let columns = self.several.then_some(Columns { runs: block.names.len().max(1), each });
            top = block.groups.iter().fold(top, |top, group| group.place(&mut page, top, width, fit, columns));
            top += MARGIN;
        }
        page.size[1] = top.ceil();
        page
    }
}

/// Columns of a page with several runs.
#[derive(Debug, Clone, Copy)]
struct Columns {
    /// How many runs stand beside each other here.
    runs: usize,
    /// Width of each, pixels.
    each: f64,
}

impl MapGroup<'_> {
    /// Puts the maps on the page, this far from its top and so wide; gives the place below. Where there are columns of runs, the maps of one
    /// stand below each other.
    fn place(&self, page: &mut Page, begin: f64, width: f64, fit: Fit, columns: Option<Columns>) -> f64 {
        let (mut top, mut last_box, mut right) = (begin, begin, MARGIN);
        let mut most_lines = 1;
        let rows =
            self.rows.iter().flat_map(|row| row.chunks(columns.map_or(row.len(), |columns| columns.runs).max(1)));
        for row in rows {
            let each = columns.map_or(width / row.len().max(1) as f64, |columns| columns.each);
            let mut lowest = top;
            // Maps beside each other begin at one height, however long what is written above them is.
            let lines = row.iter().flatten().map(|section| section.words(each - BETWEEN).len()).max().unwrap_or(0);
            most_lines = most_lines.max(lines);
            for (column, section) in row.iter().enumerate() {
                let Some(section) = section else { continue };
                let origin = [MARGIN + column as f64 * each, top];
                let placed = section.place(page, origin, each - BETWEEN, fit, &self.palette, lines);
                (lowest, last_box) = (lowest.max(placed.end), last_box.max(placed.box_end[1]));
                right = right.max(placed.box_end[0]);
            }
            top = lowest;
        }
        if let Some(axis) = &self.scale {
            let left = right.round() + BESIDE;
            // Room for the points at its ends. Beside a low map it begins beside what is written above that.
            let below = begin + most_lines as f64 * LINE_OF_TEXT + 36.0;
            let first = (last_box - 28.0 - SHORTEST_BAR).clamp(begin + 36.0, below);
            let end = (last_box - 28.0).clamp(first + SHORTEST_BAR, first + LONGEST_BAR);
            let frame = Frame { x: [left, left + BAR], y: [first, end].map(f64::round) };
            // What it measures may be longer than the bar.
            let label_end = 0.5 * (first + end + text_width(&axis.label, TEXT));
            page.colour_bars.push(ColourBar::new(frame, axis.clone()));
            top = top.max(end + 40.0).max(label_end);
        }
        top + 12.0
    }
}
