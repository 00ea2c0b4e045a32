//! A map over two factors: colours, lines of equal value with their numbers, the runs, and one mark.

use super::FactorAxis;
use crate::colour::{APART, COLOURS, GROUND, INK, colour_index, colour_map};
use crate::figure::axes::{Axes, Axis, Frame, most_ticks_upward};
use crate::figure::canvas::{Anchor, LINE, Place, TEXT};
use crate::figure::chart::{COLUMN, MARGIN, Meaning, legend};
use crate::figure::colour_bar::ColourBar;
use crate::figure::contour::Field;
use crate::figure::font::{shortened, text_width};
use crate::figure::page::{Content, Key, KeyStyle, Mark, Page, Panel};
use crate::figure::picture::Picture;
use crate::figure::stroke::Stroke;
use crate::study::analysis::Analysis;

/// Points of the map along each axis, and where there are places without a value, whose rim is to be seen.
const POINTS: usize = 121;
const FINE: usize = 361;
/// Room beyond the outermost points of the design, as a part of the range.
const BEYOND: f64 = 0.06;
/// Height of the box, pixels.
const HEIGHT: f64 = 800.0;
/// Room on the right for a colour bar with numbers and label, its width and its distance from the map, pixels.
const BAR_ROOM: f64 = 270.0;
const BAR: f64 = 40.0;
const BESIDE: f64 = 36.0;
/// Room for the points at the ends of the bar.
const POINTED: f64 = 34.0;
/// Height of the numbers on lines, and least length of a line that has one, pixels.
const NUMBER: u32 = 26;
const SHORTEST: f64 = 160.0;
/// Open lines that are shorter are not drawn, pixels: beside places without a value they are pieces of lines.
const PIECE: f64 = 100.0;

/// Values over two factors.
pub struct FactorMap<'a> {
    /// Which factors.
    pub factors: [usize; 2],
    /// The same as axes.
    pub axes: [&'a FactorAxis<'a>; 2],
    /// Coded values at the ends.
    ends: [[f64; 2]; 2],
    /// Points along each axis.
    points: usize,
    /// Column by column, from below, in the unit in which they are shown; NaN where there is none.
    values: Vec<f64>,
}

impl<'a> FactorMap<'a> {
    /// The values of a function of the coded values of two factors, as far as there are runs and a little beyond.
    pub fn new(
        analysis: &Analysis,
        factors: [usize; 2],
        axes: [&'a FactorAxis<'a>; 2],
        value: impl Fn([f64; 2]) -> Option<f64>,
    ) -> Self {
        let coded = |at: usize| {
            let of = &axes[at].factor.factor;
            analysis.runs.iter().filter_map(move |(settings, _)| of.coded(settings[factors[at]]))
        };
        let ends = [0, 1].map(|at| {
            let (low, high) = coded(at).fold((-1.0, 1.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
            [low - BEYOND * (high - low), high + BEYOND * (high - low)]
        });
        let at_points = |points: usize| {
            let part = |index: usize, [low, high]: [f64; 2]| low + (high - low) * index as f64 / (points - 1) as f64;
            let value = |at: usize| value([part(at / points, ends[0]), part(at % points, ends[1])]).unwrap_or(f64::NAN);
            Self { factors, axes, ends, points, values: (0..points * points).map(value).collect() }
        };
        let map = at_points(POINTS);
        if map.values.iter().any(|value| value.is_nan()) && map.varies() { at_points(FINE) } else { map }
    }

    /// Whether there are values that are not all the same.
    pub fn varies(&self) -> bool {
        let [low, high] = self.range();
        high > low
    }

    /// The least and the greatest value.
    fn range(&self) -> [f64; 2] {
        let fold = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
        self.values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], fold)
    }

