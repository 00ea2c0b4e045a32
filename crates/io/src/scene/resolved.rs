//! Resolved scene as TOML: every key that has a value, in the order and the units of the schema; and the differences of two such scenes.

use std::collections::{BTreeMap, BTreeSet};

use plateau_core::observe::Map;
use toml::{Table, Value};

use super::cycle_table::{CycleTable, DiscSpeed, Load};
use super::interpret::Setting;
use super::schema::{self, Key, Kind};
use super::settings::Settings;
use crate::units::{self, Dimension};

/// Writes a scene that reads back as the same settings, and needs neither the scenes it extended nor `--set`.
pub(super) fn write(settings: &Settings) -> String {
    let mut text = String::new();
    let mut section = "";
    for key in schema::keys() {
        let Some(setting) = settings.get(&key.path()) else { continue };
        if key.section != section {
            section = key.section;
            text.push_str(&format!("\n[{section}]\n"));
        }
        text.push_str(&format!("{} = {}\n", key.name, value(key, setting)));
    }
    text
}

fn value(key: &Key, setting: &Setting) -> String {
    match setting {
        Setting::Number(number) => match key.kind {
            Kind::Quantity { dimension, unit, .. } => string(&units::format(*number, unit, dimension)),
            Kind::LengthUnit => string(&units::format(*number, "m", Dimension::Length)),
            _ => format!("{number:?}"),
        },
        Setting::Integer(integer) => integer.to_string(),
        Setting::Bool(value) => value.to_string(),
        Setting::Text(text) => string(text),
        Setting::Pair(lengths) => {
            let unit = if let Kind::Lengths { unit, .. } = key.kind { unit } else { "m" };
            list(lengths, |length| units::format(*length, unit, Dimension::Length))
        }
        Setting::Times(times) => list(times, |time| units::format(*time, "s", Dimension::Time)),
        Setting::Rows(table) => rows(table),
        Setting::Factor(factor) => {
            let row = |(temperature, factor): &(f64, f64)| {
                format!("[{}, {factor:?}]", string(&units::format(*temperature, "degC", Dimension::Temperature)))
            };
            format!("[{}]", factor.points().iter().map(row).collect::<Vec<_>>().join(", "))
        }
        Setting::Maps(maps) => list(maps, |map: &Map| map.name().to_owned()),
    }
}

/// Rows of a cycle, in SI units.
fn rows(table: &CycleTable) -> String {
    let load = |row: usize| match &table.loads {
        Some((Load::NominalPressure, pressures)) => units::format(pressures[row], "Pa", Dimension::Pressure),
        Some((Load::BrakingTorque, torques)) => units::format(torques[row], "N m", Dimension::Torque),
        Some((Load::Force, forces)) => units::format(forces[row], "N", Dimension::Force),
        // Rows of a scene have a load, and none of the whole brake.
        Some((Load::BrakeTorque | Load::BrakePressure, _)) | None => String::new(),
    };
    let speed = |row: usize| match &table.speeds {
        Some((DiscSpeed::Sliding, speeds)) => units::format(speeds[row], "m/s", Dimension::Speed),
        Some((DiscSpeed::Rotational, speeds)) => units::format(speeds[row], "rpm", Dimension::RotationalSpeed),
        None => String::new(),
    };
    let row = |row: usize| {
        list(&[units::format(table.times[row], "s", Dimension::Time), load(row), speed(row)], String::clone)
    };
    format!("[{}]", (0..table.times.len()).map(row).collect::<Vec<_>>().join(", "))
}

fn list<T>(elements: &[T], text: impl Fn(&T) -> String) -> String {
    let elements: Vec<_> = elements.iter().map(|element| string(&text(element))).collect();
    format!("[{}]", elements.join(", "))
}

fn string(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A key that two scenes do not give alike.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// Full path of the key, such as `operation.normal_force`.
    pub key: String,
    /// Its value in the first scene, as TOML; none if the scene does not have it.
    pub first: Option<String>,
    /// Its value in the second scene.
    pub second: Option<String>,
}

/// The keys that two resolved scenes do not give alike, in the order of the alphabet. A text that is no TOML counts as a
/// scene without keys.
pub fn differences(first: &str, second: &Table) -> Vec<Difference> {
    let [first, second] = [values(&first.parse().unwrap_or_default()), values(second)];
    let keys: BTreeSet<&String> = first.keys().chain(second.keys()).collect();
    let text = |value: Option<&Value>| value.map(Value::to_string);
    let differences = keys.into_iter().map(|key| Difference {
        key: key.clone(),
        first: text(first.get(key)),
        second: text(second.get(key)),
    });
    differences.filter(|difference| difference.first != difference.second).collect()
}

/// A key that had another name when older scenes were resolved, and its present name.
const FORMER_NAME: [&str; 2] = ["plateaus.debris_pool", "plateaus.debris"];

/// The value of every key of a resolved scene, by the key's full path and present name.
pub fn values(scene: &Table) -> BTreeMap<String, Value> {
    let mut found = BTreeMap::new();
    let mut open = vec![(String::new(), scene)];
    while let Some((above, table)) = open.pop() {
        for (name, value) in table {
            let path = schema::join(&above, name);
            match value {
                Value::Table(table) => open.push((path, table)),
                value if path == FORMER_NAME[0] => drop(found.insert(FORMER_NAME[1].to_owned(), value.clone())),
                value => drop(found.insert(path, value.clone())),
            }
        }
    }
    found
}

#[cfg(test)]
#[path = "../../tests/unit/scene/resolved.rs"]
mod tests;
