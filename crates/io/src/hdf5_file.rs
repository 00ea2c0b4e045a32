//! HDF5 files, opened and written, and their attributes.
//!
//! Files of others, which somebody may have damaged, are looked through before the library reads them: their first bytes, their global
//! heap, and what they leave to other files. The global heap, where texts and lists of any length are, has one defect from which the library
//! does not come back: an object that takes no room. The library goes from object to object by the room that each takes and does not notice
//! that it stays where it is (HDF5 2.2, `H5HG__cache_heap_deserialize`).
//!
//! External links, virtual datasets and external raw storage are in other files. Whatever is read is named by the path and the digest
//! of one file, so a file that is read must hold all of it. Its objects are looked at along hard links alone, each once: nothing
//! outside is opened, and links in a circle do no harm.
//!
//! Files of the program's own have dimension scales: what gives the axes of a dataset names and coordinates in h5py, xarray and netCDF4.
//! The conventions are those of the HDF5 "Dimension Scale Specification": a scale has the attributes CLASS and NAME, and
//! REFERENCE_LIST names its users; a user's DIMENSION_LIST holds references to its scales.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Display;
use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read, Seek};
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::str::FromStr;

use hdf5::file::FileBuilder;
use hdf5::plist::dataset_create::Layout;
use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenArray, VarLenAscii, VarLenUnicode};
use hdf5::{
    Attribute, Dataset, Datatype, Group, H5Type, IndexType, IterationOrder, LinkInfo, LinkType, Location, LocationType,
    ObjectReference1, OpenMode,
};
use memchr::memmem;
use thiserror::Error;

use crate::input;
use crate::memory::bounded;
use crate::text::short;

/// An error of something else, as one of the library with its words.
pub(crate) fn in_words(error: impl Display) -> hdf5::Error {
    error.to_string().into()
}

/// Beginning of an HDF5 file, at byte 0 or at 512, 1024 and so on.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// True where the superblock says that a program has the file open for writing; if it was killed, it still does, and plain readers refuse
/// the file.
pub(crate) fn is_being_written(file: &File) -> io::Result<bool> {
    Ok(superblock(file)?.is_some_and(|superblock| superblock.version == 3 && superblock.consistency & 1 != 0))
}

/// The first bytes of an HDF5 file.
struct Superblock {
    version: u8,
    /// Bytes of a length in this file.
    length_width: u8,
    /// Flags of a file that is open for writing.
    consistency: u8,
}

