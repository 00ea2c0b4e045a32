//! Lines of several runs that go up and down all the time, as weighted means over a longer time.

use plateau_io::number;

use super::spans::{Spans, pieces};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::Unit;

/// A line that goes up and down over more than so many times the height of all lines is no line for the eye.
const MOST_WAY: f64 = 3.0;
/// Part of a run that a weighted mean goes over, at most: a line of longer ones would end long before the run, or not be what it is said to be.
const LONGEST_MEAN: f64 = 0.5;

impl Spans {
    /// As few as still show a course.
    const FEWEST: usize = 30;

    /// So many that no line goes up and down all the time, as where the contact comes and goes in many revolutions: several
    /// such lines would be one block. Of every curve the times, s, and the values.
    pub fn calm<'a>(curves: impl Iterator<Item = (&'a [f64], &'a [f64])> + Clone) -> Self {
        let longest = curves.clone().map(|(times, _)| span_of(times)).fold(0.0, f64::max);
        let mut spans = Self::FINEST;
        while spans.most > Self::FEWEST && !spans.are_calm(curves.clone()) {
            let most = (spans.most / 2).max(Self::FEWEST);
            let coarser = Self { most, duration: longest * (2 * (Self::FINEST.most / most)) as f64 };
            if !curves.clone().any(|(times, _)| coarser.is_weighted(times)) {
                break;
            }
            spans = coarser;
        }
        spans
    }

    /// The coarser of two.
    pub fn coarser(self, other: Self) -> Self {
        if other.most < self.most { other } else { self }
    }

    fn are_calm<'a>(self, curves: impl Iterator<Item = (&'a [f64], &'a [f64])>) -> bool {
        let (mut low, mut high, mut longest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for (times, values) in curves {
            let mut way = 0.0;
            let is_drawn_so = self == Self::FINEST || self.is_weighted(times);
            for piece in self.course(times, values) {
                way += piece.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()).sum::<f64>();
                (low, high) =
                    piece.iter().fold((low, high), |(low, high), [_, value]| (low.min(*value), high.max(*value)));
            }
            // A line that is too short for coarser spans is not changed by them.
            longest = if is_drawn_so { longest.max(way) } else { longest };
        }
        longest <= MOST_WAY * (high - low).max(0.0)
    }

    /// The lines through means, over times in s: as many as a figure distinguishes, each, where spans are coarser, with those beside it, whose
    /// weights fall to nothing. A line through means of single spans would go up and down where ups and downs are about as long. Such a line
    /// ends half the time of a mean before the last sample. A run for which that time is too long has the finest means.
    pub fn course(self, times: &[f64], values: &[f64]) -> Vec<Vec<[f64; 2]>> {
        let mut lines = pieces(&Self::FINEST.means(times, values));
        if self.is_weighted(times) {
            let beside = self.beside(times);
            lines.iter_mut().for_each(|line| *line = weighted(line, beside));
        }
        lines
    }

    /// Whether the line of a run with samples at these times, s, is a weighted mean: that of a run of which such a mean would be more than a
    /// part, or which has too few samples for it, is not.
    pub fn is_weighted(self, times: &[f64]) -> bool {
        let whole = times.first().zip(times.last()).map_or(0.0, |(first, last)| last - first);
        self.beside(times) > 1 && self.duration <= LONGEST_MEAN * whole
    }

    /// How many of the finest spans of a run there are in half the time of a mean.
    fn beside(self, times: &[f64]) -> usize {
        let span = span_of(times);
        if span > 0.0 { (0.5 * self.duration / span).round() as usize } else { 0 }
    }

    /// These lines as they are drawn: `place` gives each point its place on the axes.
    pub fn lines(
        self,
        times: &[f64],
        values: &[f64],
        place: impl Fn([f64; 2]) -> [f64; 2],
        stroke: Stroke,
    ) -> impl Iterator<Item = Content> {
        let placed = move |points: Vec<[f64; 2]>| points.into_iter().map(&place).collect();
        self.course(times, values).into_iter().map(move |points| Content::Line { points: placed(points), stroke })
    }

    /// What the lines of a course are: what they are at the finest, or over how long a time means go.
    pub fn meaning(self, finest: &str) -> String {
        if self == Self::FINEST {
            return finest.to_owned();
        }
        let unit = Unit::for_size("s", self.duration);
        format!("weighted mean over {}", unit.with_symbol(&number::rounded(unit.value(self.duration), 2)))
    }
}

/// The time of one of the finest spans of samples at these times, s.
fn span_of(times: &[f64]) -> f64 {
    let [Some(first), Some(last)] = [times.first(), times.last()] else { return 0.0 };
    Spans::FINEST.length(times.len()) as f64 * (last - first) / (times.len() - 1).max(1) as f64
}

