//! Physical quantities as text: "47 N", "850 rpm", "5e-5 mm^3/(N m)".
//!
//! A unit is a product of symbols with whole powers; `/` divides by the one factor that follows it. Factors of ten are
//! taken into the decimal exponent before the number is rounded, so that "50 um" is the same double as `5e-5`.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::iter::Peekable;
use std::str::Chars;

use crate::text::short;

/// 0 °C, K.
const CELSIUS: f64 = 273.15;

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
        let is_frequency = expected == Dimension::RotationalSpeed && found == "a frequency";
        let advice = if is_frequency { "; a frequency does not say whether it counts turns or radians" } else { "" };
        return Err(format!("{shown} is {found}, expected {expected}{advice}"));
    }
    finite(shift_decimal(number, scale.tens) * scale.times / scale.over, not_finite)
}

/// Reads a number with a unit that measures the same as `si_unit`, a product of SI units such as `m2` or `kg s-1`; in that unit.
pub fn parse_as(text: &str, si_unit: &str) -> Result<f64, String> {
    let (number, unit) = split_number(text.trim()).ok_or("it does not start with a number")?;
    let not_finite = || "it is not finite".to_owned();
    if unit.is_empty() {
        return Err("it has no unit".to_owned());
    }
    if si_unit == "K" && is_celsius(unit) {
        return finite(shift_decimal(number, 0) + CELSIUS, not_finite);
    }
    let (scale, expected) = (Scale::parse(unit)?, Scale::parse(&si_unit.replace('-', "^-"))?);
    if scale.powers != expected.powers {
        return Err(format!("it is {}", meaning(scale.powers)));
    }
    finite(shift_decimal(number, scale.tens) * scale.times / scale.over, not_finite)
}

/// Powers of m, kg, s, rad and K of a unit, and a, b and c: it is 10^a · b / c of the SI unit of these powers.
pub fn scale_of(unit: &str) -> Result<(Powers, i32, f64, f64), String> {
    let Scale { powers, tens, times, over } = Scale::parse(unit)?;
    let is_usual = tens.abs() < 1000 && times.is_finite() && over.is_finite();
    if is_usual { Ok((powers, tens, times, over)) } else { Err("this is not a unit".to_owned()) }
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

/// The kinds of quantity that scenes ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // Their units say what they are.
pub enum Dimension {
    Length,
    Force,
    Pressure,
    Time,
    Speed,
    RotationalSpeed,
    Torque,
    SpecificWearRate,
    Area,
    Temperature,
    ThermalConductivity,
    Density,
    SpecificHeat,
    Cooling,
    CoolingPerSpeed,
    NumberPerMass,
    Angle,
}

/// Knowledge of a kind of quantity.
struct Facts {
    powers: Powers,
    /// The coherent SI unit.
    si_unit: &'static str,
    example: &'static str,
    /// Units that are commonly used.
    units: &'static str,
}

const fn facts(powers: Powers, si_unit: &'static str, example: &'static str, units: &'static str) -> Facts {
    Facts { powers, si_unit, example, units }
}

/// Dimension of a unit of these powers.
const MEANINGS: &[(Powers, &str)] = &[
    ([1, 0, 0, 0, 0], "a length"),
    ([1, 1, -2, 0, 0], "a force"),
    ([-1, 1, -2, 0, 0], "a pressure"),
    ([0, 0, 1, 0, 0], "a time"),
    ([1, 0, -1, 0, 0], "a speed"),
    ([0, 0, -1, 1, 0], "a rotational speed"),
    ([1, -1, 2, 0, 0], "a specific wear rate"),
    ([0, 0, 0, 0, 0], "a plain number"),
    ([0, 1, 0, 0, 0], "a mass"),
    ([0, 0, 0, 1, 0], "an angle"),
    ([0, 0, -1, 0, 0], "a frequency"),
    ([2, 0, 0, 0, 0], "an area"),
    ([3, 0, 0, 0, 0], "a volume"),
    ([2, 1, -2, 0, 0], "an energy"),
    ([2, 1, -3, 0, 0], "a power"),
    ([0, 0, 0, 0, 1], "a temperature"),
    ([1, 1, -3, 0, -1], "a thermal conductivity"),
    ([-3, 1, 0, 0, 0], "a density"),
    ([2, 0, -2, 0, -1], "a specific heat"),
    ([2, 1, -3, 0, -1], "a cooling"),
    ([2, 1, -2, -1, -1], "a cooling per speed"),
    ([0, -1, 0, 0, 0], "a number per mass"),
];

fn meaning(powers: Powers) -> &'static str {
    MEANINGS.iter().find(|(known, _)| *known == powers).map_or("a quantity of another kind", |(_, name)| name)
}

