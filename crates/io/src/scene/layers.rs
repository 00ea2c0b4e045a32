//! The layers of a scene: the scenes it extends, the scene itself, `--set` arguments; later ones override earlier ones. Each is a flat list
//! of keys that remember where they stand.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::input::{self, sha256_of};
use crate::limits;
use crate::scene::error::{Locator, Origin, Problem, SceneError, Warning, is_study, not_toml};
use crate::scene::schema::{self, Group};
use crate::text::{self, MOST_PROBLEMS, short};

/// The newest version of the scene format that this program reads.
const VERSION: i128 = 1;

/// A scene is a page of text; what is larger than this is something else.
const LARGEST_FILE: u64 = 1 << 20;

/// Scene files, each with the SHA-256 of its text.
type Files = Vec<(PathBuf, String)>;

/// All layers laid over each other.
#[derive(Debug)]
pub(super) struct Layered {
    /// Entries that are left of all layers.
    pub(super) entries: Entries,
    /// The scene file and those it extends, from the top down, each with the SHA-256 of its text.
    pub(super) files: Files,
    /// Problem with single layers: unknown keys, alternatives given together.
    pub(super) problems: Vec<Problem>,
    /// Steps that `--set` puts in the place of another step of a preparation.
    pub(super) replaced: Vec<Warning>,
}

/// Reads a scene, or takes its text, what it extends and the `--set` arguments, each list of which is laid over those before.
///
/// Tables are laid over each other key by key, inline tables too. The error is for files that cannot be read as scenes
/// of this version.
pub(super) fn read(path: &Path, text: Option<&str>, sets: &[&[String]]) -> Result<Layered, SceneError> {
    let mut problems = Vec::new();
    // From the top down: what is set last, …, the scene, what it extends.
    let (files, mut layers) = read_chain(path, text, &mut problems)?;
    for arguments in sets {
        let mut set = Entries::new();
        for argument in *arguments {
            let entries = read_set(argument, &mut problems);
            refuse_newer_version(&entries)?;
            lay_over(&mut set, entries);
        }
        layers.insert(0, set);
    }
    for layer in &layers {
        refuse_two_of_a_group(layer, &mut problems);
        refuse_two_ways(layer, &mut problems);
    }

    let mut entries = Entries::new();
    let mut replaced = Vec::new();
    while let Some(mut layer) = layers.pop() {
        take_out_steps(&mut layer, &mut entries);
        if layers.len() < sets.len() {
            // The last ones are those of `--set`.
            replaced.extend(steps_replaced(&entries, &layer));
        }
        for group in schema::GROUPS {
            let chosen = members(group, &layer).next();
            if let Some((chosen, _)) = chosen {
                remove_others(group, chosen, &mut entries);
            }
        }
        for ways in schema::WAYS {
            let given = |path: &str| layer.contains_key(path);
            let others = ways.chosen(given).and_then(|set| ways.other(set[0])).unwrap_or_default();
            others.iter().for_each(|name| remove(&schema::join(ways.section, name), &mut entries));
        }
        for meaningless in schema::MEANINGLESS.iter().filter(|each| chooses(&layer, each.beside)) {
            remove(meaningless.key, &mut entries);
        }
        lay_over(&mut entries, layer);
    }
    entries.remove("extends");
    Ok(Layered { entries, files, problems, replaced })
}

