//! Factors: the keys of a scene that a study varies, and their levels, each a number with a unit, a plain number, or a word.

use std::fmt;

use plateau_study::design::Setting;

use crate::number;
use crate::scene::schema::{self, Kind};
use crate::units::{self, Dimension};

/// A value of a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Value as it stands in a scene, in TOML.
    pub text: String,
    /// Name of the level for people.
    pub label: String,
    /// Number in SI units; none for words.
    pub number: Option<f64>,
}

impl Level {
    /// Level that a value means for a key; where the key is empty, a number is taken in the unit in which it is stated.
    pub fn new(key: &str, value: &toml::Value) -> Self {
        let label = match value {
            toml::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        Self { text: value.to_string(), number: si_number(key, value), label }
    }

    /// A word as it stands, even if it looks like a number.
    pub fn word(text: &str) -> Self {
        Self { text: toml::Value::String(text.to_owned()).to_string(), label: text.to_owned(), number: None }
    }

    /// Meaning of a text for a key: a value in TOML, or a plain number in percent; what is none is a text. A minus may be that of
    /// print, as the program writes it. For a key that holds a text, it is that text.
    pub fn parse(key: &str, text: &str) -> Self {
        let is_quoted = text.starts_with(['"', '\'']);
        if holds_text(key) && !is_quoted {
            return Self::word(text);
        }
        let text = &text.replace('\u{2212}', "-");
        let percent = text.strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok());
        match percent {
            // Of a factor without a key it is a unit as any other.
            Some(percent) if key.is_empty() => return Self::new(key, &toml::Value::String(format!("{percent} %"))),
            Some(percent) if dimension(key).is_none() => return Self::new(key, &toml::Value::Float(percent / 100.0)),
            _ => {}
        }
        if key.is_empty() && !is_quoted {
            return match plain_number(text) {
                Some(number) => {
                    let value = toml::Value::Float(number).to_string();
                    Self { text: value, label: text.trim().to_owned(), number: Some(number) }
                }
                None => Self::new(key, &toml::Value::String(text.to_owned())),
            };
        }
        let table: Result<toml::Table, _> = format!("value = {text}").parse();
        let value = table.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("value"));
        Self::new(key, &value.unwrap_or_else(|| toml::Value::String(text.to_owned())))
    }

    /// A value of a key as an end of a range, in SI units.
    pub fn end_of_range(key: &str, value: &toml::Value) -> Result<f64, String> {
        match (dimension(key), value) {
            (None, toml::Value::String(_)) if key.is_empty() => {
                si_number(key, value).ok_or_else(|| format!("{value} is not a number with a unit"))
            }
            (Some(expected), toml::Value::String(_) | toml::Value::Integer(_) | toml::Value::Float(_)) => {
                quantity(value, expected)
            }
            (None, toml::Value::Integer(integer)) => Ok(*integer as f64),
            (None, toml::Value::Float(number)) if number.is_finite() => Ok(*number),
            (_, other) => Err(format!("{other} is not a number, as a range has at its ends; words are levels")),
        }
    }

    /// Reason why a value can be no level of a key that holds a quantity, in words; of other keys the scenes of the runs tell.
    pub fn unfit(key: &str, value: &toml::Value) -> Option<String> {
        let found = schema::find(key)?;
        let Kind::Quantity { dimension, .. } = found.kind else { return None };
        match value.as_str() {
            Some("none") if found.may_be_none() => None,
            _ => quantity(value, dimension).err(),
        }
    }

    /// The number before the unit, and the unit; none of a word.
    pub fn split(&self) -> Option<(f64, &str)> {
        self.number?;
        let (number, unit) = self.label.trim().split_once(' ').unwrap_or((self.label.trim(), ""));
        Some((number.parse().ok()?, unit.trim()))
    }
}

/// The numbers of two ends and the unit that both have; none of words and of two units, between which nothing lies.
fn one_unit<'a>(low: &'a Level, high: &'a Level) -> Option<(f64, f64, &'a str)> {
    let ((from, unit), (to, other)) = (low.split()?, high.split()?);
    (unit == other).then_some((from, to, unit))
}

/// Dimension of a key's quantity.
pub(super) fn dimension(key: &str) -> Option<Dimension> {
    match schema::find(key)?.kind {
        Kind::Quantity { dimension, .. } => Some(dimension),
        Kind::LengthUnit | Kind::Lengths { .. } => Some(Dimension::Length),
        _ => None,
    }
}