impl Dimension {
    fn facts(self) -> Facts {
        match self {
            Self::Length => facts([1, 0, 0, 0, 0], "m", "50 um", "m, mm, um, nm"),
            Self::Force => facts([1, 1, -2, 0, 0], "N", "47 N", "N, kN, mN"),
            Self::Pressure => facts([-1, 1, -2, 0, 0], "Pa", "100 GPa", "Pa, kPa, MPa, GPa"),
            Self::Time => facts([0, 0, 1, 0, 0], "s", "3000 s", "s, ms, min, h"),
            Self::Speed => facts([1, 0, -1, 0, 0], "m/s", "2 m/s", "m/s, mm/s, km/h"),
            Self::RotationalSpeed => facts([0, 0, -1, 1, 0], "rad/s", "850 rpm", "rpm, rad/s"),
            Self::Torque => facts([2, 1, -2, 0, 0], "N m", "0.4 N m", "N m, mN m, kN m"),
            Self::SpecificWearRate => facts([1, -1, 2, 0, 0], "1/Pa", "5e-14 1/Pa", "1/Pa, m^2/N, mm^3/(N m)"),
            Self::Area => facts([2, 0, 0, 0, 0], "m^2", "2000 um^2", "m^2, mm^2, um^2"),
            Self::Temperature => facts([0, 0, 0, 0, 1], "K", "23 degC", "degC, K"),
            Self::ThermalConductivity => facts([1, 1, -3, 0, -1], "W/(m K)", "50 W/(m K)", "W/(m K), W/m/K"),
            Self::Density => facts([-3, 1, 0, 0, 0], "kg/m^3", "7200 kg/m^3", "kg/m^3, g/cm^3"),
            Self::SpecificHeat => facts([2, 0, -2, 0, -1], "J/(kg K)", "500 J/(kg K)", "J/(kg K), kJ/(kg K), J/kg/K"),
            Self::Cooling => facts([2, 1, -3, 0, -1], "W/K", "0.4 W/K", "W/K, mW/K"),
            Self::CoolingPerSpeed => facts([2, 1, -2, -1, -1], "J/(K rad)", "0.002 J/(K rad)", "J/(K rad), J/K/rad"),
            Self::NumberPerMass => facts([0, -1, 0, 0, 0], "1/kg", "1e15 1/kg", "1/kg, 1/g, 1/mg"),
            Self::Angle => facts([0, 0, 0, 1, 0], "rad", "90 deg", "deg, rad"),
        }
    }

    fn powers(self) -> Powers {
        self.facts().powers
    }

    /// Its meaning in a scene, with an article.
    fn meaning(self) -> &'static str {
        // By its powers it would be an energy.
        if self == Self::Torque { "a torque" } else { meaning(self.powers()) }
    }

    /// Its name, such as "rotational speed".
    pub fn name(self) -> &'static str {
        let meaning = self.meaning();
        meaning.split_once(' ').map_or(meaning, |(_article, name)| name)
    }

    /// The coherent SI unit.
    pub fn si_unit(self) -> &'static str {
        self.facts().si_unit
    }

    /// A quantity as a scene may write it.
    pub fn example(self) -> &'static str {
        self.facts().example
    }

    /// The units that are commonly used, for messages and documentation.
    pub fn units(self) -> &'static str {
        self.facts().units
    }
}

