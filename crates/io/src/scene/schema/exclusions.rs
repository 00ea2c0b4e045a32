//! Keys that exclude each other, keys that have no meaning beside a value of another, and ways to say the same with different keys of a
//! table.

use super::key::{Choose, Key, Need, join};
use super::keys::{self, BRAKING_TORQUE, CYCLE, CYCLE_COLUMNS, DEBRIS_IS_LOCAL};
use super::lookup::find;

/// Alternatives, each with the keys that have a meaning only beside it.
type Members = &'static [(&'static str, &'static [&'static str])];

/// Keys of which a scene gives exactly one, or at most one.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    /// Table they belong to.
    pub section: &'static str,
    /// The alternatives.
    pub members: Members,
    /// Tells whether one must be given.
    pub required: bool,
    /// Full path of a table beside which none must be given all the same.
    pub unless: Option<&'static str>,
}

impl Group {
    /// Tells whether one is to be chosen at all: alternatives in an inline table mean nothing where that is not given.
    pub fn applies(&self, given: impl Fn(&str) -> bool) -> bool {
        self.members
            .iter()
            .all(|(name, _)| name.rsplit_once('.').is_none_or(|(table, _)| given(&join(self.section, table))))
    }

    /// Tells whether one must be given in a scene that has these tables.
    pub fn is_required(&self, given: impl Fn(&str) -> bool) -> bool {
        self.required && !self.unless.is_some_and(given)
    }

    /// Tells whether this name is one of the alternatives.
    fn has(&self, name: &str) -> bool {
        self.members.iter().any(|(member, _)| *member == name)
    }

    /// The alternatives as a list: `file, synthetic, flat`.
    pub fn names(&self) -> String {
        self.members.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    }
}

const HEIGHT_SOURCES: Members = &[("file", FILE), ("synthetic", &[]), ("flat", &[])];
const FILE: &[&str] = &["dataset", "at", "unit", "pitch", "height_range", "decimal", "skip", "profile_lay"];
const IMAGE: &[&str] =
    &["threshold", "pixel", "smooth", "despeckle", "rotate", "fibres", "repeat", "extend", "extend_seed"];

const TEXTURES: Members = &[
    ("synthetic.correlation_length", &["synthetic.correlation_length_across"]),
    ("synthetic.roll_off", &["synthetic.hurst", "synthetic.short_cutoff"]),
];

/// Alternatives where a patch or a picture is smaller than ring or pin.
const BEYOND_THE_PATCH: Members = &[("repeat", &[]), ("extend", &["extend_seed"])];

const fn one_of(section: &'static str, members: Members) -> Group {
    Group { section, members, required: true, unless: None }
}

const fn at_most_one_of(section: &'static str, members: Members) -> Group {
    Group { required: false, ..one_of(section, members) }
}

/// Keys of the operation of which one is given where there is no cycle.
const fn without_cycle(members: Members) -> Group {
    Group { unless: Some(CYCLE), ..one_of("operation", members) }
}

/// Keys that exclude each other.
pub const GROUPS: &[Group] = &[
    without_cycle(&[("normal_force", &[]), (BRAKING_TORQUE, &[])]),
    without_cycle(&[("rotational_speed", &[]), ("sliding_speed", &[])]),
    without_cycle(&[("duration", &[]), ("steps", &[])]),
    one_of("operation", &[("cycle.file", CYCLE_COLUMNS), ("cycle.points", &[])]),
    one_of("disc.surface", HEIGHT_SOURCES),
    one_of("disc.surface", TEXTURES),
    at_most_one_of("disc.prepare", BEYOND_THE_PATCH),
    one_of("pin.base", &[("synthetic", &[]), ("image", IMAGE), ("file", &["dataset"]), ("uniform", &[])]),
    at_most_one_of("pin.base", BEYOND_THE_PATCH),
    one_of("pin.surface", HEIGHT_SOURCES),
    one_of("pin.surface", TEXTURES),
    at_most_one_of("pin.prepare", BEYOND_THE_PATCH),
    at_most_one_of("output", &[("sample_every", &[]), ("sample_every_steps", &[])]),
    at_most_one_of("plateaus", &[("debris", &[]), ("debris_pool", &[])]),
];

impl Key {
    /// The group of alternatives of which the key is one.
    pub fn group(&self) -> Option<&'static Group> {
        GROUPS.iter().find(|group| group.section == self.section && group.has(self.name))
    }
}

/// A key that has no meaning beside a value of another, and why.
#[derive(Debug, Clone, Copy)]
pub struct Meaningless {
    /// The value that takes its meaning.
    pub beside: Choose,
    /// Full path of the key.
    pub key: &'static str,
    /// Effect of the value instead.
    pub reason: &'static str,
}

/// Keys that have no meaning beside a value of another key.
pub const MEANINGLESS: &[Meaningless] = &[
    Meaningless { beside: keys::PIN_IS_ROUND, key: "mesh.pin_length", reason: "a round pin is as long as it is wide" },
    Meaningless {
        beside: keys::PIN_IS_A_RECTANGLE,
        key: "mesh.pin_diameter",
        reason: "a rectangle covers all rows and pin_columns",
    },
    Meaningless {
        beside: DEBRIS_IS_LOCAL,
        key: "plateaus.pad_share",
        reason: "local debris goes to the pin up to the plateau ahead and then to the disc",
    },
    Meaningless {
        beside: DEBRIS_IS_LOCAL,
        key: "plateaus.destruction",
        reason: "with local debris no plateau falls for want of support, it goes when it is worn through",
    },
];

/// All of them.
pub const WAYS: &[Ways] = &[Ways {
    section: "mesh",
    sets: [
        &["inner_radius", "outer_radius", "rows", "disc_columns", "pin_columns", "pin_diameter"],
        &["pin_width", "pin_length", "cell_size", "mean_radius"],
    ],
}];

/// Ways to say the same with different keys of a table: a scene keeps to one of them.
#[derive(Debug, Clone, Copy)]
pub struct Ways {
    /// Table they belong to.
    pub section: &'static str,
    /// The keys of each way.
    pub sets: [&'static [&'static str]; 2],
}

impl Ways {
    /// The keys of a way of which any is given; of both, the first. Where none is given, nothing.
    pub fn chosen(&self, given: impl Fn(&str) -> bool) -> Option<&'static [&'static str]> {
        self.sets.into_iter().find(|set| set.iter().any(|name| given(&join(self.section, name))))
    }

    /// The other way than that of this key, if the key is of one.
    pub fn other(&self, name: &str) -> Option<&'static [&'static str]> {
        let [first, second] = self.sets;
        if first.contains(&name) { Some(second) } else { second.contains(&name).then_some(first) }
    }

    /// The keys of a way that must be given with it, whatever others say.
    pub fn required(&self, set: &'static [&'static str]) -> impl Iterator<Item = &'static str> {
        let section = self.section;
        let need = move |name: &str| find(&join(section, name)).map(|key| key.need);
        set.iter().copied().filter(move |name| matches!(need(name), Some(Need::OfWay(_))))
    }
}
