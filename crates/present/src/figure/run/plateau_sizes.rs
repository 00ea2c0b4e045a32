//! How large contact spots and plateaus are: how many there are of at least an area, at the first and the last moment.

use plateau_core::model::material::Status;
use plateau_core::observe::Map;
use plateau_core::observe::plateau_size::plateau_areas;
use plateau_io::run_file::ReadError;

use super::legend::{only_stroke, with_names};
use super::map_rows::{any_of, having};
use super::moments::{floats, moment, moments_in_words, shown_moments, statuses};
use super::{Figures, Subject, moments};
use crate::figure::axes::Axis;
use crate::figure::canvas::{Anchor, TEXT};
use crate::figure::chart::{COLUMN, Chart, TWO_COLUMNS, page};
use crate::figure::font::shortened;
use crate::figure::page::{Content, LINE_OF_TEXT, Page};
use crate::figure::stroke::Stroke;
use crate::quantity::Unit;

const NAME: &str = "plateau-sizes";
/// Count to which the axis reaches at least: ticks within a factor of two would stand at parts of a plateau.
const LEAST_COUNT: usize = 10;
/// Times that are named in a box without a line, at most.
const MOST_TIMES: usize = 3;

/// What is counted: what it is called, and the map that tells which cells belong to it.
const KINDS: [(&str, Map); 3] = [
    ("contact spots of the pin", Map::Pressure),
    ("pin, secondary plateaus", Map::PinStatus),
    ("disc, secondary plateaus", Map::DiscStatus),
];

/// The plateaus of a run at one moment.
struct Sizes {
    run: usize,
    first: bool,
    /// Areas, m², the largest first.
    areas: Vec<f64>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let lists = KINDS.map(|(_, map)| having(figures, NAME, subjects, map));
    let mut kinds: Vec<(&str, Vec<Sizes>)> = Vec::new();
    // Of what has a box without a line, the reason.
    let mut empty = Vec::new();
    for ((title, map), list) in KINDS.into_iter().zip(&lists) {
        let (mut sizes, mut at) = (Vec::new(), Vec::new());
        for (run, subject) in subjects.iter().enumerate() {
            if !list.iter().any(|one| std::ptr::eq(*one, subject)) {
                continue;
            }
            let moments = shown_moments(subject);
            for (place, index) in moments.iter().enumerate() {
                let areas = plateau_areas(subject.run.mesh(), &belonging(subject, map, *index)?);
                at.push(moment(subject.run, *index));
                sizes.push(Sizes { run, first: place + 1 < moments.len(), areas });
            }
        }
        if sizes.is_empty() {
            continue;
        }
        if sizes.iter().all(|sizes| sizes.areas.is_empty()) {
            at.dedup();
            let when =
                if at.len() > MOST_TIMES { "in any of the maps".to_owned() } else { format!("at {}", at.join(", ")) };
            let what = if map == Map::Pressure { "no contact" } else { "no plateaus" };
            empty.push((kinds.len(), [what.to_owned(), when]));
        }
        kinds.push((title, sizes));
    }
    if empty.len() == kinds.len() {
        for subject in any_of(subjects, lists.each_ref().map(|list| &list[..])) {
            let at = moments_in_words(subject.run, &shown_moments(subject));
            figures.leave_out(NAME, subject, &format!("no contact and no plateaus in the maps that are shown, {at}"));
        }
        return Ok(());
    }
    let all = || kinds.iter().flat_map(|(_, sizes)| sizes);
    let largest = all().filter_map(|sizes| sizes.areas.first()).copied().fold(0.0, f64::max);
    let least = all().filter_map(|sizes| sizes.areas.last()).copied().fold(largest, f64::min);
    let most = all().map(|sizes| sizes.areas.len()).max().unwrap_or(1);
    let unit = Unit::for_size("m2", largest);
    let range = [0.7 * least * unit.per_si, 1.5 * largest * unit.per_si];
    let floor = 0.7;
    let chart = |(number, (title, sizes)): (usize, &(&str, Vec<Sizes>))| {
        let line = |sizes: &Sizes| Content::Line {
            points: survival(&sizes.areas, unit.per_si, range[0], floor),
            stroke: Stroke::of(sizes.run, subjects.len()).at(sizes.first),
        };
        let y = Axis::logarithmic(floor..=1.6 * most.max(LEAST_COUNT) as f64, "number at least that large");
        Chart {
            title: (*title).to_owned(),
            x: Axis::logarithmic(range[0]..=range[1], unit.label("area")),
            y: if number == 0 { y } else { y.shared() },
            contents: sizes.iter().filter(|sizes| !sizes.areas.is_empty()).map(line).collect(),
        }
    };
    let charts: Vec<Chart> = kinds.iter().enumerate().map(chart).collect();
    let across = charts.len();
    let width = figures.width(if across == 1 { COLUMN } else { TWO_COLUMNS });
    let has_first = all().any(|sizes| sizes.first && !sizes.areas.is_empty());
    let only = only_stroke(subjects, all().map(|sizes| sizes.run));
    let own = moments::meanings(subjects, only, has_first);
    let meanings = with_names(subjects, |run| all().any(|sizes| sizes.run == run), own);
    let mut page = page(width, 640.0, across, charts, &meanings);
    for (panel, lines) in empty {
        write_within(&mut page, panel, &lines);
    }
    figures.add(
        NAME,
        "Sizes of contact spots and plateaus",
        "Number of contact spots and of secondary plateaus that are at least so large, at the last recorded moment and, paler, at the \
         first. Each is made of cells that share edges, with pressure or covered with compacted debris; the disc closes round the ring.",
        page,
    );
    Ok(())
}

