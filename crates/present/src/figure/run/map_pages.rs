//! How the maps of runs are fitted into pages of a journal.

use super::map_page::{MapBlock, Sheet};
use super::map_section::{Fit, MapSection};
use super::shape::X_LABELS;
use crate::figure::canvas::TEXT;
use crate::figure::chart::{COLUMN, Meaning, TWO_COLUMNS};
use crate::figure::font::text_width;
use crate::figure::page::Page;
use crate::figure::pages::{are_low, in_pages};

/// Maps beside each other, at most.
const MOST_ACROSS: usize = 3;
/// What is tried until no page is too high, one after the other: unrolled maps in fewer, longer windows, then smaller maps. How much longer the
/// windows are, and the part of the width that a map takes.
const FITS: [[f64; 2]; 13] = [
    [1.0, 1.0],
    [1.25, 1.0],
    [1.5, 1.0],
    [2.0, 1.0],
    [3.0, 1.0],
    [4.0, 1.0],
    [6.0, 1.0],
    [4.0, 0.9],
    [4.0, 0.8],
    [4.0, 0.7],
    [4.0, 0.6],
    [4.0, 0.5],
    [8.0, 0.5],
];

/// How many of so many runs stand beside each other: rows are about equally full.
pub fn runs_across(runs: usize) -> usize {
    runs.div_ceil(runs.div_ceil(MOST_ACROSS).max(1)).max(1)
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

/// Pages of this width (pixels) with these maps, each below an explanation of colours. A block is not divided: its maps are made smaller until
/// it fits into a page, and those of the others with them.
pub fn pages(width: f64, meanings: &[Meaning], blocks: &[MapBlock]) -> Vec<Page> {
    let across = blocks.iter().map(|block| block.names.len()).max().unwrap_or(0).max(1);
    let several = across > 1 || blocks.windows(2).any(|pair| pair[0].names != pair[1].names);
    let sheet = Sheet { width, meanings, across, several };
    let mut fit = fitted(&sheet, blocks, FITS[0]);
    for tried in &FITS[1..] {
        if are_low(&laid_out(&sheet, blocks, fit)) {
            break;
        }
        fit = fitted(&sheet, blocks, *tried);
    }
    laid_out(&sheet, blocks, Fit { paints: true, ..fit })
}

fn laid_out(sheet: &Sheet, blocks: &[MapBlock], fit: Fit) -> Vec<Page> {
    in_pages(blocks.len(), |some| sheet.page(&blocks[some], fit))
}

/// How maps are fitted in this way: the axes below them say the same, in the most words that fit everywhere. What the maps show does not matter
/// for that, so nothing is painted.
fn fitted(sheet: &Sheet, blocks: &[MapBlock], [stretch, size]: [f64; 2]) -> Fit {
    let with_words = |words: usize| Fit { stretch, size, words, paints: false };
    let has_room = |fit: &Fit| {
        let pages = laid_out(sheet, blocks, *fit);
        let mut axes = pages.iter().flat_map(|page| &page.panels).map(|panel| &panel.axes);
        axes.all(|axes| text_width(&axes.x.label, TEXT) <= axes.frame.width())
    };
    let fewest = X_LABELS - 1;
    (0..fewest).map(with_words).find(has_room).unwrap_or_else(|| with_words(fewest))
}

#[cfg(test)]
mod tests {
    use plateau_core::model::mesh::Mesh;
    use plateau_core::model::outline::Outline;
    use plotters::style::RGBColor;

    use super::*;
    use crate::figure::axes::{Axis, Frame};
    use crate::figure::run::map_page::{BAR_ROOM, BESIDE, MapGroup};
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

    /// The one page of a figure, as wide as two columns.
    fn page(blocks: &[MapBlock]) -> Page {
        let [page] = pages(TWO_COLUMNS, &[], blocks).try_into().expect("one page");
        page
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
        let [page] = &pages(COLUMN, &[], &alone)[..] else { panic!("one page") };
        // Bar, numbers and label take the room that they need on the right; the bar ends with the map.
        let (frame, bar) = (page.panels[0].axes.frame, page.colour_bars[0].frame);
        assert!(COLUMN - bar.x[1] < BAR_ROOM && bar.x[0] - frame.x[1] < 2.0 * BESIDE, "{frame:?} {bar:?}");
        assert!(bar.y[1] < frame.y[1] + 120.0 && page.size[1] < frame.y[1] + 200.0, "{frame:?} {bar:?}");
        // A label that is longer than its bar is not cut off below.
        let long = "height toward the disc, in micrometres";
        let low = vec![MapGroup { scale: Some(Axis::linear(0.0..=1.0, long)), ..group(pin.clone()) }];
        let [page] = &pages(COLUMN, &[], &block(low))[..] else { panic!("one page") };
        let bar = page.colour_bars[0].frame;
        assert!(text_width(long, TEXT) > bar.height());
        assert!(0.5 * (bar.y[0] + bar.y[1] + text_width(long, TEXT)) <= page.size[1], "{bar:?} {:?}", page.size);
        // Below a ring it is as wide as that.
        let disc = MapSection { cells: vec![0; mesh.disc_columns() * mesh.rows()], ..pin.clone() };
        let both = block(vec![group(disc), group(pin)]);
        assert_eq!(width_of(&both), TWO_COLUMNS);
        let page = self::page(&both);
        let ends = [0, 6].map(|panel: usize| page.panels[panel].axes.frame.x[1]);
        assert!((ends[0] - ends[1]).abs() < 1.0, "{ends:?}");
    }

    #[test]
    fn the_maps_of_a_round_pin_fit_into_a_page() {
        // A pin of 10 mm on its ring at 22 mm, in cells of half a millimetre.
        let mesh = Mesh::new(20, 276, 21, 17e-3, 27e-3).unwrap().with_outline(Outline::Disc { radius: 5e-3 }).unwrap();
        let [stretch, size] = FITS[0];
        let fit = Fit { stretch, size, words: 0, paints: true };
        let plain = |block| Sheet { width: TWO_COLUMNS, meanings: &[], across: 1, several: false }.page(&[block], fit);
        assert!(!are_low(&[plain(block(&mesh))]) && are_low(&[page(&[block(&mesh)])]));
        // Three rings that are 129 times as long as they are wide, beside each other.
        let mesh = Mesh::new(20, 690, 40, 20e-3, 21e-3).unwrap();
        let mut three = block(&mesh);
        three.names = vec!["run".to_owned(); 3];
        for group in &mut three.groups {
            group.rows = group.rows.iter().flatten().map(|section| vec![section.clone(); 3]).collect();
        }
        let fits = page(&[three]);
        assert!(fits.panels[0].axes.frame.width() > 500.0, "{:?}", fits.size);
        assert!(are_low(std::slice::from_ref(&fits)), "{:?}", fits.size);
        // A page with room for them keeps its maps as large as they are.
        let small = Mesh::new(8, 100, 16, 20e-3, 24e-3).unwrap();
        let block = || MapBlock { groups: block(&small).groups.split_off(1), ..MapBlock::default() };
        assert_eq!(page(&[block()]).size, plain(block()).size);
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
        let pages = pages(TWO_COLUMNS, &[], &[block(3), block(1)]);
        assert!(pages.len() == 2 && are_low(&pages));
        // Windows of the disc at two moments and two maps of the pin, of three runs and of the last one.
        let frames = |page: &Page| page.panels.iter().map(|panel| panel.axes.frame).collect::<Vec<Frame>>();
        let (first, last) = (frames(&pages[0]), frames(&pages[1]));
        let discs = last.len() - 2;
        assert!(first.len() == 3 * last.len() && discs % 2 == 0, "{} {}", first.len(), last.len());
        for [full, last] in [[&first[..3 * discs], &last[..discs]], [&first[3 * discs..], &last[discs..]]] {
            assert!(full.iter().chain(last).all(|frame| frame.width() == full[0].width()), "{full:?} {last:?}");
            // The maps of the last run stand below each other.
            assert!(last.iter().all(|frame| frame.x[0] == full[0].x[0]), "{last:?}");
        }
        // Of one run a disc has room for more words than a pin, which is a column wide.
        let [alone] = &super::pages(1800.0, &[], &[block(1)])[..] else { panic!("one page") };
        let mut labels: Vec<&str> = alone.panels.iter().map(|panel| panel.axes.x.label.as_str()).collect();
        labels.retain(|label| !label.is_empty());
        labels.dedup();
        assert_eq!(labels, ["arc length, mm; the disc moves \u{2192}"]);
    }
}
