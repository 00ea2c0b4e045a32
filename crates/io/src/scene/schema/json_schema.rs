//! Scenes as a JSON Schema, with which editors complete keys, explain them and mark mistakes while one writes.
//!
//! It is made from the table of keys and so says what the parser says, as far as a schema can: not what several keys
//! say together in numbers (radii, memory), nor what a scene inherits. A scene that extends another may therefore leave
//! out whatever it likes.

use plateau_core::observe;
use serde_json::{Map, Value, json};

use super::exclusions::{GROUPS, Group, MEANINGLESS, Meaningless, WAYS, Ways};
use super::key::{Choose, Key, Kind, Need, Range, is_below, join};
use super::lookup::{children, find, is_table, keys, may_be_none, optional_table, table_meaning};
use crate::units::Dimension;
use crate::units::pattern::{self, Sign};

/// The JSON Schema (draft 7, the one that TOML plug-ins of editors read) of scene files.
pub fn document() -> Value {
    let mut document = Map::new();
    document.insert("$schema".into(), "http://json-schema.org/draft-07/schema#".into());
    document.insert("title".into(), "Scene of Plateau".into());
    document.extend(table(""));
    document.insert("if".into(), json!({ "required": ["extends"] }));
    document.insert("else".into(), complete("").into());
    document.into()
}

/// Content of a table: its keys and no others, alternatives one at a time.
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
    let exclusions = exclusions(path);
    if !exclusions.is_empty() {
        schema.insert("dependencies".into(), exclusions.into());
    }
    let meaningless = meaningless(path);
    if !meaningless.is_empty() {
        schema.insert("allOf".into(), meaningless.into());
    }
    schema
}

/// A key, a table, or what may be either.
fn property(path: &str) -> Value {
    let key = find(path).map(key);
    match key {
        Some(key) if is_table(path) => json!({ "anyOf": [key, table(path)] }),
        Some(key) => key.into(),
        None if may_be_none(path) => json!({ "anyOf": [table(path), { "const": "none" }] }),
        None => table(path).into(),
    }
}

