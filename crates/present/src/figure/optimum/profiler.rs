//! Each response, and the mean desirability, against each factor, with the others at the optimum.

use plateau_io::number;
use plateau_study::design::Setting;
use plateau_study::optimum::Axis as Range;

use super::Shown;
use crate::colour::{DATA, DERIVED, FAINT};
use crate::figure::axes::Axis;
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{Chart, Meaning, TWO_COLUMNS, page, up_from_zero};
use crate::figure::effects::{FactorAxis, axes, range_of, said_of_cuts};
use crate::figure::font::shortened;
use crate::figure::format::Figure;
use crate::figure::page::{Content, KeyStyle, Mark};
use crate::figure::stroke::{SOLID, Stroke};

/// Height of a box, pixels.
const HEIGHT: f64 = 400.0;
/// Values along a range.
const VALUES: usize = 41;
/// Whether one sees through bands.
const OPACITY: f64 = 0.25;
/// Width of the boxes of one factor up to this many factors; with more they share the page, pixels.
const BOX: f64 = 620.0;

/// A place on the axis below, a value and the ends of its interval.
type Point = (f64, f64, Option<[f64; 2]>);

/// The figure.
pub fn figure(shown: &Shown<'_>) -> Figure {
    let axes: Vec<FactorAxis<'_>> =
        axes(shown.analysis).into_iter().zip(shown.axes).map(|(axis, range)| looked_at(axis, range)).collect();
    let surrogates = shown.surrogates();
    let across = axes.len();
    let width = (BOX * across as f64 + 300.0).min(TWO_COLUMNS);
    let mut charts = Vec::new();
    let mut cut = "";
    for (response, surrogate) in shown.analysis.responses.iter().zip(&surrogates) {
        let Some(surrogate) = surrogate else { continue };
        let unit = &response.scale.unit;
        let curves: Vec<Vec<Point>> = (0..across)
            .map(|factor| {
                curve(shown, &axes[factor], factor, |settings| {
                    let forecast = surrogate.forecast(settings, shown.confidence).ok()?;
                    Some((
                        unit.value(forecast.value),
                        forecast.mean_interval.map(|ends| ends.map(|end| unit.value(end))),
                    ))
                })
            })
            .collect();
        let ends = curves.iter().flatten().flat_map(|(.., ends)| ends.unwrap_or([f64::NAN; 2]));
        if cut.is_empty() {
            cut = said_of_cuts(response.bounds, unit, ends);
        }
        let values = curves
            .iter()
            .flatten()
            .flat_map(|(_, value, ends)| [Some(*value), ends.map(|ends| ends[0]), ends.map(|ends| ends[1])]);
        let y = Axis::linear(range_of(values.flatten()), shortened(&response.head(), TEXT, HEIGHT));
        charts.extend(row(shown, &axes, &curves, &y, false));
    }
    let curves: Vec<Vec<Point>> = (0..across)
        .map(|factor| {
            curve(shown, &axes[factor], factor, |settings| Some((shown.desirability(&surrogates, settings)?, None)))
        })
        .collect();
    charts.extend(row(shown, &axes, &curves, &Axis::linear(up_from_zero(1.0), "desirability"), true));
    let meaning = |colour, text: String| Meaning { colour, style: KeyStyle::Line(SOLID), text };
    let level = number::rounded(100.0 * shown.confidence, 4);
    let meanings = [meaning(DATA, format!("predicted, {level} % of means")), meaning(DERIVED, "optimum".to_owned())];
    Figure {
        name: "profiler".to_owned(),
        title: "Responses and desirability against each factor".to_owned(),
        caption: format!(
            "What each response is expected to be, and how much all goals are met, against each factor with the others at the \
             optimum; bands are intervals of the mean of many runs.{cut}"
        ),
        page: page(width, HEIGHT, across, charts, &meanings),
    }
}

/// A factor as an axis: levels between which the optimum may be, or a value is held, lie on a range of values.
fn looked_at<'a>(axis: FactorAxis<'a>, range: &Range) -> FactorAxis<'a> {
    let is_between = match range {
        Range::Range => true,
        Range::Settings(settings) => settings.iter().any(|setting| matches!(setting, Setting::Coded(_))),
    };
    if is_between { axis.as_range() } else { axis }
}

/// The values of a function along a factor.
fn curve(
    shown: &Shown<'_>,
    axis: &FactorAxis<'_>,
    factor: usize,
    value: impl Fn(&[Setting]) -> Option<(f64, Option<[f64; 2]>)>,
) -> Vec<Point> {
    let settings: Vec<Setting> = match &shown.axes[factor] {
        _ if axis.is_range() => {
            let last = (VALUES - 1) as f64;
            (0..VALUES).map(|at| Setting::Coded(-1.0 + 2.0 * at as f64 / last)).collect()
        }
        Range::Settings(settings) if settings.len() > 1 => settings.clone(),
        _ => axis.settings(VALUES),
    };
    let point = |setting: Setting| {
        let (value, ends) = value(&shown.with(&[(factor, setting)]))?;
        Some((axis.place(setting), value, ends))
    };
    let mut points: Vec<Point> = settings.into_iter().filter_map(point).collect();
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    points
}

/// One box for each factor, with one scale of values.
fn row(shown: &Shown<'_>, axes: &[FactorAxis<'_>], curves: &[Vec<Point>], y: &Axis, is_last: bool) -> Vec<Chart> {
    let chart = |(factor, (axis, points)): (usize, (&FactorAxis<'_>, &Vec<Point>))| {
        let mut contents = Vec::new();
        let spans: Vec<[f64; 3]> =
            points.iter().filter_map(|(x, _, ends)| ends.map(|[low, high]| [*x, low, high])).collect();
        if axis.is_range() && !spans.is_empty() {
            contents.push(Content::Band { spans, colour: DATA, opacity: OPACITY });
        } else {
            let bar = |[x, low, high]: &[f64; 3]| Content::Line {
                points: vec![[*x, *low], [*x, *high]],
                stroke: Stroke::solid(DATA, LINE),
            };
            contents.extend(spans.iter().map(bar));
        }
        let places: Vec<[f64; 2]> = points.iter().map(|(x, value, _)| [*x, *value]).collect();
        if axis.is_range() {
            contents.push(Content::Line { points: places, stroke: Stroke::solid(DATA, LINE + 2) });
        } else {
            contents.push(Content::Line { points: places.clone(), stroke: Stroke::solid(FAINT, LINE) });
            contents.push(Content::Marks { points: places, colour: DATA, mark: Mark::Dot });
        }
        let best = axis.place(shown.best[factor]);
        let line = vec![[best, *y.range.start()], [best, *y.range.end()]];
        contents.push(Content::Line { points: line, stroke: Stroke::solid(DERIVED, LINE) });
        let x = axis.axis(axis.room());
        let x = if is_last { x } else { Axis { label: String::new(), numbered: false, ..x } };
        Chart { title: String::new(), x, y: if factor == 0 { y.clone() } else { y.clone().shared() }, contents }
    };
    axes.iter().zip(curves).enumerate().map(chart).collect()
}