/// Tells whether a key holds texts, among which none is a number.
fn holds_text(key: &str) -> bool {
    schema::find(key).is_some_and(|key| matches!(key.kind, Kind::Text | Kind::InputFile | Kind::Choice(_)))
}

/// Tells whether a key holds whole numbers.
pub(super) fn is_whole(key: &str) -> bool {
    schema::find(key).is_some_and(|key| matches!(key.kind, Kind::Integer(_) | Kind::CountOr(_)))
}

/// A number that is finite and written as one: `007` is a name.
fn plain_number(text: &str) -> Option<f64> {
    let text = text.trim();
    let digits = text.trim_start_matches(['+', '-']).as_bytes();
    let is_padded = matches!(digits, [b'0', b'0'..=b'9', ..]);
    text.parse().ok().filter(|number: &f64| number.is_finite() && !is_padded)
}

/// A value that has to have a unit, in SI units, or why it has none of what is expected.
fn quantity(value: &toml::Value, expected: Dimension) -> Result<f64, String> {
    match value {
        toml::Value::String(text) => units::parse(text, expected),
        other => Err(units::no_unit(other, expected)),
    }
}

/// A value in SI units, if it is a number; without a key in the unit in which it is stated.
fn si_number(key: &str, value: &toml::Value) -> Option<f64> {
    match value {
        // A number needs quotes only with a unit: without one, what is in quotes is meant as a word.
        toml::Value::String(text) if key.is_empty() => plain_number(text.trim().split_once(' ')?.0),
        toml::Value::String(text) => units::parse(text, dimension(key)?).ok(),
        toml::Value::Integer(integer) => Some(*integer as f64),
        toml::Value::Float(number) => Some(*number).filter(|number| number.is_finite()),
        _ => None,
    }
}

/// Keys of a scene that a study varies together.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Name of the factor.
    pub name: String,
    /// The keys that are set, all to the same value; none of a factor that is set elsewhere, as on a rig.
    pub keys: Vec<String>,
    /// The unit in which values of a factor without a key are stated; empty for plain numbers and words.
    pub stated_unit: String,
    /// Values of the factor.
    pub values: Values,
}

/// Values of a factor.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// One of some levels.
    Levels(Vec<Level>),
    /// Anything between two ends.
    Range {
        /// Level at the coded value −1.
        low: Level,
        /// Level at the coded value 1.
        high: Level,
        /// Tells whether equal steps are equal ratios.
        logarithmic: bool,
    },
}

impl Factor {
    /// The factor as a design knows it.
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

    /// Level between two, in the unit of both, so that a study of "20 N" to "60 N" has "40 N" between them.
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
        let Level { label, .. } = Level::new(self.key(), &stated(number::to_digits(value, 15)));
        Some(Level { label, ..level })
    }

    /// The first of its keys, whose dimension its values have; empty if it has none.
    pub fn key(&self) -> &str {
        self.keys.first().map_or("", String::as_str)
    }

    /// Keys of the factor, in words.
    pub fn keys_in_words(&self) -> String {
        if self.keys.is_empty() { "set elsewhere".to_owned() } else { self.keys.join(", ") }
    }

    /// Level that a text means for this factor. A plain number is in the unit in which a factor without a key is stated.
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

    /// Tells whether it has no key and its levels are words, whatever they look like.
    fn is_of_words(&self) -> bool {
        let has_words = |levels: &[Level]| levels.iter().any(|level| level.number.is_none());
        self.keys.is_empty() && matches!(&self.values, Values::Levels(levels) if has_words(levels))
    }

    /// Tells whether its values are those of a table of points.
    fn is_of_a_table(&self) -> bool {
        matches!(&self.values, Values::Levels(levels) if levels.is_empty())
    }

    /// The first of some levels of a factor without a key that is in another unit than those before.
    pub fn in_another_unit(levels: &[Level]) -> Option<&Level> {
        let unit = |level: &Level| level.split().map(|(_, unit)| unit.to_owned());
        let first = unit(levels.first()?)?;
        levels.iter().find(|level| unit(level).is_some_and(|unit| unit != first))
    }

    /// Tells whether its keys hold whole numbers, so that nothing lies between two of them.
    pub fn is_whole(&self) -> bool {
        is_whole(self.key())
    }

    /// Names of the factor: its own name, and its keys.
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

/// Writes its values for people: `20 N, 47 N` or `20 N … 60 N`.
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
#[path = "../../tests/unit/study/factor.rs"]
mod tests;
