//! Contact area against time (paper Fig. 14): the mean over a simulated revolution, and how far single steps are from it.

use plateau_io::run_file::ReadError;

use super::spans::{band, means, pieces};
use super::{Figures, Subject, only_stroke, operation, spans, with_names};
use crate::colour::paler;
use crate::figure::axes::Axis;
use crate::figure::canvas::LINE;
use crate::figure::chart::{COLUMN, Chart, Meaning, page, up_from_zero};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{Unit, title};

/// Colour of a line through single steps, as a part of the run's colour.
const PALE: f64 = 0.5;
/// What the line of a run is.
const MEAN: &str = "mean of a simulated revolution";

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let having = figures.with_series("contact-area", subjects, &["contact_area", "contact_area_mean"]);
    let mut runs = Vec::new();
    for (number, subject) in having {
        let values = |name| Ok(subject.run.values(name)?.unwrap_or_default());
        let rubbing = |name| operation::while_rubbing(subject.run, values(name)?);
        runs.push((number, subject, rubbing("contact_area")?, rubbing("contact_area_mean")?));
    }
    if runs.is_empty() {
        return Ok(());
    }
    let largest = runs.iter().flat_map(|(_, _, single, mean)| single.iter().chain(mean)).copied().fold(0.0, f64::max);
    let area = Unit::for_size("m2", largest);
    let end = runs.iter().filter_map(|(_, subject, ..)| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let mut steps = Vec::new();
    let mut lines = Vec::new();
    for (number, subject, single, mean) in &runs {
        let times: Vec<f64> = subject.run.time().iter().map(|seconds| time.value(*seconds)).collect();
        let single: Vec<f64> = single.iter().map(|value| area.value(*value)).collect();
        let stroke = Stroke::of(*number, subjects.len());
        let bands = band(&times, &single, stroke.colour);
        let is_banded = !bands.is_empty();
        steps.extend(bands);
        if !is_banded {
            let stroke = single_steps(stroke);
            steps.extend(pieces(&means(&times, &single)).into_iter().map(|points| Content::Line { points, stroke }));
        }
        let mean: Vec<f64> = mean.iter().map(|value| area.value(*value)).collect();
        lines.extend(pieces(&means(&times, &mean)).into_iter().map(|points| Content::Line { points, stroke }));
    }
    let has_bands = steps.iter().any(|content| matches!(content, Content::Band { .. }));
    let only = only_stroke(subjects, runs.iter().map(|(number, ..)| *number));
    let own = match only {
        _ if has_bands => spans::meanings(true, only, MEAN, "least to greatest of single steps"),
        Some(stroke) => {
            vec![Meaning::of_line(stroke, MEAN), Meaning::of_line(single_steps(stroke), "single steps")]
        }
        None => vec![Meaning::in_words(&format!("lines: {MEAN}, paler: single steps"))],
    };
    let meanings = with_names(subjects, |shown| runs.iter().any(|(number, ..)| *number == shown), own);
    let mut charts = operation::charts(subjects, &time, end)?;
    let (with_operation, height) = (!charts.is_empty(), if charts.is_empty() { 760.0 } else { 420.0 });
    charts.push(Chart {
        title: String::new(),
        x: Axis::linear(0.0..=time.value(end), time.label("time")),
        y: Axis::linear(up_from_zero(area.value(largest)), area.label(title("contact_area"))),
        contents: steps.into_iter().chain(lines).collect(),
    });
    if let [subject] = subjects {
        operation::shade_events(subject.run, &time, &mut charts)?;
    }
    let of_operation = if with_operation {
        " Above it load and speed; spans with both are shaded (of a single run that has ended)."
    } else {
        ""
    };
    let width = figures.width(COLUMN);
    figures.add(
        "contact-area",
        "Contact area",
        format!(
            "Contact area against time: the line is the mean over the last simulated revolution, the band reaches from the least \
         to the greatest of the samples of single steps. Where there are more samples than the figure can tell apart, the line \
         is their mean; where there are few, a paler line goes through those of single steps instead of the band. Both have a gap \
         where nothing rubs.{of_operation}"
        ),
        page(width, height, 1, charts, &meanings),
    );
    Ok(())
}

/// How a line through single steps is drawn.
fn single_steps(stroke: Stroke) -> Stroke {
    Stroke { colour: paler(stroke.colour, PALE), width: LINE, ..stroke }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::RUNS;
    use crate::figure::run::written::{Written, lines_of};

    #[test]
    fn where_nothing_rubs_there_is_a_gap() {
        let is_still = |time: f64| (4.0..7.0).contains(&time);
        for zero in ["normal_force", "rotational_speed"] {
            let run = Written::new("one", &["normal_force", "rotational_speed"], move |name, time| {
                if name == zero && is_still(time) { 0.0 } else { 1.0 }
            });
            let figures = Written::figures(&[run]);
            let figure = figures.figures.iter().find(|figure| figure.name == "contact-area").unwrap();
            let own = Stroke::of(0, 1).colour;
            for colour in [own, paler(own, PALE)] {
                let lines = lines_of(figure.page.panels.last().unwrap(), colour);
                assert_eq!(lines.len(), 2, "{zero}: {lines:?}");
                assert!(lines.iter().flatten().all(|[time, _]| !is_still(*time)), "{zero}: {lines:?}");
            }
        }
    }

    #[test]
    fn the_legend_has_the_colours_that_are_drawn() {
        let run = |title| Written::new(title, &[], |_, _| 1.0);
        let figures = Written::figures(&[run("one")]);
        let figure = figures.figures.iter().find(|figure| figure.name == "contact-area").unwrap();
        let drawn = [RUNS[0], paler(RUNS[0], PALE)];
        assert_eq!(figure.page.keys.iter().map(|key| key.colour).collect::<Vec<_>>(), drawn);
        let figures = Written::figures(&[run("one"), run("two")]);
        let figure = figures.figures.iter().find(|figure| figure.name == "contact-area").unwrap();
        assert_eq!(figure.page.keys.iter().map(|key| key.colour).collect::<Vec<_>>(), RUNS[..2]);
    }
}
