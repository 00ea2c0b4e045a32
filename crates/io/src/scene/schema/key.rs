//! Key of a scene: table, kind and range of values, default, meaning, role, and an example for documentation and editors.

use std::fmt;

use crate::units::Dimension;

/// One key of a scene.
#[derive(Debug, Clone)]
pub struct Key {
    /// Table it belongs to, for instance `disc.surface`; empty at the top.
    pub section: &'static str,
    /// Name in that table; a key of an inline table has a dotted name, for instance `synthetic.seed`.
    pub name: &'static str,
    /// Its content.
    pub kind: Kind,
    /// Its need: what happens when it is absent.
    pub need: Need,
    /// Its meaning, in one line.
    pub meaning: &'static str,
    /// Its role: the part of a run that changes with it.
    pub role: Role,
}

impl Key {
    /// Full path, for instance `disc.surface.synthetic.seed`.
    pub fn path(&self) -> String {
        join(self.section, self.name)
    }

    /// Tells whether it is a step of a preparation that "none" takes out of a scene, as if the key were absent there and in what it extends.
    pub fn may_be_none(&self) -> bool {
        self.section.ends_with(".prepare") && self.need == Need::Optional && !self.name.contains('.')
    }

    /// Path of the inline table that holds the key, if it is in one.
    pub fn inline_table(&self) -> Option<String> {
        self.name.rsplit_once('.').map(|(table, _)| join(self.section, table))
    }
}

/// Role of a key: the part of a run that changes with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The physics that is simulated.
    Physics,
    /// The same, computed otherwise.
    Numerics,
    /// Length of the run.
    Length,
    /// The series that are recorded, and their times.
    Series,
    /// The maps that are recorded.
    Maps,
    /// Time at which maps are recorded. None is after the end, so this may change with the length.
    MapTimes,
    /// No step and nothing that is recorded: names, threads, what is warned of, checkpoints.
    Nothing,
}

/// Content of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A string with a number and a unit.
    Quantity {
        /// Dimension of the unit.
        dimension: Dimension,
        /// The unit in which the resolved scene is written.
        unit: &'static str,
        /// Accepted values, in SI units.
        range: Range,
    },
    /// One length, or as many as this in a list.
    Lengths {
        /// Length of the list.
        count: usize,
        /// Tells whether one length may stand for all.
        single: bool,
        /// The unit in which the resolved scene is written.
        unit: &'static str,
        /// Accepted values, in m.
        range: Range,
    },
    /// A unit of length, or a length.
    LengthUnit,
    /// A plain number.
    Number(Range),
    /// A plain number, or this word.
    NumberOr(Range, &'static str),
    /// An integer, at least this.
    Integer(u64),
    /// true or false.
    Bool,
    /// Only true: the key names a choice and has no other value.
    True,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// An integer, at least 1, or this word.
    CountOr(&'static str),
    /// Any text but an empty one.
    Text,
    /// Path of an input file, relative to the scene file that names it.
    InputFile,
    /// Times, none negative.
    Times,
    /// Names of maps, see [`plateau_core::observe::Map::name`].
    Maps,
    /// Rows of a cycle: time, load and speed of each.
    Rows,
    /// Rows of temperature and factor.
    Factor,
}

/// Need of a key: what happens when it is absent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Need {
    /// It is an error; for a key of an inline table, if that table is there.
    Required,
    /// The key is one of a group of which one is chosen (see [`GROUPS`](super::GROUPS)).
    OneOf,
    /// It is an error where the key's way of saying the same is chosen (see [`WAYS`](super::WAYS)), unless another key has a certain value.
    OfWay(Option<Choose>),
    /// This value is taken, in TOML; for a key of an inline table, if that table is there.
    Default(&'static str),
    /// The value of the same name in this table is taken.
    SameAs(&'static str),
    /// A value that depends on the scene is taken.
    Computed(&'static str),
    /// It is an error, unless another key has a certain value: then this value is taken, in TOML.
    RequiredUnless(Choose, &'static str),
    /// The step that the key describes is not done.
    Optional,
}

/// A value of a key that decides over others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choose {
    /// Full path of the key.
    pub key: &'static str,
    /// The word.
    pub value: &'static str,
}

/// Tells whether `path` is a key of the table `table` or of a table in it.
pub(crate) fn is_below(path: &str, table: &str) -> bool {
    path.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'))
}

/// Path of a key of a table; the top table has the empty path.
pub(crate) fn join(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") }
}

/// An interval of numbers; NaN and infinities are in none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub(super) low: f64,
    pub(super) low_included: bool,
    pub(super) high: f64,
    pub(super) high_included: bool,
}

impl Range {
    /// Any finite number.
    pub const ANY: Self = Self::new(f64::NEG_INFINITY, false, f64::INFINITY, false);
    /// More than 0.
    pub const POSITIVE: Self = Self::new(0.0, false, f64::INFINITY, false);
    /// 0 or more.
    pub const NOT_NEGATIVE: Self = Self::new(0.0, true, f64::INFINITY, false);
    /// From 0 to 1, both included.
    pub const FRACTION: Self = Self::new(0.0, true, 1.0, true);

    /// The numbers between two, each of which is or is not one of them.
    pub(super) const fn new(low: f64, low_included: bool, high: f64, high_included: bool) -> Self {
        Self { low, low_included, high, high_included }
    }

    /// Tells whether the interval contains the number.
    pub fn contains(&self, number: f64) -> bool {
        number.is_finite()
            && (number > self.low || self.low_included && number == self.low)
            && (number < self.high || self.high_included && number == self.high)
    }
}

/// In words: "more than -1 and at most 0.5".
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let low = if self.low_included { "at least" } else { "more than" };
        let high = if self.high_included { "at most" } else { "less than" };
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => write!(f, "{low} {} and {high} {}", self.low, self.high),
            (true, false) => write!(f, "{low} {}", self.low),
            (false, true) => write!(f, "{high} {}", self.high),
            (false, false) => write!(f, "a finite number"),
        }
    }
}

