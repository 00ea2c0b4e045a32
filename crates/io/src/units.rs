//! Physical quantities as text: "47 N", "850 rpm", "5e-5 mm^3/(N m)".
//!
//! A unit is a product of symbols with whole powers; `/` divides by the one factor that follows it. Factors of ten are
//! taken into the decimal exponent before the number is rounded, so that "50 um" is the same double as `5e-5`.

mod dimension;
mod expression;

use dimension::meaning;
use expression::Scale;

use crate::text::short;

pub use dimension::Dimension;
pub use expression::PREFIXES;

/// 0 °C, K.
const CELSIUS: f64 = 273.15;

/// Says that what was found has no unit, and what is expected.
pub(crate) fn no_unit(found: impl std::fmt::Display, expected: Dimension) -> String {
    format!("{found} has no unit, expected {expected}")
}

/// Reads a number with a unit of the given dimension, as the nearest double in the SI unit; else says what was found and what is expected.
pub fn parse(text: &str, expected: Dimension) -> Result<f64, String> {
    let shown = format!("\"{}\"", short(text.trim()).escape_debug());
    let not_finite = || format!("{shown} is not finite, expected {expected}");
    let Some((number, unit)) = split_number(text.trim()) else {
        let word = text.trim().trim_start_matches(['+', '-']).to_ascii_lowercase();
        return Err(if word.starts_with("inf") || word.starts_with("nan") {
            not_finite()
        } else {
            format!("{shown} does not start with a number, expected {expected}")
        });
    };
    if unit.is_empty() {
        return Err(no_unit(shown, expected));
    }
    if expected == Dimension::Temperature && is_celsius(unit) {
        return finite(shift_decimal(number, 0) + CELSIUS, not_finite);
    }
    let scale = Scale::parse(unit).map_err(|reason| format!("{shown}: {reason}, expected {expected}"))?;
    if scale.powers != expected.powers() {
        let found = meaning(scale.powers);
        let advice = match expected {
            Dimension::RotationalSpeed if found == "a frequency" => {
                "; a frequency does not say whether it counts turns or radians"
            }
            _ => "",
        };
        return Err(format!("{shown} is {found}, expected {expected}{advice}"));
    }
    finite(shift_decimal(number, scale.tens) * scale.times / scale.over, not_finite)
}

/// Reads a number with a unit that measures the same as `si_unit`, a product of SI units such as `m2` or `kg s-1`; in that unit.
pub fn parse_as(text: &str, si_unit: &str) -> Result<f64, String> {
    let (number, unit) = split_number(text.trim()).ok_or("it does not start with a number")?;
    if unit.is_empty() {
        return Err("it has no unit".to_owned());
    }
    let scale = if si_unit == "K" && is_celsius(unit) {
        return finite(shift_decimal(number, 0) + CELSIUS, || "it is not finite".to_owned());
    } else {
        Scale::parse(unit)?
    };
    let expected = Scale::parse(&si_unit.replace('-', "^-"))?;
    if scale.powers != expected.powers {
        return Err(format!("it is {}", meaning(scale.powers)));
    }
    finite(shift_decimal(number, scale.tens) * scale.times / scale.over, || "it is not finite".to_owned())
}

/// Value of 0 of a unit in the SI unit: 273.15 K for degrees Celsius, else 0.
pub fn zero_of(unit: &str) -> f64 {
    if is_celsius(unit) { CELSIUS } else { 0.0 }
}

/// Degrees Celsius are no multiple of a kelvin, and have a meaning only as a temperature alone.
fn is_celsius(unit: &str) -> bool {
    matches!(unit, "degC" | "°C")
}

/// The number without the sign of −0, if it is finite.
fn finite<E>(value: f64, error: impl Fn() -> E) -> Result<f64, E> {
    if value.is_finite() { Ok(value + 0.0) } else { Err(error()) }
}

/// Writes a value in SI units as a quantity in the given unit, so that [`parse`] gives the same double back.
///
/// Where a unit that is no power of ten of the SI unit (rpm) cannot give the same double, the SI unit is used.
pub fn format(value: f64, unit: &str, dimension: Dimension) -> String {
    if is_celsius(unit) {
        let text = format!("{} {unit}", decimal(&format!("{:.12e}", value - CELSIUS), 0));
        if parse(&text, dimension) == Ok(value) {
            return text;
        }
    }
    if let Ok(scale) = Scale::parse(unit) {
        let candidates = if scale.times == 1.0 && scale.over == 1.0 {
            vec![format!("{value:e}")]
        } else {
            let converted = value * scale.over / scale.times;
            (13..=16).map(|digits| format!("{converted:.digits$e}")).collect()
        };
        for candidate in candidates {
            let text = format!("{} {unit}", decimal(&candidate, -scale.tens));
            if parse(&text, dimension) == Ok(value) {
                return text;
            }
        }
    }
    format!("{} {}", decimal(&format!("{value:e}"), 0), dimension.si_unit())
}

/// Splits "47 N" into "47" and "N"; `None` if the text does not start with a number.
fn split_number(text: &str) -> Option<(&str, &str)> {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let sign = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));

    let start = sign(0);
    let mut end = digits(start);
    let mut count = end - start;
    if bytes.get(end) == Some(&b'.') {
        let fraction = digits(end + 1);
        count += fraction - (end + 1);
        end = fraction;
    }
    if count == 0 {
        return None;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = sign(end + 1);
        let exponent_end = digits(exponent);
        if exponent_end > exponent {
            end = exponent_end;
        }
    }
    Some((&text[..end], text[end..].trim()))
}

/// The double nearest to number · 10^tens.
fn shift_decimal(number: &str, tens: i32) -> f64 {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    // An exponent that does not fit is far beyond any double, on the side that its sign says.
    let limit = if exponent.starts_with('-') { i64::MIN / 2 } else { i64::MAX / 2 };
    let exponent = exponent.parse().unwrap_or(limit) + i64::from(tens);
    format!("{mantissa}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// Number · 10^tens, written plainly where that is short; `scientific` is what `{:e}` gives.
fn decimal(scientific: &str, tens: i32) -> String {
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((scientific, "0"));
    let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("-", rest));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let digits = digits.trim_end_matches('0');
    if digits.is_empty() {
        return "0".to_owned();
    }
    let exponent = exponent.parse::<i32>().unwrap_or(0) + tens;
    let text = match usize::try_from(exponent) {
        Ok(places) if places < 6.max(digits.len()) => {
            let padded = format!("{digits:0<width$}", width = places + 1);
            let (whole, fraction) = padded.split_at(places + 1);
            if fraction.is_empty() { whole.to_owned() } else { format!("{whole}.{fraction}") }
        }
        Err(_) if exponent >= -3 => format!("0.{}{digits}", "0".repeat(exponent.unsigned_abs() as usize - 1)),
        _ => {
            let (first, rest) = digits.split_at(1);
            if rest.is_empty() { format!("{first}e{exponent}") } else { format!("{first}.{rest}e{exponent}") }
        }
    };
    format!("{sign}{text}")
}

#[cfg(test)]
#[path = "../tests/unit/units.rs"]
mod tests;
