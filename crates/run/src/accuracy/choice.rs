//! Which runs are worth their time, and when that can be told.

/// How many times the reference's own error another error must be, so that it is told from it.
pub const CLEAR: f64 = 3.0;

/// Wall time (s) and error of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Wall time, s.
    pub time: f64,
    /// Error; NaN where it is not known.
    pub error: f64,
}

/// Whether each run is on the Pareto front: no other one is as quick and as exact, and better in one of the two.
pub fn front(costs: &[Cost]) -> Vec<bool> {
    let beats = |one: &Cost, other: &Cost| {
        one.time <= other.time && one.error <= other.error && (one.time < other.time || one.error < other.error)
    };
    costs.iter().map(|cost| !cost.error.is_nan() && !costs.iter().any(|other| beats(other, cost))).collect()
}

/// The quickest run with an error of at most this.
fn quickest_within(costs: &[Cost], error: f64) -> Option<usize> {
    let within = (0..costs.len()).filter(|index| costs[*index].error <= error);
    within.min_by(|one, other| costs[*one].time.total_cmp(&costs[*other].time))
}

/// The run with the least error.
fn most_exact(costs: &[Cost]) -> Option<usize> {
    let known = (0..costs.len()).filter(|index| !costs[*index].error.is_nan());
    known.min_by(|one, other| costs[*one].error.total_cmp(&costs[*other].error))
}

/// What can be said about an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Advice {
    /// This run is the quickest of those that are as exact.
    Use(usize),
    /// No run is as exact; this one has the least error.
    Missed(usize),
    /// The reference's own error decides which runs are as exact.
    ReferenceInexact,
    /// No run is a choice.
    NoChoice,
}

/// The advice for an error, from the costs of the runs that may be chosen. `reference` is the reference's own error, which
/// adds to that of a run; `clear` tells of each run whether its error is well above that.
pub fn judge(error: f64, costs: &[Cost], reference: f64, clear: &[bool]) -> Advice {
    let if_clear = |index: usize, advice: fn(usize) -> Advice| {
        if clear[index] { advice(index) } else { Advice::ReferenceInexact }
    };
    match (quickest_within(costs, error - reference), quickest_within(costs, error), most_exact(costs)) {
        (Some(index), _, _) => if_clear(index, Advice::Use),
        (None, Some(_), _) => Advice::ReferenceInexact,
        (None, None, Some(index)) => if_clear(index, Advice::Missed),
        (None, None, None) => Advice::NoChoice,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn costs(of: &[(f64, f64)]) -> Vec<Cost> {
        of.iter().map(|(time, error)| Cost { time: *time, error: *error }).collect()
    }

    fn many() -> Vec<Cost> {
        costs(&[(10.0, 0.001), (5.0, 0.01), (6.0, 0.02), (1.0, 0.05), (0.5, f64::NAN), (5.0, 0.01), (1.0, 0.06)])
    }

    #[test]
    fn the_front_has_no_run_that_another_one_beats() {
        assert_eq!(front(&many()), [true, true, false, true, false, true, false]);
    }

    #[test]
    fn the_quickest_that_is_exact_enough_is_advised() {
        let from_the_model = |error| judge(error, &many(), 0.0, &[true; 7]);
        assert_eq!(from_the_model(0.1), Advice::Use(3));
        assert_eq!(from_the_model(0.01), Advice::Use(1));
        assert_eq!(from_the_model(1e-4), Advice::Missed(0));
        assert_eq!(judge(0.1, &[], 0.0, &[]), Advice::NoChoice);
        assert_eq!(judge(0.1, &costs(&[(1.0, f64::NAN)]), 0.0, &[true]), Advice::NoChoice);
    }

    #[test]
    fn nothing_is_advised_where_the_reference_is_not_better() {
        let costs = costs(&[(5.0, 0.002), (2.0, 0.009), (1.0, 0.04)]);
        // Errors of 0.2, 0.9 and 4 % against a reference that is itself off by 0.1 %: no more than 0.3, 1 and 4.1 %.
        let with = |error, own: f64| judge(error, &costs, own, &[0.002, 0.009, 0.04].map(|found| found >= 3.0 * own));
        assert_eq!(
            [0.1, 0.01, 0.003].map(|error| with(error, 0.0009)),
            [Advice::Use(2), Advice::Use(1), Advice::ReferenceInexact]
        );
        // Off by 0.2 %, the second may have 1.1 %; the first is not told from the reference.
        assert_eq!(
            [0.1, 0.01, 0.001].map(|error| with(error, 0.002)),
            [Advice::Use(2), Advice::ReferenceInexact, Advice::ReferenceInexact]
        );
        // Off by 2 %, nothing is told from it.
        assert_eq!([0.1, 0.01, 0.001].map(|error| with(error, 0.02)), [Advice::ReferenceInexact; 3]);
        assert_eq!([0.1, 0.01, 0.001].map(|error| with(error, f64::NAN)), [Advice::ReferenceInexact; 3]);
    }
}