/// Reads the scene, unless its text is given, and, one after the other, the scenes it extends.
fn read_chain(
    path: &Path,
    mut text: Option<&str>,
    problems: &mut Vec<Problem>,
) -> Result<(Files, Vec<Entries>), SceneError> {
    let (mut names, mut files, mut layers, mut identities) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut next = Some((path.to_path_buf(), None));
    while let Some((path, named)) = next.take() {
        let file: Arc<Path> = path.as_path().into();
        let unreadable = |error: io::Error| {
            let problem = match &named {
                Some(origin) => Problem::new(origin, "extends", format!("cannot read {}: {error}", path.display())),
                None => Problem::without_key(&Origin::File(file.clone()), format!("cannot read the scene: {error}")),
            };
            Problem { system: error.raw_os_error(), ..problem }
        };
        let text = match text.take() {
            Some(text) => text.to_owned(),
            None => {
                let identity = path.canonicalize().map_err(|error| unreadable(input::not_there(&path, error)))?;
                names.push(path.clone());
                if let (Some(first), Some(origin)) = (identities.iter().position(|known| *known == identity), &named) {
                    let chain: Vec<_> = names[first..].iter().map(|file| file.display().to_string()).collect();
                    let message = format!("scenes extend each other in a circle: {}", text::list(chain, " -> "));
                    return Err(Problem::new(origin, "extends", message).into());
                }
                identities.push(identity);
                if identities.len() > limits::LAYERS {
                    let message = limits::more("more", limits::LAYERS, "scenes that extend each other");
                    return Err(match &named {
                        Some(origin) => Problem::new(origin, "extends", message),
                        None => Problem::without_key(&Origin::File(file), message),
                    }
                    .into());
                }
                let text = read_text(&path).map_err(unreadable)?;
                files.push((path.clone(), sha256_of(text.as_bytes())));
                text
            }
        };
        let entries = entries_of(&file, &text, problems).map_err(|problem| {
            let earlier = std::mem::take(problems);
            SceneError::new(earlier.into_iter().chain([problem]).collect())
        })?;
        refuse_newer_version(&entries)?;
        if let Some(entry) = entries.get("extends") {
            match &entry.value {
                Value::Text(base) if !base.is_empty() => {
                    let folder = path.parent().unwrap_or(Path::new(""));
                    next = Some((folder.join(base), Some(entry.origin.clone())));
                }
                other => {
                    let message = format!("{other}, expected the path of a scene");
                    problems.push(Problem::new(&entry.origin, "extends", message));
                }
            }
        }
        layers.push(entries);
    }
    Ok((files, layers))
}

fn read_text(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    input::open(path)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    let refuse = |message: &str| Err(io::Error::new(io::ErrorKind::InvalidData, message));
    if bytes.starts_with(b"\x89HDF") {
        return refuse("this is an HDF5 file, expected a scene in TOML");
    }
    if bytes.len() as u64 > LARGEST_FILE {
        return refuse("it is larger than 1 MiB, expected a scene in TOML");
    }
    String::from_utf8(bytes).or_else(|error| {
        let at = error.utf8_error().valid_up_to();
        refuse(&format!("it is not UTF-8 text (byte {at}), expected a scene in TOML"))
    })
}

/// Comes before all other checks, for a newer format may have other keys.
fn refuse_newer_version(entries: &Entries) -> Result<(), Problem> {
    if let Some(entry) = entries.get("version")
        && let Value::Integer(version) = entry.value
        && version > VERSION
    {
        let message =
            format!("this scene has version {version} and was written for a newer program; this one reads {VERSION}");
        return Err(Problem::new(&entry.origin, "version", message));
    }
    Ok(())
}

/// Members of a group that a layer gives, with the place of each.
fn members<'a>(group: &'a Group, entries: &'a Entries) -> impl Iterator<Item = (&'static str, &'a Origin)> {
    group.members.iter().filter_map(|(name, _)| {
        let entry = entries.get(&schema::join(group.section, name))?;
        Some((*name, &entry.origin))
    })
}

fn refuse_two_of_a_group(layer: &Entries, problems: &mut Vec<Problem>) {
    for group in schema::GROUPS {
        let mut given: Vec<_> = members(group, layer).collect();
        given.sort_by_key(|(_, origin)| *origin);
        if let [.., (last, origin)] = given.as_slice()
            && given.len() > 1
        {
            let names: Vec<_> = given.iter().map(|(name, _)| *name).collect();
            let message = format!("{} are given together, keep one of {}", names.join(" and "), group.names());
            problems.push(Problem::new(origin, &schema::join(group.section, last), message));
        }
    }
}

