//! Interaction plots: the mean response at pairs of levels, for each pair of factors.
//!
//! Boxes stand above the diagonal of a matrix: a factor along the axis below in each column, another one as lines in each
//! row. Where lines are not parallel, the factors interact.

use plateau_study::design::Setting;
use plateau_study::effects::Model;

use super::{FactorAxis, ResponseFigures, Subject, range_of};
use crate::figure::axes::{Axes, Axis, Frame};
use crate::figure::canvas::{Anchor, TEXT};
use crate::figure::chart::{COLUMN, MARGIN, TWO_COLUMNS, note};
use crate::figure::font::shortened;
use crate::figure::page::{Content, Key, KeyStyle, LINE_OF_TEXT, Mark, Page, Panel};
use crate::figure::stroke::Stroke;

/// Factors of the matrix, at most.
const MOST_FACTORS: usize = 6;
/// Height of a box, pixels, and its least and greatest ratio to the width.
const HEIGHTS: [f64; 2] = [330.0, 560.0];
/// Room between boxes beside each other: the last number of one and the first of the next stand in it.
const BETWEEN: f64 = 72.0;
/// Room on the right for what lines mean.
const LEGEND: f64 = 420.0;
/// Width of the sample of a colour.
const KEY: f64 = 60.0;
/// Values at which a line of predictions is calculated.
const VALUES: usize = 121;

/// A line of a box: what it is the line of, and its points in the unit of the response.
struct Line {
    points: Vec<[f64; 2]>,
    predicted: bool,
}

/// A pair of factors.
struct Pair {
    /// Which factor is along the axis.
    along: usize,
    /// A line for each setting of the other.
    lines: Vec<Line>,
}

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    let all = subject.axes.len();
    if all < 2 {
        figures.left_out.push("Interactions need two factors.".to_owned());
        return;
    }
    let factors = chosen(subject);
    let rows: Vec<(usize, Vec<Setting>, Vec<Pair>)> = (0..factors.len() - 1)
        .map(|row| {
            let mut settings = settings(&subject.axes[factors[row]]);
            // Of levels without a result there is nothing to show.
            let cells = subject.effects.level_means(factors[row]);
            settings.retain(|setting| {
                cells.is_empty()
                    || !matches!(setting, Setting::Level(_))
                    || cells.iter().any(|cell| cell.settings[0] == *setting)
            });
            let pairs = factors[row + 1..].iter().map(|along| pair(subject, factors[row], *along, &settings)).collect();
            (factors[row], settings, pairs)
        })
        .collect();
    let lines = || rows.iter().flat_map(|(_, _, pairs)| pairs).flat_map(|pair| &pair.lines);
    let range = range_of(lines().flat_map(|line| &line.points).map(|[_, value]| *value));
    let predicted = lines().any(|line| line.predicted);
    let y = Axis { label: String::new(), ..subject.value_axis(range, HEIGHTS[0]) };
    let mut page = matrix(subject, &rows, &y);
    if predicted && all > 2 {
        note(&mut page, &subject.held(&[], "predicted with the others at"));
    }
    note(&mut page, &subject.note_of_impossible(lines().flat_map(|line| &line.points).map(|[_, value]| *value)));
    let mut caption =
        "Mean response at pairs of levels: one factor along the axis, the other one as lines. Where lines are \
                       not parallel, the effect of one factor depends on the other."
            .to_owned();
    if predicted {
        caption
            .push_str(" Lines along ranges, or of ranges, are what the model predicts, other factors averaged over.");
    }
    if subject.effects.model == Model::MainEffects {
        caption.push_str(
            " The model has no interactions: in designs of few runs, lines that are not parallel may as well show effects of \
             other factors.",
        );
    }
    if all > MOST_FACTORS {
        note(&mut page, &format!("the {MOST_FACTORS} of {all} factors with the largest share"));
        caption.push_str(&format!(
            " Shown are the {MOST_FACTORS} of {all} factors that have the largest share in the differences between runs."
        ));
    }
    subject.add(figures, "interactions", "Interactions on", caption, page);
}

/// The factors of the matrix, in the order of the study: all of them, or those with the largest share.
fn chosen(subject: &Subject) -> Vec<usize> {
    let mut factors: Vec<usize> = (0..subject.axes.len()).collect();
    let share = |factor: &usize| {
        let own = subject.effects.terms.iter().filter(|term| term.factors.contains(factor));
        own.map(|term| term.sum_of_squares).sum::<f64>()
    };
    factors.sort_by(|one, other| share(other).total_cmp(&share(one)));
    factors.truncate(MOST_FACTORS);
    factors.sort_unstable();
    factors
}

/// The settings of a factor that have a line each: levels, or the ends and the middle of a range.
fn settings(axis: &FactorAxis) -> Vec<Setting> {
    if axis.is_range() {
        let middle = axis.is_continuous().then_some(0.0);
        return [Some(-1.0), middle, Some(1.0)].into_iter().flatten().map(Setting::Coded).collect();
    }
    axis.settings(0)
}

