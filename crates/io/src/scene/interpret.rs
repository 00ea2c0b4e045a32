//! Single values: of the type that their key asks for, in SI units, in range; and rows of a cycle or of a factor over temperature.

use std::path::Path;

use plateau_core::model::thermal::{Factor, FactorError};
use plateau_core::observe::Map;

use super::cycle_table::{CycleTable, DiscSpeed, Load};
use super::error::{Origin, Problem};
use super::schema::{Kind, Range};
use crate::scene::layers::{Entry, Value};
use crate::text::{nearest, odd_character, short, too_long};
use crate::units;
use crate::units::Dimension::{self, Force, Pressure, RotationalSpeed, Speed, Time, Torque};

/// Puts the place of an entry beside a message.
pub(super) fn at(entry: &Entry) -> impl Fn(String) -> (Origin, String) {
    |message| (entry.origin.clone(), message)
}

/// A quantity with its unit, in SI units.
pub(super) fn quantity(value: &Value, dimension: Dimension, range: Range) -> Result<f64, String> {
    let number = match value {
        Value::Text(text) => units::parse(text, dimension)?,
        Value::Integer(_) | Value::Float(_) => {
            return Err(units::no_unit(value.text(), dimension));
        }
        _ => return Err(format!("{value}, expected {dimension}")),
    };
    if range.contains(number) {
        Ok(number)
    } else {
        Err(format!("{} is out of range, expected {range} {}", value.text(), dimension.si_unit()))
    }
}

/// A plain number, in range.
pub(super) fn number(value: &Value, range: Range) -> Result<f64, String> {
    let number = match value {
        Value::Integer(integer) => *integer as f64,
        Value::Float(float) => *float,
        _ => return Err(format!("{value}, expected a number, {range}")),
    };
    if range.contains(number) { Ok(number) } else { Err(format!("{} is out of range, expected {range}", value.text())) }
}

/// Rows of time, load and speed as a scene gives them.
fn cycle_rows(list: &[Entry]) -> Result<CycleTable, (Origin, String)> {
    let (mut times, mut loads, mut speeds, mut places) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut kinds = None;
    for entry in list {
        let Value::Array(row) = &entry.value else {
            return Err(at(entry)(format!("{}, expected a row such as [\"0 s\", \"47 N\", \"850 rpm\"]", entry.value)));
        };
        let [time, load, speed] = row.as_slice() else {
            return Err(at(entry)(format!("a row of {} values, expected three: time, load, speed", row.len())));
        };
        let value = |entry: &Entry, dimension| quantity(&entry.value, dimension, Range::NOT_NEGATIVE);
        times.push(value(time, Time).map_err(at(time))?);
        let (kind_of_load, load_value) = match (value(load, Force), value(load, Pressure), value(load, Torque)) {
            (_, Ok(pressure), _) => (Load::NominalPressure, pressure),
            (_, _, Ok(torque)) => (Load::BrakingTorque, torque),
            // A torque, but none that can be.
            (_, _, Err(error)) if quantity(&load.value, Torque, Range::ANY).is_ok() => return Err(at(load)(error)),
            (force, ..) => (Load::Force, force.map_err(at(load))?),
        };
        let (kind_of_speed, speed_value) = match (value(speed, RotationalSpeed), value(speed, Speed)) {
            (_, Ok(slide)) => (DiscSpeed::Sliding, slide),
            (rotation, Err(_)) => (DiscSpeed::Rotational, rotation.map_err(at(speed))?),
        };
        let (above_load, above_speed) = *kinds.get_or_insert((kind_of_load, kind_of_speed));
        if kind_of_load != above_load {
            let message = "a load of another kind than in the rows above: give forces, pressures or braking torques";
            return Err(at(load)(message.to_owned()));
        }
        if kind_of_speed != above_speed {
            let message = "a speed of another kind than in the rows above: give rotational speeds or sliding speeds";
            return Err(at(speed)(message.to_owned()));
        }
        loads.push(load_value);
        speeds.push(speed_value);
        places.push(entry.origin.clone());
    }
    let (loads, speeds) = kinds.map(|(load, speed)| ((load, loads), (speed, speeds))).unzip();
    Ok(CycleTable { times, start: 0.0, loads, speeds, road_speeds: None, places })
}

