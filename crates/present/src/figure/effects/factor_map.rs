//! A map over two factors: colours, lines of equal value with their numbers, the runs, and one mark.

use std::ops::RangeInclusive;

use plateau_study::design::Setting;

use super::FactorAxis;
use super::line_numbers::{NumberedLine, all_numbered, length_of, numbers};
use crate::colour::{APART, COLOURS, GROUND, INK, colour_index, colour_map};
use crate::figure::axes::{Axes, Axis, Frame, most_ticks_upward};
use crate::figure::brush::Place;
use crate::figure::canvas::LINE;
use crate::figure::chart::{COLUMN, MARGIN, Meaning, legend, note};
use crate::figure::colour_bar::ColourBar;
use crate::figure::contour::Field;
use crate::figure::hull::{hull, is_within};
use crate::figure::page::{Content, KeyStyle, Mark, Page, Panel};
use crate::figure::picture::Picture;
use crate::figure::stroke::Stroke;
use crate::study::analysis::Analysis;

/// Steps of the map along each axis, and where there are places without a value, whose rim is to be seen.
const STEPS: usize = 160;
const FINE: usize = 320;
/// One step beyond the runs for so many of the map: marks at its ends are not on the frame.
const ROOM: usize = 16;
/// Part of the map that a dot hides.
const HIDDEN: f64 = 1e-3;
/// How far settings may differ that are the same, in coded units.
const SAME: f64 = 1e-6;
/// Height of the box, pixels.
const HEIGHT: f64 = 800.0;
/// Room on the right for a colour bar with numbers and label, its width and its distance from the map, pixels.
const BAR_ROOM: f64 = 270.0;
const BAR: f64 = 40.0;
const BESIDE: f64 = 36.0;
/// Room for the points at the ends of the bar.
const POINTED: f64 = 34.0;
/// Dashes and gaps of borders, pixels.
const BORDER: [f64; 2] = [14.0, 8.0];
/// Open lines that are shorter are not drawn, pixels: beside places without a value they are pieces of lines.
const PIECE: f64 = 70.0;

/// Values over two factors.
pub struct FactorMap<'a> {
    /// Which factors.
    pub factors: [usize; 2],
    /// The same as axes.
    pub axes: [&'a FactorAxis<'a>; 2],
    /// Coded values at the ends of the runs.
    ends: [[f64; 2]; 2],
    /// Steps between these, and beyond them on either side.
    steps: usize,
    room: usize,
    /// The rim of the runs, in coded values, where these do not reach to the corners.
    rim: Vec<[f64; 2]>,
    /// Column by column, from below, in the unit in which they are shown; NaN where there is none.
    values: Vec<f64>,
}

/// Where runs are: with all other factors as they are on the map, and elsewhere; each place once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapRuns {
    /// In the plane of the map.
    pub within: Vec<[f64; 2]>,
    /// With other settings of the other factors.
    pub elsewhere: Vec<[f64; 2]>,
}

impl MapRuns {
    /// What is said of those elsewhere.
    pub fn note(&self) -> String {
        let said = "hollow dots: runs with other values of the factors that are held";
        if self.elsewhere.is_empty() { String::new() } else { said.to_owned() }
    }

    fn all(&self) -> Vec<[f64; 2]> {
        [&self.within[..], &self.elsewhere[..]].concat()
    }
}