/// The lines of two factors: means of runs where both have levels, else predictions.
fn pair(subject: &Subject, lines_of: usize, along: usize, settings: &[Setting]) -> Pair {
    let (effects, axis) = (subject.effects, &subject.axes[along]);
    let predicted = axis.is_continuous() || subject.axes[lines_of].is_continuous();
    let cells = if predicted { Vec::new() } else { effects.adjusted_means(&[lines_of, along]) };
    let line = |setting: &Setting| {
        let mut points: Vec<[f64; 2]> = if predicted {
            let values = axis.settings(VALUES).into_iter();
            let value = |at: Setting| Some((at, effects.predict_at(&[(lines_of, *setting), (along, at)]).ok()?.value));
            values.filter_map(value).map(|(at, value)| [axis.place(at), subject.unit.value(value)]).collect()
        } else {
            let own = cells.iter().filter(|cell| is_same(cell.settings[0], *setting));
            own.map(|cell| [axis.place(cell.settings[1]), subject.unit.value(cell.mean)]).collect()
        };
        points.sort_by(|one, other| one[0].total_cmp(&other[0]));
        Line { points, predicted }
    };
    Pair { along, lines: settings.iter().map(line).collect() }
}

/// Whether settings are the same but for rounding.
fn is_same(one: Setting, other: Setting) -> bool {
    match (one, other) {
        (Setting::Coded(one), Setting::Coded(other)) => (one - other).abs() < 1e-9,
        _ => one == other,
    }
}

fn matrix(subject: &Subject, rows: &[(usize, Vec<Setting>, Vec<Pair>)], y: &Axis) -> Page {
    let across = rows.len() as f64;
    let width = if rows.len() == 1 { COLUMN } else { TWO_COLUMNS };
    let left = MARGIN + y.room_beside(HEIGHTS[1]) + 1.3 * f64::from(TEXT);
    let box_width = ((width - left - LEGEND - MARGIN - (across - 1.0) * BETWEEN) / across).floor();
    // Lines of a row stand below each other beside it.
    let keys = rows.iter().map(|(_, settings, _)| settings.len() as f64 + 1.2).fold(0.0, f64::max);
    let height = (0.75 * box_width).clamp(HEIGHTS[0], HEIGHTS[1]).max(keys * LINE_OF_TEXT).round();
    let mut page = Page { size: [width, 0.0], ..Page::default() };
    let mut top = MARGIN + 12.0;
    for (row, (lines_of, settings, pairs)) in rows.iter().enumerate() {
        let mut below = 0.0_f64;
        for (at, pair) in pairs.iter().enumerate() {
            let begin = (left + (row + at) as f64 * (box_width + BETWEEN)).round();
            let frame = Frame { x: [begin, begin + box_width], y: [top, top + height] };
            // The first box of a row is the lowest of its column: both have the numbers.
            let x = subject.axes[pair.along].axis(box_width);
            // All have numbers below them, or one would look for them in another row.
            let (x, y) = match at {
                0 => (x, y.clone()),
                _ => (Axis { label: String::new(), ..x }, y.clone().shared()),
            };
            below = below.max(x.room_below());
            let contents = [subject.impossible(&x.range, &y.range), contents(pair)].concat();
            page.panels.push(Panel { axes: Axes { frame, x, y }, contents });
        }
        legend(&mut page, &subject.axes[*lines_of], settings, [width - MARGIN - LEGEND + 40.0, top]);
        if row == 0 {
            let label = shortened(
                &subject.value_axis(y.range.clone(), height + 2.0 * MARGIN).label,
                TEXT,
                height + 2.0 * MARGIN,
            );
            let place = (MARGIN + 1.1 * f64::from(TEXT), top + 0.5 * height);
            page.write(label, place, Anchor::Upward, TEXT);
        }
        top += height + below + 20.0;
    }
    page.size[1] = (top + MARGIN).ceil();
    page
}

fn contents(pair: &Pair) -> Vec<Content> {
    let of_line = |(number, line): (usize, &Line)| {
        let stroke = Stroke::of(number, 1);
        let mut contents = Vec::new();
        if line.points.len() > 1 {
            contents.push(Content::Line { points: line.points.clone(), stroke });
        }
        if !line.predicted {
            contents.push(Content::Marks { points: line.points.clone(), colour: stroke.colour, mark: Mark::Dot });
        }
        contents
    };
    pair.lines.iter().enumerate().flat_map(of_line).collect()
}

/// Writes what the lines of a row mean, beside it.
fn legend(page: &mut Page, axis: &FactorAxis, settings: &[Setting], [left, top]: [f64; 2]) {
    let room = LEGEND - 40.0;
    page.write(shortened(axis.plain_name(), TEXT, room), (left, top), Anchor::BelowRight, TEXT);
    for (number, setting) in settings.iter().enumerate() {
        let middle = top + (number as f64 + 1.7) * LINE_OF_TEXT;
        let frame = Frame { x: [left, left + KEY], y: [middle - 13.0, middle + 13.0] };
        let Stroke { colour, dashes, .. } = Stroke::of(number, 1);
        page.keys.push(Key { frame, colour, style: KeyStyle::Line(dashes) });
        let name = shortened(&axis.name(*setting), TEXT, room - KEY - 16.0);
        page.write(name, (left + KEY + 16.0, middle), Anchor::Right, TEXT);
    }
}
