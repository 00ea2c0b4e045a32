//! Labels beside points: as many as there is room for, none upon another or upon a point.

use super::axes::Frame;
use super::brush::Place;
use super::canvas::{Anchor, TEXT};
use super::font::text_width;
use super::page::{Content, LINE_OF_TEXT, Page};
use super::stroke::Stroke;
use crate::colour::FAINT;

/// Half the side of a dot, pixels, with a little room round it.
const DOT: f64 = 10.0;
/// Room between a label beside its point and any other point, pixels: it would not be clear whose it is.
const OTHERS: f64 = 16.0;
/// Distances of a label that a line leads to, and in how many directions it is looked for there.
const FAR: [f64; 2] = [44.0, 700.0];
const FARTHER: f64 = 16.0;
const DIRECTIONS: usize = 48;
/// Room between labels and the frame, pixels.
const FRAME: f64 = 8.0;
/// Points so near to each other are one for the eye, pixels.
const SAME: f64 = 14.0;
/// Distance of the places of a line that labels keep off, pixels, and the side of each.
const ALONG: f64 = 8.0;
const LINE: f64 = 6.0;

/// Where a label stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// Where the text begins, at half its height.
    pub begin: Place,
    /// The line that leads to it from its point, where it is not beside that.
    pub leader: Option<[Place; 2]>,
}

/// Names at places: those at one place, as far as the eye can tell, in one text.
pub fn gathered(named: impl IntoIterator<Item = (String, Place)>) -> Vec<(Vec<String>, Place)> {
    let mut groups: Vec<(Vec<String>, Place)> = Vec::new();
    for (name, place) in named {
        let is_near = |(_, other): &&mut (Vec<String>, Place)| (place.0 - other.0).hypot(place.1 - other.1) < SAME;
        match groups.iter_mut().find(is_near) {
            Some((names, _)) => names.push(name),
            None => groups.push((vec![name], place)),
        }
    }
    groups
}

/// A box with points, and the room that labels have in it.
#[derive(Debug, Clone)]
pub struct Labels {
    whole: Frame,
    taken: Vec<Frame>,
    points: Vec<Place>,
    /// Places of lines.
    lines: Vec<Frame>,
    /// Lines that lead to labels.
    leaders: Vec<[Place; 2]>,
}

impl Labels {
    /// Without labels so far.
    pub fn new(whole: Frame, points: impl Iterator<Item = Place>) -> Self {
        let points: Vec<Place> = points.collect();
        let taken = points.iter().map(|point| around(*point, [2.0 * DOT, 2.0 * DOT])).collect();
        // No letter touches the frame.
        let inset = |[low, high]: [f64; 2]| [low + FRAME, high - FRAME];
        let whole = Frame { x: inset(whole.x), y: inset(whole.y) };
        Self { whole, taken, points, lines: Vec::new(), leaders: Vec::new() }
    }

