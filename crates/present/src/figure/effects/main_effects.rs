//! The mean of the response at the levels of each factor.

use plateau_study::design::Setting;
use plateau_study::effects::{Cell, Model};

use super::{FactorAxis, ResponseFigures, Subject, range_of, said_of_cuts};
use crate::colour::{DATA, FAINT};
use crate::figure::canvas::LINE;
use crate::figure::chart::{COLUMN, Chart, MARGIN, Meaning, TWO_COLUMNS, note, page_of_rows};
use crate::figure::page::{Content, KeyStyle, Mark};
use crate::figure::pages::with_lower_boxes;
use crate::figure::stroke::{SOLID, Stroke};

/// Height of a box, pixels; at least, where there are many factors, and mostly.
const HEIGHTS: [f64; 2] = [300.0, 620.0];
/// Boxes beside each other, at most.
const MOST_ACROSS: usize = 6;
/// Room of the numbers and the label on the left, and of what is between two boxes, pixels.
const LEFT: f64 = 210.0;
const BETWEEN: f64 = 84.0;
/// Values at which a line of predictions is calculated.
const VALUES: usize = 121;
/// Half the width of the end of an error bar, as a part of the axis.
const CAP: f64 = 0.025;
/// Means that differ by less than this part of the largest are the same.
const SAME: f64 = 1e-9;
/// Whether one sees through the band of a predicted line.
const OPACITY: f64 = 0.25;

/// What is shown of a factor, in the unit of the response.
struct Shown {
    /// Places and values.
    points: Vec<[f64; 2]>,
    /// Places with the ends of their confidence intervals; empty without an error.
    intervals: Vec<[f64; 3]>,
    /// Whether it is a line of predictions, not means of runs.
    predicted: bool,
}

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    let shown: Vec<Shown> = (0..subject.axes.len()).map(|factor| shown(subject, factor)).collect();
    let mean = {
        let (sum, count) =
            subject.effects.responses().fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
        subject.unit.value(sum / count)
    };
    let values = shown.iter().flat_map(|shown| {
        let ends = shown.intervals.iter().flat_map(|[_, low, high]| [*low, *high]);
        shown.points.iter().map(|[_, value]| *value).chain(ends)
    });
    let range = range_of(values.chain([mean]));
    let Layout { width, across, box_width } = Layout::of(subject.axes);
    let boxes: Vec<(&FactorAxis, &Shown)> = subject.axes.iter().zip(&shown).collect();
    let rows = |height: f64| -> Vec<Vec<Chart>> {
        let y = subject.value_axis(range.clone(), height);
        let chart = |(column, (axis, shown)): (usize, &(&FactorAxis, &Shown))| Chart {
            title: String::new(),
            x: axis.axis(box_width),
            y: if column == 0 { y.clone() } else { y.clone().shared() },
            contents: {
                let x = axis.range();
                [subject.impossible(&x, &y.range), contents(shown, axis, mean)].concat()
            },
        };
        boxes.chunks(across).map(|row| row.iter().enumerate().map(chart).collect()).collect()
    };
    let has_intervals = shown.iter().any(|shown| !shown.intervals.is_empty());
    let (any_predicted, all_predicted) =
        (shown.iter().any(|shown| shown.predicted), shown.iter().all(|shown| shown.predicted));
    let is_adjusted = (0..subject.axes.len()).any(|factor| is_adjusted(subject, factor));
    let what = match (any_predicted, all_predicted) {
        (_, true) => {
            "Response against each factor as the model predicts it, with the others at the middle of their range"
        }
        (true, _) => {
            "Mean response at the levels of each factor, and what the model predicts along ranges with the other factors in \
             the middle"
        }
        _ => "Mean response at the levels of each factor",
    };
    let adjusted = if is_adjusted {
        " Means at levels are adjusted for the other factors (least-squares means), for the runs do not have all levels alike."
    } else {
        ""
    };
    let interval = subject.confidence();
    // What others would give with other seeds is no part of what levels differ by.
    let of_seeds = if subject.effects.blocks.is_some() { "with these seeds" } else { "confidence" };
    let of_levels = if is_adjusted { "adjusted mean at a level" } else { "mean of the runs at a level" };
    let bars = format!("Bars are intervals of {interval} {of_seeds}, from the error of the whole study.");
    let bands = format!(
        "Bands have the mean of many runs in them, whatever their seeds, with {interval} confidence, as predictions."
    );
    let keys = [(!all_predicted, of_levels, of_seeds, bars), (any_predicted, "predicted", "of means", bands)];
    let line = |colour, text| Meaning { colour, style: KeyStyle::Line(SOLID), text };
    let mut meanings = vec![line(FAINT, "mean of all runs".to_owned())];
    let mut uncertainty = Vec::new();
    for (_, key, of, said) in keys.into_iter().filter(|(is_shown, ..)| *is_shown) {
        let text = if has_intervals { format!("{key}, {interval} {of}") } else { key.to_owned() };
        meanings.push(line(DATA, text));
        uncertainty.extend(has_intervals.then_some(said));
    }
    if !has_intervals {
        uncertainty.push("There is no error, so there are no confidence intervals.".to_owned());
    }
    let uncertainty = uncertainty.join(" ");
    let ends = shown.iter().flat_map(|shown| &shown.intervals).flat_map(|[_, low, high]| [*low, *high]);
    let cut = said_of_cuts(subject.bounds(), &subject.unit, ends);
    let caption = format!("{what}.{adjusted} {uncertainty}{cut}");
    let held = match any_predicted && subject.axes.len() > 1 {
        true => subject.held(&[], "predicted with the others at"),
        false => String::new(),
    };
    let impossible = subject.note_of_impossible(shown.iter().flat_map(|shown| &shown.points).map(|[_, value]| *value));
    let pages = with_lower_boxes(boxes.len().div_ceil(across), HEIGHTS, |some, height| {
        let mut page = page_of_rows(width, height, &rows(height), some, &meanings);
        note(&mut page, &held);
        note(&mut page, &impossible);
        page
    });
    subject.add_pages(figures, "main-effects", "Main effects on", caption, pages);
}

