//! The resolved scene as TOML: every key that has a value, in the order and the units of the schema.

use plateau_core::observe::Map;

use super::cycle_table::{CycleTable, Loads, Speeds};
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
        Setting::Numbers(numbers) => match key.kind {
            Kind::Lengths { unit, .. } => list(numbers, |length| units::format(*length, unit, Dimension::Length)),
            _ => list(numbers, |time| units::format(*time, "s", Dimension::Time)),
        },
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
        Some(Loads::NominalPressure(pressures)) => units::format(pressures[row], "Pa", Dimension::Pressure),
        Some(Loads::Force(forces)) => units::format(forces[row], "N", Dimension::Force),
        None => String::new(),
    };
    let speed = |row: usize| match &table.speeds {
        Some(Speeds::Sliding(speeds)) => units::format(speeds[row], "m/s", Dimension::Speed),
        Some(Speeds::Rotational(speeds)) => units::format(speeds[row], "rpm", Dimension::RotationalSpeed),
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
