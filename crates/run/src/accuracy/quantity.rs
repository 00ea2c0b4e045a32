//! Quantities whose errors are measured, and a course of them over windows of physical time, over which runs are compared.

use plateau_core::observe::{QUANTITIES, Sample};

/// One quantity whose error is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// Name for people.
    pub words: &'static str,
    /// Series of a run file whose sum it is.
    pub series: &'static [&'static str],
    /// True if these only grow: over a window they then have a mean rate; else what counts is their value at its end.
    is_total: bool,
}

/// Number of quantities.
pub const COUNT: usize = 4;

/// All quantities, in the order of tables.
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
    /// Values at the moments.
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

    /// Tells whether there is a moment at the end of each window, or less than `step` (s) after it.
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

/// Narrowest window, s.
pub const LEAST_WINDOW: f64 = 5.0;

/// Windows that follow each other from the start of a run. What is left at its end is less than one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Windows {
    /// Width of each, s.
    pub width: f64,
    /// Number of them, at least 1.
    pub count: usize,
}

impl Windows {
    /// Makes as many windows as a run of that duration (s) has room for. Each is a whole number of times as wide as `unit` (s),
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

    /// Ends of the windows, s.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        let width = self.width;
        (1..=self.count).map(move |number| number as f64 * width)
    }
}

/// Smallest multiple of the largest number, up to four times it, that is a multiple of all of them; the largest itself where
/// there is none.
pub fn common_multiple(numbers: &[f64]) -> f64 {
    let largest = numbers.iter().copied().fold(0.0, f64::max);
    let divides = |number: &f64, multiple: f64| ((multiple / number).round() * number / multiple - 1.0).abs() < 1e-9;
    let multiples = [1.0, 2.0, 3.0, 4.0].map(|times| times * largest);
    let common = |multiple: &f64| numbers.iter().all(|number| divides(number, *multiple));
    multiples.into_iter().find(common).unwrap_or(largest)
}

#[cfg(test)]
#[path = "../../tests/unit/accuracy/quantity.rs"]
mod tests;
