//! Scenes as a JSON Schema, with which editors complete keys, explain them and mark mistakes while one writes.
//!
//! It is made from the table of keys and so says what the parser says, as far as a schema can: not what several keys
//! say together in numbers (radii, memory), nor what a scene inherits. A scene that extends another may therefore leave
//! out whatever it likes.

use std::path::Path;

use plateau_core::observe;
use plateau_io::scene::schema::{
    Choose, GROUPS, Group, Key, Kind, MEANINGLESS, Meaningless, Need, Range, WAYS, Ways, children, find, is_below,
    is_table, join, keys, may_be_none, optional_table,
};
use plateau_io::units::Dimension;
use serde_json::{Map, Value, json};

use super::units::{self, Sign};

/// The copy that scenes name in `#:schema`, for editors, and that `plateau schema` prints.
#[test]
fn the_schema_of_scenes_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/scene.schema.json");
    let text = format!("{:#}\n", document());
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, text).expect("a schema that can be written");
    } else {
        let found = std::fs::read_to_string(&path).expect("the schema");
        assert!(found == text, "data/scene.schema.json is out of date; UPDATE_DOCS=1 writes it anew");
    }
}

#[test]
fn every_table_of_the_keys_is_explained_and_no_other() {
    for path in keys().iter().map(Key::path) {
        for (end, _) in path.match_indices('.') {
            assert!(table_meaning(&path[..end]).is_some(), "{}", &path[..end]);
        }
    }
    for (path, _) in TABLES {
        assert!(is_table(path), "{path}");
    }
}

/// Path of every table and what it is for; the first is the top of a scene.
const TABLES: &[(&str, &str)] = &[
    ("", "a simulation of a pin on a coated disc"),
    ("mesh", "the ring that the pin slides on, and its cells"),
    ("operation", "load, speed and how long"),
    ("operation.cycle", "load and speed that change with time, see docs/drive.md"),
    (
        "operation.cycle.columns",
        "headers of a file that has others than those of docs/drive.md, which are then passed over",
    ),
    ("contact", "the elastic foundation that carries the load"),
    ("materials", "stiffness and wear of what touches"),
    ("materials.disc_primary", "the disc's coating"),
    ("materials.disc_secondary", "compacted debris on the disc"),
    ("materials.pin_primary", "the pin's fibres"),
    ("materials.pin_secondary", "compacted debris on the pin"),
    ("materials.pin_resin", "the pin between its fibres"),
    ("plateaus", "how wear debris becomes secondary plateaus"),
    ("brake", "the brake of whose pads the pin is a piece, with disc and pads as they are, see docs/drive.md"),
    ("friction", "friction of what touches, see docs/drive.md; without this table there is no friction"),
    ("friction.secondary", "where compacted debris has another friction"),
    ("friction.resin", "where resin has another friction"),
    ("thermal", "heat of friction and what it changes; needs [friction]"),
    ("thermal.disc", "the disc below its coating, and how it is cooled"),
    ("thermal.disc.coating", "the disc's coating, as heat sees it"),
    ("thermal.pin", "the pin as heat sees it"),
    ("emission", "how much of the debris that leaves the contact is airborne"),
    ("disc", "the disc's initial surface"),
    ("disc.surface", "where the disc's initial heights come from"),
    ("disc.surface.synthetic", "random heights with given statistics"),
    ("disc.prepare", "what is done to the disc's heights, in this order"),
    ("disc.prepare.crop", "the part of the heights that is kept"),
    ("disc.prepare.unroll", "makes arc length and radius of a sector of a ring that was measured in x and y"),
    ("pin", "the pin's fibres and initial surface"),
    ("pin.base", "where the pin has fibre and where resin"),
    ("pin.base.synthetic", "random fibres with given statistics"),
    ("pin.surface", "where the pin's initial heights come from; they grow away from the disc"),
    ("pin.surface.synthetic", "random heights with given statistics"),
    ("pin.prepare", "what is done to the pin's heights, in this order"),
    ("pin.prepare.crop", "the part of the heights that is kept"),
    ("pin.prepare.unroll", "makes arc length and radius of a sector of a ring that was measured in x and y"),
    ("numerics", "how time is stepped, and on how many cores"),
    ("numerics.time_acceleration", "acceleration that the run chooses itself, see docs/evidence/accuracy.md"),
    ("output", "the run file and what is written to it"),
];

