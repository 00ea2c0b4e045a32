//! Contact area against time (paper Fig. 14): the mean over a simulated revolution, and how far single steps are from it.

use plateau_io::run_file::ReadError;

use super::legend::{meanings, of_short_runs, only_stroke, with_names};
use super::spans::{MOST_BANDS, Spans, pieces};
use super::{Figures, Subject, operation};
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
    // Of the single steps of more runs none could be told from the others.
    let with_steps = runs.len() <= MOST_BANDS;
    if !with_steps {
        runs.iter_mut().for_each(|(_, _, single, _)| single.clear());
    }
    let end = runs.iter().filter_map(|(_, subject, ..)| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let mut charts = operation::charts(subjects, &time, end)?;
    let with_operation = !charts.is_empty();
    let spans = match subjects.iter().any(operation::has_cycle) {
        true => Spans::FINEST,
        false => Spans::calm(runs.iter().map(|(_, subject, _, mean)| (subject.run.time(), &mean[..]))),
    };
    let course = |subject: &Subject, mean: &[f64]| spans.course(subject.run.time(), mean);
    let drawn = runs.iter().flat_map(|(_, subject, _, mean)| course(subject, mean)).flatten().map(|[_, mean]| mean);
    let largest = runs.iter().flat_map(|(_, _, single, _)| single).copied().chain(drawn).fold(0.0, f64::max);
    let area = Unit::for_size("m2", largest);
    let mut steps = Vec::new();
    let mut lines = Vec::new();
    for (number, subject, single, mean) in &runs {
        let times: Vec<f64> = subject.run.time().iter().map(|seconds| time.value(*seconds)).collect();
        let single: Vec<f64> = single.iter().map(|value| area.value(*value)).collect();
        let stroke = Stroke::of(*number, subjects.len());
        let bands = spans.band(&times, &single, stroke.colour, runs.len());
        let is_banded = !bands.is_empty();
        steps.extend(bands);
        if !is_banded {
            let stroke = single_steps(stroke);
            let points = pieces(&Spans::FINEST.means(&times, &single));
            steps.extend(points.into_iter().map(|points| Content::Line { points, stroke }));
        }
        let in_units = |[at, mean]: [f64; 2]| [time.value(at), area.value(mean)];
        lines.extend(spans.lines(subject.run.time(), mean, in_units, stroke));
    }
    let has_bands = steps.iter().any(|content| matches!(content, Content::Band { .. }));
    let only = only_stroke(subjects, runs.iter().map(|(number, ..)| *number));
    let line = spans.meaning(MEAN);
    let mut own = match only {
        _ if has_bands => meanings(true, only, &line, "least to greatest of single steps"),
        Some(stroke) => {
            vec![Meaning::of_line(stroke, &line), Meaning::of_line(single_steps(stroke), "single steps")]
        }
        None if with_steps => vec![Meaning::in_words(&format!("lines: {line}, paler: single steps"))],
        None => vec![Meaning::in_words(&format!("lines: {line}"))],
    };
    own.extend(of_short_runs(spans, runs.iter().map(|(_, subject, ..)| (&*subject.label, subject.run.time())), MEAN));
    let mut meanings = with_names(subjects, |shown| runs.iter().any(|(number, ..)| *number == shown), own);
    let height = if with_operation { 420.0 } else { 760.0 };
    charts.push(Chart {
        title: String::new(),
        x: Axis::linear(0.0..=time.value(end), time.label("time")),
        y: Axis::linear(up_from_zero(area.value(largest)), area.label(title("contact_area"))),
        contents: steps.into_iter().chain(lines).collect(),
    });
    meanings.extend(operation::shade_events(subjects, &time, &mut charts)?);
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
            "Contact area against time: the line is the mean over the last simulated revolution, or, where this goes up and down \
             all along and the run is long enough, a weighted mean over the time that is stated. The band reaches from the least to the greatest of the samples \
             of single steps; where there are few, a paler line goes through these. Of more than three runs there are the \
             means alone. All have a gap where nothing rubs.{of_operation}"
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
    use crate::figure::page::Page;
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
    fn many_runs_that_pulse_have_lines_alone() {
        let pulsing = |name: &str, time: f64| match name {
            "contact_area_mean" => 1.0 + (time % 2.0),
            _ => 1.0 + (time % 3.0),
        };
        let page = |runs: usize| {
            let runs: Vec<Written> = (0..runs).map(|_| Written::new("one", &[], pulsing)).collect();
            let figures = Written::figures(&runs);
            figures.figures.iter().find(|figure| figure.name == "contact-area").unwrap().page.clone()
        };
        let has = |page: &Page, wanted: &str| page.texts.iter().any(|words| words.text == wanted);
        let [three, four] = [3, 4].map(page);
        assert_eq!((three.panels[0].contents.len(), four.panels[0].contents.len()), (6, 4));
        assert!(has(&three, "lines: weighted mean over 4 s, paler: single steps"), "{:?}", three.texts);
        assert!(has(&four, "lines: weighted mean over 4 s"), "{:?}", four.texts);
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
