//! Keys that are fitted, and their values in coded units.

/// A key that is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: String,
    /// Lower end of the range in which it is looked for.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Whether equal steps in coded units are equal ratios.
    pub logarithmic: bool,
}

impl Key {
    /// Whether the ends are ends of a range.
    pub(super) fn is_range(&self) -> bool {
        let finite = self.low.is_finite() && self.high.is_finite();
        finite && self.low < self.high && !(self.logarithmic && self.low <= 0.0)
    }

    /// The value at a place in coded units: −1 is the lower end, 1 the upper one.
    pub fn value(&self, coded: f64) -> f64 {
        let share = 0.5 * (coded + 1.0);
        if self.logarithmic {
            self.low * libm::pow(self.high / self.low, share)
        } else {
            self.low + (self.high - self.low) * share
        }
    }

    /// The place of a value in coded units; NaN for one without a logarithm on a range of equal ratios.
    pub fn coded(&self, value: f64) -> f64 {
        let share = if self.logarithmic {
            libm::log(value / self.low) / libm::log(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        };
        2.0 * share - 1.0
    }

    /// How much the coded place changes where the logarithm of the value does; none where the range has values without one.
    pub(super) fn coded_by_log(&self, coded: f64) -> Option<f64> {
        if self.low <= 0.0 {
            return None;
        }
        Some(if self.logarithmic {
            2.0 / libm::log(self.high / self.low)
        } else {
            2.0 * self.value(coded) / (self.high - self.low)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Key;

    #[test]
    fn coded_places_and_values_by_hand() {
        let load = Key { name: "load".into(), low: 10.0, high: 1000.0, logarithmic: true };
        for (coded, value) in [(-1.0, 10.0), (0.0, 100.0), (1.0, 1000.0)] {
            assert!((load.value(coded) - value).abs() < 1e-12 * value && (load.coded(value) - coded).abs() < 1e-14);
        }
        let speed = Key { logarithmic: false, ..load.clone() };
        assert_eq!((speed.value(0.0), speed.coded(505.0)), (505.0, 0.0));
        // d coded/d ln value: 2/ln 100, and 2 · 505/990 in the middle of the linear one.
        assert!((load.coded_by_log(0.3).unwrap() - 2.0 / libm::log(100.0)).abs() < 1e-15);
        assert!((speed.coded_by_log(0.0).unwrap() - 1010.0 / 990.0).abs() < 1e-15);
        assert_eq!(Key { low: 0.0, ..speed }.coded_by_log(0.0), None);
    }
}
