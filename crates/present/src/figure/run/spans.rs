//! Many samples as few: their mean, and how far they reach, in spans of time.

use plotters::style::RGBColor;

use crate::colour::paler;
use crate::figure::chart::Meaning;
use crate::figure::page::{Content, KeyStyle};
use crate::figure::stroke::Stroke;

/// Spans that a figure distinguishes, at most.
const MOST_SPANS: usize = 250;
/// How much of a band's colour hides what lies below.
const OPACITY: f64 = 0.28;

/// The band over which samples reach, in pieces where there are no numbers between; none where they are so few that a line goes through
/// each of them.
pub fn band(times: &[f64], values: &[f64], colour: RGBColor) -> Vec<Content> {
    if times.len() <= MOST_SPANS {
        return Vec::new();
    }
    let spans = spans(times, values);
    let pieces = spans.split(|span| !span[1].is_finite()).filter(|piece| !piece.is_empty());
    pieces.map(|spans| Content::Band { spans: spans.to_vec(), colour, opacity: OPACITY }).collect()
}

/// What lines and bands are, where there are bands: in the colour of the only run, else in words, for there is no line of all runs.
pub fn meanings(has_bands: bool, only: Option<Stroke>, line: &str, band: &str) -> Vec<Meaning> {
    match only {
        _ if !has_bands => Vec::new(),
        Some(stroke) => {
            let colour = paler(stroke.colour, OPACITY);
            let area = Meaning { colour, style: KeyStyle::Area, text: band.to_owned() };
            vec![Meaning::of_line(stroke, line), area]
        }
        None => {
            [("lines", line), ("bands", band)].map(|(what, text)| Meaning::in_words(&format!("{what}: {text}"))).into()
        }
    }
}

/// Means of time and value in spans of time; of the values that are numbers, where there are any.
pub fn means(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let length = times.len().div_ceil(MOST_SPANS).max(1);
    let mean = |(times, values): (&[f64], &[f64])| {
        let both = times.iter().zip(values).map(|(time, value)| [*time, *value]);
        let mut points: Vec<[f64; 2]> = both.clone().filter(|[_, value]| value.is_finite()).collect();
        if points.is_empty() {
            points = both.collect();
        }
        [0, 1].map(|part| points.iter().map(|point| point[part]).sum::<f64>() / points.len() as f64)
    };
    times.chunks(length).zip(values.chunks(length)).map(mean).collect()
}

/// The pieces of a curve whose points have gaps between them: those that are no numbers.
pub fn pieces(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let is_number = |point: &[f64; 2]| point[1].is_finite();
    points.split(|point| !is_number(point)).filter(|piece| !piece.is_empty()).map(<[_]>::to_vec).collect()
}

/// The first sample, the means in spans of time, and the last sample.
pub fn means_between_ends(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let end = |at: Option<(&f64, &f64)>| at.map(|(time, value)| [*time, *value]);
    let mut points: Vec<[f64; 2]> = end(times.first().zip(values.first())).into_iter().collect();
    points.extend(means(times, values));
    points.extend(end(times.last().zip(values.last())));
    points.dedup();
    points
}

/// Least and greatest value in spans of time, each with the last value before it, so that the band has no gaps but where there is no number.
fn spans(times: &[f64], values: &[f64]) -> Vec<[f64; 3]> {
    let length = times.len().div_ceil(MOST_SPANS).max(1);
    let mut spans = Vec::with_capacity(2 * MOST_SPANS);
    for first in (0..times.len()).step_by(length) {
        let last = (first + length).min(times.len()) - 1;
        let span = &values[first.saturating_sub(1)..=last];
        let (low, high) = span
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
        let has_own = values[first..=last].iter().any(|value| value.is_finite());
        let [low, high] = if has_own { [low, high] } else { [f64::NAN; 2] };
        spans.extend([[times[first], low, high], [times[last], low, high]]);
    }
    spans.dedup();
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_samples_have_no_band() {
        let times: Vec<f64> = (0..=MOST_SPANS).map(|time| time as f64).collect();
        let colour = RGBColor(1, 2, 3);
        assert!(band(&times[1..], &times[1..], colour).is_empty());
        let [Content::Band { spans, .. }] = &band(&times, &times, colour)[..] else { panic!("one band") };
        // By hand: two samples a span, and the sample before.
        assert_eq!(spans[..4], [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [2.0, 1.0, 3.0], [3.0, 1.0, 3.0]]);
    }

    #[test]
    fn the_line_goes_through_samples_or_through_their_means() {
        assert_eq!(means(&[1.0, 2.0], &[5.0, 4.0]), [[1.0, 5.0], [2.0, 4.0]]);
        let times: Vec<f64> = (0..3 * MOST_SPANS).map(|time| time as f64).collect();
        let values: Vec<f64> = times.iter().map(|time| time % 3.0).collect();
        // By hand: three samples a span, the values 0, 1 and 2 in each.
        let means = means(&times, &values);
        assert_eq!((means.len(), means[0], means[1]), (MOST_SPANS, [1.0, 1.0], [4.0, 1.0]));
        let whole = means_between_ends(&times, &values);
        assert_eq!((whole.len(), whole[0], whole[1]), (MOST_SPANS + 2, [0.0, 0.0], [1.0, 1.0]));
        assert_eq!(whole[MOST_SPANS + 1], [(3 * MOST_SPANS - 1) as f64, 2.0]);
    }

    #[test]
    fn lines_and_bands_have_gaps_where_there_is_no_number() {
        // Four samples a span; the second span has one number, the third has none.
        let times: Vec<f64> = (0..4 * MOST_SPANS).map(|time| time as f64).collect();
        let mut values = vec![2.0; times.len()];
        values[5..12].fill(f64::NAN);
        let means = means(&times, &values);
        assert_eq!((means[0], means[1], means[3]), ([1.5, 2.0], [4.0, 2.0], [13.5, 2.0]));
        assert!(means[2][1].is_nan());
        let bands = band(&times, &values, RGBColor(1, 2, 3));
        let [Content::Band { spans: before, .. }, Content::Band { spans: after, .. }] = &bands[..] else {
            panic!("two bands")
        };
        assert_eq!((before.len(), before[3], after[0]), (4, [7.0, 2.0, 2.0], [12.0, 2.0, 2.0]));
    }

    #[test]
    fn a_legend_has_what_is_drawn() {
        let stroke = Stroke::of(0, 1);
        let [line, area] = &meanings(true, Some(stroke), "mean", "reach")[..] else { panic!("two meanings") };
        assert_eq!((line.colour, area.colour), (stroke.colour, paler(stroke.colour, OPACITY)));
        let words = meanings(true, None, "mean", "reach");
        assert!(words.iter().all(|meaning| meaning.style == KeyStyle::Words));
        assert_eq!(
            words.iter().map(|meaning| meaning.text.as_str()).collect::<Vec<_>>(),
            ["lines: mean", "bands: reach"]
        );
        assert!(meanings(false, None, "mean", "reach").is_empty());
    }

    #[test]
    fn a_curve_is_broken_where_there_is_no_number() {
        let [gap, one, two, three] = [f64::NAN, 1.0, 2.0, 3.0].map(|value| [value, value]);
        assert_eq!(pieces(&[gap, one, two, gap, gap, three]), [vec![one, two], vec![three]]);
        assert_eq!(pieces(&[gap]), [[[0.0; 2]; 0]; 0]);
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