/// Writes lines in the middle of a box.
fn write_within(page: &mut Page, panel: usize, lines: &[String]) {
    let Some(frame) = page.panels.get(panel).map(|panel| panel.axes.frame) else { return };
    let [x, y] = [frame.x, frame.y].map(|[begin, end]| 0.5 * (begin + end));
    let top = y - 0.5 * lines.len() as f64 * LINE_OF_TEXT;
    for (number, line) in lines.iter().enumerate() {
        let place = (x, top + number as f64 * LINE_OF_TEXT);
        page.write(shortened(line, TEXT, frame.width() - 20.0), place, Anchor::Below, TEXT);
    }
}

/// Which cells are in contact, or secondary.
fn belonging(subject: &Subject, map: Map, index: usize) -> Result<Vec<bool>, ReadError> {
    Ok(match map {
        Map::Pressure => floats(subject.run, map, index)?.into_iter().map(|pressure| pressure > 0.0).collect(),
        _ => {
            let cells = statuses(subject.run, map, index)?;
            cells.into_iter().map(|status| status == Status::Secondary as u8).collect()
        }
    })
}

/// Steps of the number of areas that are at least so large, from the begin of the axis to its floor.
fn survival(areas: &[f64], per_si: f64, begin: f64, floor: f64) -> Vec<[f64; 2]> {
    let mut points = vec![[begin, areas.len() as f64]];
    for (left, area) in areas.iter().enumerate().rev() {
        let (x, above) = (area * per_si, left as f64);
        if let Some([_, count]) = points.last().copied() {
            points.extend([[x, count], [x, above.max(floor)]]);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use plateau_core::observe::MapValues;

    use super::*;
    use crate::figure::run::written::{CELLS, Written};

    #[test]
    fn a_box_without_a_line_says_why() {
        // The pin is lifted in both maps, as at the ends of a drive; all of it is covered.
        let of = |values: MapValues| std::iter::repeat_n(values, 2);
        let run = Written::new("drive", &[], |_, time| time)
            .with_maps(Map::Pressure, of(MapValues::Float(vec![0.0; CELLS])))
            .with_maps(Map::PinStatus, of(MapValues::Status(vec![Status::Secondary as u8; CELLS])));
        let figures = Written::figures(&[run]);
        let page = &figures.figures.iter().find(|figure| figure.name == NAME).unwrap().page;
        let frame = page.panels[0].axes.frame;
        assert_eq!((page.panels.len(), page.panels[0].contents.len(), page.panels[1].contents.len()), (2, 0, 2));
        for text in ["no contact", "at 0 s, 1 s"] {
            let place = page.texts.iter().find(|words| words.text == text).unwrap().place;
            assert!(frame.x[0] < place.0 && place.0 < frame.x[1] && frame.y[0] < place.1 && place.1 < frame.y[1]);
        }
    }

    #[test]
    fn the_curve_steps_down_at_every_plateau() {
        // By hand: three plateaus of 1, 1 and 5.
        let points = survival(&[5.0, 1.0, 1.0], 1.0, 0.5, 0.7);
        let expected = [[0.5, 3.0], [1.0, 3.0], [1.0, 2.0], [1.0, 2.0], [1.0, 1.0], [5.0, 1.0], [5.0, 0.7]];
        assert_eq!(points, expected);
    }
}
