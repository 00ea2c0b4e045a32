//! Error against run time, on axes of equal ratios, with the runs that are worth their time.

use std::ops::RangeInclusive;

use plateau_run::accuracy::{Ladder, Report, Row};
use plotters::style::RGBColor;

use super::axes::Axis;
use super::canvas::{Anchor, LINE, TEXT};
use super::colour::{APART, FAINT, RUNS};
use super::labels::Labels;
use super::page::{Content, KeyStyle, Page};
use super::run::Figure;
use super::run::chart::{COLUMN, Chart, Meaning, page};

/// Height of the box, pixels.
const HEIGHT: f64 = 860.0;
/// Room between the largest value and the end of an axis, as a ratio.
const ROOM: f64 = 1.6;

/// A ladder's colour.
fn colour(ladder: Ladder) -> RGBColor {
    RUNS[ladder as usize % RUNS.len()]
}

/// The figure.
pub fn figure(report: &Report) -> Figure {
    let shown = shown(&report.rows);
    let reference = report.reference.outcome.wall_time.unwrap_or(f64::NAN);
    let times = shown.iter().map(|row| row.cost().time).chain([reference]);
    let own_error = 100.0 * report.own_error.contact_area();
    let errors = shown.iter().map(|row| 100.0 * row.error()).chain([own_error]);
    let (x, y) = (range(times), range(errors));
    let mut contents = Vec::new();
    if reference > 0.0 {
        let points = vec![[reference, *y.start()], [reference, *y.end()]];
        contents.push(Content::Line { points, colour: FAINT, width: LINE });
    }
    if own_error > 0.0 {
        let points = vec![[*x.start(), own_error], [*x.end(), own_error]];
        contents.push(Content::Line { points, colour: FAINT, width: LINE });
    }
    let front = front(&shown);
    let has_front = !front.is_empty();
    contents.push(Content::Line { points: front, colour: APART, width: 5 * LINE });
    let mut ladders: Vec<Ladder> = shown.iter().map(|row| row.rung.ladder).collect();
    ladders.dedup();
    for ladder in &ladders {
        let points: Vec<[f64; 2]> =
            shown.iter().filter(|row| row.rung.ladder == *ladder).map(|row| point(row)).collect();
        if matches!(ladder, Ladder::TimeAcceleration | Ladder::Mesh) {
            contents.push(Content::Line { points: points.clone(), colour: colour(*ladder), width: LINE });
        }
        // A line of one point is a dot.
        contents.extend(points.into_iter().map(|point| Content::Line {
            points: vec![point],
            colour: colour(*ladder),
            width: LINE,
        }));
    }
    let meaning = |colour, style, text: &str| Meaning { colour, style, text: text.to_owned() };
    let mut meanings: Vec<Meaning> =
        ladders.iter().map(|ladder| meaning(colour(*ladder), KeyStyle::Area, ladder.name())).collect();
    if has_front {
        meanings.push(meaning(APART, KeyStyle::Area, "no other run is as quick and as exact"));
    }
    if reference > 0.0 || own_error > 0.0 {
        let lines = if own_error > 0.0 { ", its time and its own error" } else { "" };
        let text = format!("reference, time_acceleration = {}{lines}", report.reference.time_acceleration);
        meanings.push(meaning(FAINT, KeyStyle::Line, &text));
    }
    let chart = Chart {
        title: String::new(),
        x: Axis::logarithmic(x, "run time, s"),
        y: Axis::logarithmic(y, "error of the contact area, %"),
        contents,
    };
    let mut page = page(COLUMN, HEIGHT, 1, vec![chart], &meanings);
    label(&mut page, &shown);
    Figure {
        name: "accuracy".to_owned(),
        title: "Error against run time".to_owned(),
        caption:
            "Error of the mean contact areas over equal windows of physical time, against the wall time of the run."
                .to_owned(),
        page,
    }
}

/// The rows that have a place. Perturbed references far below all other errors would take most of the room, and say no more
/// than that they are there.
fn shown(rows: &[Row]) -> Vec<&Row> {
    let has_place = |row: &&Row| row.error() > 0.0 && row.error().is_finite();
    let perturbed = |row: &Row| row.rung.ladder == Ladder::Perturbation;
    let others = rows.iter().filter(has_place).filter(|row| !perturbed(row)).map(Row::error);
    let least = others.reduce(f64::min).unwrap_or(0.0);
    rows.iter().filter(has_place).filter(|row| !perturbed(row) || row.error() >= 0.1 * least).collect()
}

fn point(row: &Row) -> [f64; 2] {
    [row.cost().time, 100.0 * row.error()]
}

/// The runs that no other one beats, from the quickest on.
fn front(rows: &[&Row]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = rows.iter().filter(|row| row.on_front).map(|row| point(row)).collect();
    points.sort_by(|one, other| one[0].total_cmp(&other[0]));
    points
}

/// Writes beside the points of the first two ladders what they are, where there is room; first beside those of the front.
fn label(page: &mut Page, rows: &[&Row]) {
    let Some(axes) = page.panels.first().map(|panel| panel.axes.clone()) else { return };
    let place = |row: &Row| {
        let [x, y] = point(row);
        axes.place_within(x, y)
    };
    let mut labels = Labels::new(axes.frame, rows.iter().map(|row| place(row)));
    let mut waiting: Vec<&&Row> = rows.iter().collect();
    waiting.sort_by_key(|row| !row.on_front);
    for row in waiting {
        let text = match row.rung.ladder {
            Ladder::TimeAcceleration => format!("{}", row.rung.value()),
            Ladder::Tolerance => format!("tolerance {}", row.rung.value()),
            Ladder::Mesh => format!("{}\u{d7} coarser", row.rung.value()),
            _ => continue,
        };
        if let Some(begin) = labels.beside(&text, place(row)) {
            page.write(text, begin, Anchor::Right, TEXT);
        }
    }
}

/// A range with room round positive values; where there are none, any.
fn range(values: impl Iterator<Item = f64>) -> RangeInclusive<f64> {
    let (low, high) = values
        .filter(|value| *value > 0.0 && value.is_finite())
        .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if high > 0.0 { low / ROOM..=high * ROOM } else { 0.1..=10.0 }
}

#[cfg(test)]
mod tests {
    use super::range;

    #[test]
    fn ranges_have_room_on_both_sides() {
        assert_eq!(range([2.0, 10.0, f64::NAN, 0.0].into_iter()), 1.25..=16.0);
        assert_eq!(range([].into_iter()), 0.1..=10.0);
    }
}
