//! A page of maps: bodies below each other, moments or runs beside each other, with the colour bars they share.

use plotters::style::RGBColor;

use super::map_section::{Fit, MapSection};
use super::shape::X_LABELS;
use crate::figure::axes::{Axis, Frame};
use crate::figure::canvas::{Anchor, TEXT, TITLE};
use crate::figure::chart::{COLUMN, LEGEND, MARGIN, Meaning, TWO_COLUMNS, legend};
use crate::figure::colour_bar::ColourBar;
use crate::figure::font::{shortened, text_width};
use crate::figure::page::{LINE_OF_TEXT, Page};

/// Maps beside each other, at most.
const MOST_ACROSS: usize = 3;
/// Room on the right for a colour bar with numbers and label, pixels.
const BAR_ROOM: f64 = 250.0;
/// Width of a colour bar, and its distance from the maps.
const BAR: f64 = 40.0;
const BESIDE: f64 = 36.0;
/// Length of a colour bar, pixels.
const SHORTEST_BAR: f64 = 260.0;
const LONGEST_BAR: f64 = 900.0;
/// Distance of maps beside each other.
const BETWEEN: f64 = 40.0;

/// Height of a page of one block of maps, at most: 240 mm beside a width of 180 mm.
const HIGHEST: f64 = TWO_COLUMNS * 4.0 / 3.0;
/// What is tried until a page is no higher, one after the other: unrolled maps in fewer, longer windows, then smaller maps.
const FITS: [Fit; 11] = [
    Fit { stretch: 1.0, size: 1.0, words: 0 },
    Fit { stretch: 1.25, size: 1.0, words: 0 },
    Fit { stretch: 1.5, size: 1.0, words: 0 },
    Fit { stretch: 2.0, size: 1.0, words: 0 },
    Fit { stretch: 3.0, size: 1.0, words: 0 },
    Fit { stretch: 4.0, size: 1.0, words: 0 },
    Fit { stretch: 4.0, size: 0.9, words: 0 },
    Fit { stretch: 4.0, size: 0.8, words: 0 },
    Fit { stretch: 4.0, size: 0.7, words: 0 },
    Fit { stretch: 4.0, size: 0.6, words: 0 },
    Fit { stretch: 4.0, size: 0.5, words: 0 },
];

