//! Quantities whose errors are measured, and a course of them over windows of physical time.

use plateau_core::observe::{QUANTITIES, Sample};

use super::windows::Windows;

/// One quantity whose error is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// Name for people.
    pub words: &'static str,
    /// Series of a run file whose sum it is.
    pub series: &'static [&'static str],
    /// Whether these only grow: over a window they then have a mean rate; else what counts is their value at its end.
    is_total: bool,
}

/// Number of quantities.
pub const COUNT: usize = 4;

/// All of them, in the order of tables.
pub const COMPARED: [Compared; COUNT] = [
    Compared { name: "contact_area", words: "contact area", series: &["contact_area_integral"], is_total: true },
    Compared { name: "filled_fraction", words: "filled fraction", series: &["filled_fraction"], is_total: false },
    Compared { name: "worn", words: "worn volume", series: &["worn_pin", "worn_resin", "worn_disc"], is_total: true },
    Compared { name: "emitted", words: "emitted volume", series: &["emitted"], is_total: true },
];

/// A value of every quantity, in the order of [`COMPARED`].
pub type Values = [f64; COUNT];

/// Values in a sample.
pub fn values_of(sample: &Sample) -> Values {
    COMPARED.map(|compared| {
        QUANTITIES.iter().filter(|one| compared.series.contains(&one.name)).map(|one| one.value(sample)).sum()
    })
}

/// Error of one quantity of a run, against the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityError {
    /// √(Σ (a − b)² / Σ b²) over the windows, with b the reference.
    pub mean_square: f64,
    /// Largest |a − b| / |b| of any window.
    pub largest: f64,
    /// (a − b) / b at the end of the last window; of the mean contact area, the worn and the emitted volume since the start.
    pub end: f64,
}

/// Values of all quantities at moments, the first of which is the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Moments, s.
    time: Vec<f64>,
    /// Values there.
    values: Vec<Values>,
}

impl Course {
    /// A run at its start.
    pub fn start() -> Self {
        Self { time: vec![0.0], values: vec![[0.0; COUNT]] }
    }

    /// Adds a later moment.
    pub fn record(&mut self, time: f64, values: Values) {
        self.time.push(time);
        self.values.push(values);
    }

    /// Counts the moments after the start.
    pub fn moments(&self) -> usize {
        self.time.len() - 1
    }

    /// Keeps so many moments after the start.
    #[must_use]
    pub fn first(&self, moments: usize) -> Self {
        let [time, values] = [self.time.len(), self.values.len()].map(|length| length.min(moments + 1));
        Self { time: self.time[..time].to_vec(), values: self.values[..values].to_vec() }
    }

    /// Interpolates at the ends of windows. As many moments as windows are their ends, as every run made here has them: each
    /// follows the end of its window by less than a step.
    #[must_use]
    pub fn at(&self, windows: &Windows) -> Self {
        if self.moments() == windows.count {
            return self.clone();
        }
        let mut course = Self::start();
        for end in windows.ends() {
            let after = self.time.partition_point(|time| *time < end).clamp(1, self.time.len() - 1);
            let (low, high) = (self.time[after - 1], self.time[after]);
            let part = ((end - low) / (high - low)).clamp(0.0, 1.0);
            let between = |one: usize| {
                let [low, high] = [after - 1, after].map(|moment| self.values[moment][one]);
                low + part * (high - low)
            };
            course.record(low + part * (high - low), std::array::from_fn(between));
        }
        course
    }

    /// Tells that there is a moment at the end of each window, or less than `step` (s) after it.
    pub fn knows(&self, windows: &Windows, step: f64) -> bool {
        windows.ends().all(|end| {
            let after = self.time.partition_point(|time| *time < end - 1e-6 * step);
            self.time.get(after).is_some_and(|time| *time < end + step)
        })
    }

    /// Means over the windows between the moments, of the quantity at a place of [`COMPARED`].
    fn means(&self, one: usize) -> Vec<f64> {
        let spans = self.time.windows(2).zip(self.values.windows(2));
        let mean = |(time, values): (&[f64], &[Values])| match COMPARED[one].is_total {
            true => (values[1][one] - values[0][one]) / (time[1] - time[0]),
            false => values[1][one],
        };
        spans.map(mean).collect()
    }

