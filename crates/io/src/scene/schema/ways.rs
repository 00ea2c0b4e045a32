//! Ways to say the same with different keys of a table.

use super::key::{Need, join};
use super::lookup::find;

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
