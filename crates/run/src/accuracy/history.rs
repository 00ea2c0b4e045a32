//! Windows of physical time over which runs are compared, and what is kept of the course of a run.

/// Narrowest window, s.
pub const LEAST_WINDOW: f64 = 5.0;

/// Windows that follow each other from the start of a run. What is left at its end is less than one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Windows {
    /// Width of each, s.
    pub width: f64,
    /// How many there are, at least 1.
    pub count: usize,
}

impl Windows {
    /// As many windows as a run of that duration (s) has room for. Each is a whole number of times as wide as `unit` (s),
    /// and at least `least` (s); a run that is shorter than that is one window.
    ///
    /// The contact area fluctuates as the disc turns, and a mean over a part of a revolution depends on which part that is.
    /// So the unit is to be a time in which the runs do whole revolutions: see [`common_multiple`].
    pub fn new(duration: f64, unit: f64, least: f64) -> Self {
        let width = unit * (least / unit - 1e-9).ceil().max(1.0);
        match (duration / width + 1e-9).floor() as usize {
            0 => Self { width: duration, count: 1 },
            count => Self { width, count },
        }
    }

    /// Where the last of them ends, s.
    pub fn span(&self) -> f64 {
        self.count as f64 * self.width
    }

    /// Where each of them ends, s.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        let width = self.width;
        (1..=self.count).map(move |number| number as f64 * width)
    }
}

/// The smallest multiple of the largest number, up to four times it, that is a multiple of all of them; the largest itself
/// where there is none.
pub fn common_multiple(numbers: &[f64]) -> f64 {
    let largest = numbers.iter().copied().fold(0.0, f64::max);
    let divides = |number: &f64, multiple: f64| ((multiple / number).round() * number / multiple - 1.0).abs() < 1e-9;
    let multiples = [1.0, 2.0, 3.0, 4.0].map(|times| times * largest);
    let common = |multiple: &f64| numbers.iter().all(|number| divides(number, *multiple));
    multiples.into_iter().find(common).unwrap_or(largest)
}

/// Values at moments, the first of which is the start.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// The moments, s.
    time: Vec<f64>,
    /// ∫ contact area dt since the start, m² s.
    area_integral: Vec<f64>,
    /// Filled fraction.
    filled: Vec<f64>,
}

impl History {
    /// A run at its start.
    pub fn start() -> Self {
        Self { time: vec![0.0], area_integral: vec![0.0], filled: vec![0.0] }
    }

    /// Adds a later moment.
    pub fn record(&mut self, time: f64, area_integral: f64, filled: f64) {
        self.time.push(time);
        self.area_integral.push(area_integral);
        self.filled.push(filled);
    }

    /// Moments after the start.
    pub fn moments(&self) -> usize {
        self.time.len() - 1
    }

    /// The same at the ends of windows, interpolated between the moments that are known. As many moments as windows are
    /// their ends, as every run made here has them: each follows the end of its window by less than a step.
    pub fn at(&self, windows: &Windows) -> Self {
        if self.moments() == windows.count {
            return self.clone();
        }
        let mut history = Self::start();
        for end in windows.ends() {
            let after = self.time.partition_point(|time| *time < end).clamp(1, self.time.len() - 1);
            let (low, high) = (self.time[after - 1], self.time[after]);
            let part = ((end - low) / (high - low)).clamp(0.0, 1.0);
            let between = |values: &[f64]| values[after - 1] + part * (values[after] - values[after - 1]);
            history.record(low + part * (high - low), between(&self.area_integral), between(&self.filled));
        }
        history
    }

    /// Whether there is a moment at the end of each window, or less than `step` (s) after it.
    pub fn knows(&self, windows: &Windows, step: f64) -> bool {
        windows.ends().all(|end| {
            let after = self.time.partition_point(|time| *time < end - 1e-6 * step);
            self.time.get(after).is_some_and(|time| *time < end + step)
        })
    }

    /// Mean contact area between each moment and the next, m²: differences of the integral.
    pub fn mean_areas(&self) -> Vec<f64> {
        let spans = self.time.windows(2).zip(self.area_integral.windows(2));
        spans.map(|(time, integral)| (integral[1] - integral[0]) / (time[1] - time[0])).collect()
    }

    /// Filled fraction at every moment after the start.
    pub fn filled(&self) -> &[f64] {
        &self.filled[1..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_multiples_are_found_where_there_are_small_ones() {
        assert_eq!(common_multiple(&[1.0, 2.0, 5.0, 10.0]), 10.0);
        assert_eq!(common_multiple(&[1.0, 10.0, 20.0, 50.0]), 100.0);
        assert_eq!(common_multiple(&[2.5, 3.0, 10.0]), 30.0);
        assert_eq!(common_multiple(&[7.3, 100.0]), 100.0);
    }

    #[test]
    fn windows_are_whole_units_and_wide_enough() {
        for (duration, unit, least, width, count) in [
            (3000.0, 70.0, 5.0, 70.0, 42),
            (3000.0, 0.75, 5.0, 5.25, 571),
            (60.0, 2.5, 5.0, 5.0, 12),
            (2.0, 0.75, 5.0, 2.0, 1),
            (7.0, 8.0, 5.0, 7.0, 1),
        ] {
            assert_eq!(Windows::new(duration, unit, least), Windows { width, count });
        }
        assert_eq!(Windows::new(10.0, 5.0, 5.0).ends().collect::<Vec<_>>(), [5.0, 10.0]);
    }

    /// Contact area 1 + 2t, filled fraction t/10, known at these moments.
    fn known_at(moments: &[f64]) -> History {
        let mut history = History::start();
        moments.iter().for_each(|t| history.record(*t, t + t * t, t / 10.0));
        history
    }

    #[test]
    fn means_are_those_of_the_function() {
        // The mean of 1 + 2t over [a, b] is 1 + a + b.
        assert_eq!(known_at(&[2.0, 4.0, 8.0]).mean_areas(), [3.0, 7.0, 13.0]);
    }

    #[test]
    fn dense_moments_are_interpolated_at_the_ends_of_windows() {
        let moments: Vec<f64> = (1..=4000).map(|number| f64::from(number) * 2e-3).collect();
        // Windows that end between moments.
        let width = 2.6665;
        let history = known_at(&moments).at(&Windows { width, count: 3 });
        for (number, mean) in history.mean_areas().into_iter().enumerate() {
            let expected = 1.0 + (2.0 * number as f64 + 1.0) * width;
            // Linear interpolation of a parabola errs by at most (2e-3)²/4 at each end.
            assert!((mean - expected).abs() < 2.0 * 1e-6 / width, "{mean}, expected {expected}");
        }
        assert!((history.filled()[1] - 2.0 * width / 10.0).abs() < 1e-12);
    }

    #[test]
    fn moments_just_after_the_ends_are_known() {
        let history = known_at(&[2.5, 5.001, 7.5, 10.0]);
        let windows = Windows { width: 5.0, count: 2 };
        assert!(history.knows(&windows, 0.002) && !history.knows(&windows, 0.0005));
        assert!(!known_at(&[4.999, 10.0]).knows(&windows, 0.002) && !known_at(&[5.0]).knows(&windows, 0.002));
    }

    #[test]
    fn moments_at_the_ends_stay_as_they_are() {
        let history = known_at(&[5.001, 10.0]);
        assert_eq!(history.at(&Windows { width: 5.0, count: 2 }), history);
    }
}
