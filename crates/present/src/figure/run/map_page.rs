//! A page of maps: bodies below each other, moments or runs beside each other, with the colour bars they share.

use plateau_core::model::mesh::Mesh;
use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;
use plotters::style::RGBColor;

use super::shape::{Shape, Window};
use super::{Figures, Subject};
use crate::figure::axes::{Axes, Axis, Frame};
use crate::figure::canvas::{Anchor, TEXT, TITLE};
use crate::figure::chart::{MARGIN, Meaning, TWO_COLUMNS, legend};
use crate::figure::colour_bar::ColourBar;
use crate::figure::font::{shortened, text_width};
use crate::figure::page::{Content, LINE_OF_TEXT, Page, Panel};

/// Maps beside each other, at most.
pub const MOST_ACROSS: usize = 3;
/// Room on the right for a colour bar with numbers and label, pixels.
const BAR_ROOM: f64 = 250.0;
/// Width of a colour bar, and its distance from the maps.
const BAR: f64 = 40.0;
const BESIDE: f64 = 36.0;
/// Length of a colour bar, pixels.
const SHORTEST_BAR: f64 = 260.0;
const LONGEST_BAR: f64 = 900.0;
/// Height of a box, at least.
const LEAST_HEIGHT: f64 = 64.0;
/// Distance of maps beside each other, and of windows of one map below each other.
const BETWEEN: f64 = 40.0;
const BELOW: f64 = 14.0;

/// Height of a page of one block of maps, at most: 240 mm beside a width of 180 mm.
const HIGHEST: f64 = TWO_COLUMNS * 4.0 / 3.0;
/// What is tried until a page is no higher, one after the other: unrolled maps in fewer, longer windows, then smaller maps.
const FITS: [Fit; 9] = [
    Fit { stretch: 1.0, size: 1.0 },
    Fit { stretch: 1.25, size: 1.0 },
    Fit { stretch: 1.5, size: 1.0 },
    Fit { stretch: 2.0, size: 1.0 },
    Fit { stretch: 2.0, size: 0.9 },
    Fit { stretch: 2.0, size: 0.8 },
    Fit { stretch: 2.0, size: 0.7 },
    Fit { stretch: 2.0, size: 0.6 },
    Fit { stretch: 2.0, size: 0.5 },
];

/// How maps are fitted into a page.
#[derive(Debug, Clone, Copy)]
struct Fit {
    /// How much longer the windows of unrolled maps are than they mostly are.
    stretch: f64,
    /// The part of the width that there is for a map that it takes.
    size: f64,
}

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

/// Where a map lies on its page.
struct Placed {
    /// The lower right corner of its last box.
    box_end: [f64; 2],
    /// Where its text ends, from the top of the page.
    end: f64,
}

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

/// The maps of a few runs beside each other.
#[derive(Debug, Clone, Default)]
pub struct MapBlock<'a> {
    /// What the runs are called.
    pub names: Vec<String>,
    /// Their maps.
    pub groups: Vec<MapGroup<'a>>,
}

/// The page of this width (pixels) with these maps, below an explanation of colours. Maps of one block are fitted into the page of a journal.
pub fn page(whole: f64, meanings: &[Meaning], blocks: &[MapBlock]) -> Page {
    let mut page = fitted(whole, meanings, blocks, FITS[0]);
    for fit in &FITS[1..] {
        if blocks.len() > 1 || page.size[1] <= HIGHEST {
            break;
        }
        page = fitted(whole, meanings, blocks, *fit);
    }
    page
}

/// The page with maps that are fitted in this way.
fn fitted(whole: f64, meanings: &[Meaning], blocks: &[MapBlock], fit: Fit) -> Page {
    let mut page = Page { size: [whole, 0.0], ..Page::default() };
    let scaled = blocks.iter().flat_map(|block| &block.groups).any(|group| group.scale.is_some());
    let width = whole - MARGIN - if scaled { BAR_ROOM } else { MARGIN };
    // What colours mean stands below the name of the one run, but above the names of several.
    let mut top = MARGIN;
    let several = blocks.len() > 1 || blocks.iter().any(|block| block.names.len() > 1);
    if several {
        top = legend(&mut page, meanings, top);
    }
    for block in blocks {
        let across = block.names.len().max(1);
        let each = width / across as f64;
        for (column, name) in block.names.iter().enumerate() {
            let place = (MARGIN + column as f64 * each, top);
            page.write(shortened(name, TITLE, each - BETWEEN), place, Anchor::BelowRight, TITLE);
        }
        top += 1.5 * f64::from(TITLE);
        if !several {
            top = legend(&mut page, meanings, top);
        }
        top = block.groups.iter().fold(top, |top, group| group.place(&mut page, top, width, fit));
        top += MARGIN;
    }
    page.size[1] = top.ceil();
    page
}

