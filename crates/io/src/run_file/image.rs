//! Image: the organisation of a run file at a checkpoint, so that a loss of power afterwards does it no harm.
//!
//! A series or map that is on the disk is only appended to, but what says where its parts are is written again and again. After a
//! loss of power some of that may be new and some old, and then nothing can be read. So a checkpoint keeps all of the file that is
//! neither a value of a series nor of a map, as it was when the file was last handed to the disk. Put back, it makes the file what
//! it was then.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read as _};
use std::os::unix::fs::FileExt as _;
use std::path::Path;

use hdf5::Dataset;
use memchr::memmem;
use serde::{Deserialize, Serialize};

use crate::input;
use crate::process::Process;
use crate::temporary::Temporary;

/// Attribute of the root of a run file that is being written: a word that no other file has. It tells which file an image is of.
pub(super) const MARK: &str = "mark";
/// Zeros that are not worth leaving out of an image, bytes.
const SHORT: usize = 64;

/// All of a run file but the values of its series and maps, as it was at a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Image {
    /// Process that was writing the file.
    pub writer: Process,
    /// Length of the file, bytes.
    length: u64,
    /// See [`MARK`].
    mark: String,
    /// Its place in the file, bytes.
    mark_at: u64,
    /// Pieces of the file: their beginnings and bytes.
    pieces: Vec<(u64, Vec<u8>)>,
    /// Zeros that are in no piece: their beginnings and numbers.
    zeros: Vec<(u64, u64)>,
}

impl Image {
    /// Takes the image of a file that was flushed. None if the file has not the mark.
    pub(super) fn of(path: &Path, values: &Values, mark: &str) -> io::Result<Option<Self>> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut image = Self {
            writer: Process::this(),
            length,
            mark: mark.to_owned(),
            mark_at: length,
            pieces: Vec::new(),
            zeros: Vec::new(),
        };
        let mut from = 0;
        let ends = values.extents.iter().map(|(start, end)| (*start, *end)).chain([(length, length)]);
        for (start, end) in ends {
            if from < start.min(length) {
                let mut bytes = vec![0; (start.min(length) - from) as usize];
                file.read_exact_at(&mut bytes, from)?;
                if let Some(at) = memmem::find(&bytes, mark.as_bytes()) {
                    image.mark_at = from + at as u64;
                }
                image.add(from, &bytes);
            }
            from = from.max(end);
        }
        Ok((image.mark_at < length).then_some(image))
    }

    /// Adds a part of the file; long zeros, such as pages that are not full, are only counted.
    fn add(&mut self, start: u64, bytes: &[u8]) {
        let mut begin = 0;
        let mut at = 0;
        while at < bytes.len() {
            let zeros = bytes[at..].iter().take_while(|byte| **byte == 0).count();
            if zeros > SHORT {
                self.add_piece(start, &bytes[..at], begin);
                self.zeros.push((start + at as u64, zeros as u64));
                begin = at + zeros;
            }
            at += zeros;
            at += bytes[at..].iter().take_while(|byte| **byte != 0).count();
        }
        self.add_piece(start, bytes, begin);
    }

    fn add_piece(&mut self, start: u64, bytes: &[u8], begin: usize) {
        if begin < bytes.len() {
            self.pieces.push((start + begin as u64, bytes[begin..].to_vec()));
        }
    }

    /// Tells whether a file is the one that this is an image of, and still has what it had then.
    pub fn is_of(&self, path: &Path) -> bool {
        let mut mark = vec![0; self.mark.len()];
        let there = input::open(path).and_then(|file| {
            file.read_exact_at(&mut mark, self.mark_at)?;
            file.metadata()
        });
        there.is_ok_and(|there| there.len() >= self.length) && mark == self.mark.as_bytes()
    }

    /// A copy of the file as it was, beside it.
    pub(super) fn restore(&self, path: &Path) -> io::Result<Temporary> {
        let (temporary, mut copy) = Temporary::create(path)?;
        // Who may not read the file may not read its copy.
        temporary.permit_as(path);
        io::copy(&mut input::open(path)?.take(self.length), &mut copy)?;
        for (at, bytes) in &self.pieces {
            self.check(*at, bytes.len() as u64)?;
            copy.write_all_at(bytes, *at)?;
        }
        for (at, count) in &self.zeros {
            self.check(*at, *count)?;
            copy.write_all_at(&vec![0; *count as usize], *at)?;
        }
        if fs::metadata(temporary.path())?.len() != self.length {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        Ok(temporary)
    }

    fn check(&self, at: u64, count: u64) -> io::Result<()> {
        let end = at.checked_add(count).filter(|end| *end <= self.length);
        end.map(|_| ()).ok_or_else(|| io::Error::new(ErrorKind::InvalidData, "an image of it goes beyond its end"))
    }
}

/// Extents of the values of series and maps in a file.
#[derive(Debug, Default)]
pub(super) struct Values {
    /// Beginning of each extent, and where it ends. None touches another.
    extents: BTreeMap<u64, u64>,
    /// Chunks of each dataset that are in it: they come in their order, and stay where they are.
    chunks: Vec<usize>,
}

impl Values {
    /// Adds what is new in these datasets since the last time; they are always the same.
    pub(super) fn add_new_of<'a>(&mut self, datasets: impl Iterator<Item = &'a Dataset>) {
        for (number, dataset) in datasets.enumerate() {
            if number == self.chunks.len() {
                self.chunks.push(0);
            }
            let chunks = dataset.num_chunks().unwrap_or(0);
            for index in self.chunks[number]..chunks {
                let Some(chunk) = dataset.chunk_info(index) else { break };
                self.add(chunk.addr, chunk.addr + chunk.size);
                self.chunks[number] = index + 1;
            }
        }
    }

    fn add(&mut self, mut start: u64, mut end: u64) {
        if let Some((before, its_end)) = self.extents.range(..=start).next_back().map(|(start, end)| (*start, *end))
            && its_end >= start
        {
            self.extents.remove(&before);
            (start, end) = (before, end.max(its_end));
        }
        if let Some(its_end) = self.extents.remove(&end) {
            end = its_end;
        }
        self.extents.insert(start, end);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/run_file/image.rs"]
mod tests;
