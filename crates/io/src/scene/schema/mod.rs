//! Every key of a scene: where it belongs, what it holds, what it defaults to and what it means.
//!
//! One table ([`keys`]) serves for checking, for messages about unknown keys, for the resolved scene and for
//! documentation. The order is that of docs/scenes.md.

pub mod choices;
mod example;
mod json_schema;
mod keys;
mod mesh;
mod optional_parts;
mod straightening;
mod suggest;
mod table;
mod tables;
mod ways;

use std::collections::HashMap;
use std::fmt;
use std::sync::LazyLock;

use crate::units::Dimension;

pub use json_schema::document as json_schema;
pub use keys::{GROUPS, MEANINGLESS};
pub(crate) use suggest::{nearest, unknown};
pub use tables::table_meaning;
pub use ways::{WAYS, Ways};

/// Full path of the key of m: a number, or a table with how the run chooses it.
pub(crate) const ACCELERATION: &str = "numerics.time_acceleration";
/// Full path of the table of the cycle.
pub(crate) const CYCLE: &str = "operation.cycle";

/// One key of a scene.
#[derive(Debug, Clone)]
pub struct Key {
    /// Table it belongs to, for instance `disc.surface`; empty at the top.
    pub section: &'static str,
    /// Name in that table; a key of an inline table has a dotted name, for instance `synthetic.seed`.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// What happens when it is absent.
    pub need: Need,
    /// What it means, in one line.
    pub meaning: &'static str,
    /// What changes with it.
    pub role: Role,
}

impl Key {
    /// Full path, for instance `disc.surface.synthetic.seed`.
    pub fn path(&self) -> String {
        join(self.section, self.name)
    }

    /// A value as a scene may give it, in TOML, where a value's form has to be seen.
    pub fn example(&self) -> Option<String> {
        example::of(self)
    }

    /// The group of alternatives of which the key is one.
    pub fn group(&self) -> Option<&'static Group> {
        GROUPS.iter().find(|group| group.section == self.section && group.has(self.name))
    }

    /// Whether it is a step of a preparation that "none" takes out of a scene, as if the key were absent there and in what it extends.
    pub fn may_be_none(&self) -> bool {
        self.section.ends_with(".prepare") && self.need == Need::Optional && !self.name.contains('.')
    }

    /// Path of the inline table that holds the key, if it is in one.
    pub fn inline_table(&self) -> Option<String> {
        self.name.rsplit_once('.').map(|(table, _)| join(self.section, table))
    }
}

/// What changes with a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// What is simulated.
    Physics,
    /// The same, computed otherwise.
    Numerics,
    /// How much of it is simulated.
    Length,
    /// Which series are recorded, and when.
    Series,
    /// Which maps are recorded.
    Maps,
    /// When maps are recorded. None is after the end, so this may change with the length.
    MapTimes,
    /// No step and nothing that is recorded: names, threads, what is warned of, checkpoints.
    Nothing,
}

/// What changes with the key with this full path; of one that is not known (any more, or yet) what is simulated.
pub fn role(path: &str) -> Role {
    find(path).map_or(Role::Physics, |key| key.role)
}

/// Whether the key with this full path names a file whose content is read.
pub fn is_input(path: &str) -> bool {
    find(path).is_some_and(|key| key.kind == Kind::InputFile)
}

