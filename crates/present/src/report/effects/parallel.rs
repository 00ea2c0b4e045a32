//! All runs as lines over axes side by side: parallel coordinates.
//!
//! The lines are drawn here, so that they are there without scripts; the script of the page filters them.

use std::fmt::Write as _;

use plateau_study::design::Setting;
use serde::Serialize;

use crate::colour::viridis;
use crate::figure::effects::FactorAxis;
use crate::quantity::Unit;
use crate::report::html;
use crate::study::analysis::{AnalysedResponse, Analysis};
use plateau_io::number;

/// Colours of lines.
const COLOURS: usize = 16;
/// Parts of the colour map that can be seen on light and on dark paper.
const LIGHT: [f64; 2] = [0.0, 0.88];
const DARK: [f64; 2] = [0.28, 1.0];
/// Room on both sides of the axes, and the ends of the axes, pixels.
const SIDE: f64 = 80.0;
const TOP: f64 = 66.0;
const BOTTOM: f64 = 386.0;
const HEIGHT: f64 = 404.0;
/// Distance of axes: where there are few, and at least.
const WIDTH: f64 = 940.0;
const DISTANCES: [f64; 2] = [130.0, 190.0];
/// More levels than this have no names beside their axis.
const NAMED: usize = 16;
/// From so many runs on, lines are faint.
const MANY: usize = 200;

/// What the script of the page knows.
#[derive(Debug, Serialize)]
pub struct Parallel {
    axes: Vec<PlotAxis>,
    /// Values of each run on each axis, of levels their places; null where there is none.
    runs: Vec<Vec<Option<f64>>>,
    /// Places of the axes, and of their ends.
    places: Vec<f64>,
    ends: [f64; 2],
    /// The axis that gives lines their colours.
    coloured: Option<usize>,
    colours: usize,
}

/// An axis.
#[derive(Debug, Serialize)]
struct PlotAxis {
    name: String,
    unit: String,
    low: f64,
    high: f64,
    /// Names of levels, from below; empty for numbers.
    levels: Vec<String>,
    is_response: bool,
}

impl Parallel {
    /// The runs of a study.
    pub fn new(analysis: &Analysis, factors: &[FactorAxis]) -> Self {
        let mut axes: Vec<PlotAxis> = factors.iter().map(PlotAxis::of_factor).collect();
        let units: Vec<Unit> = (0..analysis.responses.len())
            .map(|at| {
                let values = analysis.runs.iter().map(|(_, responses)| responses[at].abs());
                let largest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
                Unit::readable_with_differences(analysis.responses[at].unit, largest)
            })
            .collect();
        let values = |(settings, responses): &(Vec<Setting>, Vec<f64>)| {
            let settings =
                factors.iter().zip(settings).map(|(axis, setting)| six_digits(axis.straight_place(*setting)));
            let responses = responses.iter().zip(&units).map(|(value, unit)| six_digits(unit.value(*value)));
            settings.chain(responses).collect()
        };
        let runs: Vec<Vec<Option<f64>>> = analysis.runs.iter().map(values).collect();
        for (at, (response, unit)) in analysis.responses.iter().zip(units).enumerate() {
            let values = runs.iter().filter_map(|run| run[factors.len() + at]);
            axes.push(PlotAxis::of_response(response, unit, values));
        }
        let distance = (WIDTH / (axes.len().max(2) - 1) as f64).clamp(DISTANCES[0], DISTANCES[1]).round();
        let places = (0..axes.len()).map(|at| SIDE + distance * at as f64).collect();
        let has_values = |axis: &usize| runs.iter().any(|run| run[*axis].is_some());
        let coloured = (factors.len()..axes.len()).find(has_values);
        Self { axes, runs, places, ends: [TOP, BOTTOM], coloured, colours: COLOURS }
    }

