//! How far the lowlands of the disc are filled, and how much of disc and pin is plateau, against time.

use plateau_io::run_file::ReadError;

use super::spans::Spans;
use super::{Figures, Subject, only_stroke, spans, with_names};
use crate::figure::axes::Axis;
use crate::figure::chart::{Chart, TWO_COLUMNS, page, up_from_zero};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{Unit, title};

const NAME: &str = "filled";
const SERIES: [&str; 4] = ["filled_fraction", "disc_secondary", "pin_secondary", "pin_primary"];

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let end = subjects.iter().filter_map(|subject| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let mut charts = Vec::new();
    let mut shown = vec![false; subjects.len()];
    let mut has_bands = false;
    for series in SERIES {
        let (mut bands, mut lines) = (Vec::new(), Vec::new());
        let mut largest = 0.0_f64;
        let having = figures.with_series(NAME, subjects, &[series]);
        for (number, subject) in &having {
            let number = *number;
            shown[number] = true;
            let values = subject.run.values(series)?.unwrap_or_default();
            let times: Vec<f64> = subject.run.time().iter().map(|at| time.value(*at)).collect();
            let values: Vec<f64> = values.iter().map(|value| Unit::PERCENT.value(*value)).collect();
            largest = values.iter().copied().fold(largest, f64::max);
            let stroke = Stroke::of(number, subjects.len());
            bands.extend(Spans::FINEST.band(&times, &values, stroke.colour, having.len()));
            lines.push(Content::Line { points: Spans::FINEST.means_between_ends(&times, &values), stroke });
        }
        if lines.is_empty() {
            continue;
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
    let own = spans::meanings(has_bands, only, "mean of a span of time", "least to greatest");
    let meanings = with_names(subjects, |number| shown[number], own);
    let width = figures.width(TWO_COLUMNS);
    figures.add(
        NAME,
        "Filling and coverage",
        "Filled part of the initial volume below the highest point of the disc, and parts of the area of disc and pin that \
         are plateaus, against time. A cell is secondary as soon as any debris lies on it. Where \
         there are more samples than the figure can tell apart, the line is their mean and the band their extent.",
        page(width, 560.0, 2, charts, &meanings),
    );
    Ok(())
}
