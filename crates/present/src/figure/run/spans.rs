//! Many samples as few: their mean, and how far they reach, in spans of time.

use plotters::style::RGBColor;

use crate::figure::page::Content;

/// How much of a band's colour hides what lies below; among several bands less.
pub const OPACITY: f64 = 0.28;
const OPACITY_OF_SEVERAL: f64 = 0.12;
/// Runs whose samples have bands, or lines of their own beside the means, at most: of more none could be told from the others.
pub const MOST_BANDS: usize = 3;

/// In how many spans of time, at most, samples are put together.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Spans {
    pub(super) most: usize,
    /// Over how long a time the means of lines go, s: the same for all runs, however long they are; 0 at the finest.
    pub(super) duration: f64,
}

impl Spans {
    /// As many as a figure distinguishes.
    pub const FINEST: Self = Self { most: 250, duration: 0.0 };

    /// Samples of a span.
    pub(super) fn length(self, samples: usize) -> usize {
        samples.div_ceil(self.most).max(1)
    }

    /// Whether there are so many samples that their reach is a band.
    pub fn has_bands(self, values: &[f64]) -> bool {
        self.length(values.len()) > 1
    }

    /// The band over which samples reach, one of so many, in pieces where there are no numbers between; none where they are so few that a
    /// line goes through each of them.
    pub fn band(self, times: &[f64], values: &[f64], colour: RGBColor, bands: usize) -> Vec<Content> {
        if !self.has_bands(values) {
            return Vec::new();
        }
        let reach = self.reach(times, values);
        let opacity = if bands > 1 { OPACITY_OF_SEVERAL } else { OPACITY };
        let pieces = reach.split(|span| !span[1].is_finite()).filter(|piece| !piece.is_empty());
        pieces.map(|spans| Content::Band { spans: spans.to_vec(), colour, opacity }).collect()
    }

    /// Means of time and value in spans of time; of the values that are numbers, where there are any.
    pub fn means(self, times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
        let length = self.length(times.len());
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

    /// The first sample, the means in spans of time, and the last sample.
    pub fn means_between_ends(self, times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
        let end = |at: Option<(&f64, &f64)>| at.map(|(time, value)| [*time, *value]);
        let mut points: Vec<[f64; 2]> = end(times.first().zip(values.first())).into_iter().collect();
        points.extend(self.means(times, values));
        points.extend(end(times.last().zip(values.last())));
        points.dedup();
        points
    }

    /// Least and greatest value in spans of time, each with the last value before it, so that the band has no gaps but where there is no
    /// number.
    fn reach(self, times: &[f64], values: &[f64]) -> Vec<[f64; 3]> {
        let length = self.length(times.len());
        let mut spans = Vec::with_capacity(2 * self.most);
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
}

/// The pieces of a curve whose points have gaps between them: those that are no numbers.
pub fn pieces(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let is_number = |point: &[f64; 2]| point[1].is_finite();
    points.split(|point| !is_number(point)).filter(|piece| !piece.is_empty()).map(<[_]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Spans = Spans::FINEST;
    const MOST_SPANS: usize = ALL.most;

    #[test]
    fn few_samples_have_no_band() {
        let times: Vec<f64> = (0..=MOST_SPANS).map(|time| time as f64).collect();
        let colour = RGBColor(1, 2, 3);
        assert!(ALL.band(&times[1..], &times[1..], colour, 1).is_empty());
        let [Content::Band { spans, .. }] = &ALL.band(&times, &times, colour, 1)[..] else { panic!("one band") };
        // By hand: two samples a span, and the sample before.
        assert_eq!(spans[..4], [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [2.0, 1.0, 3.0], [3.0, 1.0, 3.0]]);
    }

    #[test]
    fn the_line_goes_through_samples_or_through_their_means() {
        assert_eq!(ALL.means(&[1.0, 2.0], &[5.0, 4.0]), [[1.0, 5.0], [2.0, 4.0]]);
        let times: Vec<f64> = (0..3 * MOST_SPANS).map(|time| time as f64).collect();
        let values: Vec<f64> = times.iter().map(|time| time % 3.0).collect();
        // By hand: three samples a span, the values 0, 1 and 2 in each.
        let means = ALL.means(&times, &values);
        assert_eq!((means.len(), means[0], means[1]), (MOST_SPANS, [1.0, 1.0], [4.0, 1.0]));
        let whole = ALL.means_between_ends(&times, &values);
        assert_eq!((whole.len(), whole[0], whole[1]), (MOST_SPANS + 2, [0.0, 0.0], [1.0, 1.0]));
        assert_eq!(whole[MOST_SPANS + 1], [(3 * MOST_SPANS - 1) as f64, 2.0]);
    }

    #[test]
    fn lines_and_bands_have_gaps_where_there_is_no_number() {
        // Four samples a span; the second span has one number, the third has none.
        let times: Vec<f64> = (0..4 * MOST_SPANS).map(|time| time as f64).collect();
        let mut values = vec![2.0; times.len()];
        values[5..12].fill(f64::NAN);
        let means = ALL.means(&times, &values);
        assert_eq!((means[0], means[1], means[3]), ([1.5, 2.0], [4.0, 2.0], [13.5, 2.0]));
        assert!(means[2][1].is_nan());
        let bands = ALL.band(&times, &values, RGBColor(1, 2, 3), 1);
        let [Content::Band { spans: before, .. }, Content::Band { spans: after, .. }] = &bands[..] else {
            panic!("two bands")
        };
        assert_eq!((before.len(), before[3], after[0]), (4, [7.0, 2.0, 2.0], [12.0, 2.0, 2.0]));
    }

    #[test]
    fn several_bands_hide_less() {
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        let opacity = |bands| match &ALL.band(&times, &times, RGBColor(1, 2, 3), bands)[..] {
            [Content::Band { opacity, .. }] => *opacity,
            _ => panic!("one band"),
        };
        assert!(opacity(5) < opacity(1));
    }

    #[test]
    fn no_extreme_of_many_samples_is_lost() {
        let times: Vec<f64> = (0..10_001).map(f64::from).collect();
        let mut values = vec![1.0; times.len()];
        (values[4321], values[9999]) = (7.0, -2.0);
        let spans = ALL.reach(&times, &values);
        assert!(spans.len() <= 2 * MOST_SPANS);
        let at = |time: f64| spans.windows(2).find(|pair| pair[0][0] <= time && time <= pair[1][0]).unwrap()[1];
        assert_eq!((at(4321.0)[2], at(9999.0)[1]), (7.0, -2.0));
        assert_eq!((spans[0][0], spans[spans.len() - 1][0]), (0.0, 10_000.0));
    }

    #[test]
    fn a_curve_is_broken_where_there_is_no_number() {
        let [gap, one, two, three] = [f64::NAN, 1.0, 2.0, 3.0].map(|value| [value, value]);
        assert_eq!(pieces(&[gap, one, two, gap, gap, three]), [vec![one, two], vec![three]]);
        assert_eq!(pieces(&[gap]), [[[0.0; 2]; 0]; 0]);
    }
}
