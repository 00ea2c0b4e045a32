//! One layer of a scene - a file, or the `--set` arguments - as a flat list of keys that remember where they stand.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Locator, Origin, Problem, is_study, not_toml};
use super::schema;
use crate::text::{MOST_PROBLEMS, short};

/// A value as it stands in the text.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Text(String),
    Integer(i128),
    Float(f64),
    Bool(bool),
    Date(String),
    Array(Vec<Entry>),
    /// A table; its keys are entries of their own.
    Table,
}

impl Value {
    /// The value as it stands in a scene.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Text(text) => format!("\"{}\"", short(text).escape_debug()),
            Self::Integer(integer) => integer.to_string(),
            Self::Float(float) => format!("{float:?}"),
            Self::Bool(value) => value.to_string(),
            Self::Date(date) => date.clone(),
            Self::Array(_) | Self::Table => "this".to_owned(),
        }
    }
}

/// The value found, for messages: `"80" is a string`.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self {
            Self::Text(_) => "a string",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a decimal number",
            Self::Bool(_) => "a boolean",
            Self::Date(_) => "a date",
            Self::Array(_) => "a list",
            Self::Table => "a table",
        };
        write!(f, "{} is {kind}", self.text())?;
        match self {
            Self::Text(text) => number_in(text).map_or(Ok(()), |number| write!(f, " (write {number} without quotes)")),
            _ => Ok(()),
        }
    }
}

/// The number that stands in a text, also with a decimal comma, as TOML has it.
fn number_in(text: &str) -> Option<String> {
    let number = text.trim().replacen(',', ".", 1);
    number.parse::<f64>().is_ok_and(f64::is_finite).then_some(number)
}

/// Tells whether a key is given with this value.
pub(super) fn chooses(entries: &Entries, choose: schema::Choose) -> bool {
    matches!(entries.get(choose.key), Some(Entry { value: Value::Text(text), .. }) if text == choose.value)
}

/// Tells whether the entries make a choice that none of its words is, so that nobody knows what follows from it.
pub(super) fn is_undecided(entries: &Entries, choice: &str) -> bool {
    let words = match schema::find(choice).map(|key| key.kind) {
        Some(schema::Kind::Choice(words)) => words,
        _ => return false,
    };
    entries
        .get(choice)
        .is_some_and(|entry| !matches!(&entry.value, Value::Text(text) if words.contains(&text.as_str())))
}

/// A value and where it was given.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) value: Value,
    pub(super) origin: Origin,
}

/// Known keys by their full path; tables are entries too, for an empty table is a choice of a source as well.
pub(super) type Entries = BTreeMap<String, Entry>;

/// Reads the text of a scene file.
///
/// What is wrong with single keys is added to `problems`; the error is for a text that is not TOML.
pub(super) fn read(file: &Arc<Path>, text: &str, problems: &mut Vec<Problem>) -> Result<Entries, Problem> {
    let locator = Locator::new(file.clone(), text);
    let document = DeTable::parse(text).map_err(|error| {
        let origin = error.span().map_or(Origin::File(file.clone()), |span| locator.origin(span));
        let message = not_toml(text, &error);
        Problem::without_key(&origin, message)
    })?;
    if is_study(|key| document.get_ref().contains_key(key)) {
        let message = "this is a study, expected a scene; `plateau sweep plan` and `plateau sweep run` take studies";
        return Err(Problem::without_key(&Origin::File(file.clone()), message));
    }
    let mut flattening = Flattening { locate: |span| locator.origin(span), entries: Entries::new(), problems };
    flattening.table(document.get_ref(), "");
    Ok(flattening.entries)
}