    /// Errors against a course over the same windows.
    pub fn errors(&self, reference: &Self) -> [QuantityError; COUNT] {
        std::array::from_fn(|one| {
            let end = |course: &Self| {
                let (time, value) = (course.time[course.moments()], course.values[course.moments()][one]);
                if COMPARED[one].is_total { value / time } else { value }
            };
            let (means, expected) = (self.means(one), reference.means(one));
            let pairs = || means.iter().copied().zip(expected.iter().copied());
            let difference: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
            let size: f64 = expected.iter().map(|b| b.powi(2)).sum();
            QuantityError {
                mean_square: ratio(difference, size).sqrt(),
                largest: greatest(pairs().map(|(a, b)| ratio(a - b, b).abs())),
                end: ratio(end(self) - end(reference), end(reference)),
            }
        })
    }
}

/// A difference over a size; 0 where there is no difference, for both may be 0.
fn ratio(difference: f64, size: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / size }
}

/// Greatest of numbers that are not negative; NaN if one of them is no number.
pub fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| if number.is_nan() || number > most { number } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral of a contact area 1 + 2t, filled fraction t/10, nothing worn or emitted, known at these moments.
    fn known_at(moments: &[f64]) -> Course {
        let mut course = Course::start();
        moments.iter().for_each(|t| course.record(*t, [t + t * t, t / 10.0, 0.0, 0.0]));
        course
    }

    #[test]
    fn means_are_those_of_the_function() {
        // The mean of 1 + 2t over [a, b] is 1 + a + b.
        assert_eq!(known_at(&[2.0, 4.0, 8.0]).means(0), [3.0, 7.0, 13.0]);
        assert_eq!(known_at(&[2.0, 4.0, 8.0]).means(1), [0.2, 0.4, 0.8]);
    }

    #[test]
    fn errors_are_those_of_the_definition() {
        let course = |integral: [f64; 2]| {
            let mut course = Course::start();
            integral.iter().zip([1.0, 2.0]).for_each(|(value, time)| course.record(time, [*value, 0.5, 0.0, *value]));
            course
        };
        // Means 3.3 and 3.6 against 3 and 4. By hand: √((0.3² + 0.4²)/(3² + 4²)) = 0.1; the larger of 0.3/3 and 0.4/4; 6.9/7 − 1.
        let [area, filled, worn, emitted] = course([3.3, 6.9]).errors(&course([3.0, 7.0]));
        assert!((area.mean_square - 0.1).abs() < 1e-15 && (area.largest - 0.1).abs() < 1e-15, "{area:?}");
        assert!((area.end + 0.1 / 7.0).abs() < 1e-15 && emitted == area, "{area:?}, {emitted:?}");
        for equal in [filled, worn] {
            assert_eq!(equal, QuantityError { mean_square: 0.0, largest: 0.0, end: 0.0 });
        }
        // Something where the reference has nothing is no small error.
        assert_eq!(known_at(&[1.0]).errors(&course([0.0, 0.0]).first(1))[0].mean_square, f64::INFINITY);
        let [unknown, ..] = course([f64::NAN, 6.9]).errors(&course([3.0, 7.0]));
        assert!(unknown.mean_square.is_nan() && unknown.largest.is_nan());
    }

    #[test]
    fn dense_moments_are_interpolated_at_the_ends_of_windows() {
        let moments: Vec<f64> = (1..=4000).map(|number| f64::from(number) * 2e-3).collect();
        // Windows that end between moments.
        let width = 2.6665;
        let course = known_at(&moments).at(&Windows { width, count: 3 });
        for (number, mean) in course.means(0).into_iter().enumerate() {
            let expected = 1.0 + (2.0 * number as f64 + 1.0) * width;
            // Linear interpolation of a parabola errs by at most (2e-3)²/4 at each end.
            assert!((mean - expected).abs() < 2.0 * 1e-6 / width, "{mean}, expected {expected}");
        }
        assert!((course.means(1)[1] - 2.0 * width / 10.0).abs() < 1e-12);
    }

    #[test]
    fn moments_at_or_just_after_the_ends_are_known() {
        let windows = Windows { width: 5.0, count: 2 };
        let course = known_at(&[2.5, 5.001, 7.5, 10.0]);
        assert!(course.knows(&windows, 0.002) && !course.knows(&windows, 0.0005));
        assert!(!known_at(&[4.999, 10.0]).knows(&windows, 0.002) && !known_at(&[5.0]).knows(&windows, 0.002));
        let exact = known_at(&[5.001, 10.0]);
        assert_eq!(exact.at(&windows), exact);
    }
}
