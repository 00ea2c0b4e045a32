//! Numbers and quantities as values of a scene, in SI units and in range.

use super::document::{Entry, Value};
use super::error::Origin;
use super::schema::Range;
use crate::units::{self, Dimension, UnitError};

/// Puts the place of an entry beside a message.
pub(super) fn at(entry: &Entry) -> impl Fn(String) -> (Origin, String) {
    |message| (entry.origin.clone(), message)
}

/// A quantity with its unit, in SI units.
pub(super) fn quantity(value: &Value, dimension: Dimension, range: Range) -> Result<f64, String> {
    let number = match value {
        Value::Text(text) => units::parse(text, dimension).map_err(|error| error.to_string())?,
        Value::Integer(_) | Value::Float(_) => {
            return Err(UnitError::NoUnit { text: value.text(), expected: dimension }.to_string());
        }
        _ => return Err(format!("{value}, expected {dimension}")),
    };
    if range.contains(number) {
        Ok(number)
    } else {
        Err(format!("{} is out of range, expected {range} {}", value.text(), dimension.si_unit()))
    }
}

/// A number, if it is in range.
pub(super) fn in_range(number: f64, value: &Value, range: Range) -> Result<f64, String> {
    if range.contains(number) { Ok(number) } else { Err(format!("{} is out of range, expected {range}", value.text())) }
}

/// A plain number, in range.
pub(super) fn number(value: &Value, range: Range) -> Result<f64, String> {
    match value {
        Value::Integer(integer) => in_range(*integer as f64, value, range),
        Value::Float(float) => in_range(*float, value, range),
        _ => Err(format!("{value}, expected a number, {range}")),
    }
}
