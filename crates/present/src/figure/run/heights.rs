//! How the heights of disc and pin are distributed before and after, with the Abbott-Firestone curve.

use std::ops::RangeInclusive;

use plateau_core::observe::Map;
use plateau_core::surface::describe::MaterialCurve;
use plateau_io::run_file::ReadError;

use super::legend::{only_stroke, with_names};
use super::map_rows::having;
use super::moments::{heights, shown_moments};
use super::{Figures, Subject, moments};
use crate::figure::axes::{Axis, Scale};
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
/// Distributions whose maxima differ more than this many times, or of which one class has more than this many times as many cells as the
/// others have in the mean, are shown on such a scale.
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

/// The heights of a body in all runs.
struct Body<'a> {
    look: &'a MapLook,
    range: RangeInclusive<f64>,
    distributions: Vec<Distribution>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let mut bodies = Vec::new();
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
        bodies.push(Body::of(MapLook::of(map), &runs)?);
    }
    if bodies.is_empty() {
        return Ok(());
    }
    // Disc and pin are compared: both are on one kind of scale.
    let scale = if bodies.iter().any(Body::is_dominated) { Scale::Logarithmic } else { Scale::Linear };
    let charts = bodies.iter().flat_map(|body| body.charts(scale, subjects.len())).collect();
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

impl Body<'_> {
    fn of<'a>(look: &'a MapLook, runs: &[(usize, &Subject)]) -> Result<Body<'a>, ReadError> {
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
        Ok(Body { look, range, distributions })
    }

    /// Whether beside a narrow distribution, or beside one class, nothing would be seen of all else on a scale of equal differences.
    fn is_dominated(&self) -> bool {
        let largest = self.distributions.iter().map(Distribution::largest);
        let narrowest = largest.clone().fold(0.0, f64::max);
        let widest = largest.fold(narrowest, f64::min);
        narrowest > MOST_LINEAR * widest || self.distributions.iter().any(Distribution::has_a_peak)
    }

    /// The distribution and the Abbott-Firestone curve.
    fn charts(&self, scale: Scale, count: usize) -> [Chart; 2] {
        let Body { look, range, distributions } = self;
        let body = look.body();
        let y = Axis::linear(range.clone(), look.unit.label(&format!("{body}, {}", look.what)));
        let line = |distribution: &Distribution, points| Content::Line {
            points,
            stroke: Stroke::of(distribution.run, count).at(distribution.first),
        };
        let narrowest = distributions.iter().map(Distribution::largest).fold(0.0, f64::max);
        let x = match scale {
            Scale::Logarithmic => Axis::logarithmic(LEAST_SHOWN..=130.0 * narrowest, "cells per class, %"),
            Scale::Linear => Axis::linear(0.0..=105.0 * narrowest, "cells per class, %"),
        };
        [
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
        ]
    }
}

impl Distribution {
    /// The largest part of the cells that is in a class.
    fn largest(&self) -> f64 {
        self.histogram.fractions.iter().copied().fold(1e-6, f64::max)
    }

    /// Whether one class has far more cells than the others.
    fn has_a_peak(&self) -> bool {
        let largest = self.largest();
        let fractions = self.histogram.fractions.iter().filter(|part| **part > 0.0);
        let (count, sum) = fractions.fold((0.0, 0.0), |(count, sum), part| (count + 1.0, sum + part));
        largest * (count - 1.0) > MOST_LINEAR * (sum - largest) && count > 1.0
    }
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
    use plateau_core::observe::MapValues;

    use super::*;
    use crate::figure::run::written::Written;

    #[test]
    fn a_class_that_has_most_cells_makes_the_scales_of_disc_and_pin_logarithmic() {
        let scales = |heights: fn(usize) -> f64| {
            let map = |cells: usize| std::iter::once(MapValues::Float((0..cells).map(heights).collect()));
            let run = Written::new("one", &[], |_, time| time).with_maps(Map::DiscHeight, map(240)).with_maps(
                Map::PinHeight,
                std::iter::once(MapValues::Float((0..20).map(|cell| cell as f64).collect())),
            );
            let figures = Written::figures(&[run]);
            let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
            [0, 2].map(|panel| figure.page.panels[panel].axes.x.scale)
        };
        // Every second cell of the disc is cut at one height.
        assert_eq!(scales(|cell| if cell % 2 == 0 { 300.0 } else { cell as f64 }), [Scale::Logarithmic; 2]);
        assert_eq!(scales(|cell| cell as f64), [Scale::Linear; 2]);
    }

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
