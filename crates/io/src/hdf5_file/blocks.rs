//! The bytes of a file, looked through from its beginning to its end.

use std::fs::File;
use std::io::{self, Read, Seek};

/// Bytes that are looked through at a time.
const BLOCK: usize = 1 << 20;

/// Calls `look` with the file block by block, and where each block starts, until it gives `false`. Blocks overlap, so that
/// whatever has `width` bytes is whole in one of them.
pub(super) fn for_each_block(
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