/// Lengths and times of the paper's baseline or of its kind, by the last name of the key.
const USUAL: &[(&str, &str)] = &[
    ("inner_radius", "20 mm"),
    ("outer_radius", "24 mm"),
    ("pin_diameter", "3 mm"),
    ("pin_width", "4 mm"),
    ("pin_length", "8 mm"),
    ("cell_size", "50 um"),
    ("mean_radius", "22 mm"),
    ("wear_height", "5 um"),
    ("pitch", "0.5 um"),
    ("height_range", "12 um"),
    ("rms_height", "3 um"),
    ("correlation_length", "120 um"),
    ("correlation_length_across", "40 um"),
    ("roll_off", "200 um"),
    ("short_cutoff", "20 um"),
    ("patch", "8 mm"),
    ("pixel", "10 um"),
    ("s_filter", "25 um"),
    ("l_filter", "2 mm"),
    ("cutoff", "3 um"),
    ("fibre_length", "400 um"),
    ("fibre_width", "100 um"),
    ("smooth", "25 um"),
    ("resin_recess", "8 um"),
    ("sample_every", "1 s"),
    ("checkpoint_every", "60 s"),
    ("shear_strength", "0.75 MPa"),
    ("thickness", "6 mm"),
    ("coating.thickness", "60 um"),
    ("length", "12 mm"),
    ("area", "31 cm^2"),
];

/// Pairs of lengths, by the last name of the key.
const PAIRS: &[(&str, &str)] = &[
    ("along", "[\"1 mm\", \"9 mm\"]"),
    ("across", "[\"0.5 mm\", \"5 mm\"]"),
    ("centre", "[\"4 mm\", \"-20 mm\"]"),
    ("radii", "[\"20 mm\", \"24 mm\"]"),
];

impl Key {
    /// A value as a scene may give it, in TOML, where a value's form has to be seen.
    pub fn example(&self) -> Option<String> {
        example_of(self)
    }
}

/// A value that the key may have, in TOML; `None` where its form is plain.
fn example_of(key: &Key) -> Option<String> {
    let name = key.name.rsplit('.').next().unwrap_or(key.name);
    let usual = USUAL.iter().find(|(known, _)| *known == name).map(|(_, example)| *example);
    if let Some((_, pair)) = PAIRS.iter().find(|(known, _)| *known == name) {
        return Some((*pair).to_owned());
    }
    match key.kind {
        Kind::Quantity { dimension, .. } => Some(format!("\"{}\"", usual.unwrap_or(dimension.example()))),
        Kind::Lengths { single: true, .. } => usual.map(|length| format!("\"{length}\"")),
        Kind::Lengths { .. } => usual.map(|length| format!("[\"0 um\", \"{length}\"]")),
        Kind::LengthUnit => Some("\"um\"".to_owned()),
        Kind::Times => Some("[\"0 s\", \"500 s\"]".to_owned()),
        Kind::Rows => Some("[[\"0 s\", \"47 N\", \"850 rpm\"], [\"3 s\", \"47 N\", \"0 rpm\"]]".to_owned()),
        Kind::Factor => Some("[[\"230 degC\", 1.0], [\"400 degC\", 4.0]]".to_owned()),
        Kind::Maps => Some("[\"disc_height\", \"pressure\"]".to_owned()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_say_what_they_contain() {
        let poisson = Range::new(-1.0, false, 0.5, true);
        assert_eq!(poisson.to_string(), "more than -1 and at most 0.5");
        for (number, inside) in [(-1.0, false), (-0.99, true), (0.5, true), (0.51, false), (f64::NAN, false)] {
            assert_eq!(poisson.contains(number), inside, "{number}");
        }
        assert!(!Range::ANY.contains(f64::INFINITY));
        assert!(!Range::POSITIVE.contains(0.0) && Range::NOT_NEGATIVE.contains(0.0));
        assert_eq!(Range::POSITIVE.to_string(), "more than 0");
    }
}
