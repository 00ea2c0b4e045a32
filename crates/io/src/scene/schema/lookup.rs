//! Keys and tables of a scene by their paths.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::key::{Key, Kind, Role, is_below};
use super::keys::all;

/// Every key, in the order of docs/scenes.md.
pub fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(all);
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

/// What changes with the key with this full path; of one that is not known (any more, or yet) what is simulated.
pub fn role(path: &str) -> Role {
    find(path).map_or(Role::Physics, |key| key.role)
}

/// Whether the key with this full path names a file whose content is read.
pub fn is_input(path: &str) -> bool {
    find(path).is_some_and(|key| key.kind == Kind::InputFile)
}

#[cfg(test)]
mod tests {
    use super::super::exclusions::GROUPS;
    use super::super::key::join;
    use super::*;

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
