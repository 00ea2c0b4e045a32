//! Error against run time, on axes of equal ratios, with the runs that are worth their time.

use std::ops::RangeInclusive;

use super::axes::Axis;
use super::canvas::LINE;
use super::chart::{COLUMN, Chart, Meaning, page};
use super::format::Figure;
use super::labels::{Labels, write_labels};
use super::page::{Content, KeyStyle, Page};
use super::stroke::{SOLID, Stroke};
use crate::colour::{APART, FAINT};

/// Height of the box, pixels.
const HEIGHT: f64 = 860.0;
/// Room between the largest value and the end of an axis, as a ratio.
const ROOM: f64 = 1.6;

/// What runs are held against.
#[derive(Debug, Clone, Copy)]
pub struct Reference {
    /// Wall time, s.
    pub time: f64,
    /// Its own error of the contact area, as a fraction.
    pub error: f64,
    /// Its time acceleration.
    pub time_acceleration: f64,
}

/// Runs that differ in one thing, the finest first.
#[derive(Debug, Clone)]
pub struct Ladder<'a> {
    /// What they differ in.
    pub name: &'a str,
    /// Number of its colour.
    pub colour: usize,
    /// Whether a line goes through them.
    pub is_joined: bool,
    /// Whether what they differ in is chance.
    pub is_chance: bool,
    /// The runs.
    pub rungs: Vec<Rung>,
}

/// A run.
#[derive(Debug, Clone)]
pub struct Rung {
    /// Wall time, s.
    pub time: f64,
    /// Error of the contact area, as a fraction.
    pub error: f64,
    /// Whether no other run is as quick and as exact.
    pub on_front: bool,
    /// What stands beside it, where there is room.
    pub label: String,
}

impl Rung {
    fn has_place(&self) -> bool {
        self.error > 0.0 && self.error.is_finite()
    }

    fn point(&self) -> [f64; 2] {
        [self.time, 100.0 * self.error]
    }
}

/// The figure.
pub fn figure(reference: &Reference, ladders: &[Ladder]) -> Figure {
    let ladders = shown(ladders);
    let rungs: Vec<&Rung> = ladders.iter().flat_map(|(_, rungs)| rungs).copied().collect();
    let times = rungs.iter().map(|rung| rung.time).chain([reference.time]);
    let own_error = 100.0 * reference.error;
    let errors = rungs.iter().map(|rung| 100.0 * rung.error).chain([own_error]);
    let (x, y) = (range(times), range(errors));
    let front = front(&rungs);
    let meanings = meanings(reference, &ladders, !front.is_empty());
    let chart = Chart {
        title: String::new(),
        contents: contents([reference.time, own_error], &ladders, front, [&x, &y]),
        x: Axis::logarithmic(x, "run time, s"),
        y: Axis::logarithmic(y, "error of the contact area, %"),
    };
    let mut page = page(COLUMN, HEIGHT, 1, vec![chart], &meanings);
    label(&mut page, &rungs);
    Figure {
        name: "accuracy".to_owned(),
        title: "Error against run time".to_owned(),
        caption:
            "Error of the mean contact areas over equal windows of physical time, against the wall time of the run."
                .to_owned(),
        page,
    }
}

/// A ladder with its runs that have a place.
type Shown<'a> = (&'a Ladder<'a>, Vec<&'a Rung>);