    /// The JSON document of the page.
    pub fn to_json(&self) -> String {
        // Texts, numbers and lists of them can always be written.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The section of the page.
    pub fn html(&self) -> String {
        let width = self.places.last().map_or(0.0, |last| last + SIDE);
        let faint = if self.runs.len() >= MANY { " many" } else { "" };
        let lines: String = self.runs.iter().map(|run| self.line(run)).collect();
        let axes: String = (0..self.axes.len()).map(|at| self.axis(at)).collect();
        format!(
            "<p class=\"hint\">One line for each run, over the axes of factors and responses. Drag along axes to show only \
             the runs within; click an axis to show all again. With the keyboard: arrow keys on an axis move what is shown, \
             with Shift they move its upper end, Escape clears it.</p>\n\
             <div id=\"parallel-controls\" class=\"controls\"></div>\n{}\
             <div class=\"scroll parallel\" tabindex=\"0\" role=\"region\" aria-label=\"Runs as lines\">\n\
             <svg id=\"parallel\" viewBox=\"0 0 {width} {HEIGHT}\" width=\"{width}\" height=\"{HEIGHT}\">\n\
             <g class=\"lines{faint}\">\n{lines}</g>\n{axes}</svg></div>\n\
             <p class=\"reading\" id=\"parallel-reading\" aria-live=\"polite\"></p>\n",
            self.key()
        )
    }

    /// Where a value lies on an axis, 0 at its lower end.
    fn part(&self, axis: usize, value: f64) -> f64 {
        let PlotAxis { low, high, .. } = self.axes[axis];
        (value - low) / (high - low)
    }

    fn height(&self, axis: usize, value: f64) -> f64 {
        BOTTOM - (BOTTOM - TOP) * self.part(axis, value)
    }

    /// A run, in pieces where it has no value.
    fn line(&self, run: &[Option<f64>]) -> String {
        let mut path = String::new();
        let mut pen = 'M';
        for (axis, value) in run.iter().enumerate() {
            match value {
                Some(value) => {
                    // Writing to a String cannot fail.
                    let _ = write!(path, "{pen}{} {:.1}", self.places[axis], self.height(axis, *value));
                    pen = 'L';
                }
                None => pen = 'M',
            }
        }
        let class = self.coloured.and_then(|axis| Some(colour(self.part(axis, run[axis]?))));
        let class = class.map_or_else(|| "none".to_owned(), |colour| format!("c{colour}"));
        format!("<path class=\"{class}\" d=\"{path}\"/>\n")
    }

    fn axis(&self, at: usize) -> String {
        let axis = &self.axes[at];
        // Names of neighbours stand at different heights, so that they may be twice as long.
        let y = if at.is_multiple_of(2) { 14.0 } else { 34.0 };
        let unit = if axis.unit.is_empty() { String::new() } else { format!(", {}", axis.unit) };
        let name = format!("{}{unit}", axis.name);
        let mut text = format!(
            "<g class=\"axis\" data-axis=\"{at}\" transform=\"translate({} 0)\">\n<title>{}</title>\n\
             <line y1=\"{TOP}\" y2=\"{BOTTOM}\"/>\n<text class=\"name\" y=\"{y}\">{}</text>\n",
            self.places[at],
            html::escape(&name),
            html::escape(&shortened(&axis.name, &unit)),
        );
        for (value, label) in axis.ticks() {
            let _ = writeln!(
                text,
                "<text class=\"tick\" x=\"7\" y=\"{:.1}\">{}</text>",
                self.height(at, value) + 4.0,
                html::escape(&label)
            );
        }
        text + "</g>\n"
    }

    /// What colours mean.
    fn key(&self) -> String {
        let Some(axis) = self.coloured.map(|axis| &self.axes[axis]) else { return String::new() };
        let [low, high] = [axis.low, axis.high].map(|end| number::rounded(end, 4));
        let unit = if axis.unit.is_empty() { String::new() } else { format!(" {}", axis.unit) };
        let samples: String = (0..COLOURS).map(|colour| format!("<i class=\"c{colour}\"></i>")).collect();
        format!(
            "<p class=\"ramp\" id=\"parallel-key\"><span>{}</span> <span>{low}{unit}</span><span>{samples}</span>\
             <span>{high}{unit}</span></p>\n",
            html::escape(&axis.name)
        )
    }
}

impl PlotAxis {
    fn of_factor(axis: &FactorAxis) -> Self {
        let settings = axis.settings(2);
        let places: Vec<f64> = settings.iter().map(|setting| axis.straight_place(*setting)).collect();
        let (low, high) = (places.first().copied().unwrap_or(0.0), places.last().copied().unwrap_or(1.0));
        let level = |setting: &Setting| match setting {
            Setting::Level(level) => axis.names.get(*level).cloned(),
            Setting::Coded(_) => None,
        };
        let (name, unit, levels) =
            (axis.factor.factor.name.clone(), axis.unit.clone(), settings.iter().filter_map(level).collect());
        let high = if high > low { high } else { low + 1.0 };
        Self { name, unit, low, high, levels, is_response: false }
    }

