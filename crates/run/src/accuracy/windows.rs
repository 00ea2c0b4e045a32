//! Windows of physical time over which runs are compared.

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
#[path = "../../tests/unit/accuracy/windows.rs"]
mod tests;
