//! Factors: the keys of a scene that a study varies, and what it sets them to.

use std::fmt;

use plateau_study::design::Setting;

use super::level::{Level, dimension, one_unit};
use crate::number;
use crate::scene::schema::{self, Kind};

/// Keys of a scene that a study varies together.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// The keys that are set, all to the same value; none of a factor that is set elsewhere, as on a rig.
    pub keys: Vec<String>,
    /// The unit in which values of a factor without a key are stated; empty for plain numbers and words.
    pub stated_unit: String,
    /// What they are set to.
    pub values: Values,
}

/// What a factor is set to.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// One of some levels.
    Levels(Vec<Level>),
    /// Anything between two ends.
    Range {
        /// At the coded value −1.
        low: Level,
        /// At the coded value 1.
        high: Level,
        /// Whether equal steps are equal ratios.
        logarithmic: bool,
    },
}

impl Factor {
    /// What a design has to know.
    pub fn kind(&self) -> plateau_study::design::Factor {
        match &self.values {
            Values::Levels(levels) => plateau_study::design::Factor::Levels(levels.len()),
            Values::Range { .. } => plateau_study::design::Factor::Range,
        }
    }

    /// The value at a setting of a design; none where words have nothing between them.
    pub fn at(&self, setting: Setting) -> Option<Level> {
        match (&self.values, setting) {
            (Values::Levels(levels), Setting::Level(index)) => levels.get(index).cloned(),
            (Values::Levels(levels), Setting::Coded(coded)) => match levels.as_slice() {
                [low, _] if coded == -1.0 => Some(low.clone()),
                [_, high] if coded == 1.0 => Some(high.clone()),
                [low, high] => self.between(low, high, coded, false),
                _ => None,
            },
            (Values::Range { low, .. }, Setting::Coded(-1.0) | Setting::Level(0)) => Some(low.clone()),
            (Values::Range { high, .. }, Setting::Coded(1.0) | Setting::Level(_)) => Some(high.clone()),
            (Values::Range { low, high, logarithmic }, Setting::Coded(coded)) => {
                self.between(low, high, coded, *logarithmic)
            }
        }
    }

    /// Tells of settings whether there is a value at them, without making it as [`at`](Self::at) does.
    pub fn has_value(&self) -> impl Fn(Setting) -> bool + '_ {
        let ends = match &self.values {
            Values::Levels(levels) => levels.first().zip(levels.get(1)).filter(|_| levels.len() == 2),
            Values::Range { low, high, .. } => Some((low, high)),
        };
        let between = ends.is_some_and(|(low, high)| one_unit(low, high).is_some());
        move |setting| match (&self.values, setting) {
            (Values::Levels(levels), Setting::Level(index)) => index < levels.len(),
            (Values::Range { .. }, Setting::Level(_)) => true,
            (_, Setting::Coded(coded)) => between || ends.is_some() && coded.abs() == 1.0,
        }
    }

    /// In the unit of both ends, so that a study of "20 N" to "60 N" has "40 N" between them.
    fn between(&self, low: &Level, high: &Level, coded: f64, logarithmic: bool) -> Option<Level> {
        let (from, to, unit) = one_unit(low, high)?;
        let share = (coded + 1.0) / 2.0;
        let value = if logarithmic { from * libm::pow(to / from, share) } else { from + (to - from) * share };
        // With an exponent where there would be a row of zeros.
        let stated = |value: f64| match unit {
            "" => toml::Value::Float(value),
            unit if (1e-4..1e9).contains(&value.abs()) || value == 0.0 => {
                toml::Value::String(format!("{value} {unit}"))
            }
            unit => toml::Value::String(format!("{value:e} {unit}")),
        };
        let level = Level::new(self.key(), &stated(value));
        // The run has the number to its last bit; people read the one that was meant, 0.3 in place of 0.30000000000000004.
        let Level { label, .. } = Level::new(self.key(), &stated(number::to_fifteen_digits(value)));
        Some(Level { label, ..level })
    }

    /// The first of its keys, whose dimension its values have; empty if it has none.
    pub fn key(&self) -> &str {
        self.keys.first().map_or("", String::as_str)
    }

    /// Its keys in words.
    pub fn keys_in_words(&self) -> String {
        if self.keys.is_empty() { "set elsewhere".to_owned() } else { self.keys.join(", ") }
    }

    /// What a text means for this factor. A plain number is in the unit in which a factor without a key is stated.
    pub fn parse(&self, text: &str) -> Level {
        if self.is_of_words() {
            return Level::word(text);
        }
        let level = Level::parse(self.key(), text);
        match level.split() {
            Some((_, "")) if self.keys.is_empty() && !self.stated_unit.is_empty() => {
                Level::parse("", &format!("{} {}", level.label, self.stated_unit))
            }
            // In another unit it is no number that could be compared. A table of points is what tells the unit.
            Some((_, unit)) if self.keys.is_empty() && unit != self.stated_unit && !self.is_of_a_table() => {
                Level { number: None, ..level }
            }
            _ => level,
        }
    }

    /// Whether it has no key and its levels are words, whatever they look like.
    fn is_of_words(&self) -> bool {
        let has_words = |levels: &[Level]| levels.iter().any(|level| level.number.is_none());
        self.keys.is_empty() && matches!(&self.values, Values::Levels(levels) if has_words(levels))
    }

    /// Whether its values are those of a table of points.
    fn is_of_a_table(&self) -> bool {
        matches!(&self.values, Values::Levels(levels) if levels.is_empty())
    }

    /// The first of some levels of a factor without a key that is in another unit than those before.
    pub fn in_another_unit(levels: &[Level]) -> Option<&Level> {
        let unit = |level: &Level| level.split().map(|(_, unit)| unit.to_owned());
        let first = unit(levels.first()?)?;
        levels.iter().find(|level| unit(level).is_some_and(|unit| unit != first))
    }

    /// Whether its keys hold whole numbers, so that nothing lies between two of them.
    pub fn is_whole(&self) -> bool {
        let kind = schema::find(self.key()).map(|key| &key.kind);
        kind.is_some_and(|kind| matches!(kind, Kind::Integer(_) | Kind::CountOr(_)))
    }

    /// What it may be called: its own name, and its keys.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.name).chain(&self.keys).map(String::as_str)
    }

    /// SI unit of its numbers, or that in which those of a factor without a key are stated; empty for words, `1` for plain numbers.
    pub fn unit(&self) -> &str {
        let has_numbers = match &self.values {
            Values::Levels(levels) => levels.iter().all(|level| level.number.is_some()),
            Values::Range { .. } => true,
        };
        if !has_numbers {
            return "";
        }
        match (dimension(self.key()), self.stated_unit.as_str()) {
            (Some(dimension), _) => dimension.si_unit(),
            (None, "") => "1",
            (None, unit) => unit,
        }
    }
}