impl MapGroup<'_> {
    /// Puts the maps on the page, this far from its top and so wide; gives the place below.
    fn place(&self, page: &mut Page, begin: f64, width: f64, fit: Fit) -> f64 {
        let (mut top, mut last_box, mut right) = (begin, begin, MARGIN);
        let mut most_lines = 1;
        for row in &self.rows {
            let each = width / row.len().max(1) as f64;
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
            // Room for the points at its ends.
            let first = begin + most_lines as f64 * LINE_OF_TEXT + 36.0;
            let end = (last_box - 28.0).clamp(first + SHORTEST_BAR, first + LONGEST_BAR);
            let frame = Frame { x: [left, left + BAR], y: [first, end].map(f64::round) };
            page.colour_bars.push(ColourBar::new(frame, axis.clone()));
            top = top.max(end + 40.0);
        }
        top + 12.0
    }
}

impl MapSection<'_> {
    /// What is written above a map with so much room for it and its axis.
    fn words(&self, width: f64) -> Vec<String> {
        let room = width - Axis::linear(self.shape.y_range(self.mesh), self.shape.y_label()).room_beside(width);
        let texts = [&self.title, &self.remark].into_iter().filter(|text| !text.is_empty());
        texts.flat_map(|text| wrapped(text, room)).collect()
    }

    /// Puts the map on the page with its upper left corner there, below so many lines of text.
    fn place(
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
        let height = |window: &Window, inner: f64| (inner * proportion(window)).clamp(LEAST_HEIGHT, inner).round();
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
            // A body that is taller than wide stays in proportion.
            let wide = inner.min(inner / proportion(&window)).max(LEAST_HEIGHT).round();
            let frame = Frame { x: [begin.round(), begin.round() + wide], y: [y_top, y_top + height] };
            let frame_end = frame.x[1];
            let label = if number == last { self.shape.x_label() } else { String::new() };
            // A narrow map has no room for where the arc is measured.
            let label = if text_width(&label, TEXT) > wide { label.replace(" at the mean radius", "") } else { label };
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
    let mut lines: Vec<String> = Vec::new();
    for part in text.split_inclusive(", ") {
        match lines.last_mut() {
            Some(line) if text_width(format!("{line}{part}").trim_end(), TEXT) <= room => line.push_str(part),
            _ => lines.push(part.to_owned()),
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

/// The runs that have a map at any moment; of the others it is noted that they are left out.
pub fn having<'a>(
    figures: &mut Figures,
    what: &'static str,
    subjects: &'a [Subject<'a>],
    map: Map,
) -> Vec<&'a Subject<'a>> {
    let mut having = Vec::new();
    for subject in subjects {
        if !subject.run.has_map(map) {
            figures.leave_out(what, subject, &format!("no map {}", map.name()));
        } else if subject.run.map_time().is_empty() {
            figures.leave_out(what, subject, "no maps yet");
        } else {
            having.push(subject);
        }
    }
    having
}

/// The runs of any of the lists, in the order of all.
pub fn any_of<'a, const N: usize>(subjects: &'a [Subject<'a>], lists: [&[&'a Subject<'a>]; N]) -> Vec<&'a Subject<'a>> {
    let has = |subject: &Subject| lists.iter().any(|list| list.iter().any(|other| std::ptr::eq(*other, subject)));
    subjects.iter().filter(|subject| has(subject)).collect()
}

/// A map.
pub struct Painted {
    /// What it is, in a few words.
    pub title: String,
    /// What else is to know of it; may be empty.
    pub remark: String,
    /// Number of the colour of every cell.
    pub cells: Vec<u8>,
}

/// Rows of maps. The moments of a single run stand below each other if they are `wide`, else beside each other; those of
/// several runs stand below each other, the runs beside each other. `shape` tells how a body on a mesh is shown, `paint` gives the map of a run at a moment.
pub fn rows<'a>(
    subjects: &[&'a Subject<'a>],
    shape: impl Fn(&Mesh) -> Shape,
    wide: bool,
    moments: impl Fn(&Subject) -> Vec<usize>,
    mut paint: impl FnMut(&Subject, usize) -> Result<Option<Painted>, ReadError>,
) -> Result<Vec<Vec<Option<MapSection<'a>>>>, ReadError> {
    let mut columns = Vec::new();
    for subject in subjects {
        let mut column = Vec::new();
        for moment in moments(subject) {
            let mesh = subject.run.mesh();
            let section =
                |Painted { title, remark, cells }| MapSection { title, remark, mesh, shape: shape(mesh), cells };
            column.push(paint(subject, moment)?.map(section));
        }
        columns.push(column);
    }
    match &mut columns[..] {
        [one] if wide => Ok(std::mem::take(one).into_iter().map(|section| vec![section]).collect()),
        [one] => {
            let mut row = std::mem::take(one);
            // A single map needs not more than half of the page.
            row.resize(row.len().max(2), None);
            Ok(vec![row])
        }
        several => {
            let most = several.iter().map(Vec::len).max().unwrap_or(0);
            for column in several.iter_mut() {
                // The only map of a run stands beside the last maps of the others.
                column.splice(..0, vec![None; most - column.len()]);
            }
            let row = |moment: usize| several.iter_mut().map(|column| column[moment].take()).collect();
            Ok((0..most).map(row).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::model::outline::Outline;

    use super::*;

    /// Two maps of the disc below each other and two of the pin beside each other, as `status` has them.
    fn block(mesh: &Mesh) -> MapBlock<'_> {
        let section = |shape: Shape, columns: usize| MapSection {
            title: "disc, 0 s".to_owned(),
            remark: "none 100, primary 0, secondary 0 %".to_owned(),
            mesh,
            shape,
            cells: vec![0; columns * mesh.rows()],
        };
        let disc = || vec![Some(section(Shape::Unrolled, mesh.disc_columns()))];
        let pin = || Some(section(Shape::of_pin(mesh), mesh.pin_columns()));
        let group = |rows| MapGroup { rows, palette: vec![RGBColor(0, 0, 0), RGBColor(255, 255, 255)], scale: None };
        MapBlock {
            names: vec!["run".to_owned()],
            groups: vec![group(vec![disc(), disc()]), group(vec![vec![pin(), pin()]])],
        }
    }

    #[test]
    fn long_words_above_a_map_stand_in_several_lines() {
        assert_eq!(wrapped("disc, 0 s", 400.0), ["disc, 0 s"]);
        let lines = wrapped("none 21.7, primary 29.8, secondary 48.5 %", 400.0);
        assert_eq!(lines, ["none 21.7, primary 29.8,", "secondary 48.5 %"]);
    }

    #[test]
    fn the_maps_of_a_round_pin_fit_into_a_page() {
        // A pin of 10 mm on its ring at 22 mm, in cells of half a millimetre.
        let mesh = Mesh::new(20, 276, 21, 17e-3, 27e-3).unwrap().with_outline(Outline::Disc { radius: 5e-3 }).unwrap();
        assert!(fitted(TWO_COLUMNS, &[], &[block(&mesh)], FITS[0]).size[1] > HIGHEST);
        assert!(page(TWO_COLUMNS, &[], &[block(&mesh)]).size[1] <= HIGHEST);
        // A page with room for them keeps its maps as large as they are.
        let small = Mesh::new(8, 100, 16, 20e-3, 24e-3).unwrap();
        let block = || MapBlock { groups: block(&small).groups.split_off(1), ..MapBlock::default() };
        assert_eq!(page(TWO_COLUMNS, &[], &[block()]).size, fitted(TWO_COLUMNS, &[], &[block()], FITS[0]).size);
    }
}