/// Reads `key.path=value`; a value that is not TOML is a string.
pub(super) fn read_set(argument: &str, problems: &mut Vec<Problem>) -> Entries {
    let origin = Origin::Set(argument.into());
    let complete = |path: &str| path.split('.').all(|name| !name.trim().is_empty());
    let Some((path, text)) = argument.split_once('=').filter(|(path, _)| complete(path)) else {
        problems
            .push(Problem::without_key(&origin, "expected key=value, for instance operation.normal_force=\"47 N\""));
        return Entries::new();
    };
    let path = path.trim();
    if path == "extends" {
        problems.push(Problem::new(&origin, path, "only a scene file can extend another"));
        return Entries::new();
    }
    let text = text.trim();
    let string = || Spanned::new(0..text.len(), DeValue::String(text.into()));
    let value = DeValue::parse(text).unwrap_or_else(|_| string());

    let mut flattening = Flattening { locate: |_| origin.clone(), entries: Entries::new(), problems };
    let (mut table, mut rest) = (String::new(), path);
    while let Some((name, below)) = rest.split_once('.') {
        if !flattening.is_table(&table, name, &origin) {
            return Entries::new();
        }
        table = schema::join(&table, name);
        flattening.entries.insert(table.clone(), Entry { value: Value::Table, origin: origin.clone() });
        rest = below;
    }
    flattening.key(&table, rest, origin.clone(), &value);
    flattening.entries
}

/// Reads a default of the schema.
pub(super) fn read_default(text: &str) -> Option<Entry> {
    let value = DeValue::parse(text).ok()?;
    let mut flattening = Flattening { locate: |_| Origin::Default, entries: Entries::new(), problems: &mut Vec::new() };
    flattening.entry("", &value)
}

/// Walks down a document and keeps what the schema knows.
struct Flattening<'p, L> {
    locate: L,
    entries: Entries,
    problems: &'p mut Vec<Problem>,
}

impl<L: Fn(Range<usize>) -> Origin> Flattening<'_, L> {
    fn table(&mut self, table: &DeTable<'_>, path: &str) {
        for (key, value) in table {
            let origin = (self.locate)(key.span());
            self.key(path, key.get_ref(), origin, value);
        }
    }

    fn key(&mut self, table: &str, name: &str, key_origin: Origin, value: &Spanned<DeValue<'_>>) {
        if self.problems.len() >= MOST_PROBLEMS {
            return;
        }
        let path = schema::join(table, name);
        if name.is_empty() || name.contains('.') {
            let message = "unknown key; write the path of a key without quotes";
            self.problems.push(Problem::new(&key_origin, &path, message));
            return;
        }
        let content = match value.get_ref() {
            DeValue::Table(content) if schema::is_table(&path) => content,
            // A step of a preparation that is a table may be "none" in its place.
            other if schema::find(&path).is_some() || other.as_str() == Some("none") && schema::may_be_none(&path) => {
                if let Some(entry) = self.entry(&path, value) {
                    self.entries.insert(path, entry);
                }
                return;
            }
            _ => {
                if self.is_table(table, name, &key_origin) {
                    let found = self.entry(&path, value).map_or(Value::Table, |entry| entry.value);
                    let origin = (self.locate)(value.span());
                    self.problems.push(Problem::new(&origin, &path, format!("{found}, expected a table")));
                }
                return;
            }
        };
        self.entries.insert(path.clone(), Entry { value: Value::Table, origin: key_origin });
        self.table(content, &path);
    }

    /// Tells whether the name is a table; if it is not, that is a problem.
    fn is_table(&mut self, table: &str, name: &str, origin: &Origin) -> bool {
        let path = schema::join(table, name);
        let is_table = !path.is_empty() && schema::is_table(&path);
        if !is_table {
            let message = match schema::find(&path) {
                Some(_) => "this key is not a table".to_owned(),
                None => schema::unknown(table, name),
            };
            self.problems.push(Problem::new(origin, &path, message));
        }
        is_table
    }

    fn entry(&mut self, path: &str, value: &Spanned<DeValue<'_>>) -> Option<Entry> {
        let origin = (self.locate)(value.span());
        let value = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.clone().into_owned()),
            DeValue::Integer(integer) => match i128::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(integer) => Value::Integer(integer),
                Err(_) => {
                    self.problems.push(Problem::new(
                        &origin,
                        path,
                        format!("{} is too large a number", short(&integer.to_string())),
                    ));
                    return None;
                }
            },
            DeValue::Float(float) => Value::Float(float.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(value) => Value::Bool(*value),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(elements) => {
                Value::Array(elements.iter().filter_map(|element| self.entry(path, element)).collect())
            }
            DeValue::Table(_) => Value::Table,
        };
        Some(Entry { value, origin })
    }
}