/// What it is set to, for people: `20 N, 47 N` or `20 N … 60 N`.
impl fmt::Display for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.values {
            Values::Levels(levels) => {
                let labels: Vec<&str> = levels.iter().map(|level| level.label.as_str()).collect();
                write!(f, "{}", labels.join(", "))
            }
            Values::Range { low, high, logarithmic } => {
                let scale = if *logarithmic { ", equal ratios" } else { "" };
                write!(f, "{} … {}{scale}", low.label, high.label)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(key: &str, ends: [&str; 2], logarithmic: bool) -> Factor {
        let level = |text: &str| Level::new(key, &format!("v = {text}").parse::<toml::Table>().unwrap()["v"]);
        let [low, high] = ends.map(level);
        let values = Values::Range { low, high, logarithmic };
        Factor { name: "f".into(), keys: vec![key.into()], stated_unit: String::new(), values }
    }

    #[test]
    fn values_between_are_in_the_unit_of_the_ends() {
        let load = factor("operation.normal_force", ["\"20 N\"", "\"60 N\""], false);
        let labels = [-1.0, 0.0, 0.5, 1.0].map(|coded| load.at(Setting::Coded(coded)).unwrap().label);
        assert_eq!(labels, ["20 N", "40 N", "50 N", "60 N"]);
        let fraction = factor("plateaus.captured_fraction", ["0.01", "1.0"], true);
        let middle = fraction.at(Setting::Coded(0.0)).unwrap();
        assert!((middle.number.unwrap() - 0.1).abs() < 1e-15);
        assert_eq!(load.at(Setting::Coded(0.5)).unwrap().number, Some(50.0));
    }

    #[test]
    fn people_read_the_number_that_was_meant_and_runs_have_its_last_bit() {
        let fraction = factor("pin.base.synthetic.fibre_fraction", ["0.2", "0.4"], false);
        let middle = fraction.at(Setting::Coded(0.0)).unwrap();
        assert_eq!((middle.label.as_str(), middle.text.as_str()), ("0.3", "0.30000000000000004"));
        assert_eq!(middle.number, Some(0.2 + (0.4 - 0.2) * 0.5));
        let load = factor("operation.normal_force", ["\"0.2 kN\"", "\"0.4 kN\""], false);
        let middle = load.at(Setting::Coded(0.0)).unwrap();
        assert_eq!((middle.label.as_str(), middle.text.as_str()), ("0.3 kN", "\"0.30000000000000004 kN\""));
    }

    #[test]
    fn a_factor_of_a_rig_has_the_unit_in_which_it_is_stated() {
        let level = |text: &str| Level::new("", &toml::Value::String(text.into()));
        let values = Values::Range { low: level("20 %RH"), high: level("60 %RH"), logarithmic: false };
        let humidity = Factor { name: "humidity".into(), keys: Vec::new(), stated_unit: "%RH".into(), values };
        assert_eq!(humidity.unit(), "%RH");
        let middle = humidity.at(Setting::Coded(0.0)).unwrap();
        assert_eq!((middle.label.as_str(), middle.number), ("40 %RH", Some(40.0)));
        assert_eq!(humidity.parse("30").label, "30 %RH");
        assert_eq!(humidity.parse("30 %RH").number, Some(30.0));
        assert_eq!(humidity.parse("30 g/kg").number, None);
        assert_eq!(
            Factor::in_another_unit(&[level("1 MPa"), level("2 MPa"), level("500 kPa")]),
            Some(&level("500 kPa"))
        );
        assert_eq!(Factor::in_another_unit(&[level("supplier A"), level("supplier B")]), None);
    }

    #[test]
    fn words_of_a_rig_are_words_whatever_they_look_like() {
        let level = |text: &str| Level::new("", &toml::Value::String(text.into()));
        let levels = ["nan", "inf", "1e3", "1000", "007", "7", "-", "=1+1", "30%", "\u{2212}5", "\"a\""];
        let values = Values::Levels(levels.map(level).to_vec());
        let grade = Factor { name: "grade".into(), keys: Vec::new(), stated_unit: String::new(), values };
        assert_eq!(grade.unit(), "");
        for word in levels {
            assert_eq!(grade.parse(word), level(word));
            assert_eq!((level(word).label.as_str(), level(word).number), (word, None));
        }
        // Of a table, which has no quotes.
        let of_table = |text: &str| Factor { values: Values::Levels(Vec::new()), ..grade.clone() }.parse(text).number;
        assert_eq!(["1e3", "-.5", "+2", "0", "0.5"].map(of_table), [1e3, -0.5, 2.0, 0.0, 0.5].map(Some));
        assert_eq!(["A", "inf", "nan", "1e400", "2b", "", "007", "-", "=1+1"].map(of_table), [None; 9]);
        assert_eq!(["1 N", "1e400 N", "07 N"].map(|text| level(text).number), [Some(1.0), None, None]);
    }

    #[test]
    fn keys_that_hold_texts_have_no_numbers() {
        for (key, word) in [("disc.surface.file", "1e3"), ("title", "nan"), ("plateaus.debris", "007")] {
            let level = Level::parse(key, word);
            assert_eq!((level.text.as_str(), level.number), (format!("\"{word}\"").as_str(), None), "{key}");
            assert_eq!(Level::parse(key, &format!("\"{word}\"")), level);
        }
        assert_eq!(Level::parse("pin.base.synthetic.fibre_fraction", "nan").number, None);
    }

    #[test]
    fn very_small_values_between_have_no_row_of_zeros() {
        let rate = factor("materials.pin_primary.specific_wear_rate", ["\"1e-14 1/Pa\"", "\"9e-14 1/Pa\""], false);
        assert_eq!(rate.at(Setting::Coded(0.0)).unwrap().label, "5e-14 1/Pa");
        assert_eq!(rate.at(Setting::Coded(0.0)).unwrap().number, Some(5e-14));
    }

    #[test]
    fn settings_without_a_value_are_told_as_they_would_be_found() {
        let levels = |labels: &[&str]| Factor {
            name: "f".into(),
            keys: Vec::new(),
            stated_unit: String::new(),
            values: Values::Levels(
                labels.iter().map(|label| Level::new("", &toml::Value::String((*label).into()))).collect(),
            ),
        };
        let range = |ends, logarithmic| factor("contact.foundation_height", ends, logarithmic);
        for factor in [
            levels(&[]),
            levels(&["1 N"]),
            levels(&["1 N", "2 N"]),
            levels(&["1 N", "2 kN"]),
            levels(&["a", "b"]),
            levels(&["1 N", "2 N", "3 N"]),
            range(["\"50 um\"", "\"1 mm\""], false),
            range(["\"50 um\"", "\"60 um\""], true),
        ] {
            let has_value = factor.has_value();
            let coded = [-1.0, -0.5, 0.0, 1.0, 1.5].map(Setting::Coded);
            for setting in [0, 1, 2].map(Setting::Level).into_iter().chain(coded) {
                assert_eq!(has_value(setting), factor.at(setting).is_some(), "{factor} at {setting:?}");
            }
        }
    }

    #[test]
    fn nothing_lies_between_two_units() {
        let height = factor("contact.foundation_height", ["\"50 um\"", "\"1 mm\""], false);
        assert_eq!(height.at(Setting::Coded(0.0)), None);
        assert_eq!(height.at(Setting::Coded(1.0)).unwrap().number, Some(1e-3));
        assert_eq!(height.unit(), "m");
    }
}
