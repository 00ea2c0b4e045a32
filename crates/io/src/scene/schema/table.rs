//! The table of keys while it is put together.

use super::key::{Key, Kind, Need, Role};
use super::range::Range;
use crate::units::Dimension::Length;

/// Collects keys; `section` is the table to which the next ones belong, `role` what they change.
pub(super) struct Table {
    pub(super) keys: Vec<Key>,
    pub(super) section: &'static str,
    pub(super) role: Role,
}

impl Table {
    /// No keys; the first ones belong to the top of a scene.
    pub(super) fn new(role: Role) -> Self {
        Self { keys: Vec::new(), section: "", role }
    }

    /// Adds a key.
    pub(super) fn key(&mut self, name: &'static str, kind: Kind, need: Need, meaning: &'static str) -> &mut Key {
        let place = self.keys.len();
        self.keys.push(Key { section: self.section, name, kind, need, meaning, role: self.role });
        &mut self.keys[place]
    }
}

/// A length that the resolved scene has in this unit.
pub(super) const fn length(unit: &'static str, range: Range) -> Kind {
    Kind::Quantity { dimension: Length, unit, range }
}
