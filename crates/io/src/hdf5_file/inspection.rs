//! An HDF5 file, looked through before the library reads it: its first bytes, its global heap, and what it leaves to other files.
//!
//! The global heap, where texts and lists of any length are, has one defect from which the library does not come back: an object
//! that takes no room. The library goes from object to object by the room that each takes and does not notice that it stays where it
//! is (HDF5 2.2, `H5HG__cache_heap_deserialize`).
//!
//! External links, virtual datasets and external raw storage are in other files. Whatever is read is named by the path and the digest
//! of one file, so a file that is read must hold all of it. Its objects are looked at along hard links alone, each once: nothing
//! outside is opened, and links in a circle do no harm.

use std::collections::HashSet;
use std::fmt::Display;
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read, Seek};
use std::os::unix::fs::FileExt;

use hdf5::plist::dataset_create::Layout;
use hdf5::{Dataset, Group, IndexType, IterationOrder, LinkInfo, LinkType, LocationType};
use memchr::memmem;

use crate::text::short;

/// An error of something else, as one of the library with its words.
pub(crate) fn in_words(error: impl Display) -> hdf5::Error {
    error.to_string().into()
}

/// Beginning of an HDF5 file, at byte 0 or at 512, 1024 and so on.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// True where the superblock says that a program has the file open for writing; if it was killed, it still does.
pub(super) fn is_being_written(file: &File) -> io::Result<bool> {
    Ok(superblock(file)?.is_some_and(|superblock| superblock.version == 3 && superblock.consistency & 1 != 0))
}

/// The first bytes of an HDF5 file.
pub(super) struct Superblock {
    version: u8,
    /// Bytes of a length in this file.
    length_width: u8,
    /// Flags of a file that is open for writing.
    consistency: u8,
}

/// A file's superblock, if it has one.
pub(super) fn superblock(file: &File) -> io::Result<Option<Superblock>> {
    let length = file.metadata()?.len();
    let mut bytes = [0; 16];
    let mut at = 0;
    while at < length {
        if file.read_at(&mut bytes, at)? == bytes.len() && bytes.starts_with(SIGNATURE) {
            let version = bytes[8];
            let length_width = if version < 2 { bytes[14] } else { bytes[10] };
            return Ok(Some(Superblock { version, length_width, consistency: bytes[11] }));
        }
        at = if at == 0 { 512 } else { 2 * at };
    }
    Ok(None)
}

/// Bytes that are looked through at a time.
const BLOCK: usize = 1 << 20;

/// Calls `look` with the file block by block, and where each block starts, until it gives `false`. Blocks overlap, so that
/// whatever has `width` bytes is whole in one of them.
fn for_each_block(
    mut file: &File,
    width: usize,
    mut look: impl FnMut(u64, &[u8]) -> io::Result<bool>,
) -> io::Result<()> {
    file.rewind()?;
    let mut block = Vec::with_capacity(BLOCK + width);
    let mut start = 0;
    while file.by_ref().take(BLOCK as u64).read_to_end(&mut block)? > 0 {
        if !look(start, &block)? {
            break;
        }
        let done = block.len().saturating_sub(width - 1);
        block.drain(..done);
        start += done as u64;
    }
    Ok(())
}

/// Start of a collection of objects: its signature and its version.
const COLLECTION: &[u8] = b"GCOL\x01";
/// Bytes of the header of a collection, and of each object in it, for every width of lengths.
const HEADER: u64 = 16;

/// Byte at which an object that takes no room begins, if the file has one.
pub(super) fn endless_object(file: &File, superblock: &Superblock) -> io::Result<Option<u64>> {
    let width = usize::from(superblock.length_width);
    if ![2, 4, 8].contains(&width) {
        return Ok(None);
    }
    let mut endless = None;
    for_each_block(file, COLLECTION.len(), |start, block| {
        for at in memmem::find_iter(block, COLLECTION) {
            endless = endless_object_of(file, start + at as u64, width)?;
            if endless.is_some() {
                return Ok(false);
            }
        }
        Ok(true)
    })?;
    Ok(endless)
}

/// The same for the collection at `start`.
fn endless_object_of(file: &File, start: u64, width: usize) -> io::Result<Option<u64>> {
    let mut header = [0; HEADER as usize];
    if file.read_at(&mut header, start)? < header.len() {
        return Ok(None);
    }
    let end = start.saturating_add(number(&header[8..8 + width]));
    let mut at = start + HEADER;
    while at.saturating_add(HEADER) <= end && file.read_at(&mut header, at)? == header.len() {
        let (object, size) = (number(&header[..2]), number(&header[8..8 + width]));
        // As the library reckons, overflow included: objects are padded to whole eights, free space, which is object 0,
        // counts its header.
        let room = if object == 0 { size } else { HEADER.wrapping_add(size.wrapping_add(7) / 8 * 8) };
        if room == 0 {
            return Ok(Some(at));
        }
        at = at.saturating_add(room);
    }
    Ok(None)
}

/// A number with its lowest byte first, of at most 8 bytes.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte))
}

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
            let target = target_of(bytes, &name).map_err(in_words)?;
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

/// File of the data of a dataset, if that is another file.
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

/// Target of an external link of that name, as the bytes of the file have it: the library tells only by opening it.
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
