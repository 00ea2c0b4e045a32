//! Where each record of a study is, among all shards.

use std::collections::BTreeMap;
use std::io::{self, BufReader, ErrorKind, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use super::super::record::{Outcome, Record};
use super::line::{is_torn, next_line, parse};
use super::shard::{is_named_as_shard, shards};
use crate::{limits, regular};

/// Where the records of a study are: one for each run, one that finished rather than one that failed.
#[derive(Debug, Clone, Default)]
pub struct Journal {
    pub(super) entries: BTreeMap<String, Entry>,
    /// Lines that were torn or damaged.
    pub damaged: usize,
    /// Files with lines that are no records, but for a torn last one: damaged, or of somebody else. They stay as they are.
    pub strange: Vec<PathBuf>,
}

/// Where a record is, and how its run ended.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Why the run failed, if it did.
    pub failure: Option<String>,
    /// Wall time, s.
    pub wall_time: f64,
    shard: PathBuf,
    start: u64,
}

impl Journal {
    /// Looks through all shards of a folder; there need not be any.
    ///
    /// # Errors
    /// What the system says.
    pub fn read(folder: &Path) -> io::Result<Self> {
        // While shards are merged, a list of them grows old; the merged one is there before they go.
        let mut lists = 0..100;
        loop {
            let mut journal = Self::default();
            let read = shards(folder)?.iter().try_for_each(|shard| journal.add(shard));
            match read {
                Err(error) if error.kind() == ErrorKind::NotFound && lists.next().is_some() => {}
                read => return read.map(|()| journal),
            }
        }
    }

    /// The entry of a run.
    pub fn get(&self, identity: &str) -> Option<&Entry> {
        self.entries.get(identity)
    }

    /// Number of runs that have ended, of this study or of what it was before.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether no run has ended.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds what a shard has.
    fn add(&mut self, shard: &Path) -> io::Result<()> {
        let found = Self::of(shard)?;
        self.damaged += found.damaged;
        self.strange.extend(found.strange);
        found.entries.into_iter().for_each(|(identity, entry)| self.keep(identity, entry));
        Ok(())
    }

    /// What one shard has.
    pub(super) fn of(shard: &Path) -> io::Result<Self> {
        let mut journal = Self::default();
        let mut reader = BufReader::with_capacity(1 << 20, regular::open(shard)?);
        let (mut line, mut start, mut is_strange, mut records) = (Vec::new(), 0, false, 0);
        loop {
            let length = next_line(&mut reader, &mut line, limits::RECORD)?;
            if length == 0 {
                break;
            }
            if let Some(record) = parse(&line) {
                let failure = match record.outcome {
                    Outcome::Finished { .. } => None,
                    Outcome::Failed { error } => Some(error),
                };
                let entry = Entry { failure, wall_time: record.wall_time, shard: shard.to_owned(), start };
                journal.keep(record.identity, entry);
                records += 1;
            } else {
                journal.damaged += 1;
                // Only the last line of a shard has no end.
                is_strange |= line.ends_with(b"\n") || !is_torn(&line);
            }
            start += length as u64;
        }
        if is_strange || (records == 0 && !is_named_as_shard(shard)) {
            journal.strange.push(shard.to_owned());
        }
        Ok(journal)
    }

    /// Keeps an entry, unless one that is known of the same run is as good.
    pub(super) fn keep(&mut self, identity: String, entry: Entry) {
        let known = self.entries.get(&identity);
        if known.is_none_or(|known| known.failure.is_some() && entry.failure.is_none()) {
            self.entries.insert(identity, entry);
        }
    }
}

impl Entry {
    /// The record.
    ///
    /// # Errors
    /// What the system says; [`ErrorKind::NotFound`] when the shard was merged meanwhile, and the journal has to be read
    /// again; [`ErrorKind::InvalidData`] when the record was damaged meanwhile.
    pub fn record(&self) -> io::Result<Record> {
        parse(&self.line()?).ok_or_else(|| ErrorKind::InvalidData.into())
    }

    /// The line of the record in its shard.
    pub(super) fn line(&self) -> io::Result<Vec<u8>> {
        let mut file = regular::open(&self.shard)?;
        file.seek(SeekFrom::Start(self.start))?;
        let mut line = Vec::new();
        next_line(&mut BufReader::with_capacity(1 << 20, file), &mut line, limits::RECORD)?;
        Ok(line)
    }
}
