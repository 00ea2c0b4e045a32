//! The unit in which a study states a factor, in which people read it, too.

use plateau_io::study::factor::Level;

use crate::quantity::Unit;

/// The unit whose 0 is not that of the SI unit.
const CELSIUS: &str = "degC";

/// A unit, and how many of it there are in the SI unit; for ranges of equal ratios of the values' logarithms.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The unit; empty for plain numbers.
    pub unit: String,
    per_si: f64,
    /// What 0 of the SI unit is in it: 0 but for degrees Celsius.
    offset: f64,
    logarithmic: bool,
}

impl Reading {
    /// The unit of the first of some values that tells it.
    pub fn of<'a>(levels: impl IntoIterator<Item = &'a Level>, logarithmic: bool) -> Self {
        let stated = |level: &'a Level| {
            let (number, unit) = split(&level.label);
            if unit == CELSIUS {
                return Some((unit.to_owned(), 1.0, Unit::CELSIUS.offset));
            }
            let ratio = number? / level.number?;
            (ratio.is_finite() && ratio > 0.0).then(|| (unit.to_owned(), ratio, 0.0))
        };
        let (unit, per_si, offset) = levels.into_iter().find_map(stated).unwrap_or((String::new(), 1.0, 0.0));
        Self { unit, per_si, offset, logarithmic }
    }

    /// A value of the factor, as the analysis has it, in this unit.
    pub fn value(&self, value: f64) -> f64 {
        if self.logarithmic { value + libm::log10(self.per_si) } else { value * self.per_si + self.offset }
    }

    /// Whether the values are logarithms.
    pub fn is_logarithmic(&self) -> bool {
        self.logarithmic
    }
}

/// The number in front of a label, and the rest.
pub fn split(label: &str) -> (Option<f64>, &str) {
    let (number, unit) = label.trim().split_once(' ').unwrap_or((label.trim(), ""));
    (number.parse().ok(), unit.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_celsius_are_counted_from_their_zero() {
        let level = |text: &str| Level::new("thermal.ambient", &toml::Value::String(text.into()));
        let reading = Reading::of(&[level("200 degC"), level("0 degC")], false);
        assert_eq!(reading.unit, "degC");
        assert!((reading.value(356.65) - 83.5).abs() < 1e-9 && (reading.value(273.15)).abs() < 1e-9);
    }

    #[test]
    fn values_are_read_in_the_unit_of_the_study() {
        let level = |text: &str| Level::new("operation.rotational_speed", &toml::Value::String(text.into()));
        let levels = [level("0 rpm"), level("850 rpm")];
        let reading = Reading::of(&levels, false);
        assert_eq!(reading.unit, "rpm");
        let value = levels[1].number.unwrap();
        assert!((reading.value(value) - 850.0).abs() < 1e-9);
        let logarithmic = Reading::of(&levels, true);
        assert!((logarithmic.value(libm::log10(value)) - libm::log10(850.0)).abs() < 1e-12);
        assert_eq!(
            Reading::of(&[level("fast")], false),
            Reading { unit: String::new(), per_si: 1.0, offset: 0.0, logarithmic: false }
        );
    }
}
