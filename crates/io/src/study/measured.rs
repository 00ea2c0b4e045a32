//! What was measured of the responses of a study, and how they are fitted to it.

use toml::{Spanned, Value};

use super::collected::unit_of;
use super::document::Document;
use super::place::Place;
use super::response::Response;
use crate::scene::Problem;
use crate::units;

/// Runs of a fit, unless given.
const RUNS: usize = 60;
/// Level of its intervals, unless given.
const CONFIDENCE: f64 = 0.95;

/// How a study is fitted to measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct FitSettings {
    /// Most runs in all, those with each seed counted.
    pub runs: usize,
    /// Level of intervals and regions.
    pub confidence: f64,
    /// What was measured of each response, in SI units; none of those that are not fitted.
    pub measured: Vec<Option<Measured>>,
}

/// A measured value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its standard uncertainty.
    pub uncertainty: f64,
}

/// What `[fit]` and the keys `measured` and `uncertainty` of responses say.
pub(super) fn settings(
    document: &Document,
    responses: &[Response],
    place: &Place<'_>,
    problems: &mut Vec<Problem>,
) -> FitSettings {
    let fit = document.fit.as_ref();
    let confidence = match fit.and_then(|fit| fit.confidence.as_ref()) {
        Some(level) if !(*level.get_ref() > 0.0 && *level.get_ref() < 1.0) => {
            let message = format!("{}, expected more than 0 and less than 1, such as 0.95", level.get_ref());
            problems.push(place.problem(level, "fit.confidence", message));
            CONFIDENCE
        }
        level => level.map_or(CONFIDENCE, |level| *level.get_ref()),
    };
    let mut measured = Vec::new();
    for (table, response) in document.response.iter().zip(responses) {
        let unit = response.unit(unit_of(&response.series));
        let mut number = |found: &Spanned<Value>, key: &str| {
            let read = value(found.get_ref(), unit);
            read.map_err(|message| problems.push(place.problem(found, key, message))).ok()
        };
        let given = match (&table.measured, &table.uncertainty) {
            (None, None) => None,
            (Some(value), Some(uncertainty)) => {
                let value = number(value, "response.measured");
                let deviation = number(uncertainty, "response.uncertainty");
                if deviation.is_some_and(|deviation| deviation <= 0.0) {
                    let message = "expected more than 0: the standard uncertainty of the measured value";
                    problems.push(place.problem(uncertainty, "response.uncertainty", message));
                }
                value.zip(deviation).map(|(value, uncertainty)| Measured { value, uncertainty })
            }
            (Some(alone), None) | (None, Some(alone)) => {
                let message = "measured and uncertainty belong together: give both, in the same response";
                problems.push(place.problem(alone, "response.measured", message));
                None
            }
        };
        measured.push(given);
    }
    FitSettings {
        runs: fit.and_then(|fit| fit.runs.as_ref()).map_or(RUNS, |runs| *runs.get_ref()),
        confidence,
        measured,
    }
}

/// A number in SI units, or a quantity with a unit.
fn value(found: &Value, unit: &str) -> Result<f64, String> {
    let expected = if unit == "1" { "a number".to_owned() } else { format!("a number in {unit}, or one with a unit") };
    match found {
        Value::Integer(integer) => Ok(*integer as f64),
        Value::Float(number) if number.is_finite() => Ok(*number),
        Value::String(text) if unit != "1" => {
            units::parse_as(text, unit).map_err(|reason| format!("\"{text}\": {reason}, expected {expected}"))
        }
        other => Err(format!("{other}, expected {expected}")),
    }
}