    /// Keeps labels off a line, as far as there is other room.
    pub fn avoid(&mut self, [from, to]: [Place; 2]) {
        let count = ((to.0 - from.0).hypot(to.1 - from.1) / ALONG).ceil().max(1.0) as usize;
        let at = |part: f64| (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
        self.lines.extend((0..=count).map(|step| around(at(step as f64 / count as f64), [LINE, LINE])));
    }

    /// Where the labels of all points stand, as many as there is room for.
    pub fn all(&self, groups: &[(Vec<String>, Place)]) -> Vec<Option<Placed>> {
        let mut best: Vec<Option<Placed>> = vec![None; groups.len()];
        for (order, beside) in ATTEMPTS {
            let mut numbers: Vec<usize> = (0..groups.len()).collect();
            let x = |number: &usize| groups[*number].1.0;
            match order {
                Order::Given => {}
                Order::FromRight => numbers.sort_by(|one, other| x(other).total_cmp(&x(one))),
                Order::FromLeft => numbers.sort_by(|one, other| x(one).total_cmp(&x(other))),
            }
            let mut labels = self.clone();
            let mut placed = vec![None; groups.len()];
            for number in numbers {
                let (text, point) = &groups[number];
                placed[number] = labels.place(text, *point, beside);
            }
            if placed.iter().flatten().count() > best.iter().flatten().count() {
                best = placed;
            }
            if best.iter().all(Option::is_some) {
                break;
            }
        }
        best
    }

    /// Where the lines of a text about a point begin: beside it, where it is clear whose they are, or where a line leads.
    fn place(&mut self, text: &[String], point: Place, beside: usize) -> Option<Placed> {
        let width = text.iter().map(|line| text_width(line, TEXT)).fold(0.0, f64::max);
        let size = [width, LINE_OF_TEXT * (text.len() as f64 - 1.0) + f64::from(TEXT)];
        let found = [true, false].into_iter().find_map(|off_lines| {
            self.near(size, point, off_lines, beside)
                .map(|frame| (frame, None))
                .or_else(|| self.far(size, point, off_lines, beside))
        });
        let (frame, leader) = found?;
        self.taken.push(frame);
        self.leaders.extend(leader);
        Some(Placed { begin: (frame.x[0], frame.y[0] + 0.5 * f64::from(TEXT)), leader })
    }

    /// Room right beside a point and clear of all others.
    fn near(&self, size: [f64; 2], (x, y): Place, off_lines: bool, most: usize) -> Option<Frame> {
        let [beside, above] = [0.5 * size[0] + DOT + 6.0, 0.5 * size[1] + DOT];
        let middles =
            [(beside, -above), (beside, above), (-beside, above), (-beside, -above), (beside, 0.0), (-beside, 0.0)];
        let mut frames = middles.into_iter().take(most).map(|(right, down)| around((x + right, y + down), size));
        frames.find(|frame| self.is_clear(frame, (x, y)) && self.is_free(frame, off_lines))
    }

    /// Whether a label is so far from all points but its own that it is clear whose it is.
    fn is_clear(&self, frame: &Frame, (x, y): Place) -> bool {
        self.points.iter().filter(|other| (other.0 - x).hypot(other.1 - y) >= SAME).all(|other| {
            let [right, down] =
                [(frame.x, other.0), (frame.y, other.1)].map(|([low, high], at)| (low - at).max(at - high).max(0.0));
            right.hypot(down) >= DOT + OTHERS
        })
    }

    /// Room farther away: where the line ends at a side of the text, and if there is none, above or below its middle, where it is in
    /// the way of more others.
    fn far(&self, size: [f64; 2], point: Place, off_lines: bool, beside: usize) -> Option<(Frame, Option<[Place; 2]>)> {
        let to_right = (beside == RIGHT).then_some([(true, false)]).into_iter().flatten();
        let tries = to_right.chain([(false, false), (false, true)]);
        tries.into_iter().find_map(|(to_right, across)| self.far_to(size, point, off_lines, (to_right, across)))
    }

    /// Room with the line that leads there; it crosses no label, no point and no other such line.
    fn far_to(
        &self,
        size: [f64; 2],
        (x, y): Place,
        off_lines: bool,
        (to_right, is_across): (bool, bool),
    ) -> Option<(Frame, Option<[Place; 2]>)> {
        let rings = ((FAR[1] - FAR[0]) / FARTHER) as usize;
        let tries = (0..rings * DIRECTIONS).map(|at| (FAR[0] + FARTHER * (at / DIRECTIONS) as f64, at % DIRECTIONS));
        tries.into_iter().find_map(|(far, direction)| {
            let (sine, cosine) = (std::f64::consts::TAU * (direction as f64 + 0.5) / DIRECTIONS as f64).sin_cos();
            if to_right && cosine < 0.0 {
                return None;
            }
            let end = (x + far * cosine, y + far * sine);
            let side = if cosine < 0.0 { -1.0 } else { 1.0 };
            let end_of = if sine < 0.0 { -1.0 } else { 1.0 };
            let beside = (end.0 + side * (0.5 * size[0] + 4.0), end.1);
            let across = (end.0, end.1 + end_of * (0.5 * size[1] + 2.0));
            let frame = around(if is_across { across } else { beside }, size);
            let leader = [(x + 1.2 * DOT * cosine, y + 1.2 * DOT * sine), end];
            let steps = (far / ALONG) as usize;
            let along = |step: usize| {
                let part = step as f64 / steps as f64;
                let place = |from: f64, to: f64| from + part * (to - from);
                around((place(leader[0].0, leader[1].0), place(leader[0].1, leader[1].1)), [LINE, LINE])
            };
            let own = around((x, y), [2.0 * DOT, 2.0 * DOT]);
            let is_own = |other: &Frame| overlap(&own, other);
            let crosses = (1..=steps).map(along).any(|step| {
                self.taken.iter().any(|other| overlap(&step, other) && !is_own(other)) || !is_within(&step, &self.whole)
            });
            let crosses = crosses || self.leaders.iter().any(|other| cross(&leader, other));
            (!crosses && self.is_clear(&frame, (x, y)) && self.is_free(&frame, off_lines))
                .then_some((frame, Some(leader)))
        })
    }

    fn is_free(&self, frame: &Frame, off_lines: bool) -> bool {
        let is_taken = self.taken.iter().any(|other| overlap(frame, other));
        let is_on_line = off_lines && self.lines.iter().any(|other| overlap(frame, other));
        let is_led_through = self.leaders.iter().any(|leader| passes(leader, frame));
        !is_taken && !is_on_line && !is_led_through && is_within(frame, &self.whole)
    }
}

/// How labels are placed, until there is room for all: in which order, and in how many places beside their points; with those on the
/// right alone lines lead to the right, too, as long as there is room.
const ATTEMPTS: [(Order, usize); 4] =
    [(Order::Given, BESIDE), (Order::FromRight, BESIDE), (Order::FromRight, RIGHT), (Order::FromLeft, BESIDE)];
/// Places beside a point, and those of them that are on its right.
const BESIDE: usize = 6;
const RIGHT: usize = 2;

/// In which order labels look for room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    Given,
    FromRight,
    FromLeft,
}

