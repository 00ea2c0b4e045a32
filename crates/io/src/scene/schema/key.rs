//! A key of a scene: where it belongs, what it holds, what happens without it, and what changes with it.

use super::range::Range;
use crate::units::Dimension;

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

/// Whether `path` is a key of the table `table` or of a table in it.
pub(crate) fn is_below(path: &str, table: &str) -> bool {
    path.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'))
}

/// Path of a key of a table; the top table has the empty path.
pub(crate) fn join(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") }
}
