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
    /// Content of the key.
    pub kind: Kind,
    /// Need of the key: what happens when it is absent.
    pub need: Need,
    /// Meaning of the key, in one line.
    pub meaning: &'static str,
    /// Role of the key: the part of a run that changes with it.
    pub role: Role,
}

impl Key {
    /// Full path, for instance `disc.surface.synthetic.seed`.
    pub fn path(&self) -> String {
        join(self.section, self.name)
    }

    /// Tells whether the key is a step of preparation that "none" takes out of a scene, as if it were absent there and in what it extends.
    pub fn may_be_none(&self) -> bool {
        self.section.ends_with(".prepare") && self.need == Need::Optional && !self.name.contains('.')
    }

    /// Tells whether the key is a seed of random heights or bases.
    pub fn is_seed(&self) -> bool {
        self.name.ends_with(".seed") || self.name == "extend_seed"
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
    /// The same physics, computed otherwise.
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
    /// Two lengths in a list.
    Lengths {
        /// Tells whether one length may stand for both.
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
    /// `true` and nothing else: the key names a choice and has no other value.
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
    /// Error; for a key of an inline table, if that table is there.
    Required,
    /// The key is one of a group of which one is chosen (see [`GROUPS`](super::GROUPS)).
    OneOf,
    /// Error where the key's way of saying the same is chosen (see [`WAYS`](super::WAYS)), unless another key has a certain value.
    OfWay(Option<Choose>),
    /// Default that is taken, in TOML; for a key of an inline table, if that table is there.
    Default(&'static str),
    /// The value of the same name in this table is taken.
    SameAs(&'static str),
    /// A value that depends on the scene is taken.
    Computed(&'static str),
    /// Error, unless another key has a certain value: then this default is taken, in TOML.
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
pub fn is_below(path: &str, table: &str) -> bool {
    path.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'))
}

/// Path of a key of a table; the top table has the empty path.
pub fn join(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") }
}

/// An interval of numbers; NaN and infinities are in none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The lower end.
    pub low: f64,
    /// Tells whether it is one of the numbers.
    pub low_included: bool,
    /// The upper end.
    pub high: f64,
    /// Tells whether it is one of the numbers.
    pub high_included: bool,
}

impl Range {
    /// Any finite number.
    pub const ANY: Self = Self::new(f64::NEG_INFINITY, false, f64::INFINITY, false);
    /// Numbers above 0.
    pub const POSITIVE: Self = Self::new(0.0, false, f64::INFINITY, false);
    /// Numbers from 0 on.
    pub const NOT_NEGATIVE: Self = Self::new(0.0, true, f64::INFINITY, false);
    /// Numbers from 0 to 1, both included.
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

/// Writes it in words: "more than -1 and at most 0.5".
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

#[cfg(test)]
#[path = "../../../tests/unit/scene/schema/key.rs"]
mod tests;