/// Means of every value and those beside it, with weights that fall to nothing at so many places from it. Near the begin, where most
/// happens, there are as many before it as behind it. The last places have too few behind them and are left out: a mean of those before
/// would go up and down with the values. A line shorter than twice the width goes to its end, as it goes from its begin.
fn weighted(points: &[[f64; 2]], beside: usize) -> Vec<[f64; 2]> {
    let is_short = points.len() < 2 * beside;
    let count = if is_short { points.len() } else { points.len() + 1 - beside };
    let mean = |at: usize| {
        let reach = (beside - 1).min(at).min(points.len() - 1 - at);
        let part = |other: usize| (reach + 1 - at.abs_diff(other)) as f64;
        let around = at - reach..=at + reach;
        let (sum, weights) = around
            .fold((0.0, 0.0), |(sum, weights), other| (sum + part(other) * points[other][1], weights + part(other)));
        [points[at][0], sum / weights]
    };
    (0..count).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_go_up_and_down_all_the_time_are_put_together() {
        let times: Vec<f64> = (0..4000).map(f64::from).collect();
        let slow: Vec<f64> = times.iter().map(|time| time.sqrt()).collect();
        // Forty seconds up and down, as far as the slow one rises.
        let pulsing: Vec<f64> = times.iter().map(|time| 30.0 * (time * std::f64::consts::TAU / 40.0).sin()).collect();
        let spans_of = |curves: &[&Vec<f64>]| Spans::calm(curves.iter().map(|values| (&times[..], &values[..])));
        assert_eq!(spans_of(&[&slow]), Spans::FINEST);
        let coarse = spans_of(&[&slow, &pulsing]);
        // Eight spans of 16 s on both sides.
        assert_eq!(coarse, Spans { most: 31, duration: 256.0 });
        let [course] = &coarse.course(&times, &pulsing)[..] else { panic!("one line") };
        assert_eq!(course.len(), 250 - 7);
        assert!(course[8..].iter().all(|[_, value]| value.abs() < 3.0), "{course:?}");
        // What does not pulse stays as it is.
        let [straight] = &coarse.course(&times, &times)[..] else { panic!("one line") };
        assert!(straight.iter().all(|[time, value]| (time - value).abs() < 1e-9));
        // A run of half the length has the same means: as many seconds, not as large a part of it.
        let half = &times[..2000];
        let [short] = &coarse.course(half, &pulsing[..2000])[..] else { panic!("one line") };
        assert_eq!(short.len(), 250 - 15);
        assert!(short[16..].iter().all(|[_, value]| value.abs() < 3.0), "{short:?}");
        let constant = vec![2.0; times.len()];
        assert_eq!(spans_of(&[&constant]), Spans::FINEST);
    }

    #[test]
    fn a_run_that_is_too_short_for_a_weighted_mean_keeps_its_line() {
        let times: Vec<f64> = (0..4000).map(f64::from).collect();
        let pulsing: Vec<f64> = times.iter().map(|time| 30.0 * (time * std::f64::consts::TAU / 40.0).sin()).collect();
        let of = |samples: usize| (&times[..samples], &pulsing[..samples]);
        let slow: Vec<f64> = times.iter().map(|time| time.sqrt()).collect();
        let coarse = Spans::calm([(&times[..], &slow[..]), of(4000), of(500)].into_iter());
        // Means of 256 s fit twice into 512 s.
        assert_eq!(coarse, Spans { most: 31, duration: 256.0 });
        assert_eq!([4000, 514, 512].map(|samples| coarse.is_weighted(of(samples).0)), [true, true, false]);
        let (at, values) = of(500);
        assert_eq!(coarse.course(at, values), Spans::FINEST.course(at, values));
        // Its last point is the mean of the last two samples, not half a weighted mean before.
        assert_eq!(coarse.course(at, values)[0].last().unwrap()[0], 498.5);
        // Of such runs alone nothing is said of means that none of them has.
        let few: Vec<f64> = (0..6).map(f64::from).collect();
        let up_and_down = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0];
        assert_eq!(Spans::calm([(&few[..], &up_and_down[..])].into_iter()).meaning("samples"), "samples");
    }

    #[test]
    fn weights_fall_with_distance() {
        let means = |values: &[f64], beside| -> Vec<f64> {
            let points: Vec<[f64; 2]> = values.iter().map(|value| [1.0, *value]).collect();
            weighted(&points, beside).iter().map(|point| point[1]).collect()
        };
        // By hand: 1, 2, 1 behind the begin, 1, 2, 3, 2, 1 from there on; the last two places have fewer behind them.
        assert_eq!(means(&[0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 9.0, 0.0], 3), [0.0, 2.25, 3.0, 2.0, 2.0, 2.0]);
        // A short line goes to its end.
        assert_eq!(means(&[0.0, 0.0, 9.0, 0.0, 0.0], 3), [0.0, 2.25, 3.0, 2.25, 0.0]);
    }
}
