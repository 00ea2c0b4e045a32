//! The axis of a response: what it cannot be, and ticks in its own unit where a transform of it was fitted.

use std::ops::RangeInclusive;

use super::Subject;
use crate::colour::FAINT;
use crate::figure::axes::{Axis, most_ticks_upward};
use crate::figure::canvas::TEXT;
use crate::figure::font::shortened;
use crate::figure::page::Content;
use crate::figure::ticks::{logarithmic_ticks, ticks};
use plateau_study::effects::Transform;

/// How much one sees of the part of a chart in which a response cannot be.
const OPACITY: f64 = 0.22;
/// Powers of ten among which round values are looked for.
const POWERS: std::ops::RangeInclusive<i32> = -12..=12;

impl Subject<'_> {
    /// An axis of the response between two values of what is fitted, so long.
    pub(super) fn value_axis(&self, range: RangeInclusive<f64>, length: f64) -> Axis {
        let Some(transform) = self.response.scale.transform() else {
            return Axis::linear(range, shortened(&self.label(), TEXT, length));
        };
        let scale = &self.response.scale;
        let name = match transform {
            Transform::Logarithm => "log",
            Transform::SquareRoot => "√",
            Transform::Logit => "logit",
        };
        let label = shortened(&format!("{} ({name} scale)", scale.unit.label(&self.response.name)), TEXT, length);
        let shown = |fitted: f64| scale.unit.value(scale.scale.back((fitted - self.unit.offset) / self.unit.per_si));
        let place = |value: f64| {
            let response = (value - scale.unit.offset) / scale.unit.per_si;
            scale.scale.of(response).map(|fitted| self.unit.value(fitted))
        };
        let marks = round_values(&range, transform, most_ticks_upward(length), shown, place);
        if marks.len() < 2 {
            return Axis::linear(range, shortened(&self.label(), TEXT, length));
        }
        Axis::marked(range, label, marks)
    }

    /// The parts of a chart between these ends in which the response cannot be, and what is said of them.
    pub(super) fn impossible(&self, x: &RangeInclusive<f64>, y: &RangeInclusive<f64>) -> Vec<Content> {
        let bounds = self.bounds();
        let parts = [
            [*y.start(), self.unit.value(bounds.least).min(*y.end())],
            [self.unit.value(bounds.most).max(*y.start()), *y.end()],
        ];
        let parts = parts.into_iter().filter(|[from, to]| from < to);
        let ends = [*x.start(), *x.end()];
        parts
            .map(|[from, to]| Content::Band {
                spans: ends.map(|x| [x, from, to]).to_vec(),
                colour: FAINT,
                opacity: OPACITY,
            })
            .collect()
    }

    /// What is said of predictions that the response cannot be; nothing where there are none.
    pub(super) fn note_of_impossible(&self, values: impl Iterator<Item = f64>) -> String {
        let bounds = self.bounds();
        let (least, most) = (self.unit.value(bounds.least), self.unit.value(bounds.most));
        let (mut below, mut above) = (false, false);
        for value in values {
            below |= value < least;
            above |= value > most;
        }
        let name = &self.response.name;
        match (below, above) {
            (false, false) => String::new(),
            (true, false) => format!("grey: {name} cannot be below 0; there the model does not hold"),
            (false, true) => format!("grey: {name} cannot be above 1; there the model does not hold"),
            (true, true) => format!("grey: {name} cannot be below 0 or above 1; there the model does not hold"),
        }
    }
}

/// Round values of a response and where they lie on the axis of its transform, not more than there is room for.
fn round_values(
    range: &RangeInclusive<f64>,
    transform: Transform,
    most: usize,
    shown: impl Fn(f64) -> f64,
    place: impl Fn(f64) -> Option<f64>,
) -> Vec<(f64, String)> {
    let values = shown(*range.start())..=shown(*range.end());
    let placed = |found: Vec<(f64, String)>| -> Vec<(f64, String)> {
        let mark = |(value, text): (f64, String)| Some((place(value)?, text));
        found.into_iter().filter_map(mark).filter(|(at, _)| range.contains(at)).collect()
    };
    if transform == Transform::Logarithm {
        return placed(logarithmic_ticks(&values, most));
    }
    let even = placed(ticks(&values, most));
    // Values of a logit are crowded at 0 and 1, those of a square root at 0.
    let digits = POWERS.flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * libm::pow(10.0, f64::from(power))));
    let mirrored = |value: f64| if transform == Transform::Logit && value < 0.5 { Some(1.0 - value) } else { None };
    let mut round: Vec<f64> = digits.flat_map(|value| [Some(value), mirrored(value)]).flatten().collect();
    round.retain(|value| values.contains(value) && value.is_finite());
    round.sort_by(f64::total_cmp);
    round.dedup();
    let texts = round.into_iter().map(|value| (value, crate::quantity::printed_number(value, 6)));
    let apart = (range.end() - range.start()) / most.max(1) as f64;
    let mut kept: Vec<(f64, String)> = Vec::new();
    for (at, text) in placed(texts.collect()) {
        if kept.last().is_none_or(|(last, _)| at - last >= apart) {
            kept.push((at, text));
        }
    }
    if kept.len() >= 3 { kept } else { even }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: RangeInclusive<f64>, transform: Transform) -> Vec<String> {
        let marks = round_values(&range, transform, 6, |fitted| transform.back(fitted), |value| transform.of(value));
        assert!(marks.iter().all(|(at, _)| range.contains(at)));
        marks.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_of_transforms_are_round_values() {
        assert_eq!(texts(f64::ln(0.8)..=f64::ln(60.0), Transform::Logarithm), ["1", "2", "5", "10", "20", "50"]);
        assert_eq!(texts(-1.5..=-0.5, Transform::Logarithm), ["0.3", "0.4", "0.5", "0.6"]);
        // The logits of 0.5 and 0.9 are 0 and 2.2.
        let found = texts(-5.0..=5.0, Transform::Logit);
        assert!(["0.01", "0.5", "0.9"].iter().all(|text| found.contains(&(*text).to_owned())), "{found:?}");
        let found = texts(0.0..=3.2, Transform::SquareRoot);
        assert!(found.len() >= 3, "{found:?}");
    }
}
