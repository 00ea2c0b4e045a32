//! Contact area against time (paper Fig. 14): the mean over a revolution, and how far single steps are from it.

use plateau_io::run_file::ReadError;

use super::spans::{band, means, pieces};
use super::{Figures, Subject, operation, spans};
use crate::colour::paler;
use crate::figure::axes::Axis;
use crate::figure::canvas::LINE;
use crate::figure::chart::{COLUMN, Chart, Meaning, page, up_from_zero};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{Unit, title};

/// Colour of a line through single steps, as a part of the run's colour.
const PALE: f64 = 0.5;

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let having = figures.with_series("contact-area", subjects, &["contact_area", "contact_area_mean"]);
    let mut runs = Vec::new();
    for (number, subject) in having {
        let values = |name| Ok(subject.run.values(name)?.unwrap_or_default());
        let means = operation::while_pressed(subject.run, values("contact_area_mean")?)?;
        runs.push((number, subject, values("contact_area")?, means));
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
    let mut meanings = Vec::new();
    for (number, subject, single, mean) in &runs {
        let times: Vec<f64> = subject.run.time().iter().map(|seconds| time.value(*seconds)).collect();
        let single: Vec<f64> = single.iter().map(|value| area.value(*value)).collect();
        let stroke = Stroke::of(*number, subjects.len());
        steps.push(band(&times, &single, stroke.colour).unwrap_or_else(|| Content::Line {
            points: means(&times, &single),
            stroke: Stroke::solid(paler(stroke.colour, PALE), LINE),
        }));
        let mean: Vec<f64> = mean.iter().map(|value| area.value(*value)).collect();
        lines.extend(pieces(&means(&times, &mean)).into_iter().map(|points| Content::Line { points, stroke }));
        meanings.push(Meaning::of_run(*number, &subject.label));
    }
    let has_bands = steps.iter().any(|content| matches!(content, Content::Band { .. }));
    meanings.extend(spans::meanings(has_bands, "mean over a revolution", "least to greatest of single steps"));
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
            "Contact area against time: the line is the mean over the last revolution, the band reaches from the least to the \
         greatest of the samples of single steps. Where there are more samples than the figure can tell apart, the line is \
         their mean; where there are few, a paler line goes through those of single steps instead of the band.{of_operation}"
        ),
        page(width, height, 1, charts, &meanings),
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::colour::RUNS;
    use crate::figure::run::written::{Written, lines_of};

    #[test]
    fn a_lifted_pin_has_no_mean() {
        let lifted = |time: f64| (4.0..7.0).contains(&time);
        let run = Written::new("one", &["normal_force", "rotational_speed"], move |name, time| match name {
            "normal_force" if lifted(time) => 0.0,
            _ => 1.0,
        });
        let figures = Written::figures(&[run]);
        let figure = figures.figures.iter().find(|figure| figure.name == "contact-area").unwrap();
        let lines = lines_of(figure.page.panels.last().unwrap(), RUNS[0]);
        assert_eq!(lines.len(), 2, "{lines:?}");
        assert!(lines.iter().flatten().all(|[time, _]| !lifted(*time)), "{lines:?}");
    }
}