/// Writes names beside points of a panel of a page, with lines that lead to those that have no room there.
pub fn write_labels(page: &mut Page, panel: usize, labels: &Labels, named: Vec<(String, Place)>) {
    let Some(axes) = page.panels.get(panel).map(|panel| panel.axes.clone()) else { return };
    let groups = gathered(named);
    let placed = labels.all(&groups);
    for ((names, _), placed) in groups.into_iter().zip(placed) {
        let Some(Placed { begin, leader }) = placed else { continue };
        for (line, name) in names.into_iter().enumerate() {
            page.write(name, (begin.0, begin.1 + LINE_OF_TEXT * line as f64), Anchor::Right, TEXT);
        }
        if let (Some(leader), Some(panel)) = (leader, page.panels.get_mut(panel)) {
            let points = leader.map(|place| axes.values(place)).to_vec();
            panel.contents.push(Content::Line { points, stroke: Stroke::solid(FAINT, 2) });
        }
    }
}

fn around((x, y): Place, [width, height]: [f64; 2]) -> Frame {
    Frame { x: [x - 0.5 * width, x + 0.5 * width], y: [y - 0.5 * height, y + 0.5 * height] }
}

fn overlap(one: &Frame, other: &Frame) -> bool {
    let meet = |one: [f64; 2], other: [f64; 2]| one[0] < other[1] && other[0] < one[1];
    meet(one.x, other.x) && meet(one.y, other.y)
}

/// Whether two lines cross.
fn cross(one: &[Place; 2], other: &[Place; 2]) -> bool {
    let turn = |a: Place, b: Place, c: Place| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let parted =
        |line: &[Place; 2], [from, to]: &[Place; 2]| turn(line[0], line[1], *from) * turn(line[0], line[1], *to) < 0.0;
    parted(one, other) && parted(other, one)
}

