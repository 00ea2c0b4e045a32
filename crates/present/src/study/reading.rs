//! The unit in which a study states a factor, in which people read it, too.

use plateau_io::study::factor::Factor;
use plateau_io::study::level::Level;
use plateau_io::units;

/// A unit, how many of it there are in the SI unit, and where it begins to count; for ranges of equal ratios of the values'
/// logarithms.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The unit; empty for plain numbers.
    pub unit: String,
    per_si: f64,
    /// What 0 of the unit is in the SI unit.
    zero: f64,
    logarithmic: bool,
}

impl Reading {
    /// The unit of the first of some values that tells it.
    pub fn of<'a>(levels: impl IntoIterator<Item = &'a Level>, logarithmic: bool) -> Self {
        let stated = |level: &'a Level| {
            let (number, unit) = split(&level.label);
            let ratio = number? / (level.number? - units::zero_of(unit));
            (ratio.is_finite() && ratio > 0.0).then(|| (unit.to_owned(), ratio))
        };
        let (unit, per_si) = levels.into_iter().find_map(stated).unwrap_or((String::new(), 1.0));
        Self { zero: units::zero_of(&unit), unit, per_si, logarithmic }
    }

    /// That of a factor: values of one without a key are kept in the unit in which they are stated.
    pub fn of_factor<'a>(factor: &Factor, levels: impl IntoIterator<Item = &'a Level>, logarithmic: bool) -> Self {
        if factor.keys.is_empty() {
            return Self { unit: factor.stated_unit.clone(), per_si: 1.0, zero: 0.0, logarithmic };
        }
        Self::of(levels, logarithmic)
    }

    /// A value of the factor, as the analysis has it, in this unit.
    pub fn value(&self, value: f64) -> f64 {
        // A range of equal ratios has no unit with a zero of its own.
        if self.logarithmic { value + libm::log10(self.per_si) } else { (value - self.zero) * self.per_si }
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
            Reading { unit: String::new(), per_si: 1.0, zero: 0.0, logarithmic: false }
        );
    }

    #[test]
    fn degrees_celsius_count_from_their_own_zero() {
        let level = |text: &str| Level::new("thermal.ambient", &toml::Value::String(text.into()));
        // The first one has no ratio to tell the unit by.
        for first in ["0 degC", "-40 degC", "300 degC"] {
            let reading = Reading::of(&[level(first), level("200 degC")], false);
            assert_eq!(reading.unit, "degC");
            for (kelvins, celsius) in [(273.15, 0.0), (373.15, 100.0), (233.15, -40.0)] {
                assert!((reading.value(kelvins) - celsius).abs() < 1e-9, "{first}: {}", reading.value(kelvins));
            }
        }
        let kelvins = Reading::of(&[level("300 K")], false);
        assert_eq!((kelvins.unit.as_str(), kelvins.value(300.0)), ("K", 300.0));
    }
}
