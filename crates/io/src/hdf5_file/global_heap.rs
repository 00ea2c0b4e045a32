//! The global heap of an HDF5 file, where texts and lists of any length are, and the one defect in it from which the
//! library does not come back: an object that takes no room. The library goes from object to object by the room that
//! each takes and does not notice that it stays where it is (HDF5 2.2, `H5HG__cache_heap_deserialize`).

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

use memchr::memmem;

use super::Superblock;
use super::blocks::for_each_block;

/// What a collection of objects starts with: its signature and its version.
const COLLECTION: &[u8] = b"GCOL\x01";
/// Bytes of the header of a collection, and of each object in it, for every width of lengths.
const HEADER: u64 = 16;
/// Where a file has an object that takes no room, if it has one.
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
