//! Files of others, which somebody may have damaged, opened only if the library comes back from them; their attributes.

use std::path::Path;
use std::{fs, io};

use super::inspection::{endless_object, for_each_dataset, is_being_written, superblock};
use hdf5::file::FileBuilder;
use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};
use hdf5::{Attribute, Dataset, H5Type, Location, OpenMode};
use thiserror::Error;

use crate::input;
use crate::memory::bounded;

/// Number of times that the library tries to read an object of a file that is being written and is not whole yet. It waits 1 ns, then
/// twice as long each time: 33 ms in all. Left to itself it tries a hundred times, which no one lives to see.
const READ_ATTEMPTS: u32 = 25;
/// Bytes that everything but the data may take: names, attributes, and what the library keeps of a file.
const STRUCTURE: u64 = 256 << 20;
/// Bytes that deflate makes of one at most (RFC 1951), and other filters hardly ever.
const MOST_INFLATED: u64 = 1032;
/// Bytes of a dataset of which nothing need be in the file, for a value of its own may fill it.
const MADE_UP: u64 = 64 << 20;

/// Reason why a file is not opened.
#[derive(Debug, Error)]
pub(crate) enum OpenError {
    /// Message of the system.
    #[error(transparent)]
    System(#[from] io::Error),
    /// Message of the library.
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

/// Tells whether a file is marked as being written, or was when its writer was killed: then plain readers refuse it.
pub(crate) fn is_marked(path: &Path) -> io::Result<bool> {
    is_being_written(&input::open(path)?)
}

/// An attribute that is one text of any kind, if there is one.
pub(crate) fn text_attribute(location: &Location, name: &str) -> hdf5::Result<Option<String>> {
    attribute_of_one(location, name)?.map_or(Ok(None), |attribute| text_of(&attribute))
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

/// An attribute that is one number, if there is one.
pub(crate) fn number_attribute<T: H5Type>(location: &Location, name: &str) -> hdf5::Result<Option<T>> {
    attribute_of_one(location, name)?.map(|attribute| attribute.read_scalar()).transpose()
}

/// An attribute that holds one value, if there is one. What an empty one (of a null dataspace) is said to hold is whatever the
/// memory held before.
fn attribute_of_one(location: &Location, name: &str) -> hdf5::Result<Option<Attribute>> {
    // There is no other way to ask whether it is there.
    let Ok(attribute) = location.attr(name) else { return Ok(None) };
    Ok(if attribute.space()?.size() == 1 { Some(attribute) } else { None })
}

/// The bytes of a damaged file may be no text.
fn texts(read: hdf5::Result<Vec<impl AsRef<[u8]>>>) -> hdf5::Result<Vec<String>> {
    Ok(read?.iter().map(|text| String::from_utf8_lossy(text.as_ref()).into_owned()).collect())
}