/// For each alternative of a table: the others are not there. An editor so marks the key that is one too many.
fn exclusions(path: &str) -> Map<String, Value> {
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
fn name_in(table: &str, section: &str, name: &'static str) -> Option<&'static str> {
    let (parent, last) = match name.rsplit_once('.') {
        Some((inline, last)) => (join(section, inline), last),
        None => (section.to_owned(), name),
    };
    (parent == table).then_some(last)
}

/// Content that must be in a table, and in the tables in it.
fn complete(path: &str) -> Map<String, Value> {
    let (mut required, mut properties) = (Vec::new(), Map::new());
    for name in children(path) {
        let child = join(path, &name);
        if find(&child).is_some_and(|key| key.need == Need::Required) {
            required.push(name);
        } else if is_table(&child) {
            let below = complete(&child);
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

/// Tells whether a table holds anything that is required, but for tables that are themselves a choice.
fn is_needed(path: &str) -> bool {
    let in_it = |section: &str| section == path || is_below(section, path);
    let is_required = |key: &Key| matches!(key.need, Need::Required | Need::RequiredUnless(..) | Need::OfWay(_));
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

/// Values of a key, its meaning, and its value when it is absent.
pub(super) fn key(key: &Key) -> Map<String, Value> {
    let mut schema = Map::new();
    schema.insert("description".into(), description(key).into());
    let one = kind(key.kind);
    let kind = if key.may_be_none() { json!({ "anyOf": [one, { "const": "none" }] }) } else { one };
    if let Value::Object(kind) = kind {
        schema.extend(kind);
    }
    if key.path() == "version" {
        schema.insert("maximum".into(), 1.into());
    }
    if let Need::Default(default) = key.need
        && let Some(default) = from_toml(default)
    {
        schema.insert("default".into(), default);
    }
    if let Some(example) = key.example().and_then(|example| from_toml(&example)) {
        schema.insert("examples".into(), json!([example]));
    }
    schema
}

fn kind(kind: Kind) -> Value {
    match kind {
        Kind::Quantity { dimension, range, .. } => quantity(dimension, range),
        Kind::Lengths { count, single, range, .. } => {
            let one = quantity(Dimension::Length, range);
            let list = json!({ "type": "array", "items": one, "minItems": count, "maxItems": count });
            if single { json!({ "anyOf": [one, list] }) } else { list }
        }
        Kind::LengthUnit => json!({ "type": "string", "pattern": pattern::length_unit() }),
        Kind::Number(range) => number(range),
        Kind::NumberOr(range, word) => json!({ "anyOf": [number(range), { "const": word }] }),
        Kind::Integer(least) => integer(least),
        Kind::CountOr(word) => json!({ "anyOf": [integer(1), { "const": word }] }),
        Kind::Bool => json!({ "type": "boolean" }),
        Kind::True => json!({ "const": true }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Text | Kind::InputFile => json!({ "type": "string", "pattern": r"\S" }),
        Kind::Times => json!({ "type": "array", "items": quantity(Dimension::Time, Range::NOT_NEGATIVE) }),
        Kind::Rows => {
            let of = |dimension| quantity(dimension, Range::NOT_NEGATIVE);
            let any = |dimensions: &[Dimension]| json!({ "anyOf": dimensions.iter().map(|each| of(*each)).collect::<Vec<_>>() });
            let row = json!([
                of(Dimension::Time),
                any(&[Dimension::Force, Dimension::Pressure, Dimension::Torque]),
                any(&[Dimension::RotationalSpeed, Dimension::Speed]),
            ]);
            json!({ "type": "array", "minItems": 2, "items": { "type": "array", "items": row, "minItems": 3, "maxItems": 3 } })
        }
        Kind::Factor => {
            let row = json!([quantity(Dimension::Temperature, Range::POSITIVE), number(Range::NOT_NEGATIVE)]);
            json!({ "type": "array", "minItems": 1, "items": { "type": "array", "items": row, "minItems": 2, "maxItems": 2 } })
        }
        Kind::Maps => {
            json!({ "type": "array", "items": { "enum": observe::Map::CHOICES.map(observe::Map::name) } })
        }
    }
}

fn quantity(dimension: Dimension, range: Range) -> Value {
    let sign = match range {
        Range { low: 0.0, low_included: false, .. } => Sign::Positive,
        Range { low: 0.0, .. } => Sign::NotNegative,
        _ => Sign::Any,
    };
    json!({ "type": "string", "pattern": pattern::quantity(dimension, sign) })
}

fn integer(least: u64) -> Value {
    json!({ "type": "integer", "minimum": least, "maximum": u64::MAX })
}

fn number(range: Range) -> Value {
    let mut schema = Map::new();
    schema.insert("type".into(), "number".into());
    let bounds = [
        (range.low, if range.low_included { "minimum" } else { "exclusiveMinimum" }),
        (range.high, if range.high_included { "maximum" } else { "exclusiveMaximum" }),
    ];
    for (bound, word) in bounds.into_iter().filter(|(bound, _)| bound.is_finite()) {
        schema.insert(word.into(), bound.into());
    }
    schema.into()
}

fn from_toml(text: &str) -> Option<Value> {
    let value: toml::Value = format!("value = {text}").parse::<toml::Table>().ok()?.remove("value")?;
    serde_json::to_value(value).ok()
}

/// Meaning, units, range, and what happens when the key is absent.
fn description(key: &Key) -> String {
    let sentences = [Some(key.meaning.to_owned()), units(key.kind), range(key.kind), absent(key)];
    let sentences: Vec<_> = sentences.into_iter().flatten().collect();
    format!("{}.", sentences.join(". "))
}

fn units(kind: Kind) -> Option<String> {
    let dimension = match kind {
        Kind::Quantity { dimension, .. } => dimension,
        Kind::Lengths { .. } | Kind::LengthUnit => Dimension::Length,
        Kind::Times => Dimension::Time,
        _ => return None,
    };
    Some(format!("Units: {}", dimension.units()))
}

fn range(kind: Kind) -> Option<String> {
    let range = match kind {
        Kind::Quantity { range, .. } | Kind::Lengths { range, .. } => range,
        Kind::Number(range) | Kind::NumberOr(range, _) => range,
        _ => return None,
    };
    (range != Range::ANY).then(|| format!("Range: {range}"))
}

fn absent(key: &Key) -> Option<String> {
    match key.need {
        Need::Required => Some("Required".to_owned()),
        Need::Default(default) => Some(format!("Default: {default}")),
        Need::SameAs(table) => Some(format!("Default: as in [{table}]")),
        Need::Computed(what) => Some(format!("Default: {}", what.replace('`', ""))),
        Need::RequiredUnless(choose, default) => {
            Some(format!("Required; default with {} = \"{}\": {default}", choose.key, choose.value))
        }
        Need::OneOf => key.group().map(|group| {
            let count = match group.unless {
                Some(table) => format!("Without [{table}] one of"),
                None if group.required => "One of".to_owned(),
                None => "At most one of".to_owned(),
            };
            format!("{count} {}", group.names())
        }),
        Need::OfWay(unless) => {
            let but = unless.map(|choose| format!(", but for {} = \"{}\"", choose.key, choose.value));
            Some(format!("Required with the keys beside which it stands{}", but.unwrap_or_default()))
        }
        Need::Optional if key.may_be_none() => Some("With \"none\" it is not done, as without the key".to_owned()),
        Need::Optional => None,
    }
}
