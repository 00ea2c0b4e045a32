//! Whether a run is still running in: what its mean contact area changed by in its second half.

use serde::Serialize;

use super::window_mean::{Cumulative, WindowMean};

/// Standard errors from which on a change is not taken for chance: 2.5 times in a hundred in either direction.
const BEYOND_CHANCE: f64 = 2.0;
/// A change of this part of the mean is of interest: a run that may hide a larger one tells nothing.
const OF_INTEREST: f64 = 0.05;

/// The last quarter of a run beside the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Mean over the third quarter.
    pub third_quarter: WindowMean,
    /// Mean over the last quarter.
    pub last_quarter: WindowMean,
    /// Change from one to the other, as a part of the mean of the third.
    pub change: f64,
    /// Its standard error, in the same measure, if both are independent.
    pub standard_error: f64,
}

/// What the change of a mean says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trend {
    /// It rises by more than chance explains.
    Rises,
    /// It falls by more than chance explains.
    Falls,
    /// It changes by less than is of interest.
    Steady,
    /// Chance may hide a change that is of interest.
    Unknown,
}

impl Drift {
    /// What the samples of a run tell; none where a quarter has too few samples or simulated revolutions for a standard error, or
    /// nothing to compare with.
    pub fn of(samples: &Cumulative<'_>) -> Option<Self> {
        let end = *samples.time.last()?;
        let quarter = |from: f64, to: f64| samples.mean(from * end, to * end);
        let (third, last) = (quarter(0.5, 0.75)?, quarter(0.75, 1.0)?);
        let error = third.standard_error?.hypot(last.standard_error?);
        let of_third = |value: f64| value / third.mean;
        (third.mean > 0.0).then(|| Self {
            third_quarter: third,
            last_quarter: last,
            change: of_third(last.mean - third.mean),
            standard_error: of_third(error),
        })
    }

    /// What the change says.
    pub fn trend(&self) -> Trend {
        let chance = BEYOND_CHANCE * self.standard_error;
        match self.change {
            change if change > chance => Trend::Rises,
            change if change < -chance => Trend::Falls,
            change if change.abs() + chance <= OF_INTEREST => Trend::Steady,
            _ => Trend::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The drift of a quantity that is the derivative of this integral, over 400 s.
    fn drift(integral: impl Fn(f64) -> f64) -> Option<Drift> {
        let time: Vec<f64> = (1..=400).map(f64::from).collect();
        let integral: Vec<f64> = time.iter().map(|time| integral(*time)).collect();
        Drift::of(&Cumulative { time: &time, integral: &integral, revolutions: &[] })
    }

    #[test]
    fn a_line_drifts_by_its_slope() {
        // The quantity is 2 t: 500 in the third quarter, 700 in the last.
        let found = drift(|time| time * time).unwrap();
        assert!((found.change - 0.4).abs() < 1e-12, "{found:?}");
        assert_eq!((found.third_quarter.mean, found.last_quarter.mean), (500.0, 700.0));
        assert_eq!((found.third_quarter.from, found.last_quarter.from, found.last_quarter.to), (200.0, 300.0, 400.0));
        assert_eq!(found.trend(), Trend::Rises);
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
    }

    #[test]
    fn what_is_nothing_or_too_short_tells_nothing() {
        assert_eq!(drift(|_| 0.0), None);
        let time = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(Drift::of(&Cumulative { time: &time, integral: &time, revolutions: &[] }), None);
        assert_eq!(Drift::of(&Cumulative { time: &[], integral: &[], revolutions: &[] }), None);
    }
}
