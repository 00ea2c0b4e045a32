//! Contact area against time (paper Fig. 14): the mean over a revolution, and how far single steps are from it.

use plateau_io::run_file::ReadError;

use super::chart::{COLUMN, Chart, Meaning, colour, page, up_from_zero};
use super::{Figures, Subject};
use crate::figure::axes::Axis;
use crate::figure::canvas::LINE;
use crate::figure::page::Content;
use crate::figure::unit::ScaledUnit;

/// Spans of time that the band distinguishes, at most.
const MOST_SPANS: usize = 250;

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let having = figures.with_series("contact-area", subjects, &["contact_area", "contact_area_mean"]);
    let mut runs = Vec::new();
    for (number, subject) in having {
        let values = |name| Ok(subject.run.values(name)?.unwrap_or_default());
        runs.push((number, subject, values("contact_area")?, values("contact_area_mean")?));
    }
    if runs.is_empty() {
        return Ok(());
    }
    let largest = runs.iter().flat_map(|(_, _, single, mean)| single.iter().chain(mean)).copied().fold(0.0, f64::max);
    let area = ScaledUnit::for_area(largest);
    let end = runs.iter().filter_map(|(_, subject, ..)| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = ScaledUnit::for_time(end);
    let mut bands = Vec::new();
    let mut lines = Vec::new();
    let mut meanings = Vec::new();
    for (number, subject, single, mean) in &runs {
        let times: Vec<f64> = subject.run.time().iter().map(|seconds| seconds * time.per_si).collect();
        let single: Vec<f64> = single.iter().map(|value| value * area.per_si).collect();
        bands.push(Content::Band { spans: spans(&times, &single), colour: colour(*number), opacity: 0.28 });
        let mean: Vec<f64> = mean.iter().map(|value| value * area.per_si).collect();
        let points = means(&times, &mean);
        lines.push(Content::Line { points, colour: colour(*number), width: LINE + 2 });
        meanings.push(Meaning::of_run(*number, subject));
    }
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(0.0..=end * time.per_si, format!("time, {}", time.symbol)),
        y: Axis::linear(
            up_from_zero([largest * area.per_si].into_iter(), 1e-6),
            format!("contact area, {}", area.symbol),
        ),
        contents: bands.into_iter().chain(lines).collect(),
    };
    figures.add(
        "contact-area",
        "Contact area",
        "Contact area against time: the line is the mean over the last revolution, the band reaches from the least to the \
         greatest of the samples of single steps. Where there are more samples than the figure can tell apart, the line is \
         their mean.",
        page(COLUMN, 760.0, 1, vec![chart], &meanings),
    );
    Ok(())
}

/// Means of time and value in spans of time.
fn means(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let length = times.len().div_ceil(MOST_SPANS).max(1);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    times.chunks(length).zip(values.chunks(length)).map(|(times, values)| [mean(times), mean(values)]).collect()
}

/// Least and greatest value in spans of time, each with the last value before it, so that the band has no gaps.
fn spans(times: &[f64], values: &[f64]) -> Vec<[f64; 3]> {
    let length = times.len().div_ceil(MOST_SPANS).max(1);
    let mut spans = Vec::with_capacity(2 * MOST_SPANS);
    for first in (0..times.len()).step_by(length) {
        let last = (first + length).min(times.len()) - 1;
        let span = &values[first.saturating_sub(1)..=last];
        let (low, high) = span
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
        spans.extend([[times[first], low, high], [times[last], low, high]]);
    }
    spans.dedup();
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_samples_are_their_own_band() {
        // By hand: a span of one sample reaches from the sample before to itself.
        assert_eq!(spans(&[1.0, 2.0, 3.0], &[5.0, 4.0, 6.0]), [[1.0, 5.0, 5.0], [2.0, 4.0, 5.0], [3.0, 4.0, 6.0]]);
    }

    #[test]
    fn the_line_goes_through_samples_or_through_their_means() {
        assert_eq!(means(&[1.0, 2.0], &[5.0, 4.0]), [[1.0, 5.0], [2.0, 4.0]]);
        let times: Vec<f64> = (0..3 * MOST_SPANS).map(|time| time as f64).collect();
        let values: Vec<f64> = times.iter().map(|time| time % 3.0).collect();
        // By hand: three samples a span, the values 0, 1 and 2 in each.
        let means = means(&times, &values);
        assert_eq!((means.len(), means[0], means[1]), (MOST_SPANS, [1.0, 1.0], [4.0, 1.0]));
    }

    #[test]
    fn no_extreme_of_many_samples_is_lost() {
        let times: Vec<f64> = (0..10_001).map(f64::from).collect();
        let mut values = vec![1.0; times.len()];
        (values[4321], values[9999]) = (7.0, -2.0);
        let spans = spans(&times, &values);
        assert!(spans.len() <= 2 * MOST_SPANS);
        let at = |time: f64| spans.windows(2).find(|pair| pair[0][0] <= time && time <= pair[1][0]).unwrap()[1];
        assert_eq!((at(4321.0)[2], at(9999.0)[1]), (7.0, -2.0));
        assert_eq!((spans[0][0], spans[spans.len() - 1][0]), (0.0, 10_000.0));
    }
}