    /// Values of both factors, in their units, at coded values.
    fn natural(&self, coded: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|at| self.axes[at].natural(coded[at]))
    }

    /// Where the runs of the study are, each place once.
    pub fn runs(&self, analysis: &Analysis) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for (settings, _) in &analysis.runs {
            let coded = [0, 1].map(|at| self.axes[at].factor.factor.coded(settings[self.factors[at]]));
            let [Some(x), Some(y)] = coded else { continue };
            let point = self.natural([x, y]);
            if !points.contains(&point) {
                points.push(point);
            }
        }
        points
    }

    /// Whether coded values are on the map.
    pub fn is_within(&self, coded: [f64; 2]) -> bool {
        (0..2).all(|at| (self.ends[at][0]..=self.ends[at][1]).contains(&coded[at]))
    }

    fn picture(&self) -> Picture {
        let [low, high] = self.range();
        let rows = (0..self.points).rev();
        let index = |value: f64| match value {
            _ if value.is_nan() => COLOURS as u8,
            _ => colour_index((value - low) / (high - low)),
        };
        let indices =
            rows.flat_map(|row| (0..self.points).map(move |column| index(self.values[column * self.points + row])));
        let palette = colour_map().into_iter().chain([APART]).collect();
        Picture { columns: self.points, rows: self.points, indices: indices.collect(), palette }
    }

    /// Lines through the values at which the colour bar has numbers, with what these say.
    fn contours(&self, scale: &Axis, length: f64) -> Vec<(Vec<[f64; 2]>, String)> {
        let field = Field { values: &self.values, rows: self.points };
        let point = |[column, row]: [f64; 2]| {
            let part = |place: f64, [low, high]: [f64; 2]| low + (high - low) * place / (self.points - 1) as f64;
            self.natural([part(column, self.ends[0]), part(row, self.ends[1])])
        };
        let levels = scale.ticks(most_ticks_upward(length));
        let lines = levels
            .into_iter()
            .flat_map(|(level, text)| field.contours(level).into_iter().map(move |places| (places, text.clone())));
        let lines = lines.filter(|(places, _)| places.len() > 1);
        lines.map(|(places, text)| (places.into_iter().map(point).collect(), text)).collect()
    }

    /// The page: `label` says what the values are, `none` where there is none, `runs` are where runs are, and `mark` is a place
    /// in coded values with what it is.
    pub fn page(&self, label: &str, none: &str, runs: &[[f64; 2]], mark: Option<([f64; 2], String)>) -> Page {
        let mut page = Page { size: [COLUMN, 0.0], ..Page::default() };
        let meaning = |mark, text: String| Meaning { colour: INK, style: KeyStyle::Mark(mark), text };
        let mut meanings = vec![meaning(Mark::Rimmed, "runs".to_owned())];
        meanings.extend(mark.as_ref().map(|(_, text)| meaning(Mark::Cross, text.clone())));
        if self.values.iter().any(|value| value.is_nan()) {
            meanings.push(Meaning { colour: APART, style: KeyStyle::Area, text: none.to_owned() });
        }
        let top = legend(&mut page, &meanings, MARGIN) + 12.0;
        let [low, high] = self.range();
        let scale = Axis::linear(low..=high, shortened(label, TEXT, HEIGHT));
        // A picture's outer points lie on the edge of the box by their middles.
        let half = |at: usize| 0.5 * (self.ends[at][1] - self.ends[at][0]) / (self.points - 1) as f64;
        let range = |at: usize| {
            let [low, high] = self.ends[at];
            self.axes[at].natural(low - half(at))..=self.axes[at].natural(high + half(at))
        };
        let y = self.axes[1].between(range(1), HEIGHT);
        let left = (MARGIN + y.room_beside(HEIGHT)).round();
        let frame = Frame { x: [left, COLUMN - BAR_ROOM], y: [top, top + HEIGHT].map(f64::round) };
        let x = self.axes[0].between(range(0), frame.width());
        let below = x.room_below();
        let axes = Axes { frame, x, y };
        let mut lines = self.contours(&scale, HEIGHT - 2.0 * POINTED);
        lines.retain(|(points, _)| points.first() == points.last() || length_of(&axes, points) >= PIECE);
        let mut contents = vec![Content::Map(self.picture())];
        let line = |(points, _): &(Vec<[f64; 2]>, String)| Content::Line {
            points: points.clone(),
            stroke: Stroke::solid(GROUND, LINE - 1),
        };
        contents.extend(lines.iter().map(line));
        contents.push(Content::Marks { points: runs.to_vec(), colour: INK, mark: Mark::Rimmed });
        let marked: Vec<[f64; 2]> = mark.iter().map(|(coded, _)| self.natural(*coded)).collect();
        write_numbers(&mut page, &axes, &lines, &[runs, &marked].concat());
        if !marked.is_empty() {
            contents.push(Content::Marks { points: marked, colour: INK, mark: Mark::Cross });
        }
        page.panels.push(Panel { axes, contents });
        let bar = frame.x[1] + BESIDE;
        let bar = Frame { x: [bar, bar + BAR], y: [frame.y[0] + POINTED, frame.y[1] - POINTED] };
        page.colour_bars.push(ColourBar::new(bar, scale));
        page.size[1] = (frame.y[1] + below + MARGIN).ceil();
        page
    }
}

/// Length of a line on the page, pixels.
fn length_of(axes: &Axes, points: &[[f64; 2]]) -> f64 {
    let places: Vec<Place> = points.iter().map(|[x, y]| axes.place(*x, *y)).collect();
    places.windows(2).map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)).sum()
}

/// Writes on each line what it is the line of: away from marks and other numbers, and as far from other lines as there is room.
fn write_numbers(page: &mut Page, axes: &Axes, lines: &[(Vec<[f64; 2]>, String)], marks: &[[f64; 2]]) {
    let place = |point: &[f64; 2]| axes.place(point[0], point[1]);
    let mut taken: Vec<Place> = marks.iter().map(place).collect();
    let all: Vec<Vec<Place>> = lines.iter().map(|(points, _)| points.iter().map(place).collect()).collect();
    for (at, ((points, text), places)) in lines.iter().zip(&all).enumerate() {
        if length_of(axes, points) < SHORTEST {
            continue;
        }
        let half = [0.5 * text_width(text, NUMBER) + 6.0, 0.5 * f64::from(NUMBER) + 2.0];
        let is_free = |(x, y): &Place| {
            let [left, right] = axes.frame.x;
            let [top, bottom] = axes.frame.y;
            let inside = x - half[0] > left && x + half[0] < right && y - half[1] > top && y + half[1] < bottom;
            let is_near = |(other_x, other_y): &Place| {
                (other_x - x).abs() < 2.0 * half[0] + 6.0 && (other_y - y).abs() < 2.0 * half[1] + 6.0
            };
            inside && !taken.iter().any(is_near)
        };
        let others = || all.iter().enumerate().filter(|(other, _)| *other != at).flat_map(|(_, places)| places);
        let to_others = |(x, y): &Place| {
            others().map(|(other_x, other_y)| (other_x - x).hypot(other_y - y)).fold(f64::INFINITY, f64::min)
        };
        let free = places.iter().filter(|place| is_free(place)).map(|place| (to_others(place), *place));
        let Some((_, found)) = free.max_by(|one, other| one.0.total_cmp(&other.0)) else { continue };
        let (x, y) = found;
        let frame = Frame { x: [x - half[0], x + half[0]], y: [y - half[1], y + half[1]] };
        page.keys.push(Key { frame, colour: GROUND, style: KeyStyle::Area });
        page.write(text.clone(), (x - half[0] + 6.0, y), Anchor::Right, NUMBER);
        taken.push(found);
    }
}
