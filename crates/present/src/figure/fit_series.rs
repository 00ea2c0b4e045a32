//! A series that keys were fitted to: what was measured, and what runs give at the most likely values.

use plateau_study::fit::{FitResult, FittedSeries};

use super::axes::Axis;
use super::canvas::{LINE, TEXT};
use super::chart::{COLUMN, Chart, Meaning, around, page};
use super::effects::file_names;
use super::font::shortened;
use super::format::Figure;
use super::page::{Content, KeyStyle, Mark};
use super::stroke::{SOLID, Stroke};
use crate::colour::{DATA, DERIVED, FAINT};
use crate::quantity::Unit;

/// Height of a box, pixels.
const HEIGHT: f64 = 620.0;
/// Whether one sees through the band.
const OPACITY: f64 = 0.3;
/// Points above which they have no bars: there is no room between them.
const MOST_BARS: usize = 120;
/// Points above which they are drawn small.
const MOST_DOTS: usize = 20;

/// A figure for each series; `names` are those of the responses, with the SI units of the series.
pub fn figures(result: &FitResult, names: &[(&str, &'static str)]) -> Vec<Figure> {
    let files = file_names(names.iter().map(|(name, _)| *name));
    let each = result.series.iter().zip(names).zip(files);
    each.map(|((series, (name, si)), file)| figure(series, name, si, &file)).collect()
}

fn figure(series: &FittedSeries, name: &str, si: &str, file: &str) -> Figure {
    let measured = &series.measured;
    let largest = measured.values().iter().chain(&series.forecast).map(|value| value.abs()).fold(0.0, f64::max);
    let unit = Unit::readable_with_differences(si, largest);
    let time = Unit::readable("s", measured.times().last().copied().unwrap_or(0.0));
    let place = |at: usize, value: f64| [time.value(measured.times()[at]), unit.value(value)];
    let points = 0..measured.times().len();
    let bar = |at: usize| {
        let (value, uncertainty) = (measured.values()[at], measured.uncertainties()[at]);
        [place(at, value - uncertainty), place(at, value + uncertainty)]
    };
    let band = |at: usize| {
        let [x, low] = place(at, series.forecast[at] - series.deviations[at]);
        [x, low, unit.value(series.forecast[at] + series.deviations[at])]
    };
    let bars: Vec<[[f64; 2]; 2]> = points.clone().map(bar).collect();
    let spans: Vec<[f64; 3]> = points.clone().map(band).collect();
    let ends: Vec<f64> =
        bars.iter().flatten().map(|[_, y]| *y).chain(spans.iter().flat_map(|s| [s[1], s[2]])).collect();
    let times: Vec<f64> = measured.times().iter().map(|at| time.value(*at)).collect();
    let mut contents = Vec::new();
    if bars.len() <= MOST_BARS {
        let line = |bar: [[f64; 2]; 2]| Content::Line { points: bar.to_vec(), stroke: Stroke::solid(FAINT, LINE) };
        contents.extend(bars.iter().copied().map(line));
    }
    let dots = points.clone().map(|at| place(at, measured.values()[at])).collect();
    let mark = if bars.len() > MOST_DOTS { Mark::Point } else { Mark::Dot };
    contents.push(Content::Marks { points: dots, colour: DERIVED, mark });
    contents.push(Content::Band { spans, colour: DATA, opacity: OPACITY });
    let forecast = points.map(|at| place(at, series.forecast[at])).collect();
    contents.push(Content::Line { points: forecast, stroke: Stroke::solid(DATA, LINE + 2) });
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(around(&times), time.label("time")),
        y: Axis::linear(around(&ends), shortened(&unit.label(name), TEXT, HEIGHT)),
        contents,
    };
    let meaning = |colour, style, text: &str| Meaning { colour, style, text: text.to_owned() };
    let measured = if bars.len() <= MOST_BARS { "measured, with its uncertainty" } else { "measured" };
    let meanings = [
        meaning(DERIVED, KeyStyle::Mark(mark), measured),
        meaning(DATA, KeyStyle::Line(SOLID), "runs at the most likely values"),
    ];
    Figure {
        name: format!("series-{file}"),
        title: format!("{name} as measured, and as runs give it"),
        caption: format!(
            "{name} against time as it was measured, and as runs give it at the most likely values of the keys; the band is the \
             standard deviation of that for want of runs and seeds."
        ),
        page: page(COLUMN, HEIGHT, 1, vec![chart], &meanings),
    }
}
