//! Many values as few that keep their envelope: no peak is lost.

/// Indices of at most `most` values (at least 4) that keep the envelope: the first and the last value, and between them the
/// lowest and the highest of intervals with equally many values. All of them if there are no more.
///
/// Values that are not finite are passed over, unless an interval has no others.
pub fn thin(values: &[f64], most: usize) -> Vec<usize> {
    let most = most.max(4);
    if values.len() <= most {
        return (0..values.len()).collect();
    }
    let inner = values.len() - 2;
    let intervals = (most - 2) / 2;
    let mut kept = vec![0];
    for interval in 0..intervals {
        let bound = |interval: usize| 1 + (interval as u128 * inner as u128 / intervals as u128) as usize;
        kept.extend(envelope(values, bound(interval), bound(interval + 1)));
    }
    kept.push(values.len() - 1);
    kept
}

/// Where the lowest and the highest value of an interval are, in order.
fn envelope(values: &[f64], begin: usize, end: usize) -> Vec<usize> {
    let finite = || (begin..end).filter(|index| values[*index].is_finite());
    let by_value = |one: &usize, other: &usize| values[*one].total_cmp(&values[*other]);
    let mut pair = match (finite().min_by(by_value), finite().max_by(by_value)) {
        (Some(lowest), Some(highest)) => vec![lowest, highest],
        _ => vec![begin],
    };
    pair.sort_unstable();
    pair.dedup();
    pair
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_series_stay_as_they_are() {
        assert_eq!(thin(&[], 10), [0; 0]);
        assert_eq!(thin(&[3.0, 1.0], 10), [0, 1]);
        assert_eq!(thin(&[0.0; 10], 10).len(), 10);
    }

    #[test]
    fn the_envelope_is_kept() {
        // Two intervals between the ends: 5 9 2 | 4 4 1.
        let values = [7.0, 5.0, 9.0, 2.0, 4.0, 4.0, 1.0, 8.0];
        assert_eq!(thin(&values, 6), [0, 2, 3, 5, 6, 7]);
        let values = [7.0, f64::NAN, f64::NAN, f64::NAN, 4.0, f64::NAN, 4.0, f64::NAN];
        assert_eq!(thin(&values, 6), [0, 1, 4, 6, 7]);
    }

    #[test]
    fn a_single_peak_of_a_long_series_stays() {
        let mut values = vec![1.0; 1_000_000];
        values[765_432] = 2.0;
        values[123_456] = 0.5;
        let kept = thin(&values, 1500);
        assert!(kept.len() <= 1500 && kept.is_sorted_by(|one, other| one < other));
        assert!(kept.contains(&765_432) && kept.contains(&123_456));
    }
}
