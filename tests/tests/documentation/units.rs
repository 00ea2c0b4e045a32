//! Quantities as regular expressions, for editors that check a scene while it is written.
//!
//! What a pattern matches, [`parse`] reads. The reverse does not hold: a regular expression cannot multiply out
//! units, so a quantity in an unusual form ("1 kg m/s^2" for a force) is read by the program and marked by an editor.

use plateau_io::units::{Dimension, PREFIXES, parse};
use proptest::prelude::*;
use proptest::string::string_regex;
use regex::Regex;

/// Numbers that a quantity may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    /// Any.
    Any,
    /// 0 or more.
    NotNegative,
    /// More than 0.
    Positive,
}

/// A regular expression (ECMA 262, without look-around) for quantities of this dimension in the usual units.
pub(super) fn quantity(dimension: Dimension, sign: Sign) -> String {
    format!("^ *{} *$", number_with_unit(dimension, sign))
}

/// As [`quantity`] for lengths, where a unit alone stands for 1 of it.
pub(super) fn length_unit() -> String {
    let (number, unit) = (number_with_unit(Dimension::Length, Sign::Positive), Units::new().length);
    format!("^ *({number}|{unit}) *$")
}

fn number_with_unit(dimension: Dimension, sign: Sign) -> String {
    if dimension == Dimension::Temperature {
        // Below 0 °C, down to 0 K.
        let celsius = match sign {
            Sign::Any => number(Sign::Any),
            _ => format!(r"({}|-([01]?[0-9]{{1,2}}|2[0-6][0-9]|27[0-2])(\.[0-9]*)?)", number(Sign::NotNegative)),
        };
        return format!("({} *K|{celsius} *(degC|°C))", number(sign));
    }
    let (glued, apart) = Units::new().of(dimension);
    let number = number(sign);
    match apart {
        None => format!("{number} *({glued})"),
        // "5 1/Pa" is not "51/Pa".
        Some(apart) => format!("{number}( *({glued})| +({apart}))"),
    }
}

/// Exponents have two digits at most, so that every number is finite and none vanishes.
fn number(sign: Sign) -> String {
    let (sign, digits) = match sign {
        Sign::Any => ("[+-]?", r"([0-9]+\.?[0-9]*|\.[0-9]+)"),
        Sign::NotNegative => (r"\+?", r"([0-9]+\.?[0-9]*|\.[0-9]+)"),
        Sign::Positive => (r"\+?", r"([0-9]*[1-9][0-9]*\.?[0-9]*|[0-9]*\.[0-9]*[1-9][0-9]*)"),
    };
    format!("{sign}{digits}([eE][+-]?[0-9]{{1,2}})?")
}

/// Regular expressions of units.
struct Units {
    length: String,
    time: String,
    force: String,
    pressure: String,
    mass: String,
    energy: String,
    power: String,
}

const OVER: &str = " ?/ ?";
const TIMES: &str = "( ?[*·] ?| )";
const SQUARED: &str = r"(\^?2|²)";
const CUBED: &str = r"(\^?3|³)";
const INVERSE: &str = r"(\^-1|⁻¹)";

impl Units {
    fn new() -> Self {
        let prefix: String = PREFIXES.iter().map(|(prefix, _)| *prefix).collect();
        let prefixed = |symbol: &str| format!("[{prefix}]?{symbol}");
        let (length, force) = (prefixed("m"), prefixed("N"));
        let time = format!("({}|min|h|d)", prefixed("s"));
        let pressure = format!("({}|bar|{force}{OVER}{length}{SQUARED})", prefixed("Pa"));
        let [mass, energy, power] = ["g", "J", "W"].map(prefixed);
        Self { length, time, force, pressure, mass, energy, power }
    }

