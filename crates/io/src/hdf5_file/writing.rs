//! How HDF5 files are opened for writing, and attributes written.

use std::path::Path;
use std::str::FromStr;

use hdf5::file::{File, FileBuilder};
use hdf5::types::VarLenUnicode;
use hdf5::{H5Type, Location};

/// Chunk cache of a dataset: slots, bytes, and 1 for "a chunk that is full goes first".
///
/// Nothing is read back, so it need hold no more than the chunk of a series that is being filled; a chunk of a map is written
/// at once. Every dataset has one that grows to its size.
const CHUNK_CACHE: (usize, usize, f64) = (31, 16 * 1024, 1.0);

/// Opens a file for writing, in the format that readers can follow.
///
/// Without locks, since many network file systems have none. They would protect nothing: HDF5 gives them up when
/// readers are let in, and marks the file itself as being written.
pub(crate) fn open_for_writing(path: &Path) -> hdf5::Result<File> {
    let (slots, bytes, preemption) = CHUNK_CACHE;
    FileBuilder::new()
        .with_fapl(|list| list.libver_v110().file_locking(false).chunk_cache(slots, bytes, preemption))
        .open_rw(path)
}

/// Sets a text attribute, new or not.
pub(crate) fn write_text(location: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    // HDF5 ends a text at a null character; there is no other way to store one.
    let text = VarLenUnicode::from_str(&text.replace('\0', "\u{fffd}"))
        .map_err(|error| hdf5::Error::from(error.to_string()))?;
    match location.attr(name) {
        Ok(attribute) => attribute.write_scalar(&text),
        Err(_) => location.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text),
    }
}

/// Adds an attribute that is one number.
pub(crate) fn write_number<T: H5Type>(location: &Location, name: &str, number: T) -> hdf5::Result<()> {
    location.new_attr::<T>().create(name)?.write_scalar(&number)
}
