//! What an HDF5 file leaves to other files: external links, virtual datasets and external raw storage.
//!
//! Whatever is read is named by the path and the digest of one file, so a file that is read must hold all of it. Its objects
//! are looked at along hard links alone, each once: nothing outside is opened, and links in a circle do no harm.

use std::collections::HashSet;
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::io;

use hdf5::plist::dataset_create::Layout;
use hdf5::{Dataset, Group, IndexType, IterationOrder, LinkInfo, LinkType, LocationType};
use memchr::memmem;

use super::blocks::for_each_block;
use crate::text::short;

/// Bytes of a link that are looked at: names of file and object, each with a zero behind it.
const LONGEST_LINK: usize = 8192;
/// Groups and datasets of a file: the library keeps some ten kilobytes of each that is open.
const MOST_OBJECTS: usize = 10_000;
/// Names of files that are told.
const TOLD: usize = 3;

/// Calls `visit` with every dataset of a file. Ends with what lies elsewhere, in words, where something does.
pub(super) fn for_each_dataset(
    file: &hdf5::File,
    bytes: &File,
    visit: &mut dyn FnMut(Dataset),
) -> hdf5::Result<Option<String>> {
    let (hasher, mut seen) = (RandomState::new(), HashSet::new());
    let mut groups = vec![file.as_group()?];
    while let Some(group) = groups.pop() {
        if let Some(name) = first_link(&group, |_, link| link.link_type == LinkType::External)? {
            let target = target_of(bytes, &name).map_err(|error| hdf5::Error::from(error.to_string()))?;
            return Ok(Some(format!("{} links to {target}", path_in(&group, &name))));
        }
        // A slash in a name would lead through other links.
        if let Some(name) = first_link(&group, |name, _| name.contains('/'))? {
            return Err(format!("{} has a link of the name \"{}\"", group.name(), short(&name).escape_debug()).into());
        }
        let mut found = None;
        group.iter_visit_default(|name, link| {
            if link.link_type != LinkType::Hard || found.is_some() {
                return Ok(());
            }
            // An object that is damaged cannot be opened, nor read then; who wants it will say so.
            let kind = match group.loc_info_by_name(name) {
                // There is no other way to compare tokens than by how they show.
                Ok(info) if !seen.insert(hasher.hash_one(format!("{:?}", info.token))) => return Ok(()),
                Ok(info) => info.loc_type,
                Err(error) if group.group(name).is_ok() => return Err(error),
                Err(_) => LocationType::Dataset,
            };
            if seen.len() > MOST_OBJECTS {
                return Err(
                    format!("it has more than {MOST_OBJECTS} groups and datasets, expected at most that many").into()
                );
            }
            match kind {
                LocationType::Group => groups.extend(group.group(name)),
                LocationType::Dataset => {
                    let Ok(dataset) = group.dataset(name) else { return Ok(()) };
                    found = data_elsewhere(&dataset)?.map(|what| format!("{} {what}", path_in(&group, name)));
                    visit(dataset);
                }
                _ => {}
            }
            Ok(())
        })?;
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}

/// The first link of a group of which something holds.
fn first_link(group: &Group, holds: impl Fn(&str, LinkInfo) -> bool) -> hdf5::Result<Option<String>> {
    group.find_link(IndexType::default(), IterationOrder::default(), |name, link| {
        Ok(holds(name, link).then(|| name.to_owned()))
    })
}

fn path_in(group: &Group, name: &str) -> String {
    format!("{}/{name}", group.name().trim_end_matches('/'))
}

/// Where the data of a dataset are, if that is another file.
fn data_elsewhere(dataset: &Dataset) -> hdf5::Result<Option<String>> {
    let made = dataset.create_plist()?;
    if made.get_layout()? == Layout::Virtual {
        let sources =
            made.virtual_map().into_iter().map(|part| format!("{} in {}", part.src_dataset, part.src_filename));
        return Ok(Some(format!("is a virtual dataset, made of {}", told(sources))));
    }
    let files = made.get_external()?;
    let names = files.into_iter().map(|file| file.name);
    Ok(if names.len() == 0 { None } else { Some(format!("has its data in {}", told(names))) })
}

/// The first of some names.
fn told(names: impl Iterator<Item = String>) -> String {
    let mut names: Vec<String> = names.map(|name| short(&name).escape_debug().to_string()).collect();
    names.dedup();
    let more = names.len() > TOLD;
    names.truncate(TOLD);
    match names.len() {
        0 => "others".to_owned(),
        _ => names.join(", ") + if more { " and others" } else { "" },
    }
}

/// What an external link of that name points to, as the bytes of the file have it: the library tells only by opening it.
///
/// A link is kept as its name, the length of what follows (2 bytes), a byte for version and flags (0), and the names of file
/// and object, each with a zero behind it (HDF5 File Format Specification 3.0, IV.A.2.g "The Link Message").
fn target_of(file: &File, name: &str) -> io::Result<String> {
    let mut target = None;
    for_each_block(file, name.len() + LONGEST_LINK, |_, block| {
        target = memmem::find_iter(block, name).find_map(|at| names_behind(&block[at + name.len()..]));
        Ok(target.is_none())
    })?;
    Ok(target.unwrap_or_else(|| "another file".to_owned()))
}

fn names_behind(bytes: &[u8]) -> Option<String> {
    let length = usize::from(u16::from_le_bytes(bytes.get(..2)?.try_into().ok()?));
    let names = bytes.get(2..2 + length)?.strip_prefix(b"\0")?.strip_suffix(b"\0")?;
    let mut names = names.split(|byte| *byte == 0);
    let (file, object, nothing) = (names.next()?, names.next()?, names.next());
    let text = |name| std::str::from_utf8(name).ok().map(|name: &str| short(name).escape_debug().to_string());
    let is_link = nothing.is_none() && !file.is_empty() && !object.is_empty();
    if is_link { Some(format!("{} in {}", text(object)?, text(file)?)) } else { None }
}