/// Says what is expected, with an example: `a force such as "47 N" (N, kN, mN)`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} such as \"{}\" ({})", self.meaning(), self.example(), self.units())
    }
}

/// Powers of length, mass, time, plane angle and temperature.
///
/// The angle counts as a dimension of its own, for only so does "14 Hz" differ from "14 rad/s".
pub type Powers = [i32; 5];

/// A unit in terms of SI: 10^tens · times / over of the SI unit with these powers.
///
/// Tens are kept apart so that they can be applied without rounding, and the divisor so that "72 km/h" is 20 m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scale {
    powers: Powers,
    tens: i32,
    times: f64,
    over: f64,
}

const fn unit(powers: Powers, tens: i32, times: f64, over: f64) -> Scale {
    Scale { powers, tens, times, over }
}

/// Symbols that take a prefix.
const PREFIXABLE: &[(&str, Scale)] = &[
    ("m", unit([1, 0, 0, 0, 0], 0, 1.0, 1.0)),
    ("s", unit([0, 0, 1, 0, 0], 0, 1.0, 1.0)),
    ("N", unit([1, 1, -2, 0, 0], 0, 1.0, 1.0)),
    ("Pa", unit([-1, 1, -2, 0, 0], 0, 1.0, 1.0)),
    ("g", unit([0, 1, 0, 0, 0], -3, 1.0, 1.0)),
    ("Hz", unit([0, 0, -1, 0, 0], 0, 1.0, 1.0)),
    ("J", unit([2, 1, -2, 0, 0], 0, 1.0, 1.0)),
    ("W", unit([2, 1, -3, 0, 0], 0, 1.0, 1.0)),
    ("K", unit([0, 0, 0, 0, 1], 0, 1.0, 1.0)),
];

/// Symbols that take none.
const PLAIN: &[(&str, Scale)] = &[
    ("min", unit([0, 0, 1, 0, 0], 0, 60.0, 1.0)),
    ("h", unit([0, 0, 1, 0, 0], 0, 3600.0, 1.0)),
    ("d", unit([0, 0, 1, 0, 0], 0, 86400.0, 1.0)),
    ("bar", unit([-1, 1, -2, 0, 0], 5, 1.0, 1.0)),
    ("rad", unit([0, 0, 0, 1, 0], 0, 1.0, 1.0)),
    ("deg", unit([0, 0, 0, 1, 0], 0, PI, 180.0)),
    ("rev", unit([0, 0, 0, 1, 0], 0, TAU, 1.0)),
    ("rpm", unit([0, 0, -1, 1, 0], 0, TAU, 60.0)),
    ("RPM", unit([0, 0, -1, 1, 0], 0, TAU, 60.0)),
    // Tribology writes "mm^3/Nm" and means mm³/(N·m).
    ("Nm", unit([2, 1, -2, 0, 0], 0, 1.0, 1.0)),
    ("1", Scale::ONE),
];

/// Decimal prefixes; micro also as either of the two Unicode letters.
pub const PREFIXES: &[(char, i32)] = &[
    ('p', -12),
    ('n', -9),
    ('u', -6),
    ('\u{b5}', -6),
    ('\u{3bc}', -6),
    ('m', -3),
    ('c', -2),
    ('k', 3),
    ('M', 6),
    ('G', 9),
    ('T', 12),
];

/// Longer texts are no units; it bounds the depth of the recursion too.
const LONGEST: usize = 64;

impl Scale {
    const ONE: Self = unit([0; 5], 0, 1.0, 1.0);

    /// Reads a unit expression; the error says what is wrong with it.
    fn parse(text: &str) -> Result<Self, String> {
        if text.starts_with(',') {
            return Err("a comma does not separate decimals, write a point".to_owned());
        }
        if text.len() > LONGEST {
            return Err("this is not a unit".to_owned());
        }
        let mut characters = text.chars().peekable();
        let scale = product(&mut characters)?;
        match characters.next() {
            None => Ok(scale),
            Some(found) => Err(format!("unexpected '{found}' in the unit")),
        }
    }

