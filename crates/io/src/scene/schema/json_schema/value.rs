//! What single keys may hold.

use plateau_core::observe;
use serde_json::{Map, Value, json};

use super::super::key::{Key, Kind, Need};
use super::super::range::Range;
use super::description;
use crate::units::Dimension;
use crate::units::pattern::{self, Sign};

/// What a key may hold, what it means and what it is when it is absent.
pub(super) fn key(key: &Key) -> Map<String, Value> {
    let mut schema = Map::new();
    schema.insert("description".into(), description::of(key).into());
    let one = kind(key.kind);
    let kind = if key.may_be_none() { json!({ "anyOf": [one, { "const": "none" }] }) } else { one };
    if let Value::Object(kind) = kind {
        schema.extend(kind);
    }
    if key.path() == "version" {
        schema.insert("maximum".into(), 1.into());
    }
    if let Need::Default(default) = key.need
        && let Some(default) = from_toml(default)
    {
        schema.insert("default".into(), default);
    }
    if let Some(example) = key.example().and_then(|example| from_toml(&example)) {
        schema.insert("examples".into(), json!([example]));
    }
    schema
}

fn kind(kind: Kind) -> Value {
    match kind {
        Kind::Quantity { dimension, range, .. } => quantity(dimension, range),
        Kind::Lengths { count, single, range, .. } => {
            let one = quantity(Dimension::Length, range);
            let list = json!({ "type": "array", "items": one, "minItems": count, "maxItems": count });
            if single { json!({ "anyOf": [one, list] }) } else { list }
        }
        Kind::LengthUnit => json!({ "type": "string", "pattern": pattern::length_unit() }),
        Kind::Number(range) => number(range),
        Kind::NumberOr(range, word) => json!({ "anyOf": [number(range), { "const": word }] }),
        Kind::Integer(least) => integer(least),
        Kind::CountOr(word) => json!({ "anyOf": [integer(1), { "const": word }] }),
        Kind::Bool => json!({ "type": "boolean" }),
        Kind::True => json!({ "const": true }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Text | Kind::InputFile => json!({ "type": "string", "pattern": r"\S" }),
        Kind::Times => json!({ "type": "array", "items": quantity(Dimension::Time, Range::NOT_NEGATIVE) }),
        Kind::Rows => {
            let of = |dimension| quantity(dimension, Range::NOT_NEGATIVE);
            let either = |one, other| json!({ "anyOf": [of(one), of(other)] });
            let row = json!([
                of(Dimension::Time),
                either(Dimension::Force, Dimension::Pressure),
                either(Dimension::RotationalSpeed, Dimension::Speed),
            ]);
            json!({ "type": "array", "minItems": 2, "items": { "type": "array", "items": row, "minItems": 3, "maxItems": 3 } })
        }
        Kind::Factor => {
            let row = json!([quantity(Dimension::Temperature, Range::POSITIVE), number(Range::NOT_NEGATIVE)]);
            json!({ "type": "array", "minItems": 1, "items": { "type": "array", "items": row, "minItems": 2, "maxItems": 2 } })
        }
        Kind::Maps => {
            json!({ "type": "array", "items": { "enum": observe::Map::CHOICES.map(observe::Map::name) } })
        }
    }
}

fn quantity(dimension: Dimension, range: Range) -> Value {
    let sign = match range {
        Range { low: 0.0, low_included: false, .. } => Sign::Positive,
        Range { low: 0.0, .. } => Sign::NotNegative,
        _ => Sign::Any,
    };
    json!({ "type": "string", "pattern": pattern::quantity(dimension, sign) })
}

fn integer(least: u64) -> Value {
    json!({ "type": "integer", "minimum": least, "maximum": u64::MAX })
}

fn number(range: Range) -> Value {
    let mut schema = Map::new();
    schema.insert("type".into(), "number".into());
    let bounds = [
        (range.low, if range.low_included { "minimum" } else { "exclusiveMinimum" }),
        (range.high, if range.high_included { "maximum" } else { "exclusiveMaximum" }),
    ];
    for (bound, word) in bounds.into_iter().filter(|(bound, _)| bound.is_finite()) {
        schema.insert(word.into(), bound.into());
    }
    schema.into()
}

fn from_toml(text: &str) -> Option<Value> {
    let value: toml::Value = format!("value = {text}").parse::<toml::Table>().ok()?.remove("value")?;
    serde_json::to_value(value).ok()
}
