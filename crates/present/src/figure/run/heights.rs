//! How the heights of disc and pin are distributed before and after, with the Abbott-Firestone curve.

use std::ops::RangeInclusive;

use plateau_core::observe::Map;
use plateau_core::surface::describe::MaterialCurve;
use plateau_io::run_file::ReadError;

use super::map_page::having;
use super::moments::{heights, shown_moments};
use super::{Figures, Subject, moments, only_stroke, with_names};
use crate::figure::axes::Axis;
use crate::figure::chart::{Chart, TWO_COLUMNS, page};
use crate::figure::histogram::Histogram;
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{MapLook, RobustRange};

const NAME: &str = "heights";
/// Classes of the distribution.
const CLASSES: usize = 80;
/// Part of the cells that is shown at least where parts are on a scale of equal ratios, %.
const LEAST_SHOWN: f64 = 0.01;
/// Distributions whose maxima differ more than this many times are shown on such a scale.
const MOST_LINEAR: f64 = 6.0;
/// Points of the Abbott-Firestone curve.
const CURVE: usize = 200;

/// The heights of a body at one moment, as far as they are drawn; µm.
struct Distribution {
    run: usize,
    first: bool,
    histogram: Histogram,
    /// Height that 0, 0.5, …, 100 % of the cells reach.
    curve: Vec<f64>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let mut charts = Vec::new();
    let mut shown = vec![false; subjects.len()];
    for map in [Map::DiscHeight, Map::PinHeight] {
        let having = having(figures, NAME, subjects, map);
        let runs: Vec<(usize, &Subject)> = subjects
            .iter()
            .enumerate()
            .filter(|(_, subject)| having.iter().any(|one| std::ptr::eq(*one, *subject)))
            .collect();
        if runs.is_empty() {
            continue;
        }
        runs.iter().for_each(|(run, _)| shown[*run] = true);
        charts.extend(body_charts(MapLook::of(map), &runs, subjects.len())?);
    }
    if charts.is_empty() {
        return Ok(());
    }
    let has_first = subjects.iter().any(|subject| shown_moments(subject).len() > 1);
    let only = only_stroke(subjects, (0..subjects.len()).filter(|run| shown[*run]));
    let meanings = with_names(subjects, |run| shown[run], moments::meanings(subjects, only, has_first));
    let width = figures.width(TWO_COLUMNS);
    figures.add(
        NAME,
        "Height distributions",
        "Left the distribution of the heights, right the Abbott-Firestone curve, at the last recorded moment and, paler, at \
         the first. Heights are positive toward the other body; the pin's are counted from their mean. Every cell counts alike.",
        page(width, 560.0, 2, charts, &meanings),
    );
    Ok(())
}

/// Heights of a body, within its outline, in the unit that they are shown in.
fn scaled(subject: &Subject, look: &MapLook, index: usize) -> Result<Vec<f64>, ReadError> {
    let (mut heights, _) = heights(subject.run, look.map, index)?;
    heights.retain(|height| !height.is_nan());
    heights.iter_mut().for_each(|height| *height = look.unit.value(*height));
    Ok(heights)
}

