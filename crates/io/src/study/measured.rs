//! What was measured of the responses of a study, and how they are fitted to it.

use toml::{Spanned, Value};

use super::document::Document;
use super::place::Place;
use super::record::unit_of;
use super::response::Response;
use crate::scene::Problem;
use crate::text::short;
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
        if let Some(time) = table.correlation_time.as_ref().filter(|_| table.measured_file.is_none()) {
            problems.push(place.problem(time, "response.correlation_time", "it belongs to measured_file"));
        }
        if table.measured_file.is_some() {
            // The series is part of the question.
            measured.push(None);
            continue;
        }
        let unit = response.unit(unit_of(&response.series));
        let given = match (&table.measured, &table.uncertainty) {
            (None, None) => None,
            (Some(value), Some(uncertainty)) => {
                let mut refuse =
                    |found: &Spanned<Value>, key, message: String| problems.push(place.problem(found, key, message));
                let number = number(value.get_ref(), unit, units::parse_as);
                let number = number.map_err(|message| refuse(value, "response.measured", message)).ok();
                let deviation = self::uncertainty(uncertainty.get_ref(), unit);
                let deviation = deviation.map_err(|message| refuse(uncertainty, "response.uncertainty", message)).ok();
                number.zip(deviation).map(|(value, uncertainty)| Measured { value, uncertainty })
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

/// A standard uncertainty in SI units.
pub(super) fn uncertainty(found: &Value, unit: &str) -> Result<f64, String> {
    match number(found, unit, units::parse_difference_as)? {
        uncertainty if uncertainty > 0.0 => Ok(uncertainty),
        other => Err(format!("{other}, expected more than 0: the standard uncertainty of what was measured")),
    }
}

/// A number in SI units, or a quantity with a unit.
fn number(found: &Value, unit: &str, parse: impl FnOnce(&str, &str) -> Result<f64, String>) -> Result<f64, String> {
    let expected = if unit == "1" {
        "a number, or one with %".to_owned()
    } else {
        format!("a number in {unit}, or one with a unit")
    };
    match found {
        Value::Integer(integer) => Ok(*integer as f64),
        Value::Float(number) if number.is_finite() => Ok(*number),
        Value::String(text) if unit == "1" && text.trim_end().ends_with('%') => {
            let percent =
                text.trim_end().trim_end_matches('%').trim().parse::<f64>().ok().filter(|number| number.is_finite());
            percent.map(|percent| percent / 100.0).ok_or_else(|| format!("\"{}\", expected {expected}", short(text)))
        }
        Value::String(text) if unit != "1" => {
            parse(text, unit).map_err(|reason| format!("\"{}\": {reason}, expected {expected}", short(text)))
        }
        other => Err(format!("{other}, expected {expected}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_may_be_measured_in_percent() {
        let part = |text: &str, unit: &str| number(&Value::String(text.into()), unit, units::parse_as);
        assert_eq!([part("15 %", "1"), part("2.5%", "1")], [Ok(0.15), Ok(0.025)]);
        assert!(part("x %", "1").is_err() && part("15 %", "m2").is_err() && part("0.15", "1").is_err());
    }
}