/// What a key holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A string with a number and a unit.
    Quantity {
        /// What the unit measures.
        dimension: Dimension,
        /// The unit in which the resolved scene is written.
        unit: &'static str,
        /// Accepted values, in SI units.
        range: Range,
    },
    /// One length, or as many as this in a list.
    Lengths {
        /// How many the list has.
        count: usize,
        /// Whether one length may stand for all.
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

/// What happens when a key is absent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Need {
    /// It is an error; for a key of an inline table, if that table is there.
    Required,
    /// The key is one of a group of which one is chosen (see [`GROUPS`]).
    OneOf,
    /// It is an error where the key's way of saying the same is chosen (see [`WAYS`]), unless another key has a certain value.
    OfWay(Option<Choose>),
    /// This value is taken, in TOML; for a key of an inline table, if that table is there.
    Default(&'static str),
    /// The value of the same name in this table is taken.
    SameAs(&'static str),
    /// A value that depends on the scene is taken.
    Computed(&'static str),
    /// It is an error, unless another key has a certain value: then this value is taken, in TOML.
    RequiredUnless(Choose, &'static str),
    /// It is an error, unless the table with this full path is given.
    RequiredWithout(&'static str),
    /// What the key describes is not done.
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

/// A key that has no meaning beside a value of another, and why.
#[derive(Debug, Clone, Copy)]
pub struct Meaningless {
    /// The value that takes its meaning.
    pub beside: Choose,
    /// Full path of the key.
    pub key: &'static str,
    /// What the value does instead.
    pub reason: &'static str,
}

/// Keys of which a scene gives exactly one, or at most one.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    /// Table they belong to.
    pub section: &'static str,
    /// The alternatives, each with the keys that have a meaning only beside it.
    pub members: &'static [(&'static str, &'static [&'static str])],
    /// Whether one must be given.
    pub required: bool,
    /// Full path of a table beside which none must be given all the same.
    pub unless: Option<&'static str>,
}

impl Group {
    /// Whether one is to be chosen at all: alternatives in an inline table mean nothing where that is not given.
    pub fn applies(&self, given: impl Fn(&str) -> bool) -> bool {
        self.members
            .iter()
            .all(|(name, _)| name.rsplit_once('.').is_none_or(|(table, _)| given(&join(self.section, table))))
    }

    /// Whether one must be given in a scene that has these tables.
    pub fn is_required(&self, given: impl Fn(&str) -> bool) -> bool {
        self.required && !self.unless.is_some_and(given)
    }

    /// Whether this name is one of the alternatives.
    fn has(&self, name: &str) -> bool {
        self.members.iter().any(|(member, _)| *member == name)
    }

    /// The alternatives as a list: `file, synthetic, flat`.
    pub fn names(&self) -> String {
        self.members.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    }
}

/// An interval of numbers; NaN and infinities are in none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    low: f64,
    low_included: bool,
    high: f64,
    high_included: bool,
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

    const fn new(low: f64, low_included: bool, high: f64, high_included: bool) -> Self {
        Self { low, low_included, high, high_included }
    }

    /// Whether the interval contains the number.
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

/// Every key, in the order of docs/scenes.md.
pub fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(keys::all);
    &KEYS
}

/// All keys by their paths: a study asks for some of them in each of its scenes.
static BY_PATH: LazyLock<HashMap<String, &'static Key>> =
    LazyLock::new(|| keys().iter().rev().map(|key| (key.path(), key)).collect());

/// The key with this full path.
pub fn find(path: &str) -> Option<&'static Key> {
    BY_PATH.get(path).copied()
}

/// Tables that switch a part of the model on; without the table its keys are not asked for.
const OPTIONAL_TABLES: &[&str] = &["friction", "thermal", "emission"];

/// The table without which the keys of a section are not asked for, if there is one.
pub(crate) fn optional_table(section: &str) -> Option<&'static str> {
    OPTIONAL_TABLES.iter().copied().find(|table| section == *table || is_below(section, table))
}

/// Whether keys live below this path.
pub fn is_table(path: &str) -> bool {
    path.is_empty() || BY_PATH.keys().any(|key| is_below(key, path))
}

/// Whether "none" takes what has this path out of a scene: a step of a preparation, be it a key or a table such as `crop`.
pub(crate) fn may_be_none(path: &str) -> bool {
    let is_step = |path: &str| path.rsplit_once('.').is_some_and(|(above, _)| above.ends_with(".prepare"));
    find(path).map_or_else(|| is_table(path) && is_step(path), Key::may_be_none)
}

/// Every table that directly holds keys, in the order of docs/scenes.md; the first is the top, with an empty name.
pub(crate) fn sections() -> Vec<&'static str> {
    let mut sections: Vec<_> = keys().iter().map(|key| key.section).collect();
    sections.dedup();
    sections
}

/// Whether `path` is a key of the table `table` or of a table in it.
pub(crate) fn is_below(path: &str, table: &str) -> bool {
    path.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'))
}

/// Path of a key of a table; the top table has the empty path.
pub(crate) fn join(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") }
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

    #[test]
    fn every_path_is_there_once_and_every_group_member_is_a_key_or_table() {
        let mut paths: Vec<_> = keys().iter().map(Key::path).collect();
        paths.sort();
        let count = paths.len();
        paths.dedup();
        assert_eq!(paths.len(), count);
        for group in GROUPS {
            for (member, companions) in group.members {
                let path = join(group.section, member);
                assert!(find(&path).is_some() || is_table(&path), "{path}");
                for companion in *companions {
                    assert!(find(&join(group.section, companion)).is_some(), "{companion}");
                }
            }
        }
    }
}
