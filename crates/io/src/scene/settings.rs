//! The keys of a scene with their values in SI units: each checked by itself, defaults filled in, none missing.

use std::collections::BTreeMap;
use std::path::Path;

use plateau_core::model::thermal::Factor;
use plateau_core::observe::Map;

use super::error::{Origin, Problem};
use super::interpret::{Setting, interpret};
use super::schema::choices::Choices;
use super::schema::{self, Key, Need};
use crate::scene::layers::{self, Entries, Value};

/// Checked values by full path, with the place of each.
#[derive(Debug, Default)]
pub(super) struct Settings {
    values: BTreeMap<String, (Setting, Origin)>,
    /// Tables that are given and have no key.
    tables: BTreeMap<String, Origin>,
}

impl Settings {
    /// Checks every entry of the scene at `scene` by itself and fills in what is absent.
    pub(super) fn read(entries: &Entries, scene: &Path, problems: &mut Vec<Problem>) -> Self {
        let mut settings = Self::default();
        for (path, entry) in entries {
            let Some(key) = schema::find(path) else { continue };
            if entry.value == Value::Table && schema::is_table(path) {
                settings.tables.insert(path.clone(), entry.origin.clone());
                continue;
            }
            match interpret(path, key.kind, entry, scene) {
                Ok(setting) => settings.insert(path, setting, &entry.origin),
                Err(problem) => problems.push(problem),
            }
        }
        settings.fill_in(entries, scene);
        settings
    }

    pub(super) fn insert(&mut self, path: &str, setting: Setting, origin: &Origin) {
        self.values.insert(path.to_owned(), (setting, origin.clone()));
    }

    pub(super) fn remove(&mut self, path: &str) {
        self.values.remove(path);
    }

    pub(super) fn get(&self, path: &str) -> Option<&Setting> {
        self.values.get(path).map(|(setting, _)| setting)
    }

    /// Finds the origin of a key, or of an empty table; the default where neither is given.
    pub(super) fn origin(&self, path: &str) -> Origin {
        let table = || self.tables.get(path).cloned().unwrap_or(Origin::Default);
        self.values.get(path).map_or_else(table, |(_, origin)| origin.clone())
    }

    /// Origin of every key that has a value.
    pub(super) fn places(&self) -> BTreeMap<String, Origin> {
        self.values.iter().map(|(path, (_, origin))| (path.clone(), origin.clone())).collect()
    }

    /// The value of a number or quantity (SI units) that a checked scene has.
    pub(super) fn number(&self, path: &str) -> Result<f64, Problem> {
        self.value(path, "a number", |found| if let Setting::Number(number) = found { Some(*number) } else { None })
    }

    pub(super) fn integer(&self, path: &str) -> Result<u64, Problem> {
        self.value(path, "an integer", |found| if let Setting::Integer(count) = found { Some(*count) } else { None })
    }

    /// The value of a text or choice that a checked scene has.
    pub(super) fn text(&self, path: &str) -> Result<&str, Problem> {
        self.value(path, "a text", |found| if let Setting::Text(text) = found { Some(text.as_str()) } else { None })
    }

    /// Meaning of the word of a choice that a checked scene has.
    pub(super) fn choice<T: Copy, const COUNT: usize>(
        &self,
        path: &str,
        choices: &Choices<T, COUNT>,
    ) -> Result<T, Problem> {
        let found = self.text(path)?;
        let known = choices.iter().find(|(word, _)| *word == found).map(|(_, meaning)| *meaning);
        known.ok_or_else(|| self.unlike(path, "a word of its choice", self.get(path)))
    }

    /// Meaning of the word of a choice that may be absent.
    pub(super) fn optional_choice<T: Copy, const COUNT: usize>(
        &self,
        path: &str,
        choices: &Choices<T, COUNT>,
    ) -> Result<Option<T>, Problem> {
        self.get(path).map(|_| self.choice(path, choices)).transpose()
    }

    pub(super) fn bool(&self, path: &str) -> Result<bool, Problem> {
        self.value(path, "true or false", |found| if let Setting::Bool(value) = found { Some(*value) } else { None })
    }

    /// A factor over temperature; without the key it is 1.
    pub(super) fn factor(&self, path: &str) -> Result<Factor, Problem> {
        let factor = |found: &Setting| if let Setting::Factor(factor) = found { Some(factor.clone()) } else { None };
        self.get(path).map_or_else(|| Ok(Factor::default()), |_| self.value(path, "a factor", factor))
    }