    /// Units that may follow a number at once, and those that must stand apart from it.
    fn of(&self, dimension: Dimension) -> (String, Option<String>) {
        let Self { length, time, force, pressure, mass, energy, power } = self;
        let glued = match dimension {
            Dimension::Length => length.clone(),
            Dimension::Force => force.clone(),
            Dimension::Torque => format!("{force}{TIMES}{length}|{energy}"),
            Dimension::Pressure => pressure.clone(),
            Dimension::Time => time.clone(),
            Dimension::Speed => format!("{length}{OVER}{time}"),
            Dimension::RotationalSpeed => format!("rpm|RPM|(rad|rev|deg){OVER}{time}"),
            Dimension::Angle => "deg|rad|rev".to_owned(),
            Dimension::Area => format!("{length}{SQUARED}"),
            Dimension::Temperature => "K".to_owned(),
            Dimension::ThermalConductivity => format!("{power}({OVER}{length}{OVER}K|{OVER}\\({length}{TIMES}K\\))"),
            Dimension::Density => format!("{mass}{OVER}{length}{CUBED}"),
            Dimension::SpecificHeat => format!("{energy}({OVER}{mass}{OVER}K|{OVER}\\({mass}{TIMES}K\\))"),
            Dimension::Cooling => format!("{power}{OVER}K"),
            Dimension::CoolingPerSpeed => format!("{energy}({OVER}K{OVER}rad|{OVER}\\(K{TIMES}rad\\))"),
            Dimension::NumberPerMass => return (format!("{mass}{INVERSE}"), Some(format!("1{OVER}{mass}"))),
            Dimension::SpecificWearRate => {
                let work = format!(
                    r"{OVER}(\( ?{force}{TIMES}{length} ?\)|{force}{OVER}{length}|Nm)|{TIMES}{force}{INVERSE}{TIMES}{length}{INVERSE}"
                );
                let alternatives = format!("{length}{SQUARED}{OVER}{force}|{length}{CUBED}({work})");
                return (alternatives, Some(format!("1{OVER}({pressure})")));
            }
        };
        (glued, None)
    }
}

const DIMENSIONS: [Dimension; 16] = [
    Dimension::Length,
    Dimension::Force,
    Dimension::Pressure,
    Dimension::Time,
    Dimension::Speed,
    Dimension::RotationalSpeed,
    Dimension::SpecificWearRate,
    Dimension::Area,
    Dimension::Temperature,
    Dimension::ThermalConductivity,
    Dimension::Density,
    Dimension::SpecificHeat,
    Dimension::Cooling,
    Dimension::CoolingPerSpeed,
    Dimension::NumberPerMass,
    Dimension::Angle,
];

/// Without the anchors, which the generator of strings does not know.
fn inner(pattern: &str) -> &str {
    pattern.trim_start_matches('^').trim_end_matches('$')
}

#[test]
fn whatever_a_pattern_matches_is_read_as_a_number_of_its_sign() {
    let mut runner = proptest::test_runner::TestRunner::default();
    for dimension in DIMENSIONS {
        for sign in [Sign::Any, Sign::NotNegative, Sign::Positive] {
            let texts = string_regex(inner(&quantity(dimension, sign))).unwrap();
            let law = |text: String| {
                let number = parse(&text, dimension).map_err(|error| TestCaseError::fail(error.to_string()))?;
                prop_assert!(sign != Sign::NotNegative || number >= 0.0, "{text}");
                prop_assert!(sign != Sign::Positive || number > 0.0, "{text}");
                Ok(())
            };
            runner.run(&texts, law).unwrap();
        }
    }
}

#[test]
fn the_units_that_messages_name_match() {
    // Expected: the units that the documentation names, and a unit of every other dimension.
    for dimension in DIMENSIONS {
        let pattern = Regex::new(&quantity(dimension, Sign::Any)).unwrap();
        let matches = |text: &str| pattern.is_match(text);
        assert!(matches(dimension.example()), "{}", dimension.example());
        for unit in dimension.units().split(", ") {
            assert!(matches(&format!("-1.5e-3 {unit}")), "{unit}");
            assert!(!matches(unit), "{unit} alone");
        }
        for other in DIMENSIONS.into_iter().filter(|other| *other != dimension) {
            assert!(!matches(other.example()), "{} as {dimension:?}", other.example());
        }
        assert!(!matches("1") && !matches("") && !matches("14 Hz") && !matches("one m"), "{dimension:?}");
    }
    let pattern = Regex::new(&length_unit()).unwrap();
    let matches = |text: &str| pattern.is_match(text);
    assert!(matches("um") && matches("0.5 µm") && !matches("kg") && !matches("0 um") && !matches("1"));
}
