//! HDF5 files that somebody else made, or that were damaged since: opened only if the library comes back from them.

use std::fs::File;
use std::io::{self, Read};
use std::os::unix::fs::FileExt;
use std::path::Path;

use hdf5::file::FileBuilder;
use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};
use hdf5::{Location, OpenMode};
use memchr::memmem;

/// Bytes that are looked through at a time.
const BLOCK: usize = 1 << 20;
/// What a global heap collection starts with: its signature and its version.
const COLLECTION: &[u8] = b"GCOL\x01";
/// Bytes of the header of a collection, and of each object in it, for every size of lengths.
const HEADER: u64 = 16;
/// How often the library tries to read an object of a file that is being written and is not whole yet. It waits 1 ns, then
/// twice as long each time: 33 ms in all. Left to itself it tries a hundred times, which no one lives to see.
const READ_ATTEMPTS: u32 = 25;
/// What an HDF5 file starts with, at byte 0 or at 512, 1024 and so on.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Opens a file for reading, also one that another program is writing, or was writing when it was killed.
///
/// Locks are not asked for: many network file systems have none, and a reader needs none.
///
/// # Errors
/// What the system or the library says, and a message when the file has a global heap in which the library would go
/// round for ever.
pub(crate) fn open(path: &Path) -> hdf5::Result<hdf5::File> {
    let system = |error: io::Error| hdf5::Error::from(error.to_string());
    let file = File::open(path).map_err(system)?;
    if let Some(at) = endless_heap(&file).map_err(system)? {
        return Err(format!("the global heap is damaged at byte {at}").into());
    }
    let mode = if is_being_written(&file).map_err(system)? { OpenMode::ReadSWMR } else { OpenMode::Read };
    let mut builder = FileBuilder::new();
    builder.with_fapl(|list| list.file_locking(false).metadata_read_attempts(READ_ATTEMPTS));
    builder.open_as(path, mode)
}

/// Whether a file has a superblock, which is where an HDF5 file begins.
pub(crate) fn is_hdf5(path: &Path) -> io::Result<bool> {
    Ok(superblock(&File::open(path)?)?.is_some())
}

/// An attribute that is one text of any kind, if there is one.
pub(crate) fn text_attribute(location: &Location, name: &str) -> Option<String> {
    let attribute = location.attr(name).ok().filter(|attribute| attribute.size() == 1)?;
    match attribute.dtype().ok()?.to_descriptor().ok()? {
        TypeDescriptor::VarLenUnicode => attribute.read_scalar::<VarLenUnicode>().ok().map(|text| text.to_string()),
        TypeDescriptor::VarLenAscii => attribute.read_scalar::<VarLenAscii>().ok().map(|text| text.to_string()),
        TypeDescriptor::FixedAscii(_) => attribute.read_scalar::<FixedAscii<64>>().ok().map(|text| text.to_string()),
        TypeDescriptor::FixedUnicode(_) => {
            attribute.read_scalar::<FixedUnicode<64>>().ok().map(|text| text.to_string())
        }
        _ => None,
    }
}

/// Where a file has an object of a global heap that takes no room, if it has one.
///
/// The library goes from object to object by the room that each takes and does not notice that it stays where it is
/// (HDF5 2.2, `H5HG__cache_heap_deserialize`). Every other fault of a heap it finds by itself.
fn endless_heap(file: &File) -> io::Result<Option<u64>> {
    let Some(width) = length_width(file)? else { return Ok(None) };
    let mut heap = None;
    for_each(file, COLLECTION, |start| {
        heap = endless_object(file, start, width)?;
        Ok(heap.is_none())
    })?;
    Ok(heap)
}

/// Calls `found` with every place at which the file has `bytes`, until it gives `false`.
fn for_each(mut file: &File, bytes: &[u8], mut found: impl FnMut(u64) -> io::Result<bool>) -> io::Result<()> {
    let finder = memmem::Finder::new(bytes);
    let mut block = Vec::with_capacity(BLOCK + bytes.len());
    let mut start = 0;
    loop {
        let read = file.by_ref().take(BLOCK as u64).read_to_end(&mut block)?;
        for at in finder.find_iter(&block) {
            if !found(start + at as u64)? {
                return Ok(());
            }
        }
        if read == 0 {
            return Ok(());
        }
        // What begins at the end of this block ends in the next.
        let done = block.len().saturating_sub(bytes.len() - 1);
        block.drain(..done);
        start += done as u64;
    }
}

/// Whether the superblock says that a program has the file open for writing; if it was killed, it still does.
fn is_being_written(file: &File) -> io::Result<bool> {
    Ok(superblock(file)?.is_some_and(|superblock| superblock[8] == 3 && superblock[11] & 1 != 0))
}

/// Bytes of a length in this file, if it is an HDF5 file with a superblock that is known.
fn length_width(file: &File) -> io::Result<Option<usize>> {
    let width = superblock(file)?.map(|superblock| match superblock[8] {
        0 | 1 => superblock[14],
        _ => superblock[10],
    });
    Ok(width.filter(|width| [2, 4, 8].contains(width)).map(usize::from))
}

/// The first bytes of a file's superblock, if it has one.
fn superblock(file: &File) -> io::Result<Option<[u8; 16]>> {
    let length = file.metadata()?.len();
    let mut superblock = [0; 16];
    let mut at = 0;
    while at < length {
        if file.read_at(&mut superblock, at)? == superblock.len() && superblock.starts_with(SIGNATURE) {
            return Ok(Some(superblock));
        }
        at = if at == 0 { 512 } else { 2 * at };
    }
    Ok(None)
}

/// Where the collection that starts at `start` has an object that takes no room, if it has one.
fn endless_object(file: &File, start: u64, width: usize) -> io::Result<Option<u64>> {
    let mut header = [0; HEADER as usize];
    if file.read_at(&mut header, start)? < header.len() {
        return Ok(None);
    }
    let end = start.saturating_add(number(&header[8..8 + width]));
    let mut at = start + HEADER;
    while at.saturating_add(HEADER) <= end && file.read_at(&mut header, at)? == header.len() {
        let size = number(&header[8..8 + width]);
        let is_free_space = number(&header[..2]) == 0;
        // As the library reckons, overflow included: objects are padded to whole eights, free space counts its header.
        let room = if is_free_space { size } else { HEADER.wrapping_add(size.wrapping_add(7) / 8 * 8) };
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
