//! How far the lowlands of the disc are filled, and how much of disc and pin is plateau, against time.

use plateau_io::run_file::ReadError;

use super::chart::{Chart, Meaning, TWO_COLUMNS, colour, line_width, page, up_from_zero};
use super::spans::{band, means_between_ends};
use super::{Figures, Subject};
use crate::figure::axes::Axis;
use crate::figure::page::Content;
use crate::figure::unit::ScaledUnit;

const NAME: &str = "filled";
const SERIES: [(&str, &str); 4] = [
    ("filled_fraction", "disc, filled volume"),
    ("disc_secondary", "disc, secondary plateaus"),
    ("pin_secondary", "pin, secondary plateaus"),
    ("pin_primary", "pin, primary plateaus"),
];

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let end = subjects.iter().filter_map(|subject| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = ScaledUnit::for_time(end);
    let percent = ScaledUnit::PERCENT.per_si;
    let mut charts = Vec::new();
    let mut shown = vec![false; subjects.len()];
    for (series, title) in SERIES {
        let (mut bands, mut lines) = (Vec::new(), Vec::new());
        let mut largest = 0.0_f64;
        for (number, subject) in figures.with_series(NAME, subjects, &[series]) {
            shown[number] = true;
            let values = subject.run.values(series)?.unwrap_or_default();
            let times: Vec<f64> = subject.run.time().iter().map(|at| at * time.per_si).collect();
            let values: Vec<f64> = values.iter().map(|value| value * percent).collect();
            largest = values.iter().copied().fold(largest, f64::max);
            bands.extend(band(&times, &values, colour(number)));
            let width = line_width(number, subjects.len());
            lines.push(Content::Line { points: means_between_ends(&times, &values), colour: colour(number), width });
        }
        if lines.is_empty() {
            continue;
        }
        let y = if series == "filled_fraction" { "filled, %" } else { "part of the area, %" };
        charts.push(Chart {
            title: title.to_owned(),
            x: Axis::linear(0.0..=end * time.per_si, format!("time, {}", time.symbol)),
            y: Axis::linear(up_from_zero(largest), y),
            contents: bands.into_iter().chain(lines).collect(),
        });
    }
    if charts.is_empty() {
        return Ok(());
    }
    let meanings: Vec<Meaning> = subjects
        .iter()
        .enumerate()
        .filter(|(number, _)| shown[*number])
        .map(|(number, subject)| Meaning::of_run(number, subject))
        .collect();
    figures.add(
        NAME,
        "Filling and coverage",
        "Filled part of the initial volume below the highest point of the disc, and parts of the area of disc and pin that \
         are plateaus, against time. A cell is secondary as soon as any debris lies on it. Where \
         there are more samples than the figure can tell apart, the line is their mean and the band their extent.",
        page(TWO_COLUMNS, 560.0, 2, charts, &meanings),
    );
    Ok(())
}