impl<'a> FactorMap<'a> {
    /// The values of a function of the coded values of two factors, as far as there are runs.
    pub fn new(
        analysis: &Analysis,
        factors: [usize; 2],
        axes: [&'a FactorAxis<'a>; 2],
        value: impl Fn([f64; 2]) -> Option<f64>,
    ) -> Self {
        let coded = |settings: &[Setting], at: usize| axes[at].factor.factor.coded(settings[factors[at]]);
        let places: Vec<[f64; 2]> =
            analysis.runs.iter().filter_map(|(settings, _)| Some([coded(settings, 0)?, coded(settings, 1)?])).collect();
        let ends = [0, 1].map(|at| {
            let coded = places.iter().map(|place| place[at]);
            let (low, high) = coded.fold((-1.0, 1.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
            [low, high]
        });
        // Ranges reach to their corners; axial points beyond them do not.
        let is_beyond = ends.iter().flatten().any(|end| end.abs() > 1.0 + SAME);
        let rim = if is_beyond { hull(&places) } else { Vec::new() };
        let at_steps = |steps: usize| {
            let room = steps / ROOM;
            let mut map = Self { factors, axes, ends, steps, room, rim: rim.clone(), values: Vec::new() };
            let points = map.points();
            let at = |at: usize| {
                let coded = map.coded([(at / points) as f64, (at % points) as f64]);
                if map.is_within(coded) { value(coded).unwrap_or(f64::NAN) } else { f64::NAN }
            };
            map.values = (0..points * points).map(at).collect();
            map
        };
        let map = at_steps(STEPS);
        let has_gaps = |map: &Self| (0..map.values.len()).any(|at| map.is_gap(at));
        if (has_gaps(&map) || is_beyond) && map.varies() { at_steps(FINE) } else { map }
    }

    /// Points along each axis.
    fn points(&self) -> usize {
        self.steps + 1 + 2 * self.room
    }

    /// Coded values at a column and a row.
    fn coded(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|at| {
            let [low, high] = self.ends[at];
            low + (high - low) * (place[at] - self.room as f64) / self.steps as f64
        })
    }

    /// Whether a point of the map has no value although there are runs about it.
    fn is_gap(&self, at: usize) -> bool {
        let points = self.points();
        self.values[at].is_nan() && self.is_within(self.coded([(at / points) as f64, (at % points) as f64]))
    }

    /// Whether there are places without a value that are more than a run's dot hides.
    fn has_visible_gaps(&self) -> bool {
        let gaps = (0..self.values.len()).filter(|at| self.is_gap(*at)).count();
        gaps as f64 > HIDDEN * self.values.len() as f64
    }

    /// Whether there are values that are not all the same.
    pub fn varies(&self) -> bool {
        let [low, high] = self.range();
        high > low
    }

    /// The least and the greatest value.
    pub fn range(&self) -> [f64; 2] {
        let fold = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
        self.values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], fold)
    }

    /// Values of both factors, in their units, at coded values.
    fn natural(&self, coded: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|at| self.axes[at].on_axis(coded[at]))
    }

    /// Where the runs of the study are; `held` are the settings of all factors on the map, none of those that are averaged over.
    pub fn runs(&self, analysis: &Analysis, held: &[Option<Setting>]) -> MapRuns {
        let mut runs = MapRuns::default();
        let mut elsewhere: Vec<[f64; 2]> = Vec::new();
        for (settings, _) in &analysis.runs {
            let coded = [0, 1].map(|at| self.axes[at].factor.factor.coded(settings[self.factors[at]]));
            let [Some(x), Some(y)] = coded else { continue };
            let is_held = |factor: usize| {
                let of = &analysis.factors[factor].factor;
                let Some(held) = held.get(factor).copied().flatten() else { return true };
                match (of.coded(settings[factor]), of.coded(held)) {
                    (Some(own), Some(held)) => (own - held).abs() < SAME,
                    _ => settings[factor] == held,
                }
            };
            let is_within = (0..settings.len()).all(|factor| self.factors.contains(&factor) || is_held(factor));
            let own = if is_within { &mut runs.within } else { &mut elsewhere };
            let point = self.natural([x, y]);
            if !own.contains(&point) {
                own.push(point);
            }
        }
        elsewhere.retain(|point| !runs.within.contains(point));
        MapRuns { elsewhere, ..runs }
    }

    /// Whether coded values are on the map: where there are runs.
    pub fn is_within(&self, coded: [f64; 2]) -> bool {
        let in_ends = |at: usize| (self.ends[at][0] - SAME..=self.ends[at][1] + SAME).contains(&coded[at]);
        let in_rim = self.rim.is_empty() || is_within(&self.rim, coded, SAME);
        (0..2).all(in_ends) && in_rim
    }

    fn picture(&self) -> Picture {
        let [low, high] = self.range();
        let points = self.points();
        let index = |at: usize| match self.values[at] {
            value if !value.is_nan() => colour_index((value - low) / (high - low)),
            _ if self.is_gap(at) => COLOURS as u8,
            _ => COLOURS as u8 + 1,
        };
        let rows = (0..points).rev();
        let indices = rows.flat_map(|row| (0..points).map(move |column| column * points + row)).map(index);
        let palette = colour_map().into_iter().chain([APART, GROUND]).collect();
        Picture { columns: points, rows: points, indices: indices.collect(), palette }
    }

    /// Lines through values at which so many ticks are, with what these say.
    fn contours(&self, scale: &Axis, ticks: usize) -> Vec<NumberedLine> {
        scale.ticks(ticks).into_iter().flat_map(|(level, text)| self.lines_at(level, &text)).collect()
    }

    /// Lines along which the map has a value, with a text.
    pub fn lines_at(&self, level: f64, text: &str) -> Vec<NumberedLine> {
        let field = Field { values: &self.values, rows: self.points() };
        let point = |place: [f64; 2]| self.natural(self.coded(place));
        let lines = field.contours(level).into_iter().filter(|places| places.len() > 1);
        lines.map(|places| (places.into_iter().map(point).collect(), text.to_owned())).collect()
    }

    /// The page: `scale` makes an axis of the values, `none` says where there is none, `borders` are lines that are named, `runs` are
    /// where runs are, and `mark` is a place in coded values with what it is; notes stand below.
    pub fn page(
        &self,
        scale: impl Fn(RangeInclusive<f64>, f64) -> Axis,
        none: &str,
        borders: &[NumberedLine],
        runs: &MapRuns,
        mark: Option<([f64; 2], String)>,
        notes: &[String],
    ) -> Page {
        let mut page = Page { size: [COLUMN, 0.0], ..Page::default() };
        let meaning = |mark, text: String| Meaning { colour: INK, style: KeyStyle::Mark(mark), text };
        let marks = [(Mark::Rimmed, &runs.within, "runs"), (Mark::Hollow, &runs.elsewhere, "runs elsewhere")];
        let marks = marks.into_iter().filter(|(_, places, _)| !places.is_empty());
        let mut meanings: Vec<Meaning> = marks.map(|(mark, _, text)| meaning(mark, text.to_owned())).collect();
        meanings.extend(mark.as_ref().map(|(_, text)| meaning(Mark::Cross, text.clone())));
        if self.has_visible_gaps() {
            meanings.push(Meaning { colour: APART, style: KeyStyle::Area, text: none.to_owned() });
        }
        let top = legend(&mut page, &meanings, MARGIN) + 12.0;
        let [low, high] = self.range();
        let scale = scale(low..=high, HEIGHT);
        // A picture's outer points lie on the edge of the box by their middles.
        let [first, last] = [-0.5, self.points() as f64 - 0.5].map(|place| self.natural(self.coded([place; 2])));
        let range = |at: usize| first[at]..=last[at];
        let y = self.axes[1].between(range(1), HEIGHT);
        let left = (MARGIN + y.room_beside(HEIGHT)).round();
        let frame = Frame { x: [left, COLUMN - BAR_ROOM], y: [top, top + HEIGHT].map(f64::round) };
        let x = self.axes[0].between(range(0), frame.width());
        let below = x.room_below();
        let axes = Axes { frame, x, y };
        let marked: Vec<[f64; 2]> = mark.iter().map(|(coded, _)| self.natural(*coded)).collect();
        let is_valued = |place: Place| {
            let [x, y] = axes.values(place);
            let part = |at: usize, value: f64| {
                let axis = if at == 0 { &axes.x } else { &axes.y };
                (axis.part(value) * self.points() as f64) as usize
            };
            let (column, row) = (part(0, x).min(self.points() - 1), part(1, y).min(self.points() - 1));
            !self.values[column * self.points() + row].is_nan()
        };
        let marks = [runs.all(), marked.clone()].concat();
        let numbered = |ticks: usize| {
            let mut lines = self.contours(&scale, ticks);
            lines.retain(|(points, _)| points.first() == points.last() || length_of(&axes, points) >= PIECE);
            // What is named first has the most room.
            let lines = [borders, &lines[..]].concat();
            let numbers = numbers(&axes, &lines, &marks, is_valued);
            (lines, numbers)
        };
        let (lines, numbers) = all_numbered(most_ticks_upward(HEIGHT - 2.0 * POINTED), numbered);
        let mut contents = vec![Content::Map(self.picture())];
        let line = |(at, (points, _)): (usize, &NumberedLine)| {
            let dashed = Stroke { colour: INK, width: LINE, dashes: &BORDER };
            let stroke = if at < borders.len() { dashed } else { Stroke::solid(GROUND, LINE - 1) };
            Content::Line { points: points.clone(), stroke }
        };
        contents.extend(lines.iter().enumerate().map(line));
        let outline = self.outline();
        contents.extend(
            (outline.len() > 1).then(|| Content::Line { points: outline, stroke: Stroke::solid(GROUND, LINE + 3) }),
        );
        contents.push(Content::Marks { points: runs.elsewhere.clone(), colour: INK, mark: Mark::Hollow });
        contents.push(Content::Marks { points: runs.within.clone(), colour: INK, mark: Mark::Rimmed });
        numbers.into_iter().for_each(|number| number.write(&mut page));
        if !marked.is_empty() {
            contents.push(Content::Marks { points: marked, colour: INK, mark: Mark::Cross });
        }
        page.panels.push(Panel { axes, contents });
        let bar = frame.x[1] + BESIDE;
        let bar = Frame { x: [bar, bar + BAR], y: [frame.y[0] + POINTED, frame.y[1] - POINTED] };
        page.colour_bars.push(ColourBar::new(bar, scale));
        page.size[1] = (frame.y[1] + below + MARGIN).ceil();
        notes.iter().for_each(|text| note(&mut page, text));
        page
    }

    /// The rim of the runs, where it is no rectangle.
    fn outline(&self) -> Vec<[f64; 2]> {
        self.rim.iter().chain(self.rim.first()).map(|coded| self.natural(*coded)).collect()
    }
}