fn superblock(file: &File) -> io::Result<Option<Superblock>> {
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
fn endless_object(file: &File, superblock: &Superblock) -> io::Result<Option<u64>> {
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
fn for_each_dataset(file: &hdf5::File, bytes: &File, visit: &mut dyn FnMut(Dataset)) -> hdf5::Result<Option<String>> {
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

/// Number of times that the library tries to read an object of a file that is being written and is not whole yet. It waits 1 ns, then
/// twice as long each time: 33 ms in all. Left to itself it tries a hundred times, which no one lives to see.
const READ_ATTEMPTS: u32 = 25;
/// Bytes that everything but the data may take: names, attributes, and what the library keeps of a file.
const STRUCTURE: u64 = 256 << 20;
/// Bytes that deflate makes of one at most (RFC 1951), and other filters hardly ever.
const MOST_INFLATED: u64 = 1032;
/// Bytes of a dataset of which nothing need be in the file, for a value of its own may fill it.
const MADE_UP: u64 = 64 << 20;

#[derive(Debug, Error)]
pub(crate) enum OpenError {
    #[error(transparent)]
    System(#[from] io::Error),
    #[error(transparent)]
    Hdf5(#[from] hdf5::Error),
    /// Some of it is in other files.
    #[error("it is not complete in itself: {0}")]
    Elsewhere(String),
}

/// Opens a file for reading, also one that another program is writing, or was writing when it was killed. All that is read
/// of it is in it.
///
/// Locks are not asked for: many network file systems have none, and a reader needs none.
pub(crate) fn open(path: &Path) -> Result<hdf5::File, OpenError> {
    open_with(path, &mut drop)
}

/// Opens a file as [`open`] does, and gives its datasets besides, each once.
pub(crate) fn open_with_datasets(path: &Path) -> Result<(hdf5::File, Vec<Dataset>), OpenError> {
    let mut datasets = Vec::new();
    let file = open_with(path, &mut |dataset| datasets.push(dataset))?;
    Ok((file, datasets))
}

fn open_with(path: &Path, visit: &mut dyn FnMut(Dataset)) -> Result<hdf5::File, OpenError> {
    let bytes = input::open(path)?;
    if let Some(superblock) = superblock(&bytes)?
        && let Some(at) = endless_object(&bytes, &superblock)?
    {
        return Err(hdf5::Error::from(format!("the global heap is damaged at byte {at}")).into());
    }
    let mode = if is_being_written(&bytes)? { OpenMode::ReadSWMR } else { OpenMode::Read };
    let mut builder = FileBuilder::new();
    builder.with_fapl(|list| list.file_locking(false).metadata_read_attempts(READ_ATTEMPTS));
    // What the system lacks, as a handle, the library tells in words only; the system says it again.
    let file = builder.open_as(path, mode).map_err(|error| match input::open(path) {
        Err(system) => OpenError::System(system),
        Ok(_) => OpenError::Hdf5(error),
    })?;
    match for_each_dataset(&file, &bytes, visit)? {
        Some(what) => Err(OpenError::Elsewhere(what)),
        None => Ok(file),
    }
}

/// Refuses a dataset of a shape for which there is nothing like enough in the file: all of it would be made up.
pub(crate) fn refuse_hollow(dataset: &Dataset) -> hdf5::Result<()> {
    let shape = dataset.shape();
    let width = dataset.dtype()?.size() as u64;
    let declared = shape.iter().try_fold(width, |bytes, length| bytes.checked_mul(*length as u64));
    if declared.is_some_and(|bytes| bytes <= MADE_UP) {
        return Ok(());
    }
    // A damaged file may claim more than it has.
    let length = fs::metadata(dataset.filename()).map_or(0, |file| file.len());
    let there = dataset.storage_size().min(length);
    if declared.is_some_and(|bytes| bytes / MOST_INFLATED <= there) {
        return Ok(());
    }
    Err(format!("{} has shape {shape:?}, and {there} bytes in the file", dataset.name()).into())
}

/// Does `work` on a file, for `data` bytes of data, with no more memory than that needs.
///
/// The library takes what a file asks for before it looks whether that is there: a text of 4 GiB in a damaged file of
/// 10 kB takes ten seconds and all that memory to refuse.
pub(crate) fn guarded<T>(data: usize, work: impl FnOnce() -> T) -> T {
    // Twice, for a chunk as large as all the data.
    bounded(STRUCTURE.saturating_add((data as u64).saturating_mul(2)), work)
}

/// Tells whether a file has a superblock, which is where an HDF5 file begins.
pub(crate) fn is_hdf5(path: &Path) -> io::Result<bool> {
    Ok(superblock(&input::open(path)?)?.is_some())
}

/// An attribute that is one text of any kind, if there is one.
pub(crate) fn text_attribute(location: &Location, name: &str) -> hdf5::Result<Option<String>> {
    // There is no other way to ask whether it is there.
    location.attr(name).map_or(Ok(None), |attribute| text_of(&attribute))
}

/// The text that an attribute of one value holds, of any kind; none of other values.
pub(crate) fn text_of(attribute: &Attribute) -> hdf5::Result<Option<String>> {
    // A list of one, too, as netCDF writes texts.
    if attribute.space()?.size() != 1 {
        return Ok(None);
    }
    Ok(texts_of(attribute)?.into_iter().next())
}

/// The texts that an attribute holds, of any kind; none of other values.
pub(crate) fn texts_of(attribute: &Attribute) -> hdf5::Result<Vec<String>> {
    match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::VarLenUnicode => texts(attribute.read_raw::<VarLenUnicode>()),
        TypeDescriptor::VarLenAscii => texts(attribute.read_raw::<VarLenAscii>()),
        TypeDescriptor::FixedAscii(_) => texts(attribute.read_raw::<FixedAscii<64>>()),
        TypeDescriptor::FixedUnicode(_) => texts(attribute.read_raw::<FixedUnicode<64>>()),
        _ => Ok(Vec::new()),
    }
}

/// An attribute that is one number, if there is one. What an empty one (of a null dataspace) is said to hold is whatever the memory
/// held before.
pub(crate) fn number_attribute<T: H5Type>(location: &Location, name: &str) -> hdf5::Result<Option<T>> {
    let Ok(attribute) = location.attr(name) else { return Ok(None) };
    if attribute.space()?.size() == 1 { attribute.read_scalar().map(Some) } else { Ok(None) }
}

/// The bytes of a damaged file may be no text.
fn texts(read: hdf5::Result<Vec<impl AsRef<[u8]>>>) -> hdf5::Result<Vec<String>> {
    Ok(read?.iter().map(|text| String::from_utf8_lossy(text.as_ref()).into_owned()).collect())
}

/// Chunk cache of a dataset: slots, bytes, and 1 for "a chunk that is full goes first".
///
/// Nothing is read back, so it need hold no more than the chunk of a series that is being filled; a chunk of a map is written
/// at once. Every dataset has one that grows to its size.
const CHUNK_CACHE: (usize, usize, f64) = (31, 16 * 1024, 1.0);

/// Opens a file for writing, in the format that readers can follow.
///
/// Without locks, since many network file systems have none. They would protect nothing: HDF5 gives them up when
/// readers are let in, and marks the file itself as being written.
pub(crate) fn open_for_writing(path: &Path) -> hdf5::Result<hdf5::File> {
    let (slots, bytes, preemption) = CHUNK_CACHE;
    FileBuilder::new()
        .with_fapl(|list| list.libver_v110().file_locking(false).chunk_cache(slots, bytes, preemption))
        .open_rw(path)
}

/// Sets a text attribute, new or not.
pub(crate) fn write_text(location: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    // HDF5 ends a text at a null character; there is no other way to store one.
    let text = VarLenUnicode::from_str(&text.replace('\0', "\u{fffd}")).map_err(in_words)?;
    match location.attr(name) {
        Ok(attribute) => attribute.write_scalar(&text),
        Err(_) => location.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text),
    }
}

/// Adds an attribute that is one number.
pub(crate) fn write_number<T: H5Type>(location: &Location, name: &str, number: T) -> hdf5::Result<()> {
    location.new_attr::<T>().create(name)?.write_scalar(&number)
}

/// An HDF5 file without any objects. Its root group keeps the order in which links are made, and has one attribute,
/// CLASS = "DIMENSION_SCALE" as the specification wants it: 16 bytes, null-terminated.
///
/// The crate `hdf5` makes null-padded strings only, with which the HDF5 library does not recognise a dimension scale.
/// This file is where the type comes from; every run file starts as a copy of it. What says how a file is organised lies in
/// pages of 4 KiB here, so that a process that is killed while it writes has written the whole of a piece or nothing of it: a
/// system ends a write at the end of a page of memory. It was made by h5py:
/// ```python
/// options = dict(libver=("v110", "v110"), track_order=True, fs_strategy="page", fs_page_size=4096)
/// with h5py.File("empty.h5", "w", **options) as file:
///     text = h5py.h5t.C_S1.copy(); text.set_size(16); text.set_strpad(h5py.h5t.STR_NULLTERM)
///     attribute = h5py.h5a.create(file.id, b"CLASS", text, h5py.h5s.create(h5py.h5s.SCALAR))
///     attribute.write(numpy.array(b"DIMENSION_SCALE", dtype="S16"))
/// ```
pub(crate) const EMPTY_FILE: &[u8] = include_bytes!("empty.h5");

/// Attribute of a dataset: the scales of its dimensions.
const DIMENSION_LIST: &str = "DIMENSION_LIST";

type Text = FixedAscii<16>;

/// One entry of REFERENCE_LIST: a dataset, and which of its axes the scale describes.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
struct Axis {
    dataset: ObjectReference1,
    dimension: i32,
}

/// The dimension scales of a file that started as [`EMPTY_FILE`].
pub(crate) struct Dimensions {
    file: hdf5::File,
    text: Datatype,
    users: BTreeMap<&'static str, Vec<Axis>>,
}

impl Dimensions {
    /// Takes the string type out of the file.
    pub(crate) fn new(file: &hdf5::File) -> hdf5::Result<Self> {
        let text = file.attr("CLASS")?.dtype()?;
        file.delete_attr("CLASS")?;
        Ok(Self { file: file.clone(), text, users: BTreeMap::new() })
    }

    /// Makes the dataset with this path the scale of the dimension that has its name.
    pub(crate) fn make_scale(&mut self, dataset: &Dataset, name: &'static str) -> hdf5::Result<()> {
        let title = name.rsplit('/').next().unwrap_or(name);
        for (attribute, value) in [("CLASS", "DIMENSION_SCALE"), ("NAME", title)] {
            let value = Text::from_ascii(value).map_err(in_words)?;
            dataset.new_attr_builder().empty_as(self.text.clone()).create(attribute)?.write_scalar(&value)?;
        }
        self.users.insert(name, Vec::new());
        Ok(())
    }

    /// Names the axes of a dataset by scales made before.
    pub(crate) fn attach(&mut self, dataset: &Dataset, dimensions: &[&'static str]) -> hdf5::Result<()> {
        let itself: ObjectReference1 = self.file.reference(&dataset.name())?;
        let mut scales = Vec::with_capacity(dimensions.len());
        for (dimension, name) in (0..).zip(dimensions) {
            scales.push(VarLenArray::from_slice(&[self.file.reference::<ObjectReference1>(name)?]));
            self.users.entry(name).or_default().push(Axis { dataset: itself, dimension });
        }
        dataset
            .new_attr::<VarLenArray<ObjectReference1>>()
            .shape(scales.len())
            .create(DIMENSION_LIST)?
            .write_raw(&scales)
    }

    /// Writes into every scale which datasets it describes.
    pub(crate) fn finish(self) -> hdf5::Result<()> {
        for (name, users) in self.users.iter().filter(|(_, users)| !users.is_empty()) {
            let scale = self.file.dataset(name)?;
            scale.new_attr::<Axis>().shape(users.len()).create("REFERENCE_LIST")?.write_raw(users)?;
        }
        Ok(())
    }
}
