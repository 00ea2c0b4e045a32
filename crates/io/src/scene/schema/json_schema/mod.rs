//! Scenes as a JSON Schema, with which editors complete keys, explain them and mark mistakes while one writes.
//!
//! It is made from the table of keys and so says what the parser says, as far as a schema can: not what several keys
//! say together in numbers (radii, memory), nor what a scene inherits. A scene that extends another may therefore leave
//! out whatever it likes.

mod complete;
mod description;
mod exclusion;
mod value;

use serde_json::{Map, Value, json};

use super::key::join;
use super::lookup::{find, is_table, may_be_none};
use super::suggest::children;
use super::tables::table_meaning;

/// The JSON Schema (draft 7, the one that TOML plug-ins of editors read) of scene files.
pub fn document() -> Value {
    let mut document = Map::new();
    document.insert("$schema".into(), "http://json-schema.org/draft-07/schema#".into());
    document.insert("title".into(), "Scene of Plateau".into());
    document.extend(table(""));
    document.insert("if".into(), json!({ "required": ["extends"] }));
    document.insert("else".into(), complete::table("").into());
    document.into()
}

/// What a table may hold: its keys and no others, alternatives one at a time.
fn table(path: &str) -> Map<String, Value> {
    let properties = children(path).into_iter().map(|name| {
        let below = join(path, &name);
        (name, property(&below))
    });
    let mut schema = Map::new();
    schema.insert("type".into(), "object".into());
    schema.insert("description".into(), table_meaning(path).unwrap_or_default().into());
    schema.insert("properties".into(), properties.collect::<Map<_, _>>().into());
    schema.insert("additionalProperties".into(), false.into());
    let exclusions = exclusion::table(path);
    if !exclusions.is_empty() {
        schema.insert("dependencies".into(), exclusions.into());
    }
    let meaningless = exclusion::meaningless(path);
    if !meaningless.is_empty() {
        schema.insert("allOf".into(), meaningless.into());
    }
    schema
}

/// A key, a table, or what may be either.
fn property(path: &str) -> Value {
    let key = find(path).map(value::key);
    match key {
        Some(key) if is_table(path) => json!({ "anyOf": [key, table(path)] }),
        Some(key) => key.into(),
        None if may_be_none(path) => json!({ "anyOf": [table(path), { "const": "none" }] }),
        None => table(path).into(),
    }
}