    /// Tells whether any key of a table is given or has a default.
    pub(super) fn has_table(&self, table: &str) -> bool {
        self.values.keys().any(|path| schema::is_below(path, table))
    }

    /// A number or quantity that may be absent.
    pub(super) fn optional_number(&self, path: &str) -> Result<Option<f64>, Problem> {
        self.get(path).map(|_| self.number(path)).transpose()
    }

    pub(super) fn optional_integer(&self, path: &str) -> Result<Option<u64>, Problem> {
        self.get(path).map(|_| self.integer(path)).transpose()
    }

    /// A list of two numbers (SI units) that may be absent.
    pub(super) fn optional_pair(&self, path: &str) -> Result<Option<[f64; 2]>, Problem> {
        let pair = |found: &Setting| if let Setting::Pair(pair) = found { Some(*pair) } else { None };
        self.get(path).map(|_| self.value(path, "two numbers", pair)).transpose()
    }

    /// The value of a key, if it is of the kind that is expected.
    fn value<'a, T>(&'a self, path: &str, expected: &str, of: impl Fn(&'a Setting) -> Option<T>) -> Result<T, Problem> {
        let found = self.get(path);
        found.and_then(of).ok_or_else(|| self.unlike(path, expected, found))
    }

    fn unlike(&self, path: &str, expected: &str, found: Option<&Setting>) -> Problem {
        let found = found.map_or("nothing".to_owned(), |setting| format!("{setting:?}"));
        self.problem(path, format!("found {found}, expected {expected}"))
    }

    /// Problem with a key, at the place where it was given.
    pub(super) fn problem(&self, path: &str, message: impl Into<String>) -> Problem {
        Problem::new(&self.origin(path), path, message)
    }

    fn fill_in(&mut self, entries: &Entries, scene: &Path) {
        for key in schema::keys() {
            let path = key.path();
            if entries.contains_key(&path) || !applies(key, entries) || is_meaningless(&path, entries) {
                continue;
            }
            let setting = match key.need {
                Need::Default(text) => read_default(key, text, scene),
                Need::RequiredUnless(choose, text) if layers::chooses(entries, choose) => {
                    read_default(key, text, scene)
                }
                Need::SameAs(table) => self.get(&schema::join(table, key.name)).cloned(),
                Need::Computed(_) => self.computed(&path, entries, scene),
                Need::Required | Need::RequiredUnless(..) | Need::OneOf | Need::OfWay(_) | Need::Optional => None,
            };
            if let Some(setting) = setting {
                self.insert(&path, setting, &Origin::Default);
            }
        }
    }

    fn computed(&self, path: &str, entries: &Entries, scene: &Path) -> Option<Setting> {
        let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
        match path {
            "title" => Some(Setting::Text(stem.into_owned())),
            "output.file" => Some(Setting::Text(format!("{stem}.h5"))),
            "plateaus.debris" => {
                Some(self.get("plateaus.debris_pool").cloned().unwrap_or(Setting::Text("contact".to_owned())))
            }
            "output.maps" => Some(Setting::Maps(Map::CHOICES.to_vec())),
            // They have a meaning only beside an image.
            path if path.starts_with("pin.base.") && !entries.contains_key("pin.base.image") => None,
            "pin.base.rotate" => Some(Setting::Text("0 deg".to_owned())),
            "pin.base.threshold" => Some(Setting::Text("otsu".to_owned())),
            "pin.base.fibres" => Some(Setting::Text("bright".to_owned())),
            // Of these two a scene has one.
            path if path.ends_with(".repeat") || path.ends_with(".extend_seed") => {
                let (table, name) = path.rsplit_once('.').unwrap_or_default();
                let extends = entries.contains_key(&schema::join(table, "extend"));
                match name {
                    "repeat" => (!extends).then_some(Setting::Bool(false)),
                    _ => extends.then_some(Setting::Integer(0)),
                }
            }
            path if path.starts_with("friction.") => {
                self.get(&schema::join("friction", path.rsplit('.').next().unwrap_or_default())).cloned()
            }
            // One column a step: a revolution has as many steps as the ring has columns.
            "output.sample_every_steps" if !entries.contains_key("output.sample_every") => {
                self.get("mesh.disc_columns").cloned()
            }
            _ => None,
        }
    }
}

fn read_default(key: &Key, text: &str, scene: &Path) -> Option<Setting> {
    layers::read_default(text).and_then(|entry| interpret(&key.path(), key.kind, &entry, scene).ok())
}