/// Meaning of a table, in one line; `None` if no scene has it.
pub(super) fn table_meaning(path: &str) -> Option<&'static str> {
    TABLES.iter().find(|(known, _)| *known == path).map(|(_, meaning)| *meaning)
}

/// Lengths and times of the paper's baseline or of its kind, by the last name of the key.
const USUAL: &[(&str, &str)] = &[
    ("inner_radius", "20 mm"),
    ("outer_radius", "24 mm"),
    ("pin_diameter", "3 mm"),
    ("pin_width", "4 mm"),
    ("pin_length", "8 mm"),
    ("cell_size", "50 um"),
    ("mean_radius", "22 mm"),
    ("wear_height", "5 um"),
    ("pitch", "0.5 um"),
    ("height_range", "12 um"),
    ("rms_height", "3 um"),
    ("correlation_length", "120 um"),
    ("correlation_length_across", "40 um"),
    ("roll_off", "200 um"),
    ("short_cutoff", "20 um"),
    ("patch", "8 mm"),
    ("pixel", "10 um"),
    ("s_filter", "25 um"),
    ("l_filter", "2 mm"),
    ("cutoff", "3 um"),
    ("fibre_length", "400 um"),
    ("fibre_width", "100 um"),
    ("smooth", "25 um"),
    ("resin_recess", "8 um"),
    ("sample_every", "1 s"),
    ("checkpoint_every", "60 s"),
    ("shear_strength", "0.75 MPa"),
    ("thickness", "6 mm"),
    ("pad_area", "50 cm^2"),
    ("pad_thickness", "10 mm"),
    ("effective_radius", "115 mm"),
    ("wheel_radius", "310 mm"),
    ("piston_area", "25 cm^2"),
    ("coating.thickness", "60 um"),
    ("length", "12 mm"),
    ("area", "31 cm^2"),
];

/// Pairs of lengths, by the last name of the key.
const PAIRS: &[(&str, &str)] = &[
    ("along", "[\"1 mm\", \"9 mm\"]"),
    ("across", "[\"0.5 mm\", \"5 mm\"]"),
    ("centre", "[\"4 mm\", \"-20 mm\"]"),
    ("radii", "[\"20 mm\", \"24 mm\"]"),
];

/// A value as a scene may give it, in TOML, where a value's form has to be seen.
pub(super) fn example_of(key: &Key) -> Option<String> {
    let name = key.name.rsplit('.').next().unwrap_or(key.name);
    let usual = USUAL.iter().find(|(known, _)| *known == name).map(|(_, example)| *example);
    if let Some((_, pair)) = PAIRS.iter().find(|(known, _)| *known == name) {
        return Some((*pair).to_owned());
    }
    match key.kind {
        Kind::Quantity { dimension, .. } => Some(format!("\"{}\"", usual.unwrap_or(dimension.example()))),
        Kind::Lengths { single: true, .. } => usual.map(|length| format!("\"{length}\"")),
        Kind::Lengths { .. } => usual.map(|length| format!("[\"0 um\", \"{length}\"]")),
        Kind::LengthUnit => Some("\"um\"".to_owned()),
        Kind::Times => Some("[\"0 s\", \"500 s\"]".to_owned()),
        Kind::Rows => Some("[[\"0 s\", \"47 N\", \"850 rpm\"], [\"3 s\", \"47 N\", \"0 rpm\"]]".to_owned()),
        Kind::Factor => Some("[[\"230 degC\", 1.0], [\"400 degC\", 4.0]]".to_owned()),
        Kind::Maps => Some("[\"disc_height\", \"pressure\"]".to_owned()),
        _ => None,
    }
}

