//! Which runs are worth their time.

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
pub fn quickest_within(costs: &[Cost], error: f64) -> Option<usize> {
    let within = (0..costs.len()).filter(|index| costs[*index].error <= error);
    within.min_by(|one, other| costs[*one].time.total_cmp(&costs[*other].time))
}

/// The run with the least error.
pub fn most_exact(costs: &[Cost]) -> Option<usize> {
    let known = (0..costs.len()).filter(|index| !costs[*index].error.is_nan());
    known.min_by(|one, other| costs[*one].error.total_cmp(&costs[*other].error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn costs() -> Vec<Cost> {
        [(10.0, 0.001), (5.0, 0.01), (6.0, 0.02), (1.0, 0.05), (0.5, f64::NAN), (5.0, 0.01), (1.0, 0.06)]
            .map(|(time, error)| Cost { time, error })
            .to_vec()
    }

    #[test]
    fn the_front_has_no_run_that_another_one_beats() {
        assert_eq!(front(&costs()), [true, true, false, true, false, true, false]);
    }

    #[test]
    fn the_quickest_that_is_exact_enough_is_advised() {
        assert_eq!(quickest_within(&costs(), 0.1), Some(3));
        assert_eq!(quickest_within(&costs(), 0.01), Some(1));
        assert_eq!(quickest_within(&costs(), 1e-4), None);
        assert_eq!(most_exact(&costs()), Some(0));
        assert_eq!(most_exact(&[]), None);
    }
}
