//! Whether a run is still running in: what its mean contact area changed by in its second half.

use serde::Serialize;

use super::window_mean::{Cumulative, LEAST_PARTS, ROUNDING, WindowMean, error_of_mean};

/// The fraction of the value at the end with which a run counts as run in.
pub const RUN_IN: f64 = 0.9;
/// Standard errors from which on a change is not taken for chance: 2.5 times in a hundred in either direction.
const BEYOND_CHANCE: f64 = 2.0;
/// Parts of what is missing at a fraction of the last value, and with no fraction a tenth: a change of less than the first counts as none,
/// and a run that may hide a larger one than the second tells nothing.
const NEGLIGIBLE: f64 = 0.1;
const OF_INTEREST: f64 = 0.5;
/// What is missing where nothing else is asked: at the fraction of the running-in time of a summary. So 1 % is negligible and 5 % is of
/// interest.
const MISSING: f64 = 1.0 - RUN_IN;
/// Pulses in a quarter of a run from which on two quarters can be compared: with one or less the change is that of a pulse, and no
/// standard error tells that.
pub const LEAST_PULSES: f64 = 3.0;

/// The last quarter of a run beside the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Mean over the third quarter.
    pub third_quarter: WindowMean,
    /// Mean over the last quarter.
    pub last_quarter: WindowMean,
    /// Change from one to the other, as a part of the mean of the third.
    pub change: f64,
    /// Its standard error, in the same measure: of what varies about a straight line through both quarters, for a steady rise is no
    /// chance; as if both quarters were independent.
    pub standard_error: f64,
    /// Pulses of the contact area in a quarter, at most; none where nothing pulses or that is not known.
    pub pulses: Option<f64>,
}

/// What the change of a mean says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trend {
    /// It rises by more than chance explains.
    Rises,
    /// It falls by more than chance explains.
    Falls,
    /// It changes by less than is of interest, and by no more than chance or next to nothing.
    Steady,
    /// Chance may hide a change that is of interest.
    Unknown,
    /// There are too few pulses in a quarter.
    TooShort,
}

impl Drift {
    /// What the samples of a run tell whose contact area pulses in this time, s, or longer; none where a quarter has too few samples or
    /// simulated revolutions for a standard error, or nothing to compare with.
    pub fn of(samples: &Cumulative<'_>, pulse_time: Option<f64>) -> Option<Self> {
        let end = *samples.time.last()?;
        let quarter = |from: f64, to: f64| samples.mean(from * end, to * end);
        let (third, last) = (quarter(0.5, 0.75)?, quarter(0.75, 1.0)?);
        let parts = [&third, &last].map(|quarter| samples.parts(quarter.from, quarter.to));
        let parts = parts[0].min(parts[1]);
        if parts < LEAST_PARTS || third.mean <= 0.0 {
            return None;
        }
        let rest = beside_a_line(&samples.means_of_parts(third.from, last.to, 2 * parts));
        Some(Self {
            third_quarter: third,
            last_quarter: last,
            change: (last.mean - third.mean) / third.mean,
            standard_error: 2.0_f64.sqrt() * error_of_mean(&rest, parts) / third.mean,
            pulses: pulse_time.map(|time| 0.25 * end / time),
        })
    }

    /// What the change says.
    pub fn trend(&self) -> Trend {
        self.trend_beside(MISSING)
    }

    /// What the change says where this part of the last value is missing, or more than in [`trend`](Self::trend): less is finer.
    pub(super) fn trend_beside(&self, missing: f64) -> Trend {
        let missing = missing.min(MISSING);
        let chance = BEYOND_CHANCE * self.standard_error;
        let is_negligible = self.change.abs() <= NEGLIGIBLE * missing * (1.0 + ROUNDING);
        match self.change {
            _ if self.pulses.is_some_and(|pulses| pulses < LEAST_PULSES) => Trend::TooShort,
            change if change > chance && !is_negligible => Trend::Rises,
            change if change < -chance && !is_negligible => Trend::Falls,
            change if change.abs() + chance <= OF_INTEREST * missing * (1.0 + ROUNDING) => Trend::Steady,
            _ => Trend::Unknown,
        }
    }
}