/// The distribution of a body and its Abbott-Firestone curve.
fn body_charts(look: &MapLook, runs: &[(usize, &Subject)], count: usize) -> Result<[Chart; 2], ReadError> {
    let mut range = RobustRange::default();
    for (_, subject) in runs {
        for index in shown_moments(subject) {
            range.add(scaled(subject, look, index)?.into_iter());
        }
    }
    let range = wider(&range.between(0.001, 0.999));
    let mut distributions = Vec::new();
    for (run, subject) in runs {
        let moments = shown_moments(subject);
        for (place, index) in moments.iter().enumerate() {
            let heights = scaled(subject, look, *index)?;
            let histogram = Histogram::of(&heights, 0.0, range.clone(), CLASSES);
            let curve = MaterialCurve::of(&heights, 0.0);
            distributions.push(Distribution {
                run: *run,
                first: place + 1 < moments.len(),
                histogram,
                curve: (0..=CURVE).map(|part| curve.height(part as f64 / CURVE as f64)).collect(),
            });
        }
    }
    let body = look.body();
    let y = Axis::linear(range, look.unit.label(&format!("{body}, {}", look.what)));
    let line = |distribution: &Distribution, points| Content::Line {
        points,
        stroke: Stroke::of(distribution.run, count).at(distribution.first),
    };
    let largest = |one: &Distribution| one.histogram.fractions.iter().copied().fold(1e-6, f64::max);
    let narrowest = distributions.iter().map(largest).fold(0.0, f64::max);
    let widest = distributions.iter().map(largest).fold(narrowest, f64::min);
    // Beside a narrow distribution nothing would be seen of a wide one.
    let x = if narrowest > MOST_LINEAR * widest {
        Axis::logarithmic(LEAST_SHOWN..=130.0 * narrowest, "cells per class, %")
    } else {
        Axis::linear(0.0..=105.0 * narrowest, "cells per class, %")
    };
    Ok([
        Chart {
            title: format!("{body}, distribution"),
            x,
            y: y.clone(),
            contents: distributions
                .iter()
                .flat_map(|one| outlines(&one.histogram).into_iter().map(|points| line(one, points)))
                .collect(),
        },
        Chart {
            title: format!("{body}, Abbott-Firestone curve"),
            x: Axis::linear(0.0..=100.0, "material ratio, %"),
            y: y.shared(),
            contents: distributions.iter().map(|one| line(one, ratio_curve(&one.curve))).collect(),
        },
    ])
}

/// A range with a margin.
fn wider(range: &RangeInclusive<f64>) -> RangeInclusive<f64> {
    let margin = 0.05 * (range.end() - range.start());
    range.start() - margin..=range.end() + margin
}

/// Steps of the per cent of the cells that are in a class between the heights at its ends: a line for all classes between two empty
/// ones, to the axis at both ends.
fn outlines(histogram: &Histogram) -> Vec<Vec<[f64; 2]>> {
    let (begin, end) = (*histogram.range.start(), *histogram.range.end());
    let fractions = &histogram.fractions;
    let class = (end - begin) / fractions.len() as f64;
    let numbers: Vec<usize> = (0..fractions.len()).collect();
    let filled = |number: &usize| fractions[*number] > 0.0;
    let runs = numbers.chunk_by(|one, next| filled(one) == filled(next)).filter(|run| filled(&run[0]));
    let at = |end: usize| begin + end as f64 * class;
    let step = |number: &usize| [*number, number + 1].map(|end| [100.0 * fractions[*number], at(end)]);
    let outline = |run: &[usize]| {
        let (first, last) = (run[0], run[run.len() - 1] + 1);
        let steps = run.iter().flat_map(step);
        [[0.0, at(first)]].into_iter().chain(steps).chain([[0.0, at(last)]]).collect()
    };
    runs.map(outline).collect()
}

/// Height against the per cent of the cells that reach it.
fn ratio_curve(curve: &[f64]) -> Vec<[f64; 2]> {
    let last = curve.len().saturating_sub(1).max(1) as f64;
    curve.iter().enumerate().map(|(part, height)| [100.0 * part as f64 / last, *height]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_end_where_there_are_no_heights() {
        let fractions = vec![0.0, 0.0, 0.5, 0.25, 0.0, 0.0, 0.0, 0.25];
        let outlines = outlines(&Histogram { range: 0.0..=8.0, fractions, outside: 0.0 });
        // By hand: classes are 1 wide.
        let expected: [&[[f64; 2]]; 2] = [
            &[[0.0, 2.0], [50.0, 2.0], [50.0, 3.0], [25.0, 3.0], [25.0, 4.0], [0.0, 4.0]],
            &[[0.0, 7.0], [25.0, 7.0], [25.0, 8.0], [0.0, 8.0]],
        ];
        assert_eq!(outlines, expected);
    }
}