/// The ladders with runs that have a place. Chance far below all other errors would take most of the room, and say no more
/// than that it is there.
fn shown<'a>(ladders: &'a [Ladder<'a>]) -> Vec<Shown<'a>> {
    let others = ladders.iter().filter(|ladder| !ladder.is_chance).flat_map(|ladder| &ladder.rungs);
    let least = others.filter(|rung| rung.has_place()).map(|rung| rung.error).reduce(f64::min).unwrap_or(0.0);
    let has_place = |ladder: &Ladder, rung: &Rung| rung.has_place() && (!ladder.is_chance || rung.error >= 0.1 * least);
    let of = |ladder: &'a Ladder<'a>| (ladder, ladder.rungs.iter().filter(|rung| has_place(ladder, rung)).collect());
    ladders.iter().map(of).filter(|(_, rungs): &Shown| !rungs.is_empty()).collect()
}

/// The runs that no other one beats, from the quickest on.
fn front(rungs: &[&Rung]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = rungs.iter().filter(|rung| rung.on_front).map(|rung| rung.point()).collect();
    points.sort_by(|one, other| one[0].total_cmp(&other[0]));
    points
}

/// Lines at the reference's time and own error where there are such, the front, and every ladder.
fn contents(
    [time, own_error]: [f64; 2],
    ladders: &[Shown],
    front: Vec<[f64; 2]>,
    [x, y]: [&RangeInclusive<f64>; 2],
) -> Vec<Content> {
    let line = |points, colour, width| Content::Line { points, stroke: Stroke::solid(colour, width) };
    let mut contents = Vec::new();
    if time > 0.0 {
        contents.push(line(vec![[time, *y.start()], [time, *y.end()]], FAINT, LINE));
    }
    if own_error > 0.0 {
        contents.push(line(vec![[*x.start(), own_error], [*x.end(), own_error]], FAINT, LINE));
    }
    contents.push(line(front, APART, 5 * LINE));
    for (ladder, rungs) in ladders {
        let points: Vec<[f64; 2]> = rungs.iter().map(|rung| rung.point()).collect();
        let stroke = Stroke { width: LINE, ..Stroke::of(ladder.colour, 1) };
        if ladder.is_joined {
            contents.push(Content::Line { points: points.clone(), stroke });
        }
        // A line of one point is a dot.
        contents.extend(points.into_iter().map(|point| Content::Line { points: vec![point], stroke }));
    }
    contents
}

fn meanings(reference: &Reference, ladders: &[Shown], has_front: bool) -> Vec<Meaning> {
    let meaning = |colour, style, text: &str| Meaning { colour, style, text: text.to_owned() };
    let ladders =
        ladders.iter().map(|(ladder, _)| meaning(Stroke::of(ladder.colour, 1).colour, KeyStyle::Area, ladder.name));
    let mut meanings: Vec<Meaning> = ladders.collect();
    if has_front {
        meanings.push(meaning(APART, KeyStyle::Area, "no other run is quicker and more exact"));
    }
    if reference.time > 0.0 || reference.error > 0.0 {
        let lines = if reference.error > 0.0 { ", its time and its own error" } else { "" };
        let text = format!("reference, time_acceleration = {}{lines}", reference.time_acceleration);
        meanings.push(meaning(FAINT, KeyStyle::Line(SOLID), &text));
    }
    meanings
}

/// Writes beside points what they are, off all lines; first beside those of the front.
fn label(page: &mut Page, rungs: &[&Rung]) {
    let Some(axes) = page.panels.first().map(|panel| panel.axes.clone()) else { return };
    let place = |rung: &Rung| {
        let [x, y] = rung.point();
        axes.place_within(x, y)
    };
    let mut labels = Labels::new(axes.frame, rungs.iter().map(|rung| place(rung)));
    let lines = page.panels.iter().flat_map(|panel| &panel.contents).filter_map(|content| match content {
        Content::Line { points, .. } => Some(points),
        _ => None,
    });
    for pair in lines.flat_map(|points| points.windows(2)) {
        labels.avoid([0, 1].map(|end| axes.place_within(pair[end][0], pair[end][1])));
    }
    let mut named: Vec<&&Rung> = rungs.iter().filter(|rung| !rung.label.is_empty()).collect();
    named.sort_by_key(|rung| !rung.on_front);
    let named = named.into_iter().map(|rung| (rung.label.clone(), place(rung))).collect();
    write_labels(page, 0, &labels, named);
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
    use super::*;
    use crate::figure::canvas::TEXT;
    use crate::figure::font::text_width;

    #[test]
    fn labels_stand_off_the_lines() {
        // The line of the first ladder falls steeply on the left of the other's point.
        let rung = |time: f64, error: f64, label: &str| Rung { time, error, on_front: false, label: label.to_owned() };
        let ladder = |name, rungs, is_joined| Ladder { name, colour: 0, is_joined, is_chance: false, rungs };
        let steep = ladder("m", vec![rung(0.3, 1.1e-3, "10"), rung(0.6, 1.7e-4, "5")], true);
        let others = vec![rung(1.5, 7e-4, "tolerance 0.002"), rung(0.2, 1.6e-3, "exponential")];
        let reference = Reference { time: 2.4, error: 0.0, time_acceleration: 1.0 };
        let page = figure(&reference, &[steep, ladder("others", others, false)]).page;
        let axes = &page.panels[0].axes;
        let ends = [[0.3, 0.11], [0.6, 0.017]].map(|[x, y]| axes.place(x, y));
        for label in ["10", "5", "tolerance 0.002", "exponential"] {
            let words = page.texts.iter().find(|words| words.text == label).expect(label);
            let (x, y) = words.place;
            let along =
                |part: f64| [ends[0].0 + part * (ends[1].0 - ends[0].0), ends[0].1 + part * (ends[1].1 - ends[0].1)];
            let is_within = |[right, down]: [f64; 2]| {
                (x..x + text_width(label, TEXT)).contains(&right) && (down - y).abs() < 0.5 * f64::from(TEXT)
            };
            assert!(!(0..=100).map(|step| along(f64::from(step) / 100.0)).any(is_within), "{label}");
        }
    }

    #[test]
    fn ranges_have_room_on_both_sides() {
        assert_eq!(range([2.0, 10.0, f64::NAN, 0.0].into_iter()), 1.25..=16.0);
        assert_eq!(range([].into_iter()), 0.1..=10.0);
    }
}
