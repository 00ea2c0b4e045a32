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
use crate::colour::{DATA, DATA_AREA, DERIVED, FAINT};
use crate::quantity::Unit;

/// Height of a box, pixels.
const HEIGHT: f64 = 620.0;
/// Whether one sees through the band.
const OPACITY: f64 = 0.3;
/// Points above which they have no bars: there is no room between them.
const MOST_BARS: usize = 120;
/// Points above which they are drawn small.
const MOST_DOTS: usize = 20;

/// A figure for each series; `names` are those of the responses, with the SI units of the series, `times` the units in which their
/// tables have the time.
pub fn figures(result: &FitResult, names: &[(&str, &'static str)], times: &[&str]) -> Vec<Figure> {
    let files = file_names(names.iter().map(|(name, _)| *name));
    let each = result.series.iter().zip(names).zip(times).zip(files);
    each.map(|(((series, (name, si)), time), file)| figure(series, name, si, time, &file)).collect()
}

/// The unit of a time as a table has it; one that serves where it is another.
fn unit_of_time(stated: &str, last: f64) -> Unit {
    let known = [("s", 1.0), ("ms", 1e3), ("min", 1.0 / 60.0), ("h", 1.0 / 3600.0)];
    let found = known.into_iter().find(|(name, _)| *name == stated);
    found.map_or_else(|| Unit::readable("s", last), |(name, per_si)| Unit { symbol: name.into(), per_si, offset: 0.0 })
}

fn figure(series: &FittedSeries, name: &str, si: &str, time: &str, file: &str) -> Figure {
    let measured = &series.measured;
    let largest = measured.values().iter().chain(&series.forecast).map(|value| value.abs()).fold(0.0, f64::max);
    let unit = Unit::readable_with_differences(si, largest);
    let time = unit_of_time(time, measured.times().last().copied().unwrap_or(0.0));
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
    let mut contents = vec![Content::Band { spans, colour: DATA, opacity: OPACITY }];
    let dots = points.clone().map(|at| place(at, measured.values()[at])).collect();
    let mark = if bars.len() > MOST_DOTS { Mark::Point } else { Mark::Dot };
    if bars.len() <= MOST_BARS {
        let line = |bar: [[f64; 2]; 2]| Content::Line { points: bar.to_vec(), stroke: Stroke::solid(FAINT, LINE) };
        contents.extend(bars.iter().copied().map(line));
    }
    let forecast = points.map(|at| place(at, series.forecast[at])).collect();
    contents.push(Content::Line { points: forecast, stroke: Stroke::solid(DATA, LINE + 2) });
    contents.push(Content::Marks { points: dots, colour: DERIVED, mark });
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(around(&times), time.label("time")),
        y: Axis::linear(around(&ends), shortened(&unit.label(name), TEXT, HEIGHT)),
        contents,
    };
    let meaning = |colour, style, text: &str| Meaning { colour, style, text: text.to_owned() };
    let measured = if bars.len() <= MOST_BARS { "measured ± 1σ" } else { "measured" };
    let meanings = [
        meaning(DERIVED, KeyStyle::Mark(mark), measured),
        meaning(DATA, KeyStyle::Line(SOLID), "runs at the most likely values"),
        meaning(DATA_AREA, KeyStyle::Area, "± 1σ of that, for want of runs and seeds"),
    ];
    Figure {
        name: format!("series-{file}"),
        title: format!("{name} as measured, and as runs give it"),
        caption: format!(
            "{name} against time as it was measured, with bars of one standard uncertainty, and as runs give it at the most likely \
             values of the keys; the band is one standard deviation of that for want of runs and seeds."
        ),
        page: page(COLUMN, HEIGHT, 1, vec![chart], &meanings),
    }
}

#[cfg(test)]
mod tests {
    use super::unit_of_time;

    #[test]
    fn the_time_is_in_the_unit_of_the_table() {
        let minutes = unit_of_time("min", 120.0);
        assert_eq!((minutes.label("time").as_str(), minutes.value(120.0)), ("time, min", 2.0));
        assert_eq!(unit_of_time("d", 120.0).label("time"), "time, s");
    }
}
