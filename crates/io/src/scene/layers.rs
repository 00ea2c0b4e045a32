//! The layers of a scene: the scenes it extends, the scene itself, `--set` arguments; later ones override earlier ones.

use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::document::{self, Entries, Value};
use super::error::{Origin, Problem, SceneError, Warning};
use super::schema::{self, Group};
use crate::input::sha256_of;
use crate::{input, limits, text};

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
    let (files, layers) = read_chain(path, text, &mut problems)?;
    lay_all(files, layers, sets, problems)
}

/// Lays the scenes, from the top down, and the `--set` arguments over each other.
fn lay_all(
    files: Files,
    mut layers: Vec<Entries>,
    sets: &[&[String]],
    mut problems: Vec<Problem>,
) -> Result<Layered, SceneError> {
    for arguments in sets {
        let mut set = Entries::new();
        for argument in *arguments {
            let entries = document::read_set(argument, &mut problems);
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
        for meaningless in schema::MEANINGLESS.iter().filter(|each| document::chooses(&layer, each.beside)) {
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
        let entries = document::read(&file, &text, problems).map_err(|problem| {
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
    let is_none = |(path, entry): (&String, &document::Entry)| {
        entry.value == Value::Text("none".to_owned()) && schema::may_be_none(path)
    };
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