    fn symbol(name: &str) -> Option<Self> {
        let find = |table: &[(&str, Self)], name: &str| table.iter().find(|(known, _)| *known == name).map(|e| e.1);
        find(PLAIN, name).or_else(|| find(PREFIXABLE, name)).or_else(|| {
            let mut rest = name.chars();
            let first = rest.next()?;
            let (_, tens) = PREFIXES.iter().find(|(prefix, _)| *prefix == first)?;
            let base = find(PREFIXABLE, rest.as_str())?;
            Some(Self { tens: base.tens + tens, ..base })
        })
    }

    fn times(self, other: Self, power: i32) -> Self {
        let (times, over) = if power < 0 { (other.over, other.times) } else { (other.times, other.over) };
        let magnitude = power.abs();
        Self {
            // Nested powers can exceed any integer; what saturates is no known quantity.
            powers: std::array::from_fn(|i| self.powers[i].saturating_add(power.saturating_mul(other.powers[i]))),
            tens: self.tens.saturating_add(power.saturating_mul(other.tens)),
            times: self.times * times.powi(magnitude),
            over: self.over * over.powi(magnitude),
        }
    }
}

/// factor { ("/" | "*" | "·" | space) factor }
fn product(characters: &mut Peekable<Chars<'_>>) -> Result<Scale, String> {
    let mut scale = factor(characters)?;
    loop {
        skip_spaces(characters);
        let sign = match characters.peek() {
            None | Some(')') => return Ok(scale),
            Some('/') => -1,
            Some('*' | '·' | '⋅') => 1,
            Some(_) => {
                scale = scale.times(factor(characters)?, 1);
                continue;
            }
        };
        characters.next();
        scale = scale.times(factor(characters)?, sign);
    }
}

/// ( "(" product ")" | symbol ) [ power ]
fn factor(characters: &mut Peekable<Chars<'_>>) -> Result<Scale, String> {
    skip_spaces(characters);
    let base = if characters.next_if_eq(&'(').is_some() {
        let inner = product(characters)?;
        if characters.next_if_eq(&')').is_none() {
            return Err("a parenthesis of the unit is not closed".to_owned());
        }
        inner
    } else {
        let mut name = String::new();
        if let Some(one) = characters.next_if_eq(&'1') {
            name.push(one);
        }
        while let Some(letter) = characters.next_if(|c| c.is_alphabetic()) {
            name.push(letter);
        }
        if name.is_empty() {
            return Err(match characters.peek() {
                Some(found) => format!("unexpected '{found}' in the unit"),
                None => "the unit is not complete".to_owned(),
            });
        }
        Scale::symbol(&name).ok_or_else(|| format!("unknown unit \"{name}\""))?
    };
    Ok(Scale::ONE.times(base, power(characters)?))
}

/// "^-2", "2", "⁻²" or nothing, which is 1.
fn power(characters: &mut Peekable<Chars<'_>>) -> Result<i32, String> {
    const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let caret = characters.next_if_eq(&'^').is_some();
    let negative = if caret { characters.next_if_eq(&'-').is_some() } else { characters.next_if_eq(&'⁻').is_some() };
    let digit = characters.peek().and_then(|&c| {
        let position = SUPERSCRIPTS.chars().position(|superscript| superscript == c);
        c.to_digit(10).or(position.and_then(|at| u32::try_from(at).ok()))
    });
    match digit {
        Some(digit @ 1..=9) => {
            characters.next();
            let digit = digit as i32;
            Ok(if negative { -digit } else { digit })
        }
        None if !caret && !negative => Ok(1),
        _ => Err("a power in the unit is not a digit from 1 to 9".to_owned()),
    }
}

fn skip_spaces(characters: &mut Peekable<Chars<'_>>) {
    while characters.next_if(|c| c.is_whitespace()).is_some() {}
}

#[cfg(test)]
#[path = "../tests/unit/units.rs"]
mod tests;
