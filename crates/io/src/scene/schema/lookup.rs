//! Keys and tables of a scene by their paths, and advice on keys that no scene has.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::key::{Key, Kind, Role, is_below, join};
use super::keys::all;
use crate::text::{nearest, short};

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
const OPTIONAL_TABLES: &[&str] = &["brake", "friction", "thermal", "emission"];

/// The table without which the keys of a section are not asked for, if there is one.
pub fn optional_table(section: &str) -> Option<&'static str> {
    OPTIONAL_TABLES.iter().copied().find(|table| section == *table || is_below(section, table))
}

/// Tells whether keys live below this path.
pub fn is_table(path: &str) -> bool {
    path.is_empty() || BY_PATH.keys().any(|key| is_below(key, path))
}

/// Tells whether "none" takes what has this path out of a scene: a step of a preparation, be it a key or a table such as `crop`.
pub fn may_be_none(path: &str) -> bool {
    let is_step = |path: &str| path.rsplit_once('.').is_some_and(|(above, _)| above.ends_with(".prepare"));
    find(path).map_or_else(|| is_table(path) && is_step(path), Key::may_be_none)
}

/// Every table that directly holds keys, in the order of docs/scenes.md; the first is the top, with an empty name.
pub(crate) fn sections() -> Vec<&'static str> {
    let mut sections: Vec<_> = keys().iter().map(|key| key.section).collect();
    sections.dedup();
    sections
}

/// Role of the key with this full path; of one that is not known (any more, or yet) what is simulated.
pub fn role(path: &str) -> Role {
    find(path).map_or(Role::Physics, |key| key.role)
}

/// Tells whether the key with this full path names a file whose content is read.
pub fn is_input(path: &str) -> bool {
    find(path).is_some_and(|key| key.kind == Kind::InputFile)
}

/// Keys that one may expect but that have no meaning where they stand: end of the path, why, what to use.
const EXPLAINED: &[(&str, &str)] = &[
    (
        "materials.pin_resin.specific_wear_rate",
        "resin has no specific wear rate, it loses a whole height at once when it touches: give wear_height",
    ),
    ("disc_primary.wear_height", ONLY_RESIN),
    ("disc_secondary.wear_height", ONLY_RESIN),
    ("pin_primary.wear_height", ONLY_RESIN),
    ("pin_secondary.wear_height", ONLY_RESIN),
];
const ONLY_RESIN: &str = "only materials.pin_resin loses a wear height: give specific_wear_rate";

/// Advice on the unknown key `name` in the table `table`.
pub(crate) fn unknown(table: &str, name: &str) -> String {
    let path = join(table, name);
    if let Some((_, why)) = EXPLAINED.iter().find(|(end, _)| path.ends_with(end)) {
        return format!("unknown key: {why}");
    }
    if find(name).is_some() {
        return "unknown key here, it belongs at the top, before the first table".to_owned();
    }
    if table.split('.').any(|part| part == name) {
        return format!("unknown key, keys below [{table}] stand without the name of the table before them");
    }
    // Columns of a cycle are called as the keys of other tables are.
    let is_known = |path: &str| find(path).is_some() || is_table(path);
    let tables = tables().into_iter().filter(|other| is_known(&join(other, name)) && !other.ends_with(".columns"));
    if let Some((first, more)) = of_the_same_body(table, tables.collect()).split_first() {
        let more: String = more.iter().map(|table| format!(" or [{table}]")).collect();
        return format!("unknown key here, it belongs in [{first}]{more}");
    }
    let siblings = children(table);
    if let Some(sibling) = nearest(name, siblings.iter().map(String::as_str)) {
        return format!("unknown key, did you mean \"{sibling}\"?");
    }
    let elsewhere = || keys().iter().filter(|key| !key.section.is_empty());
    let like = nearest(name, elsewhere().map(|key| key.name));
    if let Some(key) = elsewhere().find(|key| Some(key.name) == like) {
        return format!("unknown key, did you mean \"{}\" in [{}]?", key.name, key.section);
    }
    let place = if table.is_empty() { "a scene".to_owned() } else { format!("[{}]", short(table)) };
    format!("unknown key, {place} has {}", siblings.join(", "))
}

/// Of several tables those of the same body (disc, pin, ...) as `table`, if there are any.
fn of_the_same_body(table: &str, tables: Vec<String>) -> Vec<String> {
    let body = |table: &str| table.split('.').next().map(str::to_owned);
    let same: Vec<_> = tables.iter().filter(|other| body(other) == body(table)).cloned().collect();
    if same.is_empty() { tables } else { same }
}

/// Names directly below a table, in the order of docs/scenes.md.
pub fn children(table: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for path in keys().iter().map(Key::path) {
        let rest = if table.is_empty() {
            path.as_str()
        } else if is_below(&path, table) {
            &path[table.len() + 1..]
        } else {
            continue;
        };
        let name = rest.split('.').next().unwrap_or(rest);
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    names
}

/// Every table below the top, in the order of docs/scenes.md.
fn tables() -> Vec<String> {
    let mut tables: Vec<String> = Vec::new();
    for key in keys() {
        for table in [Some(key.section.to_owned()), key.inline_table()].into_iter().flatten() {
            if !table.is_empty() && !tables.contains(&table) {
                tables.push(table);
            }
        }
    }
    tables
}

#[cfg(test)]
#[path = "../../../tests/unit/scene/schema/lookup.rs"]
mod tests;
