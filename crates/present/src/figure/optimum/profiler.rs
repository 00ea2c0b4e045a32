//! Each response, and the mean desirability, against each factor, with the others at the optimum.

use std::ops::RangeInclusive;

use plateau_io::number;
use plateau_study::design::Setting;
use plateau_study::optimum::{Axis as Places, Kept};
use plateau_study::surrogate::Forecast;

use super::Shown;
use crate::colour::{DATA, DERIVED, FAINT, INK};
use crate::figure::axes::Axis;
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{Chart, Meaning, TWO_COLUMNS, note, page_of_rows};
use crate::figure::effects::{FactorAxis, axes, range_of, said_of_cuts};
use crate::figure::font::shortened;
use crate::figure::format::Figure;
use crate::figure::page::{Content, KeyStyle, Mark, Page};
use crate::figure::pages::with_lower_boxes;
use crate::figure::stroke::{Dashes, SOLID, Stroke};

/// Height of a box, pixels; at least, where there are many responses, and mostly.
const HEIGHTS: [f64; 2] = [220.0, 400.0];
/// Values along a range.
const VALUES: usize = 121;
/// How often a piece between two values is halved to find where the desirability comes to 0: a part in 10⁻⁷ of the range.
const HALVINGS: usize = 20;
/// Dashes of limits.
const DASHES: Dashes = &[14.0, 9.0];
/// Whether one sees through bands.
const OPACITY: f64 = 0.25;
/// Width of the boxes of one factor, as long as the page is wide enough; of the numbers and the label on the left; and between boxes, pixels.
const BOX: f64 = 620.0;
const LEFT: f64 = 300.0;
const BETWEEN: f64 = 48.0;
/// Distance of rows, pixels.
const BETWEEN_ROWS: f64 = 28.0;
/// Factors beside each other, at most.
const MOST_ACROSS: usize = 5;

/// The axis of the desirability: a curve at 0 is not on the frame.
const WORTH: RangeInclusive<f64> = -0.05..=1.05;

/// A place on the axis below, a value and the ends of its interval.
type Point = (f64, f64, Option<[f64; 2]>);

