//! The unit in which a study states a factor, in which people read it, too.

use plateau_io::study::factor::Level;

/// A unit, and how many of it there are in the SI unit; for ranges of equal ratios of the values' logarithms.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The unit; empty for plain numbers.
    pub unit: String,
    per_si: f64,
    logarithmic: bool,
}

impl Reading {
    /// The unit of the first of some values that tells it.
    pub fn of<'a>(levels: impl IntoIterator<Item = &'a Level>, logarithmic: bool) -> Self {
        let stated = |level: &'a Level| {
            let (number, unit) = split(&level.label);
            let ratio = number? / level.number?;
            (ratio.is_finite() && ratio > 0.0).then(|| (unit.to_owned(), ratio))
        };
        let (unit, per_si) = levels.into_iter().find_map(stated).unwrap_or((String::new(), 1.0));
        Self { unit, per_si, logarithmic }
    }

    /// A value of the factor, as the analysis has it, in this unit.
    pub fn value(&self, value: f64) -> f64 {
        if self.logarithmic { value + libm::log10(self.per_si) } else { value * self.per_si }
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
            Reading { unit: String::new(), per_si: 1.0, logarithmic: false }
        );
    }
}
