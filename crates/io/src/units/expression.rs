//! Unit expressions: symbols with prefixes, whole powers, products and quotients.

use std::f64::consts::{PI, TAU};
use std::iter::Peekable;
use std::str::Chars;

/// Powers of length, mass, time, plane angle and temperature.
///
/// The angle counts as a dimension of its own, for only so does "14 Hz" differ from "14 rad/s".
pub(super) type Powers = [i32; 5];

/// A unit in terms of SI: 10^tens · times / over of the SI unit with these powers.
///
/// Tens are kept apart so that they can be applied without rounding, and the divisor so that "72 km/h" is 20 m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) powers: Powers,
    pub(super) tens: i32,
    pub(super) times: f64,
    pub(super) over: f64,
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
    pub(super) fn parse(text: &str) -> Result<Self, String> {
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

    /// self · other^power.
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