    fn of_response(response: &AnalysedResponse, unit: Unit, values: impl Iterator<Item = f64>) -> Self {
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = match high - low {
            length if length > 0.0 => (low, high),
            // All runs at the middle.
            0.0 => (low - 0.5 * low.abs().max(1.0), high + 0.5 * low.abs().max(1.0)),
            _ => (0.0, 1.0),
        };
        Self {
            name: response.name.clone(),
            unit: unit.symbol.into_owned(),
            low,
            high,
            levels: Vec::new(),
            is_response: true,
        }
    }

    /// Values that are named beside the axis.
    fn ticks(&self) -> Vec<(f64, String)> {
        match self.levels.len() {
            0 => [self.low, 0.5 * (self.low + self.high), self.high]
                .map(|value| (value, number::rounded(value, 3)))
                .to_vec(),
            count if count <= NAMED => {
                self.levels.iter().enumerate().map(|(at, name)| (at as f64, shortened(name, ""))).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Which of the colours a part of an axis has.
fn colour(part: f64) -> usize {
    ((part * COLOURS as f64) as usize).min(COLOURS - 1)
}

/// The colours, for light and for dark paper.
pub fn colours() -> String {
    let rules = |[from, to]: [f64; 2]| -> String {
        let colour = |at: usize| viridis(from + (to - from) * at as f64 / (COLOURS - 1) as f64);
        (0..COLOURS)
            .map(|at| (at, colour(at)))
            .map(|(at, colour)| format!(".c{at} {{ --colour: #{:02x}{:02x}{:02x}; }}\n", colour.0, colour.1, colour.2))
            .collect()
    };
    let (light, dark) = (rules(LIGHT), rules(DARK));
    format!("{light}@media (prefers-color-scheme: dark) {{\n{dark}}}\n@media print {{\n{light}}}\n")
}

/// A name that fits between axes, with what follows it.
fn shortened(name: &str, behind: &str) -> String {
    const LETTERS: usize = 30;
    let room = LETTERS.saturating_sub(behind.chars().count()).max(8);
    if name.chars().count() <= room {
        return format!("{name}{behind}");
    }
    let kept: String = name.chars().take(room - 1).collect();
    format!("{}…{behind}", kept.trim_end())
}

/// A number with six digits; none where there is none.
fn six_digits(value: f64) -> Option<f64> {
    if !value.is_finite() {
        return None;
    }
    format!("{value:.5e}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits_and_nothing_stays_nothing() {
        assert_eq!([1.0 / 3.0, 1.234_567_8e9, 0.0].map(six_digits), [Some(0.333_333), Some(1.234_57e9), Some(0.0)]);
        assert_eq!(six_digits(f64::NAN), None);
    }

    #[test]
    fn colours_cover_the_axis() {
        assert_eq!([0.0, 0.49, 0.5, 1.0].map(colour), [0, 7, 8, 15]);
        assert_eq!(colours().matches(".c0 {").count(), 3);
    }

    #[test]
    fn lines_have_gaps_where_there_is_no_value() {
        let axis = |name: &str| PlotAxis {
            name: name.into(),
            unit: String::new(),
            low: 0.0,
            high: 2.0,
            levels: Vec::new(),
            is_response: false,
        };
        let parallel = Parallel {
            axes: ["<a>", "b", "c"].map(axis).into(),
            runs: vec![],
            places: vec![10.0, 20.0, 30.0],
            ends: [TOP, BOTTOM],
            coloured: Some(2),
            colours: COLOURS,
        };
        assert_eq!(
            parallel.line(&[Some(0.0), Some(2.0), Some(1.0)]),
            "<path class=\"c8\" d=\"M10 386.0L20 66.0L30 226.0\"/>\n"
        );
        assert_eq!(parallel.line(&[Some(0.0), Some(2.0), None]), "<path class=\"none\" d=\"M10 386.0L20 66.0\"/>\n");
        assert!(parallel.axis(0).contains("&lt;a&gt;") && !parallel.axis(0).contains("<a>"));
    }
}