/// How many of so many runs stand beside each other: rows are about equally full.
pub fn runs_across(runs: usize) -> usize {
    runs.div_ceil(runs.div_ceil(MOST_ACROSS).max(1)).max(1)
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

/// Width of the page that these maps mostly have, pixels: one column where no row has more than one map and none is a long ring.
pub fn width_of(blocks: &[MapBlock]) -> f64 {
    let is_narrow = |section: &MapSection| {
        let columns = section.cells.len() / section.mesh.rows();
        section.shape.windows(section.mesh, columns, 1.0).len() == 1
    };
    let mut rows = blocks.iter().flat_map(|block| &block.groups).flat_map(|group| &group.rows);
    let is_column = rows.all(|row| row.len() == 1 && row.iter().flatten().all(is_narrow));
    if is_column { COLUMN } else { TWO_COLUMNS }
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

/// The page with maps that are fitted in this way: the axes below them say the same, in the most words that fit everywhere.
fn fitted(whole: f64, meanings: &[Meaning], blocks: &[MapBlock], fit: Fit) -> Page {
    let with_words = |words: usize| laid_out(whole, meanings, blocks, Fit { words, ..fit });
    let has_room =
        |page: &Page| page.panels.iter().all(|panel| text_width(&panel.axes.x.label, TEXT) <= panel.axes.frame.width());
    let fewest = X_LABELS - 1;
    (0..fewest).map(with_words).find(has_room).unwrap_or_else(|| with_words(fewest))
}

/// The page with maps that are fitted in this way and say this.
fn laid_out(whole: f64, meanings: &[Meaning], blocks: &[MapBlock], fit: Fit) -> Page {
    let mut page = Page { size: [whole, 0.0], ..Page::default() };
    let scaled = blocks.iter().flat_map(|block| &block.groups).any(|group| group.scale.is_some());
    let width = whole - MARGIN - if scaled { BAR_ROOM } else { MARGIN };
    // What colours mean stands below the name of the one run, but above the names of several.
    let mut top = MARGIN;
    let several = blocks.len() > 1 || blocks.iter().any(|block| block.names.len() > 1);
    let meanings_at =
        |page: &mut Page, top| legend(page, meanings, top) + if meanings.is_empty() { 0.0 } else { LEGEND };
    if several {
        top = meanings_at(&mut page, top);
    }
    // All runs have boxes of one size, also those of the last row.
    let across = blocks.iter().map(|block| block.names.len()).max().unwrap_or(0).max(1);
    let each = width / across as f64;
    for block in blocks {
        for (column, name) in block.names.iter().enumerate() {
            let place = (MARGIN + column as f64 * each, top);
            page.write(shortened(name, TITLE, each - BETWEEN), place, Anchor::BelowRight, TITLE);
        }
        top += 1.5 * f64::from(TITLE);
        if !several {
            top = meanings_at(&mut page, top);
        }
        let columns = several.then_some(Columns { runs: block.names.len().max(1), each });
        top = block.groups.iter().fold(top, |top, group| group.place(&mut page, top, width, fit, columns));
        top += MARGIN;
    }
    page.size[1] = top.ceil();
    page
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
            page.colour_bars.push(ColourBar::new(frame, axis.clone()));
            top = top.max(end + 40.0);
        }
        top + 12.0
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::model::mesh::Mesh;
    use plateau_core::model::outline::Outline;

    use super::*;
    use crate::figure::run::shape::Shape;

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
    fn a_single_map_of_the_pin_has_a_column_and_fills_it() {
        let mesh = Mesh::new(20, 690, 40, 20e-3, 21e-3).unwrap();
        let pin = MapSection {
            title: "pin, 60 s".to_owned(),
            remark: "at most 8.72 MPa".to_owned(),
            mesh: &mesh,
            shape: Shape::Unrolled,
            cells: vec![0; mesh.pin_cells()],
        };
        fn group(section: MapSection<'_>) -> MapGroup<'_> {
            let rows = vec![vec![Some(section.clone())]];
            let scale = Some(Axis::linear(0.0..=1.0, "pressure, MPa"));
            MapGroup { rows, palette: vec![RGBColor(0, 0, 0), RGBColor(255, 255, 255)], scale }
        }
        let block = |groups| [MapBlock { names: vec!["run".to_owned()], groups }];
        let alone = block(vec![group(pin.clone())]);
        assert_eq!(width_of(&alone), COLUMN);
        let page = page(COLUMN, &[], &alone);
        // Bar, numbers and label take the room that they need on the right; the bar ends with the map.
        let (frame, bar) = (page.panels[0].axes.frame, page.colour_bars[0].frame);
        assert!(COLUMN - bar.x[1] < BAR_ROOM && bar.x[0] - frame.x[1] < 2.0 * BESIDE, "{frame:?} {bar:?}");
        assert!(bar.y[1] < frame.y[1] + 120.0 && page.size[1] < frame.y[1] + 200.0, "{frame:?} {bar:?}");
        // Below a ring it is as wide as that.
        let disc = MapSection { cells: vec![0; mesh.disc_columns() * mesh.rows()], ..pin.clone() };
        let both = block(vec![group(disc), group(pin)]);
        assert_eq!(width_of(&both), TWO_COLUMNS);
        let page = super::page(TWO_COLUMNS, &[], &both);
        let ends = [0, 6].map(|panel: usize| page.panels[panel].axes.frame.x[1]);
        assert!((ends[0] - ends[1]).abs() < 1.0, "{ends:?}");
    }

    #[test]
    fn the_maps_of_a_round_pin_fit_into_a_page() {
        // A pin of 10 mm on its ring at 22 mm, in cells of half a millimetre.
        let mesh = Mesh::new(20, 276, 21, 17e-3, 27e-3).unwrap().with_outline(Outline::Disc { radius: 5e-3 }).unwrap();
        assert!(fitted(TWO_COLUMNS, &[], &[block(&mesh)], FITS[0]).size[1] > HIGHEST);
        assert!(page(TWO_COLUMNS, &[], &[block(&mesh)]).size[1] <= HIGHEST);
        // Three rings that are 129 times as long as they are wide, beside each other.
        let mesh = Mesh::new(20, 690, 40, 20e-3, 21e-3).unwrap();
        let mut three = block(&mesh);
        three.names = vec!["run".to_owned(); 3];
        for group in &mut three.groups {
            group.rows = group.rows.iter().flatten().map(|section| vec![section.clone(); 3]).collect();
        }
        let fits = page(TWO_COLUMNS, &[], &[three]);
        assert!(fits.size[1] <= HIGHEST && fits.panels[0].axes.frame.width() > 500.0, "{:?}", fits.size);
        // A page with room for them keeps its maps as large as they are.
        let small = Mesh::new(8, 100, 16, 20e-3, 24e-3).unwrap();
        let block = || MapBlock { groups: block(&small).groups.split_off(1), ..MapBlock::default() };
        assert_eq!(page(TWO_COLUMNS, &[], &[block()]).size, fitted(TWO_COLUMNS, &[], &[block()], FITS[0]).size);
    }

    #[test]
    fn all_runs_have_boxes_of_one_size_and_axes_that_say_the_same() {
        // By hand: a row has no more than three.
        assert_eq!([1, 2, 3, 4, 5, 6, 7, 8].map(runs_across), [1, 2, 3, 2, 3, 3, 3, 3]);
        let mesh = Mesh::new(20, 690, 40, 20e-3, 21e-3).unwrap();
        let section = |columns: usize| MapSection {
            title: "disc, 0 s".to_owned(),
            remark: String::new(),
            mesh: &mesh,
            shape: Shape::Unrolled,
            cells: vec![0; columns * mesh.rows()],
        };
        // The last run stands alone in its row, as a run alone has its maps: those of the pin beside each other.
        let group = |columns, runs: usize| {
            let rows = match runs {
                1 if columns == mesh.pin_columns() => vec![vec![Some(section(columns)); 2]],
                _ => vec![vec![Some(section(columns)); runs]; 2],
            };
            MapGroup { rows, palette: vec![RGBColor(0, 0, 0), RGBColor(255, 255, 255)], scale: None }
        };
        let block = |runs: usize| MapBlock {
            names: vec!["run".to_owned(); runs],
            groups: [mesh.disc_columns(), mesh.pin_columns()].map(|columns| group(columns, runs)).to_vec(),
        };
        let page = page(TWO_COLUMNS, &[], &[block(3), block(1)]);
        // Six windows of the disc at two moments and two maps of the pin, of four runs.
        assert_eq!(page.panels.len(), 4 * 14);
        let frames: Vec<Frame> = page.panels.iter().map(|panel| panel.axes.frame).collect();
        for [full, last] in [[&frames[..36], &frames[42..54]], [&frames[36..42], &frames[54..]]] {
            assert!(full.iter().chain(last).all(|frame| frame.width() == full[0].width()), "{full:?} {last:?}");
            // The maps of the last run stand below each other, and below those of the first.
            assert!(last.iter().all(|frame| frame.x[0] == full[0].x[0]), "{last:?}");
        }
        // Of one run a disc has room for more words than a pin, which is a column wide.
        let alone = super::page(1800.0, &[], &[block(1)]);
        let mut labels: Vec<&str> = alone.panels.iter().map(|panel| panel.axes.x.label.as_str()).collect();
        labels.retain(|label| !label.is_empty());
        labels.dedup();
        assert_eq!(labels, ["arc length, mm; the disc moves \u{2192}"]);
    }
}