/// Whether means at levels of a factor are not those of the runs.
fn is_adjusted(subject: &Subject, factor: usize) -> bool {
    let (of_runs, adjusted) = (subject.effects.level_means(factor), subject.effects.adjusted_means(&[factor]));
    let size = of_runs.iter().fold(0.0_f64, |size, cell| size.max(cell.mean.abs()));
    of_runs.iter().zip(&adjusted).any(|(one, other)| (one.mean - other.mean).abs() > SAME * size)
}

/// Means at levels; along ranges with many values, or with squares, what the model predicts.
fn shown(subject: &Subject, factor: usize) -> Shown {
    let (axis, effects, unit) = (&subject.axes[factor], subject.effects, &subject.unit);
    let cells = effects.adjusted_means(&[factor]);
    let is_curved = effects.model == Model::Quadratic && axis.is_continuous();
    let predicted = cells.is_empty() || is_curved;
    let bounds = subject.bounds();
    let interval = |x: f64, interval: Option<[f64; 2]>| {
        interval.map(|ends| {
            let [low, high] = bounds.clipped(ends);
            [x, unit.value(low), unit.value(high)]
        })
    };
    let mut found: Vec<([f64; 2], Option<[f64; 3]>)> = if predicted {
        let at = |setting: Setting| {
            // The interval that `predict` and the profiler of an optimum have at the same place.
            let prediction = effects.mean_at(&[(factor, setting)]).ok()?;
            let x = axis.place(setting);
            Some(([x, unit.value(prediction.value)], interval(x, prediction.interval)))
        };
        axis.settings(VALUES).into_iter().filter_map(at).collect()
    } else {
        let of = |cell: &Cell| {
            let x = axis.place(cell.settings[0]);
            ([x, unit.value(cell.mean)], interval(x, cell.interval))
        };
        cells.iter().map(of).collect()
    };
    found.sort_by(|one, other| one.0[0].total_cmp(&other.0[0]));
    Shown {
        points: found.iter().map(|(point, _)| *point).collect(),
        intervals: found.iter().filter_map(|(_, interval)| *interval).collect(),
        predicted,
    }
}

fn contents(shown: &Shown, axis: &FactorAxis, mean: f64) -> Vec<Content> {
    let range = axis.range();
    let line = |points: Vec<[f64; 2]>, colour, width| Content::Line { points, stroke: Stroke::solid(colour, width) };
    let mut contents = vec![line(vec![[*range.start(), mean], [*range.end(), mean]], FAINT, LINE)];
    if shown.predicted {
        if !shown.intervals.is_empty() {
            contents.push(Content::Band { spans: shown.intervals.clone(), colour: DATA, opacity: OPACITY });
        }
        contents.push(line(shown.points.clone(), DATA, LINE + 2));
        return contents;
    }
    for [x, low, high] in &shown.intervals {
        contents.push(line(vec![[*x, *low], [*x, *high]], DATA, LINE));
        contents.extend(
            [low, high].map(|end| line([-CAP, CAP].map(|part| [axis.beside(*x, part), *end]).to_vec(), DATA, LINE)),
        );
    }
    contents.push(line(shown.points.clone(), DATA, LINE));
    contents.push(Content::Marks { points: shown.points.clone(), colour: DATA, mark: Mark::Dot });
    contents
}

/// How many boxes are beside each other on which page.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layout {
    width: f64,
    across: usize,
    /// About so wide is a box.
    box_width: f64,
}

impl Layout {
    /// One column where all boxes have room beside each other, else two with as many rows as are needed.
    fn of(axes: &[FactorAxis]) -> Self {
        let need = axes.iter().map(FactorAxis::room).fold(0.0, f64::max);
        let room = |width: f64| width - 2.0 * MARGIN - LEFT;
        let fitting = |width: f64| ((room(width) / (need + BETWEEN)) as usize).clamp(1, MOST_ACROSS);
        let width = if fitting(COLUMN) >= axes.len() { COLUMN } else { TWO_COLUMNS };
        // Rows are equally full.
        let rows = axes.len().div_ceil(fitting(width)).max(1);
        let across = axes.len().div_ceil(rows).max(1);
        Self { width, across, box_width: room(width) / across as f64 - BETWEEN }
    }
}
