//! What a scene that extends no other must say.

use serde_json::{Map, Value, json};

use super::super::exclusions::{GROUPS, Group};
use super::super::key::{Key, Need, is_below, join};
use super::super::lookup::{find, is_table, keys, optional_table};
use super::super::suggest::children;
use super::super::ways::{WAYS, Ways};
use super::exclusion::{chooses, members, name_in};

/// What must be in a table, and in the tables in it.
pub(super) fn table(path: &str) -> Map<String, Value> {
    let (mut required, mut properties) = (Vec::new(), Map::new());
    for name in children(path) {
        let child = join(path, &name);
        if find(&child).is_some_and(|key| key.need == Need::Required) {
            required.push(name);
        } else if is_table(&child) {
            let below = table(&child);
            if below.is_empty() {
                continue;
            }
            if is_needed(&child) && optional_table(&child) != Some(child.as_str()) {
                required.push(name.clone());
            }
            properties.insert(name, below.into());
        }
    }

    let mut schema = Map::new();
    if !required.is_empty() {
        schema.insert("required".into(), required.into());
    }
    if !properties.is_empty() {
        schema.insert("properties".into(), properties.into());
    }
    let mut choices = choices(path);
    choices.extend(unless(path));
    choices.extend(WAYS.iter().filter(|ways| ways.section == path).map(one_way));
    if !choices.is_empty() {
        schema.insert("allOf".into(), choices.into());
    }
    let companions = companions(path);
    if !companions.is_empty() {
        schema.insert("dependencies".into(), companions.into());
    }
    schema
}

/// Whether a table holds anything that is required, but for tables that are themselves a choice.
fn is_needed(path: &str) -> bool {
    let in_it = |section: &str| section == path || is_below(section, path);
    let is_required = |key: &Key| {
        matches!(key.need, Need::Required | Need::RequiredUnless(..) | Need::RequiredWithout(_) | Need::OfWay(_))
    };
    let is_asked_for =
        |key: &Key| optional_table(key.section).is_none_or(|table| in_it(table) || is_below(path, table));
    let key = |key: &Key| is_required(key) && key.inline_table().is_none() && in_it(key.section) && is_asked_for(key);
    let group = |group: &Group| {
        let plain = group.members.iter().all(|(name, _)| !name.contains('.'));
        group.required && plain && in_it(group.section)
    };
    keys().iter().any(key) || GROUPS.iter().any(group)
}

/// One of each group is given.
fn choices(path: &str) -> Vec<Value> {
    let one = |name: &str| json!({ "required": [name] });
    let groups = GROUPS.iter().filter(|group| group.required).filter_map(|group| {
        let beside = group.unless.and_then(|table| table.strip_prefix(path)?.strip_prefix('.'));
        Some(members(group, path)?.into_iter().chain(beside))
    });
    groups.map(|names| json!({ "anyOf": names.map(one).collect::<Vec<_>>() })).collect()
}

/// Keys that are required unless another of the table has a certain value.
fn unless(path: &str) -> Vec<Value> {
    let of_table = keys().iter().filter(|key| key.section == path);
    let alternatives = of_table.filter_map(|key| match key.need {
        Need::RequiredUnless(choose, _) => {
            Some(json!({ "anyOf": [{ "required": [key.name] }, chooses(path, choose)?] }))
        }
        Need::RequiredWithout(table) => {
            let table = table.strip_prefix(path)?.strip_prefix('.')?;
            Some(json!({ "anyOf": [{ "required": [key.name] }, { "required": [table] }] }))
        }
        _ => None,
    });
    alternatives.collect()
}

/// All that one of several ways needs is given.
fn one_way(ways: &Ways) -> Value {
    let all = |set| {
        let each = ways.required(set).map(|name| match find(&join(ways.section, name)).map(|key| key.need) {
            Some(Need::OfWay(Some(choose))) => {
                json!({ "anyOf": [{ "required": [name] }, chooses(ways.section, choose)] })
            }
            _ => json!({ "required": [name] }),
        });
        json!({ "allOf": each.collect::<Vec<_>>() })
    };
    json!({ "anyOf": ways.sets.map(all) })
}

/// Keys that have a meaning only beside an alternative, each with that alternative.
fn companions(path: &str) -> Map<String, Value> {
    let mut dependencies: Map<String, Value> = Map::new();
    for group in GROUPS {
        for (member, companions) in group.members {
            let Some(member) = name_in(path, group.section, member) else { continue };
            for companion in companions.iter().filter_map(|name| name_in(path, group.section, name)) {
                dependencies.insert(companion.into(), json!([member]));
            }
        }
    }
    dependencies
}