/// What is left of values when their least-squares line is taken out.
pub(super) fn beside_a_line(values: &[f64]) -> Vec<f64> {
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let places = || (0..values.len()).map(|place| place as f64 - middle);
    let slope = places().zip(values).map(|(place, value)| place * value).sum::<f64>()
        / places().map(|place| place * place).sum::<f64>();
    places().zip(values).map(|(place, value)| value - mean - slope * place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::random::{Random, Stream};

    /// The drift of a quantity that is the derivative of this integral, over 400 s.
    fn drift(integral: impl Fn(f64) -> f64) -> Option<Drift> {
        let time: Vec<f64> = (1..=400).map(f64::from).collect();
        let integral: Vec<f64> = time.iter().map(|time| integral(*time)).collect();
        Drift::of(&Cumulative { time: &time, integral: &integral, revolutions: &[] }, None)
    }

    #[test]
    fn a_line_drifts_by_its_slope() {
        // The quantity is 2 t: 500 in the third quarter, 700 in the last.
        let found = drift(|time| time * time).unwrap();
        assert!((found.change - 0.4).abs() < 1e-12, "{found:?}");
        assert_eq!((found.third_quarter.mean, found.last_quarter.mean), (500.0, 700.0));
        assert_eq!((found.third_quarter.from, found.last_quarter.from, found.last_quarter.to), (200.0, 300.0, 400.0));
        assert_eq!(found.trend(), Trend::Rises);
        // A line has nothing that could be chance.
        assert!(found.standard_error < 1e-12, "{found:?}");
    }

    #[test]
    fn the_error_is_that_of_what_varies_about_the_line() {
        // The quantity is 2 t and 1 more or less by lot: the change of means of 100 values errs by √(2/100).
        let mut random = Random::new(3, Stream::DiscHeight);
        let (mut sums, mut hits, runs) = (0.0, 0, 400);
        for _ in 0..runs {
            let mut noise = vec![0.0];
            (0..400).for_each(|place| noise.push(noise[place] + if random.uniform() < 0.5 { -1.0 } else { 1.0 }));
            let found = drift(|time| time * time + noise[time as usize]).unwrap();
            let of_third = found.third_quarter.mean;
            sums += (found.standard_error * of_third).powi(2);
            hits += usize::from((found.change * of_third - 200.0).abs() < 2.0 * found.standard_error * of_third);
        }
        let ratio = sums / runs as f64 / 0.02;
        // Chance moves the mean of 400 estimates by some hundredths; the truncation makes it a little too large.
        assert!((0.9..1.25).contains(&ratio), "{ratio}");
        // 95 %, give or take three standard deviations of the count and a little for the estimate.
        assert!((0.90..0.99).contains(&(hits as f64 / runs as f64)), "{hits} of {runs}");
    }

    #[test]
    fn a_quarter_of_few_pulses_tells_nothing() {
        let time: Vec<f64> = (1..=400).map(f64::from).collect();
        let integral: Vec<f64> = time.iter().map(|time| time * time).collect();
        let samples = Cumulative { time: &time, integral: &integral, revolutions: &[] };
        let trend = |pulse| Drift::of(&samples, Some(pulse)).unwrap().trend();
        assert_eq!([trend(33.0), trend(34.0)], [Trend::Rises, Trend::TooShort]);
    }

    #[test]
    fn what_swings_about_a_mean_does_not_drift() {
        // 1 + sin(t), whole and broken periods.
        let found = drift(|time| time + 1.0 - time.cos()).unwrap();
        assert!(matches!(found.trend(), Trend::Steady | Trend::Unknown) && found.change.abs() < 0.05, "{found:?}");
    }

    #[test]
    fn what_may_hide_a_change_of_interest_is_no_steady_mean() {
        let of =
            |change: f64, standard_error: f64| Drift { change, standard_error, ..drift(|time| time).unwrap() }.trend();
        assert_eq!(
            [of(0.01, 0.02), of(0.01, 0.021), of(-0.155, 0.084)],
            [Trend::Steady, Trend::Unknown, Trend::Unknown]
        );
        assert_eq!([of(0.05, 0.02), of(-0.05, 0.02)], [Trend::Rises, Trend::Falls]);
        // A hundredth is next to nothing, however well it is known.
        assert_eq!([of(0.01, 0.001), of(-0.01, 0.001), of(0.011, 0.001)], [Trend::Steady, Trend::Steady, Trend::Rises]);
    }

    #[test]
    fn what_is_nothing_or_too_short_tells_nothing() {
        assert_eq!(drift(|_| 0.0), None);
        let time = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(Drift::of(&Cumulative { time: &time, integral: &time, revolutions: &[] }, None), None);
        assert_eq!(Drift::of(&Cumulative { time: &[], integral: &[], revolutions: &[] }, None), None);
    }
}