/// Whether a line comes into a box.
fn passes([from, to]: &[Place; 2], frame: &Frame) -> bool {
    let steps = ((to.0 - from.0).hypot(to.1 - from.1) / ALONG).ceil().max(1.0) as usize;
    (0..=steps).any(|step| {
        let part = step as f64 / steps as f64;
        let place = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
        overlap(&around(place, [LINE, LINE]), frame)
    })
}

fn is_within(frame: &Frame, whole: &Frame) -> bool {
    let inside = |part: [f64; 2], whole: [f64; 2]| whole[0] <= part[0] && part[1] <= whole[1];
    inside(frame.x, whole.x) && inside(frame.y, whole.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_in_a_crowd_are_led_to() {
        let points: Vec<Place> = (0..6).map(|at| (60.0 + 26.0 * f64::from(at), 400.0 - 5.0 * f64::from(at))).collect();
        let whole = Frame { x: [0.0, 900.0], y: [0.0, 600.0] };
        let labels = Labels::new(whole, points.iter().copied());
        let groups: Vec<(Vec<String>, Place)> =
            points.iter().enumerate().map(|(at, point)| (vec![format!("a long factor {at}")], *point)).collect();
        let placed: Vec<Placed> = labels.all(&groups).into_iter().map(|placed| placed.expect("room")).collect();
        let width = text_width("a long factor 0", TEXT);
        let frame = |placed: &Placed| {
            let (x, y) = placed.begin;
            let half = 0.5 * f64::from(TEXT);
            Frame { x: [x, x + width], y: [y - half, y + half] }
        };
        let frames: Vec<Frame> = placed.iter().map(frame).collect();
        for (at, one) in frames.iter().enumerate() {
            assert!(is_within(one, &whole) && !frames[..at].iter().any(|other| overlap(one, other)));
            // No line goes through another's name.
            let others = placed.iter().enumerate().filter(|(other, _)| *other != at);
            assert!(!others.filter_map(|(_, placed)| placed.leader).any(|leader| passes(&leader, one)));
        }
        assert!(placed.iter().filter(|placed| placed.leader.is_some()).count() >= 3);
    }

    #[test]
    fn names_at_one_place_stand_together() {
        let named = [("a", (0.0, 0.0)), ("b", (400.0, 0.0)), ("c", (3.0, 4.0))];
        let found = gathered(named.map(|(name, place)| (name.to_owned(), place)));
        assert_eq!(found, [(vec!["a".into(), "c".into()], (0.0, 0.0)), (vec!["b".into()], (400.0, 0.0))]);
    }

    #[test]
    fn labels_have_room_of_their_own() {
        let points = [(100.0, 100.0), (120.0, 105.0), (140.0, 100.0), (160.0, 110.0), (500.0, 100.0)];
        let whole = Frame { x: [0.0, 520.0], y: [0.0, 200.0] };
        let labels = Labels::new(whole, points.into_iter());
        let named = |text: &str| points.map(|point| (vec![text.to_owned()], point));
        let placed = labels.all(&named("a label"));
        let frame = |placed: &Placed| {
            let ((x, y), half) = (placed.begin, 0.5 * f64::from(TEXT));
            Frame { x: [x, x + text_width("a label", TEXT)], y: [y - half, y + half] }
        };
        let frames: Vec<Frame> = placed.iter().flatten().map(frame).collect();
        let taken = labels.taken.iter().chain(&frames);
        for (index, one) in frames.iter().enumerate() {
            assert!(is_within(one, &whole));
            assert_eq!(taken.clone().take(points.len() + index).filter(|other| overlap(one, other)).count(), 0);
        }
        // The last one has no room on its right.
        assert!(placed[0].is_some() && placed[4].as_ref().is_some_and(|placed| placed.begin.0 < 500.0));
        assert!(labels.all(&named(&"long ".repeat(50))).iter().all(Option::is_none));
    }
}
