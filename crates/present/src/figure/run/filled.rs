//! How far the lowlands of the disc are filled, and how much of disc and pin is plateau, against time.

use plateau_io::run_file::ReadError;

use super::legend::{meanings, of_short_runs, only_stroke, with_names};
use super::spans::{MOST_BANDS, Spans};
use super::{Figures, Subject, operation};
use crate::figure::axes::Axis;
use crate::figure::chart::{Chart, TWO_COLUMNS, page, up_from_zero};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{Unit, title};

const NAME: &str = "filled";
const SERIES: [&str; 4] = ["filled_fraction", "disc_secondary", "pin_secondary", "pin_primary"];

/// What a line is where its samples are put together.
const MEAN: &str = "mean of a span of time";

/// A run by its number, the times of its samples, s, and a series, %.
type Course<'a> = (usize, &'a [f64], Vec<f64>);

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let end = subjects.iter().filter_map(|subject| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let mut shown = vec![false; subjects.len()];
    let mut courses = Vec::new();
    for series in SERIES {
        let mut runs = Vec::new();
        for (number, subject) in figures.with_series(NAME, subjects, &[series]) {
            shown[number] = true;
            let values = subject.run.values(series)?.unwrap_or_default();
            let values: Vec<f64> = values.iter().map(|value| Unit::PERCENT.value(*value)).collect();
            runs.push((number, subject.run.time(), values));
        }
        if !runs.is_empty() {
            courses.push((series, runs));
        }
    }
    // All charts have lines of one kind; those of a run alone cross no others.
    let calm = |(_, runs): &(_, Vec<Course>)| Spans::calm(runs.iter().map(|(_, times, values)| (*times, &values[..])));
    let spans = match subjects {
        [_] => Spans::FINEST,
        _ if subjects.iter().any(operation::has_cycle) => Spans::FINEST,
        _ => courses.iter().map(calm).fold(Spans::FINEST, Spans::coarser),
    };
    let mut charts = Vec::new();
    let mut has_bands = false;
    for (series, runs) in courses {
        let (mut bands, mut lines) = (Vec::new(), Vec::new());
        let mut largest = 0.0_f64;
        for (number, times, values) in &runs {
            let scaled: Vec<f64> = times.iter().map(|at| time.value(*at)).collect();
            largest = values.iter().copied().fold(largest, f64::max);
            let stroke = Stroke::of(*number, subjects.len());
            if runs.len() <= MOST_BANDS {
                bands.extend(spans.band(&scaled, values, stroke.colour, runs.len()));
            }
            if !spans.is_weighted(times) {
                lines.push(Content::Line { points: Spans::FINEST.means_between_ends(&scaled, values), stroke });
            } else {
                let in_units = |[at, value]: [f64; 2]| [time.value(at), value];
                lines.extend(spans.lines(times, values, in_units, stroke));
            }
        }
        let y = if series == "filled_fraction" { "part of the volume" } else { "part of the area" };
        has_bands |= !bands.is_empty();
        charts.push(Chart {
            title: title(series).to_owned(),
            x: Axis::linear(0.0..=time.value(end), time.label("time")),
            y: Axis::linear(up_from_zero(largest), Unit::PERCENT.label(y)),
            contents: bands.into_iter().chain(lines).collect(),
        });
    }
    if charts.is_empty() {
        return Ok(());
    }
    let only = only_stroke(subjects, (0..subjects.len()).filter(|number| shown[*number]));
    let times = || subjects.iter().map(|subject| subject.run.time()).filter(|times| !times.is_empty());
    let is_binned = times().any(|times| spans.has_bands(times)) || spans != Spans::FINEST;
    let mut own = meanings(is_binned, only, &spans.meaning(MEAN), "least to greatest");
    own.truncate(if has_bands { 2 } else { 1 });
    let drawn = (0..subjects.len()).filter(|number| shown[*number]).map(|number| &subjects[number]);
    own.extend(of_short_runs(spans, drawn.map(|subject| (&*subject.label, subject.run.time())), MEAN));
    let meanings = with_names(subjects, |number| shown[number], own);
    let width = figures.width(TWO_COLUMNS);
    figures.add(
        NAME,
        "Filling and coverage",
        "Filled part of the initial volume below the highest point of the disc, and parts of the area of disc and pin that \
         are plateaus, against time. A cell is secondary as soon as debris of 1e-15 m lies on it. Where \
         there are more samples than the figure can tell apart, the line is their mean and the band their extent; more than three runs \
         have lines alone.",
        page(width, 560.0, 2, charts, &meanings),
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::run::written::Written;

    #[test]
    fn series_that_pulse_have_means_that_the_legend_states() {
        let texts = |more: &[&'static str], values: fn(f64) -> f64| {
            let run = |title| Written::new(title, more, move |_, time| values(time));
            let figures = Written::figures(&[run("one"), run("two")]);
            let page = &figures.figures.iter().find(|figure| figure.name == NAME).unwrap().page;
            page.texts.iter().map(|words| words.text.clone()).collect::<Vec<_>>()
        };
        let stated = "lines: weighted mean over 4 s".to_owned();
        let pulsing = |time: f64| 0.5 + 0.1 * (time % 2.0);
        assert!(texts(&[], pulsing).contains(&stated));
        let says_lines = |texts: Vec<String>| texts.iter().any(|text| text.starts_with("lines"));
        assert!(!says_lines(texts(&[], |time| 0.01 * time)));
        // Means over longer times would rise in a pause, before the braking in which they do.
        assert!(!says_lines(texts(&["normal_force"], pulsing)));
    }
}