/// Steps of a preparation that exclude each other, one in a scene and another in `--set`: the scene's is left out, which a user
/// who wants both has to know.
fn steps_replaced(scene: &Entries, set: &Entries) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for group in schema::GROUPS.iter().filter(|group| group.section.ends_with(".prepare")) {
        let Some((chosen, place)) = members(group, set).next() else { continue };
        for (name, origin) in members(group, scene).filter(|(name, _)| *name != chosen) {
            warnings.push(Warning {
                place: place.clone(),
                key: schema::join(group.section, chosen),
                found: format!("it takes the place of {name} ({origin})"),
                bound: format!("of {} only one is done", group.names()),
                advice: format!("{name} is left out"),
            });
        }
    }
    warnings
}

/// Removes the steps of a preparation that a layer says are not done, from it and from what is below.
fn take_out_steps(layer: &mut Entries, below: &mut Entries) {
    let is_none =
        |(path, entry): (&String, &Entry)| entry.value == Value::Text("none".to_owned()) && schema::may_be_none(path);
    let steps: Vec<String> = layer.iter().filter(|entry| is_none(*entry)).map(|(path, _)| path.clone()).collect();
    for step in steps {
        layer.remove(&step);
        remove(&step, below);
        // What has a meaning only beside it goes, too.
        let of_step = |group: &Group, name: &str| schema::join(group.section, name) == step;
        let members = schema::GROUPS.iter().flat_map(|group| group.members.iter().map(move |member| (group, member)));
        for (group, (_, companions)) in members.filter(|(group, (name, _))| of_step(group, name)) {
            companions.iter().for_each(|companion| remove(&schema::join(group.section, companion), below));
        }
    }
}

/// A mesh is given in cells or in lengths.
fn refuse_two_ways(layer: &Entries, problems: &mut Vec<Problem>) {
    for ways in schema::WAYS {
        let given = ways.sets.map(|set| -> Vec<_> {
            let entry = |name: &'static str| Some((name, &layer.get(&schema::join(ways.section, name))?.origin));
            set.iter().filter_map(|name| entry(name)).collect()
        });
        if given.iter().any(Vec::is_empty) {
            continue;
        }
        let list = |set: &[(&'static str, &Origin)]| set.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        let [first, second] = &given;
        // Of the way of which less is given, or which comes last.
        let last = |set: &[(&'static str, &Origin)]| set.iter().map(|(_, origin)| (*origin).clone()).max();
        let keep = if (first.len(), last(second)) >= (second.len(), last(first)) { 0 } else { 1 };
        let (kept, left_out) = (&given[keep], &given[1 - keep]);
        let (name, origin) = left_out[0];
        let message = format!(
            "these are two ways to say the same: leave out {} and keep {}, or the other way round",
            list(left_out),
            list(kept)
        );
        problems.push(Problem::new(origin, &schema::join(ways.section, name), message));
    }
}

/// Removes every member but the chosen one, with what has a meaning only beside it.
fn remove_others(group: &Group, chosen: &str, entries: &mut Entries) {
    for (name, companions) in group.members.iter().filter(|(name, _)| *name != chosen) {
        for removed in [name].into_iter().chain(*companions) {
            remove(&schema::join(group.section, removed), entries);
        }
    }
}

fn remove(path: &str, entries: &mut Entries) {
    entries.retain(|known, _| known != path && !schema::is_below(known, path));
}

/// Overrides key by key; a plain value in place of a table removes the keys of the table.
fn lay_over(base: &mut Entries, layer: Entries) {
    for (path, entry) in layer {
        if entry.value != Value::Table {
            remove(&path, base);
        }
        base.insert(path, entry);
    }
}

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
fn entries_of(file: &Arc<Path>, text: &str, problems: &mut Vec<Problem>) -> Result<Entries, Problem> {
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
