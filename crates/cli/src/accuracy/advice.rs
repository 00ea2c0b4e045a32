//! Which run to choose for an error, in a sentence.

use super::pareto::{most_exact, quickest_within};
use super::report::Report;
use crate::number;

/// Errors of the contact area for which runs are advised.
const ERRORS: [f64; 2] = [1e-2, 1e-3];

/// One sentence for each of the errors.
pub fn advice(report: &Report) -> Vec<String> {
    let costs = report.choices();
    let of = |index: usize| {
        let (row, cost) = (&report.rows[index], costs[index]);
        (row.setting(), number::duration(cost.time), percent(cost.error))
    };
    let reference = number::duration(report.reference.outcome.wall_time);
    let sentence = |error: f64| match (quickest_within(&costs, error), most_exact(&costs)) {
        (Some(index), _) => {
            let (name, time, _) = of(index);
            format!("for {} error in contact area use {name}: {time} instead of {reference}", percent(error))
        }
        (None, Some(index)) => {
            let (name, time, found) = of(index);
            format!("no run reaches {} error in contact area; the best has {found}: {name}, {time}", percent(error))
        }
        (None, None) => "there is no run to choose".to_owned(),
    };
    let mut advice = ERRORS.map(sentence).to_vec();
    advice.dedup();
    advice
}

/// A fraction in per cent, with two digits that count.
pub fn percent(fraction: f64) -> String {
    if fraction.is_nan() {
        return "–".to_owned();
    }
    format!("{} %", number::rounded(100.0 * fraction, 2))
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn parts_are_given_in_per_cent() {
        assert_eq!(percent(1e-2), "1 %");
        assert_eq!(percent(1e-3), "0.1 %");
        assert_eq!(percent(0.002_84), "0.28 %");
        assert_eq!(percent(1.5), "150 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(percent(1.234e-9), "1.2e\u{2212}7 %");
        assert_eq!(percent(f64::NAN), "–");
    }
}
