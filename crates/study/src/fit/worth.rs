//! Whether further runs are worth making where the fit is not settled.
//!
//! An interval is as wide as the root of the measurement's variance and the processes' together, 1 + share of the measurement's.
//! Runs are worth making while they shorten it by more than what a settled fit leaves. They do not where runs scatter from one
//! surface, or from one point, to the next by as much as the measurement is uncertain: as many as the budget has then change
//! little.

use super::Fit;
use super::likelihood::Term;
use super::next::SETTLED;

/// Rounds in which nothing is gained before it is believed that nothing will be.
const PATIENCE: usize = 3;

/// The response whose forecast is known worst, against its measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Its number: among the responses of which a value was measured, or, if it is one, among the series.
    pub number: usize,
    /// Whether a series was measured.
    pub is_series: bool,
    /// By how many deviations of the measurement, as root mean square, runs miss what the others forecast.
    pub missed: f64,
}

impl Fit {
    /// Whether it is worth it to go on with so many more points at most, each of so many runs. `before` are the
    /// [`Fit::surrogate_share`]s of the rounds before.
    ///
    /// It is not if the processes themselves expect to gain too little of all of them; nor if they do not expect to settle it and
    /// the last rounds have gained nothing, whatever was expected of them.
    pub fn is_worth_more(&self, before: &[f64], count: usize, runs: usize) -> bool {
        let (now, then) = (self.surrogate_share(), self.expected_share(count, runs));
        if then <= SETTLED {
            return true;
        }
        if !gains(now, then) {
            return false;
        }
        let least = |shares: &[f64]| shares.iter().copied().fold(f64::INFINITY, f64::min);
        match (before.len() + 1).checked_sub(PATIENCE) {
            None | Some(0) => true,
            Some(rounds) => gains(least(&before[..rounds]), least(&before[rounds..]).min(now)),
        }
    }

    /// The response whose forecast is known worst; none without any.
    pub(super) fn worst(&self) -> Option<Worst> {
        let terms = self.likelihood.terms.iter().enumerate();
        let shares = terms.map(|(at, term)| (self.share_of(std::slice::from_ref(term)), at));
        let (_, worst) = shares.max_by(|one, other| one.0.total_cmp(&other.0))?;
        let term = &self.likelihood.terms[worst];
        let in_series: usize = self.series.iter().map(|series| series.count()).sum();
        let missed = missed(term);
        let Some(mut of_series) = worst.checked_sub(self.likelihood.terms.len() - in_series) else {
            return Some(Worst { number: worst, is_series: false, missed });
        };
        let mut number = 0;
        while of_series >= self.series[number].count() {
            of_series -= self.series[number].count();
            number += 1;
        }
        Some(Worst { number, is_series: true, missed })
    }
}

/// Whether an interval becomes shorter by more than a settled fit leaves.
fn gains(before: f64, after: f64) -> bool {
    1.0 + before > (1.0 + SETTLED) * (1.0 + after)
}

fn missed(term: &Term) -> f64 {
    let left_out = term.process.left_out();
    let squares = left_out.iter().map(|point| (point.observed - point.forecast).powi(2)).sum::<f64>();
    (squares / left_out.len() as f64 / term.fixed_variance()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Setting;
    use crate::effects::Observation;
    use crate::fit::{Key, Measurement};

    /// Points, rounds and the end of a fit of a to y = a, measured as 0.5 ± 0.1, of runs that differ by this in turns: it ends as
    /// `plateau fit` does.
    fn made(scatter: f64, most: usize) -> (usize, bool) {
        let keys = [Key { name: "a".into(), low: 0.0, high: 1.0, logarithmic: false }];
        let measured = [Measurement { value: 0.5, uncertainty: 0.1 }];
        let mut points: Vec<f64> = (0..6).map(|at| f64::from(at) / 2.5 - 1.0).collect();
        let mut shares = Vec::new();
        loop {
            let run = |(run, coded): (usize, &f64)| Observation {
                settings: vec![Setting::Coded(*coded)],
                replicate: 0,
                run,
                // Fractional parts of multiples of the golden section are spread evenly, and of neighbours unlike.
                response: keys[0].value(*coded) + scatter * ((run as f64 * 0.618_033_988_75).fract() - 0.5),
            };
            let fit = Fit::new(&keys, &measured, &[points.iter().enumerate().map(run).collect()], 0.95).unwrap();
            let left = most - points.len();
            if fit.is_settled() || left == 0 {
                return (points.len(), fit.is_settled());
            }
            if !fit.is_worth_more(&shares, left, 1) {
                let worst = fit.worst().unwrap();
                // Evenly spread between −½ and ½: a deviation of √(1/12), and others forecast it no better than by their mean.
                let expected = scatter / 12.0_f64.sqrt() / 0.1;
                assert!((worst.missed / expected - 1.0).abs() < 0.35 && !worst.is_series, "{worst:?} {expected}");
                return (points.len(), false);
            }
            shares.push(fit.surrogate_share());
            points.extend(fit.next_points(4.min(left), 1).iter().map(|place| place[0]));
        }
    }

    #[test]
    fn a_fit_ends_before_its_budget_where_runs_scatter_too_much_for_it() {
        // A deviation of 1, ten times the uncertainty: 40 points on a line leave 1/√40 or so, with a share of 2 or more.
        let (points, settled) = made(3.5, 40);
        assert!(points < 40 && !settled, "{points}");
        // A tenth of the uncertainty is nothing, and of half of it a few points have a mean that is known.
        assert!(made(0.035, 40).1);
        let (points, settled) = made(0.17, 60);
        assert!(settled, "{points}");
    }

    #[test]
    fn gains_are_those_of_intervals() {
        // By hand: 1.3/1.2 is less than 1.1, 1.3/1.1 is more.
        assert!(!gains(0.3, 0.2) && gains(0.3, 0.1));
    }
}
