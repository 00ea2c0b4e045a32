//! The response that a quadratic model predicts over two factors.

use plateau_study::design::Setting;
use plateau_study::effects::Model;

use super::{FactorAxis, ResponseFigures, Subject};
use crate::colour::{GROUND, INK, colour_index, colour_map};
use crate::figure::axes::{Axes, Axis, Frame, most_ticks_upward};
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{COLUMN, MARGIN, Meaning, legend};
use crate::figure::colour_bar::ColourBar;
use crate::figure::contour::Field;
use crate::figure::font::shortened;
use crate::figure::page::{Content, KeyStyle, Mark, Page, Panel};
use crate::figure::picture::Picture;

/// Points of the map along each axis.
const POINTS: usize = 121;
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

/// The predicted response over two factors.
struct Map<'a> {
    factors: [usize; 2],
    axes: [&'a FactorAxis<'a>; 2],
    /// Coded values at the ends.
    ends: [[f64; 2]; 2],
    /// Column by column, from below, in the unit of the response.
    values: Vec<f64>,
}

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    if subject.effects.model != Model::Quadratic {
        return;
    }
    let Some(factors) = factors(subject) else {
        figures.left_out.push("A response surface needs two factors that are numbers.".to_owned());
        return;
    };
    let Some(map) = Map::new(subject, factors) else {
        figures
            .left_out
            .push("The response surface is not drawn: the model does not vary over its factors.".to_owned());
        return;
    };
    let stationary = stationary(subject, factors);
    let points = map.design(subject);
    let page = map.page(subject, &points, stationary);
    let caption = caption(subject, &map, stationary);
    subject.add(figures, "surface", "Response surface of", caption, page);
}

/// The two numeric factors that have the largest share in the differences between runs, in the order of the study.
fn factors(subject: &Subject) -> Option<[usize; 2]> {
    let effects = subject.effects;
    let mut numeric: Vec<(usize, f64)> = (0..subject.axes.len())
        .filter(|factor| subject.axes[*factor].factor.factor.is_numeric())
        .map(|factor| {
            let own = effects.terms.iter().filter(|term| term.factors.contains(&factor));
            (factor, own.map(|term| term.sum_of_squares).sum())
        })
        .collect();
    numeric.sort_by(|one, other| other.1.total_cmp(&one.1));
    match numeric[..] {
        [(one, _), (other, _), ..] => Some([one.min(other), one.max(other)]),
        _ => None,
    }
}

/// The predicted response where two factors have these coded values, in SI units.
fn predicted(subject: &Subject, factors: [usize; 2], coded: [f64; 2]) -> Option<f64> {
    let given = [0, 1].map(|at| (factors[at], Setting::Coded(coded[at])));
    subject.effects.predict_at(&given).ok().map(|prediction| prediction.value)
}

/// Where the response over two factors is level, in coded values, and what it is there.
fn stationary(subject: &Subject, factors: [usize; 2]) -> Option<([f64; 2], &'static str)> {
    level_point(|x, y| predicted(subject, factors, [x, y]))
}

/// Where a polynomial of second degree is level, and what it is there: six of its values tell it.
fn level_point(at: impl Fn(f64, f64) -> Option<f64>) -> Option<([f64; 2], &'static str)> {
    let centre = at(0.0, 0.0)?;
    let (left, right, below, above) = (at(-1.0, 0.0)?, at(1.0, 0.0)?, at(0.0, -1.0)?, at(0.0, 1.0)?);
    let slopes = [0.5 * (right - left), 0.5 * (above - below)];
    let squares = [0.5 * (right + left) - centre, 0.5 * (above + below) - centre];
    let product = at(1.0, 1.0)? - centre - slopes[0] - slopes[1] - squares[0] - squares[1];
    // 2·B·x = −b, with B = [[b11, b12/2], [b12/2, b22]].
    let determinant = 4.0 * squares[0] * squares[1] - product * product;
    let size = (2.0 * squares[0]).powi(2) + (2.0 * squares[1]).powi(2) + product * product;
    if determinant.abs() <= 1e-9 * size {
        return None;
    }
    let x = (product * slopes[1] - 2.0 * squares[1] * slopes[0]) / determinant;
    let y = (product * slopes[0] - 2.0 * squares[0] * slopes[1]) / determinant;
    let nature = match (determinant > 0.0, squares[0] > 0.0) {
        (true, true) => "minimum",
        (true, false) => "maximum",
        (false, _) => "saddle",
    };
    Some(([x, y], nature))
}

