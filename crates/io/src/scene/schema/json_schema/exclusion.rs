//! Of alternatives a scene file gives one.

use serde_json::{Map, Value, json};

use super::super::exclusions::{GROUPS, Group, MEANINGLESS, Meaningless};
use super::super::key::{Choose, join};
use super::super::ways::WAYS;

/// For each alternative of a table: the others are not there. An editor so marks the key that is one too many.
pub(super) fn table(path: &str) -> Map<String, Value> {
    let mut dependencies = Map::new();
    for names in GROUPS.iter().filter_map(|group| members(group, path)) {
        for name in &names {
            let others = names.iter().filter(|other| *other != name);
            let absent: Map<_, _> = others.map(|other| ((*other).to_owned(), Value::Bool(false))).collect();
            dependencies.insert((*name).to_owned(), json!({ "properties": absent }));
        }
    }
    for ways in WAYS.iter().filter(|ways| ways.section == path) {
        for name in ways.sets.concat() {
            let others = ways.other(name).unwrap_or_default().iter();
            let absent: Map<_, _> = others.map(|other| ((*other).to_owned(), Value::Bool(false))).collect();
            dependencies.insert(name.to_owned(), json!({ "properties": absent }));
        }
    }
    dependencies
}

/// That a key of this table is given with this value.
pub(super) fn chooses(table: &str, choose: Choose) -> Option<Value> {
    let name = choose.key.strip_prefix(table)?.strip_prefix('.')?;
    Some(json!({ "required": [name], "properties": { name: { "const": choose.value } } }))
}

/// For each value of a key that takes the meaning of others of this table: those are not there.
pub(super) fn meaningless(table: &str) -> Vec<Value> {
    let rule = |each: &Meaningless| {
        let name = each.key.strip_prefix(table)?.strip_prefix('.')?;
        Some(json!({ "if": chooses(table, each.beside)?, "then": { "properties": { name: false } } }))
    };
    MEANINGLESS.iter().filter_map(rule).collect()
}

/// The alternatives of a group by their names in this table, if they belong there.
pub(super) fn members(group: &Group, table: &str) -> Option<Vec<&'static str>> {
    group.members.iter().map(|(name, _)| name_in(table, group.section, name)).collect()
}

/// The last part of the path of a key, if the key is in this very table; for instance `hurst` of `synthetic.hurst`.
pub(super) fn name_in(table: &str, section: &str, name: &'static str) -> Option<&'static str> {
    let (parent, last) = match name.rsplit_once('.') {
        Some((inline, last)) => (join(section, inline), last),
        None => (section.to_owned(), name),
    };
    (parent == table).then_some(last)
}