/// The JSON Schema (draft 7, the one that TOML plug-ins of editors read) of scene files.
fn document() -> Value {
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
    add(&mut schema, "dependencies", exclusions(path));
    add(&mut schema, "allOf", meaningless(path));
    schema
}

/// Adds a list or an object unless it is empty.
fn add(schema: &mut Map<String, Value>, name: &str, value: impl Into<Value>) {
    let value = value.into();
    if value != json!([]) && value != json!({}) {
        schema.insert(name.into(), value);
    }
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
    let mut exclude = |name: &str, others: &[&str]| {
        let absent: Map<_, _> = others.iter().map(|other| ((*other).to_owned(), Value::Bool(false))).collect();
        dependencies.insert(name.to_owned(), json!({ "properties": absent }));
    };
    for names in GROUPS.iter().filter_map(|group| members(group, path)) {
        for name in &names {
            exclude(name, &names.iter().copied().filter(|other| other != name).collect::<Vec<_>>());
        }
    }
    for ways in WAYS.iter().filter(|ways| ways.section == path) {
        ways.sets.concat().into_iter().for_each(|name| exclude(name, ways.other(name).unwrap_or_default()));
    }
    dependencies
}

/// That a key of this table is given with this value.
fn chooses(table: &str, choose: Choose) -> Option<Value> {
    let name = choose.key.strip_prefix(table)?.strip_prefix('.')?;
    Some(json!({ "required": [name], "properties": { name: { "const": choose.value } } }))
}

/// For each value of a key that takes the meaning of others of this table: those are not there.
fn meaningless(table: &str) -> Vec<Value> {
    let rule = |each: &Meaningless| {
        let name = each.key.strip_prefix(table)?.strip_prefix('.')?;
        Some(json!({ "if": chooses(table, each.beside)?, "then": { "properties": { name: false } } }))
    };
    MEANINGLESS.iter().filter_map(rule).collect()
}

/// The alternatives of a group by their names in this table, if they belong there.
fn members(group: &Group, table: &str) -> Option<Vec<&'static str>> {
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
    add(&mut schema, "required", required);
    add(&mut schema, "properties", properties);
    let mut choices = choices(path);
    choices.extend(unless(path));
    choices.extend(WAYS.iter().filter(|ways| ways.section == path).map(one_way));
    add(&mut schema, "allOf", choices);
    add(&mut schema, "dependencies", companions(path));
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
    let alternatives = of_table.filter_map(|key| {
        let Need::RequiredUnless(choose, _) = key.need else { return None };
        Some(json!({ "anyOf": [{ "required": [key.name] }, chooses(path, choose)?] }))
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
fn key(key: &Key) -> Map<String, Value> {
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
    if let Some(example) = example_of(key).and_then(|example| from_toml(&example)) {
        schema.insert("examples".into(), json!([example]));
    }
    schema
}

fn kind(kind: Kind) -> Value {
    match kind {
        Kind::Quantity { dimension, range, .. } => quantity(dimension, range),
        Kind::Lengths { single, range, .. } => {
            let one = quantity(Dimension::Length, range);
            let list = json!({ "type": "array", "items": one, "minItems": 2, "maxItems": 2 });
            if single { json!({ "anyOf": [one, list] }) } else { list }
        }
        Kind::LengthUnit => json!({ "type": "string", "pattern": units::length_unit() }),
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
        Kind::Maps => json!({ "type": "array", "items": { "enum": observe::Map::CHOICES.map(observe::Map::name) } }),
    }
}

fn quantity(dimension: Dimension, range: Range) -> Value {
    let sign = match range {
        Range { low: 0.0, low_included: false, .. } => Sign::Positive,
        Range { low: 0.0, .. } => Sign::NotNegative,
        _ => Sign::Any,
    };
    json!({ "type": "string", "pattern": units::quantity(dimension, sign) })
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
    let sentences = [Some(key.meaning.to_owned()), units_of(key.kind), range(key.kind), absent(key)];
    let sentences: Vec<_> = sentences.into_iter().flatten().collect();
    format!("{}.", sentences.join(". "))
}

fn units_of(kind: Kind) -> Option<String> {
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
