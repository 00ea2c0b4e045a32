//! Values of factors: a number with a unit, a plain number, or a word.

use crate::scene::schema::{self, Kind};
use crate::units::{self, Dimension, UnitError};

/// A value of a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// As it stands in a scene, in TOML.
    pub text: String,
    /// For people.
    pub label: String,
    /// In SI units; none for words.
    pub number: Option<f64>,
}

impl Level {
    /// What a value means for a key; where the key is empty, a number is taken in the unit in which it is stated.
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

    /// What a text means for a key: a value in TOML, or a plain number in percent; what is none is a text. A minus may be that of
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
    ///
    /// # Errors
    /// Why it cannot be one, in words.
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

    /// Why a value can be no level of a key that holds a quantity, in words; of other keys the scenes of the runs tell.
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
pub(super) fn one_unit<'a>(low: &'a Level, high: &'a Level) -> Option<(f64, f64, &'a str)> {
    let ((from, unit), (to, other)) = (low.split()?, high.split()?);
    (unit == other).then_some((from, to, unit))
}

/// What a key's quantity measures.
pub(super) fn dimension(key: &str) -> Option<Dimension> {
    match schema::find(key)?.kind {
        Kind::Quantity { dimension, .. } => Some(dimension),
        Kind::LengthUnit | Kind::Lengths { .. } => Some(Dimension::Length),
        _ => None,
    }
}

/// Whether a key holds texts, among which none is a number.
fn holds_text(key: &str) -> bool {
    schema::find(key).is_some_and(|key| matches!(key.kind, Kind::Text | Kind::InputFile | Kind::Choice(_)))
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
        toml::Value::String(text) => units::parse(text, expected).map_err(|error| error.to_string()),
        other => Err(UnitError::NoUnit { text: other.to_string(), expected }.to_string()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_and_the_minus_of_print_are_understood() {
        let fraction = Level::parse("pin.base.synthetic.fibre_fraction", "30%");
        assert_eq!((fraction.number, fraction.text.as_str()), (Some(0.3), "0.3"));
        assert_eq!(Level::parse("pin.base.synthetic.fibre_fraction", "30 %").number, Some(0.3));
        let rate = Level::parse("materials.pin_primary.specific_wear_rate", "5e\u{2212}14 1/Pa");
        assert_eq!(rate.number, Some(5e-14));
        // Without a key it is the unit in which the factor is stated.
        for text in ["30 %", "30%"] {
            let humidity = Level::parse("", text);
            assert_eq!((humidity.number, humidity.label.as_str()), (Some(30.0), "30 %"));
        }
        // Not of quantities: of what?
        assert_eq!(Level::parse("operation.normal_force", "30%").number, None);
    }
}