fn factor_rows(list: &[Entry]) -> Result<Factor, (Origin, String)> {
    let mut points = Vec::with_capacity(list.len());
    for entry in list {
        let expected = "expected a temperature and a factor such as [\"230 degC\", 1.0]";
        let Value::Array(row) = &entry.value else {
            return Err(at(entry)(format!("{}, {expected}", entry.value)));
        };
        let [temperature, factor] = row.as_slice() else {
            return Err(at(entry)(format!("a row of {} values, {expected}", row.len())));
        };
        let kelvin = quantity(&temperature.value, Dimension::Temperature, Range::POSITIVE).map_err(at(temperature))?;
        points.push((kelvin, number(&factor.value, Range::NOT_NEGATIVE).map_err(at(factor))?));
    }
    Factor::new(points).map_err(|error| {
        let (FactorError::Order { point, .. } | FactorError::Value { point, .. }) = error;
        (list[point].origin.clone(), error.to_string())
    })
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Setting {
    Number(f64),
    Integer(u64),
    Bool(bool),
    Text(String),
    Pair([f64; 2]),
    Times(Vec<f64>),
    Maps(Vec<Map>),
    Rows(CycleTable),
    Factor(Factor),
}

/// Reads the value of the key `path`; input files named by no scene file are relative to the one at `scene`.
pub(super) fn interpret(path: &str, kind: Kind, entry: &Entry, scene: &Path) -> Result<Setting, Problem> {
    match (kind, &entry.value) {
        (Kind::Times, Value::Array(list)) => quantities(list, Time, Range::NOT_NEGATIVE).map(Setting::Times),
        (Kind::Lengths { range, .. }, Value::Array(list)) if list.len() == 2 => {
            quantities(list, Dimension::Length, range).map(|lengths| Setting::Pair([lengths[0], lengths[1]]))
        }
        (Kind::Maps, Value::Array(list)) => list.iter().map(map).collect::<Result<_, _>>().map(Setting::Maps),
        (Kind::Rows, Value::Array(list)) if list.len() >= 2 => cycle_rows(list).map(Setting::Rows),
        (Kind::Factor, Value::Array(list)) if !list.is_empty() => factor_rows(list).map(Setting::Factor),
        (Kind::InputFile, Value::Text(text)) => {
            one_line(text).map(|text| Setting::Text(input_file(text, &entry.origin, scene))).map_err(at(entry))
        }
        // Other texts are paths, which may be as long as the system takes.
        (Kind::Text, Value::Text(text)) if path == "title" && too_long(text).is_some() => {
            Err(at(entry)(too_long(text).unwrap_or_default()))
        }
        (_, value) => plain(kind, value).map_err(at(entry)),
    }
    .map_err(|(origin, message)| Problem::new(&origin, path, message))
}

fn plain(kind: Kind, value: &Value) -> Result<Setting, String> {
    match (kind, value) {
        (Kind::Quantity { dimension, range, .. }, _) => quantity(value, dimension, range).map(Setting::Number),
        (Kind::Lengths { single: true, range, .. }, Value::Text(_)) => {
            quantity(value, Dimension::Length, range).map(|length| Setting::Pair([length; 2]))
        }
        (Kind::LengthUnit, Value::Text(text)) => length_unit(text, value).map(Setting::Number),
        (Kind::NumberOr(_, word) | Kind::CountOr(word), Value::Text(text)) if text == word => {
            Ok(Setting::Text(text.clone()))
        }
        (Kind::Number(range) | Kind::NumberOr(range, _), Value::Integer(_) | Value::Float(_)) => {
            number(value, range).map(Setting::Number)
        }
        (Kind::Integer(least), Value::Integer(integer)) => count(*integer, least),
        (Kind::CountOr(_), Value::Integer(integer)) => count(*integer, 1),
        (Kind::Bool, Value::Bool(value)) => Ok(Setting::Bool(*value)),
        (Kind::True, Value::Bool(true)) => Ok(Setting::Bool(true)),
        (Kind::Choice(words), Value::Text(text)) => {
            one_of(text, words, |word| word).map(|word| Setting::Text((*word).to_owned()))
        }
        (Kind::Text, Value::Text(text)) => one_line(text).map(|text| Setting::Text(text.to_owned())),
        _ => Err(format!("{value}, expected {}", expectation(kind))),
    }
}

/// Content of a key, in words.
fn expectation(kind: Kind) -> String {
    match kind {
        Kind::Quantity { dimension, .. } => dimension.to_string(),
        Kind::Lengths { single, range, .. } => {
            let one = if single { format!("{} or ", Dimension::Length) } else { String::new() };
            format!("{one}a list of 2 lengths, each {range}")
        }
        Kind::LengthUnit => "a unit of length such as \"um\", or a length such as \"0.5 um\"".to_owned(),
        Kind::Number(range) => format!("a number, {range}"),
        Kind::NumberOr(range, word) => format!("a number, {range}, or \"{word}\""),
        Kind::Integer(least) => format!("an integer, at least {least}"),
        Kind::Bool => "true or false".to_owned(),
        Kind::True => "true; leave the key out to choose another source".to_owned(),
        Kind::Choice(words) => quoted(words.iter().copied()),
        Kind::CountOr(word) => format!("an integer, at least 1, or \"{word}\""),
        Kind::Text => "a string".to_owned(),
        Kind::InputFile => "the path of a file as a string".to_owned(),
        Kind::Times => "a list of times such as [\"0 s\", \"500 s\"]".to_owned(),
        Kind::Rows => "rows such as [[\"0 s\", \"47 N\", \"850 rpm\"], [\"3 s\", \"47 N\", \"0 rpm\"]]".to_owned(),
        Kind::Factor => "rows of temperature and factor such as [[\"230 degC\", 1.0], [\"400 degC\", 4.0]]".to_owned(),
        Kind::Maps => format!("a list of {}", quoted(Map::CHOICES.iter().map(|map| map.name()))),
    }
}

/// "um" is short for "1 um".
fn length_unit(text: &str, value: &Value) -> Result<f64, String> {
    let short = text.trim_start().starts_with(char::is_alphabetic);
    let full = if short { Value::Text(format!("1 {text}")) } else { value.clone() };
    quantity(&full, Dimension::Length, Range::POSITIVE)
}

fn count(integer: i128, least: u64) -> Result<Setting, String> {
    match u64::try_from(integer) {
        Ok(count) if count >= least => Ok(Setting::Integer(count)),
        Err(_) if integer > 0 => Err(format!("{integer} is out of range, expected at most {}", u64::MAX)),
        _ => Err(format!("{integer} is out of range, expected an integer, at least {least}")),
    }
}

/// Names and paths are shown, in messages and figures, and written into tables.
fn one_line(text: &str) -> Result<&str, String> {
    match odd_character(text) {
        _ if text.trim().is_empty() => Err("the text is empty".to_owned()),
        Some(found) => Err(format!("the text has {found}, expected one line of letters; take it out")),
        None => Ok(text),
    }
}

fn one_of<'a, T>(text: &str, choices: &'a [T], name: impl Fn(&T) -> &'static str) -> Result<&'a T, String> {
    choices.iter().find(|choice| name(choice) == text).ok_or_else(|| {
        let names = || choices.iter().map(&name);
        let hint = nearest(text, names()).map(|name| format!("; did you mean \"{name}\"?"));
        let text = short(text);
        format!("\"{text}\" is unknown, expected {}{}", quoted(names()), hint.unwrap_or_default())
    })
}

fn quantities(list: &[Entry], dimension: Dimension, range: Range) -> Result<Vec<f64>, (Origin, String)> {
    list.iter().map(|entry| quantity(&entry.value, dimension, range).map_err(at(entry))).collect()
}

fn map(entry: &Entry) -> Result<Map, (Origin, String)> {
    match &entry.value {
        Value::Text(text) => one_of(text, &Map::CHOICES, |map| map.name()).copied(),
        other => Err(format!("{other}, expected the name of a map")),
    }
    .map_err(at(entry))
}

/// `"contact" or "track"`.
fn quoted<'a>(words: impl Iterator<Item = &'a str>) -> String {
    words.map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
}

/// Input files are relative to the file that names them; those of `--set` to the scene file.
fn input_file(text: &str, origin: &Origin, scene: &Path) -> String {
    let namer = match origin {
        Origin::Place { file, .. } | Origin::File(file) => file,
        Origin::Set(_) | Origin::Default => scene,
    };
    let path = namer.parent().unwrap_or(Path::new("")).join(text);
    std::path::absolute(&path).unwrap_or(path).to_string_lossy().into_owned()
}