/// Tells whether a key has no meaning beside a value of another key.
fn is_meaningless(path: &str, entries: &Entries) -> bool {
    schema::MEANINGLESS.iter().any(|each| each.key == path && layers::chooses(entries, each.beside))
}

/// Tells whether the tables are there without which the key has no meaning: the inline table that holds it, if it is in one, and
/// that which switches its part of the model on.
fn applies(key: &Key, entries: &Entries) -> bool {
    let is_there = |table: &str| entries.get(table).is_some_and(|entry| entry.value == Value::Table);
    key.inline_table().is_none_or(|table| is_there(&table)) && schema::optional_table(key.section).is_none_or(is_there)
}

/// Refuses keys that mean nothing without another one: `dataset` without `file`, and so on.
pub(super) fn refuse_lone_companions(entries: &Entries, problems: &mut Vec<Problem>) {
    for group in schema::GROUPS {
        for (member, companions) in group.members {
            if entries.contains_key(&schema::join(group.section, member)) {
                continue;
            }
            for path in companions.iter().map(|companion| schema::join(group.section, companion)) {
                if let Some(entry) = entries.get(&path) {
                    let message = format!("this key has a meaning only beside \"{member}\", which is not given");
                    problems.push(Problem::new(&entry.origin, &path, message));
                }
            }
        }
    }
}

/// Refuses keys that mean nothing beside a value of another one, as `pad_share` with `debris = "local"`.
pub(super) fn refuse_meaningless(entries: &Entries, problems: &mut Vec<Problem>) {
    for each in schema::MEANINGLESS.iter().filter(|each| layers::chooses(entries, each.beside)) {
        if let Some(entry) = entries.get(each.key) {
            let schema::Choose { key, value } = each.beside;
            let message = format!("this key has no meaning beside {key} = \"{value}\": {}; leave it out", each.reason);
            problems.push(Problem::new(&entry.origin, each.key, message));
        }
    }
}

/// Tells all missing keys at once, table by table.
pub(super) fn refuse_missing(entries: &Entries, scene: &Path, problems: &mut Vec<Problem>) {
    let given = |section, name| entries.contains_key(&schema::join(section, name));
    let mut message = String::new();
    for section in schema::sections() {
        let is_required = |key: &Key| match key.need {
            Need::RequiredUnless(choose, _) => {
                !layers::chooses(entries, choose) && !layers::is_undecided(entries, choose.key)
            }
            Need::OfWay(unless) => {
                is_of_chosen_way(key, entries) && !unless.is_some_and(|choose| layers::chooses(entries, choose))
            }
            need => need == Need::Required,
        };
        let keys = schema::keys().iter().filter(|key| key.section == section && is_required(key));
        let keys = keys.filter(|key| !given(section, key.name) && applies(key, entries));
        let is_there = |path: &str| entries.contains_key(path);
        let groups = schema::GROUPS.iter().filter(|group| group.section == section);
        let groups = groups.filter(|group| group.is_required(is_there) && group.applies(is_there));
        let groups = groups.filter(|group| !group.members.iter().any(|(name, _)| given(section, name)));

        let ways = schema::WAYS.iter().filter(|ways| ways.section == section && ways.chosen(is_there).is_none());
        let ways = ways.map(|ways| {
            let [one, other] = ways.sets.map(|set| ways.required(set).collect::<Vec<_>>().join(", "));
            format!("either {one}, or {other}")
        });

        let names: Vec<String> = keys
            .map(|key| key.name.to_owned())
            .chain(ways)
            .chain(groups.map(|group| format!("one of {{{}}}", group.names())))
            .collect();
        if !names.is_empty() {
            let table = if section.is_empty() { "at the top:".to_owned() } else { format!("[{section}]") };
            message.push_str(&format!("\n  {table} {}", names.join(", ")));
        }
    }
    if !message.is_empty() {
        let message = format!("required keys are missing:{message}");
        problems.push(Problem::without_key(&Origin::File(scene.into()), message));
    }
}

/// Tells whether the key belongs to the way of saying the same that the scene has chosen.
fn is_of_chosen_way(key: &Key, entries: &Entries) -> bool {
    let chosen = |ways: &schema::Ways| ways.chosen(|path| entries.contains_key(path));
    let of_table = schema::WAYS.iter().filter(|ways| ways.section == key.section);
    of_table.filter_map(chosen).any(|set| set.contains(&key.name))
}

#[cfg(test)]
#[path = "../../tests/unit/scene/settings.rs"]
mod tests;
