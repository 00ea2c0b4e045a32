//! The numbers that a key accepts.

use std::fmt;

/// An interval of numbers; NaN and infinities are in none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub(super) low: f64,
    pub(super) low_included: bool,
    pub(super) high: f64,
    pub(super) high_included: bool,
}

impl Range {
    /// Any finite number.
    pub const ANY: Self = Self::new(f64::NEG_INFINITY, false, f64::INFINITY, false);
    /// More than 0.
    pub const POSITIVE: Self = Self::new(0.0, false, f64::INFINITY, false);
    /// 0 or more.
    pub const NOT_NEGATIVE: Self = Self::new(0.0, true, f64::INFINITY, false);
    /// From 0 to 1, both included.
    pub const FRACTION: Self = Self::new(0.0, true, 1.0, true);

    /// The numbers between two, each of which is or is not one of them.
    pub(super) const fn new(low: f64, low_included: bool, high: f64, high_included: bool) -> Self {
        Self { low, low_included, high, high_included }
    }

    /// Whether the interval contains the number.
    pub fn contains(&self, number: f64) -> bool {
        number.is_finite()
            && (number > self.low || self.low_included && number == self.low)
            && (number < self.high || self.high_included && number == self.high)
    }
}

/// In words: "more than -1 and at most 0.5".
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let low = if self.low_included { "at least" } else { "more than" };
        let high = if self.high_included { "at most" } else { "less than" };
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => write!(f, "{low} {} and {high} {}", self.low, self.high),
            (true, false) => write!(f, "{low} {}", self.low),
            (false, true) => write!(f, "{high} {}", self.high),
            (false, false) => write!(f, "a finite number"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_say_what_they_contain() {
        let poisson = Range::new(-1.0, false, 0.5, true);
        assert_eq!(poisson.to_string(), "more than -1 and at most 0.5");
        for (number, inside) in [(-1.0, false), (-0.99, true), (0.5, true), (0.51, false), (f64::NAN, false)] {
            assert_eq!(poisson.contains(number), inside, "{number}");
        }
        assert!(!Range::ANY.contains(f64::INFINITY));
        assert!(!Range::POSITIVE.contains(0.0) && Range::NOT_NEGATIVE.contains(0.0));
        assert_eq!(Range::POSITIVE.to_string(), "more than 0");
    }
}