impl<'a> Map<'a> {
    fn new(subject: &Subject<'a>, factors: [usize; 2]) -> Option<Self> {
        let coded = |factor: usize| {
            let of = &subject.axes[factor].factor.factor;
            subject.analysis.runs.iter().filter_map(move |(settings, _)| of.coded(settings[factor]))
        };
        let ends = factors.map(|factor| {
            let (low, high) = coded(factor).fold((-1.0, 1.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
            [low - BEYOND * (high - low), high + BEYOND * (high - low)]
        });
        let value = |at: usize| {
            let part = |index: usize, [low, high]: [f64; 2]| low + (high - low) * index as f64 / (POINTS - 1) as f64;
            let coded = [part(at / POINTS, ends[0]), part(at % POINTS, ends[1])];
            predicted(subject, factors, coded).map(|value| subject.unit.value(value))
        };
        let values: Vec<f64> = (0..POINTS * POINTS).map(value).collect::<Option<_>>()?;
        let map = Self { factors, axes: factors.map(|factor| &subject.axes[factor]), ends, values };
        let [low, high] = map.range();
        (high > low).then_some(map)
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
    fn design(&self, subject: &Subject) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for (settings, _) in &subject.analysis.runs {
            let coded = [0, 1].map(|at| self.axes[at].factor.factor.coded(settings[self.factors[at]]));
            let [Some(x), Some(y)] = coded else { continue };
            let point = self.natural([x, y]);
            if !points.contains(&point) {
                points.push(point);
            }
        }
        points
    }

    fn picture(&self) -> Picture {
        let [low, high] = self.range();
        let rows = (0..POINTS).rev();
        let indices = rows.flat_map(|row| {
            (0..POINTS).map(move |column| colour_index((self.values[column * POINTS + row] - low) / (high - low)))
        });
        Picture { columns: POINTS, rows: POINTS, indices: indices.collect(), palette: colour_map() }
    }

    /// Lines through the values at which the colour bar has numbers.
    fn contours(&self, scale: &Axis, length: f64) -> Vec<Content> {
        let field = Field { values: &self.values, rows: POINTS };
        let point = |[column, row]: [f64; 2]| {
            let part = |place: f64, [low, high]: [f64; 2]| low + (high - low) * place / (POINTS - 1) as f64;
            self.natural([part(column, self.ends[0]), part(row, self.ends[1])])
        };
        let levels = scale.ticks(most_ticks_upward(length));
        let lines = levels.into_iter().flat_map(|(level, _)| field.contours(level));
        let line = |places: Vec<[f64; 2]>| Content::Line {
            points: places.into_iter().map(point).collect(),
            colour: GROUND,
            width: LINE - 1,
        };
        lines.filter(|places| places.len() > 1).map(line).collect()
    }

    fn page(&self, subject: &Subject, points: &[[f64; 2]], stationary: Option<([f64; 2], &'static str)>) -> Page {
        let mut page = Page { size: [COLUMN, 0.0], ..Page::default() };
        let meaning = |mark, text: String| Meaning { colour: INK, style: KeyStyle::Mark(mark), text };
        let mut meanings = vec![meaning(Mark::Rimmed, "runs".to_owned())];
        let within = stationary.filter(|(coded, _)| self.is_within(*coded));
        meanings.extend(within.map(|(_, nature)| meaning(Mark::Cross, format!("{nature} of the surface"))));
        let top = legend(&mut page, &meanings, MARGIN) + 12.0;
        let [low, high] = self.range();
        let scale = Axis::linear(low..=high, shortened(&subject.label(), TEXT, HEIGHT));
        let bar_height = HEIGHT - 2.0 * POINTED;
        // A picture's outer points lie on the edge of the box by their middles.
        let half = |at: usize| 0.5 * (self.ends[at][1] - self.ends[at][0]) / (POINTS - 1) as f64;
        let range = |at: usize| {
            let [low, high] = self.ends[at];
            self.axes[at].natural(low - half(at))..=self.axes[at].natural(high + half(at))
        };
        let y = Axis::linear(range(1), shortened(&self.axes[1].label(), TEXT, HEIGHT));
        let left = (MARGIN + y.room_beside(HEIGHT)).round();
        let frame = Frame { x: [left, COLUMN - BAR_ROOM], y: [top, top + HEIGHT].map(f64::round) };
        let x = Axis::linear(range(0), shortened(&self.axes[0].label(), TEXT, frame.width()));
        let below = x.room_below();
        let mut contents = vec![Content::Map(self.picture())];
        contents.extend(self.contours(&scale, bar_height));
        contents.push(Content::Marks { points: points.to_vec(), colour: INK, mark: Mark::Rimmed });
        let place = within.map(|(coded, _)| vec![self.natural(coded)]);
        contents.extend(place.map(|points| Content::Marks { points, colour: INK, mark: Mark::Cross }));
        page.panels.push(Panel { axes: Axes { frame, x, y }, contents });
        let bar = frame.x[1] + BESIDE;
        let bar = Frame { x: [bar, bar + BAR], y: [frame.y[0] + POINTED, frame.y[1] - POINTED] };
        page.colour_bars.push(ColourBar { frame: bar, axis: scale });
        page.size[1] = (frame.y[1] + below + MARGIN).ceil();
        page
    }

    fn is_within(&self, coded: [f64; 2]) -> bool {
        (0..2).all(|at| (self.ends[at][0]..=self.ends[at][1]).contains(&coded[at]))
    }
}

fn caption(subject: &Subject, map: &Map, stationary: Option<([f64; 2], &'static str)>) -> String {
    let mut caption =
        "Response that the quadratic model predicts, with lines at the numbers of the colour bar.".to_owned();
    let others = subject.axes.iter().enumerate().filter(|(factor, _)| !map.factors.contains(factor));
    let (numbers, words): (Vec<_>, Vec<_>) =
        others.map(|(_, axis)| axis).partition(|axis| axis.factor.factor.is_numeric());
    if !numbers.is_empty() {
        let middle = |axis: &&FactorAxis| format!("{} = {}", axis.factor.factor.name, axis.name(Setting::Coded(0.0)));
        caption.push_str(&format!(
            " Shown are the two factors with the largest share; the others are at 0 in coded units, the middle of their \
             range: {}.",
            numbers.iter().map(middle).collect::<Vec<_>>().join(", ")
        ));
    }
    if !words.is_empty() {
        let words: Vec<&str> = words.iter().map(|axis| axis.factor.factor.name.as_str()).collect();
        caption.push_str(&format!(" It is averaged over the levels of {}.", words.join(", ")));
    }
    match stationary {
        None => caption.push_str(" The surface is a ridge: it has no single stationary point."),
        Some((coded, nature)) => {
            let place = |at: usize| {
                let axis = map.axes[at];
                format!("{} = {}", axis.factor.factor.name, axis.name(Setting::Coded(coded[at])))
            };
            let beyond = if map.is_within(coded) { "" } else { ", beyond the map" };
            caption.push_str(&format!(" It is level at {}, {}: a {nature}{beyond}.", place(0), place(1)));
        }
    }
    caption
}

#[cfg(test)]
mod tests {
    use super::level_point;

    #[test]
    fn the_level_point_of_a_polynomial() {
        // By hand: slopes 2·(x − 0.5) + (y + 0.25) and (x − 0.5) − 4·(y + 0.25) are zero there; 2·(−4) − 1 < 0: a saddle.
        let saddle = |x: f64, y: f64| {
            let (x, y) = (x - 0.5, y + 0.25);
            Some(7.0 + x * x + x * y - 2.0 * y * y)
        };
        let ([x, y], nature) = level_point(saddle).unwrap();
        assert!((x - 0.5).abs() < 1e-12 && (y + 0.25).abs() < 1e-12 && nature == "saddle");
        let bowl = |sign: f64| level_point(move |x, y| Some(sign * (x * x + x * y + y * y))).unwrap().1;
        assert_eq!([bowl(1.0), bowl(-1.0)], ["minimum", "maximum"]);
        assert_eq!(level_point(|x, y| Some((x + y) * (x + y) + x)), None);
        assert_eq!(level_point(|x, _| Some(x)), None);
    }
}
