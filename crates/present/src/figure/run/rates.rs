//! What is added in a time, of a series that only grows; and how much there is for each metre of a way.

/// Windows of time that a figure distinguishes, at most.
const MOST_WINDOWS: usize = 60;
/// Part of the way that must be done before its mean is drawn: that of a short way is the chance of the first stops.
const SHORT: f64 = 0.05;

/// What is added in a window of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// When the window begins, s.
    pub begin: f64,
    /// When it ends, s.
    pub end: f64,
    /// What is added in it for each second.
    pub rate: f64,
}

/// The rates of a series that is 0 at the start, in windows with equally many samples.
pub fn rates(times: &[f64], values: &[f64]) -> Vec<Rate> {
    let samples: Vec<(f64, f64)> =
        times.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite()).collect();
    let length = samples.len().div_ceil(MOST_WINDOWS).max(1);
    let mut before = (0.0, 0.0);
    let mut rates = Vec::new();
    for last in samples.chunks(length).filter_map(<[_]>::last).copied() {
        let (begin, value) = before;
        if last.0 > begin {
            rates.push(Rate { begin, end: last.0, rate: (last.1 - value) / (last.0 - begin) });
            before = last;
        }
    }
    rates
}

/// A curve with a step at every end of a window: the area below it is what was added.
pub fn steps(rates: &[Rate]) -> Vec<[f64; 2]> {
    rates.iter().flat_map(|Rate { begin, end, rate }| [[*begin, *rate], [*end, *rate]]).collect()
}

/// Time, and what there is by then for each metre of the way behind; without the first part of the way.
pub fn per_metre(times: &[f64], values: &[f64], way: &[f64]) -> Vec<[f64; 2]> {
    let all = way.iter().copied().filter(|metres| metres.is_finite()).fold(0.0, f64::max);
    let points = times.iter().zip(values).zip(way);
    let far = points.filter(|((_, value), metres)| **metres > 0.0 && **metres >= SHORT * all && value.is_finite());
    far.map(|((time, value), metres)| [*time, value / metres]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_is_told_from_the_start_on() {
        let rates = rates(&[2.0, 3.0, 5.0], &[4.0, 4.0, 14.0]);
        // By hand: 4 in 2 s, nothing in 1 s, 10 in 2 s.
        assert_eq!(rates.iter().map(|window| window.rate).collect::<Vec<_>>(), [2.0, 0.0, 5.0]);
        assert_eq!(steps(&rates), [[0.0, 2.0], [2.0, 2.0], [2.0, 0.0], [3.0, 0.0], [3.0, 5.0], [5.0, 5.0]]);
    }

    #[test]
    fn windows_of_many_samples_lose_nothing() {
        let times: Vec<f64> = (1..=1001).map(|sample| 0.5 * f64::from(sample)).collect();
        let values: Vec<f64> = times.iter().map(|time| (0.1 * time).sin() + time).collect();
        let rates = rates(&times, &values);
        assert!(rates.len() <= MOST_WINDOWS);
        let added: f64 = rates.iter().map(|Rate { begin, end, rate }| rate * (end - begin)).sum();
        assert!((added - values[1000]).abs() < 1e-9);
        assert!(rates.windows(2).all(|pair| pair[0].end == pair[1].begin));
        assert_eq!(rates[rates.len() - 1].end, 500.5);
    }

    #[test]
    fn what_is_no_number_is_passed_over() {
        let rates = rates(&[1.0, 2.0, 3.0], &[1.0, f64::NAN, 5.0]);
        assert_eq!(rates.iter().map(|window| window.rate).collect::<Vec<_>>(), [1.0, 2.0]);
        assert_eq!(super::rates(&[], &[]), []);
    }

    #[test]
    fn the_mean_of_a_way_needs_a_way() {
        // By hand: 5 % of 1000 m are 50 m.
        let points = per_metre(&[1.0, 2.0, 3.0, 4.0], &[0.0, 9.0, 100.0, 500.0], &[0.0, 40.0, 50.0, 1000.0]);
        assert_eq!(points, [[3.0, 2.0], [4.0, 0.5]]);
        assert_eq!(per_metre(&[1.0], &[1.0], &[0.0]), [[0.0; 2]; 0]);
    }
}