/// The figure, on one page or several.
pub fn figures(shown: &Shown<'_>) -> Vec<Figure> {
    let axes: Vec<FactorAxis<'_>> =
        axes(shown.analysis).into_iter().zip(shown.axes).map(|(axis, range)| looked_at(axis, range)).collect();
    let surrogates = shown.surrogates();
    let across = axes.len().div_ceil(axes.len().div_ceil(MOST_ACROSS).max(1)).max(1);
    let width = (BOX * across as f64 + LEFT).min(TWO_COLUMNS);
    let box_width = (width - LEFT) / across as f64 - BETWEEN;
    // The band is what has to keep the limits.
    let of_runs = shown.limits.iter().any(|limit| limit.kept == Kept::Runs);
    let band = |forecast: &Forecast| if of_runs { forecast.run_interval } else { forecast.mean_interval };
    let mut rows: Vec<Vec<Chart>> = Vec::new();
    let mut cut = "";
    for (at, (response, surrogate)) in shown.analysis.responses.iter().zip(&surrogates).enumerate() {
        let Some(surrogate) = surrogate else { continue };
        let unit = &response.scale.unit;
        let curves: Vec<Vec<Point>> = (0..axes.len())
            .map(|factor| {
                let along = settings(shown, &axes[factor], factor);
                curve(shown, &axes[factor], factor, along, |settings| {
                    let forecast = surrogate.forecast(settings, shown.confidence).ok()?;
                    Some((unit.value(forecast.value), band(&forecast).map(|ends| ends.map(|end| unit.value(end)))))
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
        let limits = limits(shown, at).into_iter().map(|limit| unit.value(limit)).collect::<Vec<_>>();
        let range = range_of(values.flatten().chain(limits.iter().copied()));
        rows.push(row(shown, &axes, &curves, &Axis::linear(range, response.head()), &limits, box_width));
    }
    let curves: Vec<Vec<Point>> = (0..axes.len())
        .map(|factor| {
            let worth = |settings: &[Setting]| shown.desirability(&surrogates, settings);
            let is_worth = |coded| {
                worth(&shown.with(&[(factor, Setting::Coded(coded))])).is_some_and(|desirability| desirability > 0.0)
            };
            let mut along = settings(shown, &axes[factor], factor);
            along.extend(ends_of(&along, is_worth));
            curve(shown, &axes[factor], factor, along, |settings| Some((worth(settings)?, None)))
        })
        .collect();
    rows.push(row(shown, &axes, &curves, &Axis::linear(WORTH, "desirability"), &[], box_width));
    let optimum: Vec<String> = self::axes(shown.analysis)
        .iter()
        .zip(shown.best)
        .map(|(axis, best)| format!("{} {}", axis.plain_name(), axis.name(*best)))
        .collect();
    let meaning = |colour, dashes, text: String| Meaning { colour, style: KeyStyle::Line(dashes), text };
    let level = number::confidence(shown.confidence);
    let mut meanings = vec![
        meaning(DATA, SOLID, format!("predicted, {level} of {}", if of_runs { "runs" } else { "means" })),
        meaning(DERIVED, SOLID, "optimum".to_owned()),
    ];
    meanings.extend((!shown.limits.is_empty()).then(|| meaning(INK, DASHES, "limit".to_owned())));
    let held = format!("each factor with the others held at the optimum: {}", optimum.join(", "));
    let caption = format!(
        "What each response is expected to be, and how much all goals are met, against each factor with the others at the \
         optimum; bands are intervals of {}, dashes are limits.{cut}",
        if of_runs { "one more run" } else { "the mean of many runs" }
    );
    let pages = pages(&rows, across, width, &meanings, &held);
    Figure::of_pages("profiler", "Responses and desirability against each factor", &caption, pages)
}

/// Pages with a row for each response and so many factors across; the others follow below the first ones.
fn pages(responses: &[Vec<Chart>], across: usize, width: f64, meanings: &[Meaning], held: &str) -> Vec<Page> {
    let factors = responses.first().map_or(0, Vec::len);
    let of_factors = |first: usize| responses.iter().map(move |row| row[first..factors.min(first + across)].to_vec());
    let rows: Vec<Vec<Chart>> = (0..factors).step_by(across).flat_map(of_factors).collect();
    with_lower_boxes(rows.len(), HEIGHTS, |some, height| {
        let mut rows = rows.clone();
        for (number, row) in rows.iter_mut().enumerate() {
            // The first box of a row has the numbers of all of it, and the lowest box of a factor on the page those of all of the factor's.
            let is_lowest = number + 1 == some.end || (number + 1) % responses.len() == 0;
            for (column, chart) in row.iter_mut().enumerate() {
                // There is room for it beside the distance to the next row.
                chart.y.label = shortened(&chart.y.label, TEXT, height + BETWEEN_ROWS);
                if column > 0 {
                    chart.y = chart.y.clone().shared();
                }
                if !is_lowest {
                    chart.x = Axis { label: String::new(), numbered: false, ..chart.x.clone() };
                }
            }
        }
        let mut page = page_of_rows(width, height, &rows, some, meanings);
        note(&mut page, held);
        page
    })
}

/// A factor as an axis: levels between which the optimum may be, or a value is held, lie on a range of values.
fn looked_at<'a>(axis: FactorAxis<'a>, range: &Places) -> FactorAxis<'a> {
    let is_between = match range {
        Places::Range => true,
        Places::Settings(settings) => settings.iter().any(|setting| matches!(setting, Setting::Coded(_))),
    };
    if is_between { axis.as_range() } else { axis }
}

/// The limits of a response.
fn limits(shown: &Shown<'_>, response: usize) -> Vec<f64> {
    let own = shown.limits.iter().filter(|limit| limit.response == response);
    own.flat_map(|limit| [limit.least, limit.most]).flatten().collect()
}

/// Where a factor is looked at; the optimum is one of these.
fn settings(shown: &Shown<'_>, axis: &FactorAxis<'_>, factor: usize) -> Vec<Setting> {
    match &shown.axes[factor] {
        _ if axis.is_range() => {
            let last = (VALUES - 1) as f64;
            let even = (0..VALUES).map(|at| Setting::Coded(-1.0 + 2.0 * at as f64 / last));
            even.chain([shown.best[factor]]).collect()
        }
        Places::Settings(settings) if settings.len() > 1 => settings.clone(),
        _ => axis.settings(VALUES),
    }
}

/// The ends of the parts of a range in which something is worth anything, from both sides: there a limit is reached, or one
/// goal is worth nothing.
fn ends_of(settings: &[Setting], is_worth: impl Fn(f64) -> bool) -> Vec<Setting> {
    let coded = |setting: &Setting| if let Setting::Coded(coded) = setting { Some(*coded) } else { None };
    let mut places: Vec<f64> = settings.iter().filter_map(coded).collect();
    places.sort_by(f64::total_cmp);
    let places: Vec<(f64, bool)> = places.into_iter().map(|place| (place, is_worth(place))).collect();
    let end = |pair: &[(f64, bool)]| {
        let [mut within, mut without] = match pair {
            [(one, true), (other, false)] | [(other, false), (one, true)] => [*one, *other],
            _ => return None,
        };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (within + without);
            if is_worth(middle) { within = middle } else { without = middle }
        }
        Some([within, without].map(Setting::Coded))
    };
    places.windows(2).filter_map(end).flatten().collect()
}

/// The values of a function at settings of a factor.
fn curve(
    shown: &Shown<'_>,
    axis: &FactorAxis<'_>,
    factor: usize,
    settings: Vec<Setting>,
    value: impl Fn(&[Setting]) -> Option<(f64, Option<[f64; 2]>)>,
) -> Vec<Point> {
    let point = |setting: Setting| {
        let (value, ends) = value(&shown.with(&[(factor, setting)]))?;
        Some((axis.place(setting), value, ends))
    };
    let mut points: Vec<Point> = settings.into_iter().filter_map(point).collect();
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    points
}

/// One box of this width for each factor, with one scale of values and lines at limits.
fn row(
    shown: &Shown<'_>,
    axes: &[FactorAxis<'_>],
    curves: &[Vec<Point>],
    y: &Axis,
    limits: &[f64],
    box_width: f64,
) -> Vec<Chart> {
    let chart = |(factor, (axis, points)): (usize, (&FactorAxis<'_>, &Vec<Point>))| {
        let mut contents = Vec::new();
        // Below the curves: what falls at the optimum is seen.
        let best = axis.place(shown.best[factor]);
        let line = vec![[best, *y.range.start()], [best, *y.range.end()]];
        contents.push(Content::Line { points: line, stroke: Stroke::solid(DERIVED, LINE - 1) });
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
        let x = axis.axis(box_width);
        contents.extend(limits.iter().map(|limit| Content::Line {
            points: vec![[*x.range.start(), *limit], [*x.range.end(), *limit]],
            stroke: Stroke { dashes: DASHES, ..Stroke::solid(INK, LINE) },
        }));
        let at_best: Vec<[f64; 2]> =
            points.iter().filter(|(place, ..)| *place == best).map(|(place, value, _)| [*place, *value]).collect();
        contents.push(Content::Marks { points: at_best, colour: DERIVED, mark: Mark::Dot });
        Chart { title: String::new(), x, y: y.clone(), contents }
    };
    axes.iter().zip(curves).enumerate().map(chart).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_what_is_worth_anything_are_found_between_settings() {
        let settings = [-1.0, -0.5, 0.0, 0.5, 1.0].map(Setting::Coded);
        let ends = |is_worth: fn(f64) -> bool| -> Vec<f64> {
            let coded = |setting| if let Setting::Coded(coded) = setting { coded } else { f64::NAN };
            ends_of(&settings, is_worth).into_iter().map(coded).collect()
        };
        // From 0.3 on; within first, then without.
        let found = ends(|coded| coded >= 0.3);
        assert_eq!(found.len(), 2);
        assert!(found[0] >= 0.3 && found[1] < 0.3 && found[0] - found[1] < 1e-6, "{found:?}");
        // A single setting that is worth something has an end on either side.
        let found = ends(|coded| coded == 0.0);
        assert!(found.len() == 4 && found.iter().all(|coded| coded.abs() < 1e-6), "{found:?}");
        assert!(ends(|_| true).is_empty() && ends(|_| false).is_empty());
    }
}
