//! Where each record of a study is, among all shards.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, BufReader, ErrorKind, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::identity::Identity;
use super::super::record::{EVENT, Outcome, Record};
use super::line::{is_torn, next_line, parse};
use super::shard::{is_named_as_shard, shards};
use crate::{limits, regular};

/// Where the records of a study are: one for each run, one that finished rather than one that failed, and of several that finished the one
/// that kept most.
#[derive(Debug, Clone, Default)]
pub struct Journal {
    pub(super) entries: BTreeMap<String, Entry>,
    /// Lines that were torn or damaged.
    pub damaged: usize,
    /// Files with lines that are no records, but for a torn last one: damaged, or of somebody else. They stay as they are.
    pub strange: Vec<PathBuf>,
    /// How far each shard was read, by its name without the ending, bytes.
    read: BTreeMap<PathBuf, u64>,
}

/// Where a record is, and how its run ended.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Why the run failed, if it did.
    pub failure: Option<String>,
    /// Wall time, s.
    pub wall_time: f64,
    /// Number of the run when it was made.
    pub run: usize,
    /// What was run.
    pub of: Identity,
    /// Names of the series that were kept, and of the quantities of events.
    pub kept: Arc<BTreeSet<String>>,
    /// When the run ended that was made last, as its record says; it may be another one.
    pub last: String,
    shard: PathBuf,
    start: u64,
}

impl Journal {
    /// Looks through all shards of a folder; there need not be any.
    ///
    /// # Errors
    /// What the system says.
    pub fn read(folder: &Path) -> io::Result<Self> {
        let mut journal = Self::default();
        journal.read_on(folder)?;
        Ok(journal)
    }

    /// Looks for what was added since.
    ///
    /// # Errors
    /// What the system says.
    pub fn read_on(&mut self, folder: &Path) -> io::Result<()> {
        // While shards are merged, a list of them grows old; the merged one is there before they go.
        let mut lists = 0..100;
        loop {
            match shards(folder)?.iter().try_for_each(|shard| self.add(shard)) {
                Err(error) if error.kind() == ErrorKind::NotFound && lists.next().is_some() => {}
                read => return read,
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

    /// Adds what a shard has that was not read yet.
    fn add(&mut self, shard: &Path) -> io::Result<()> {
        let name = shard.with_extension("");
        let from = self.read.get(&name).copied().unwrap_or(0);
        let found = Self::from(shard, from)?;
        self.damaged += found.damaged;
        self.strange.extend(found.strange);
        self.read.extend(found.read);
        found.entries.into_iter().for_each(|(identity, entry)| self.keep(identity, entry));
        Ok(())
    }

    /// What one shard has.
    pub(super) fn of(shard: &Path) -> io::Result<Self> {
        Self::from(shard, 0)
    }

    /// What one shard has from a byte on at which a line begins.
    fn from(shard: &Path, from: u64) -> io::Result<Self> {
        let mut journal = Self::default();
        let mut file = regular::open(shard)?;
        file.seek(SeekFrom::Start(from))?;
        let mut reader = BufReader::with_capacity(1 << 20, file);
        let (mut line, mut start, mut end, mut is_strange, mut records) = (Vec::new(), from, from, false, 0);
        let mut kept = Arc::default();
        loop {
            let length = next_line(&mut reader, &mut line, limits::RECORD)?;
            if length == 0 {
                break;
            }
            let next = start + length as u64;
            if let Some(record) = parse(&line) {
                let failure = match record.outcome {
                    Outcome::Finished { series, events, .. } => {
                        let events =
                            events.iter().flat_map(|events| events.names()).map(|name| format!("{EVENT}{name}"));
                        let names: BTreeSet<String> = series.names().iter().cloned().chain(events).collect();
                        // Those of the runs of a study are mostly the same.
                        if names != *kept {
                            kept = Arc::new(names);
                        }
                        None
                    }
                    Outcome::Failed { error } => Some(error),
                };
                let kept = if failure.is_none() { kept.clone() } else { Arc::default() };
                let Record { wall_time, run, of, end_time: last, .. } = record;
                let entry = Entry { failure, wall_time, run, of, kept, last, shard: shard.to_owned(), start };
                journal.keep(record.identity, entry);
                records += 1;
                end = next;
            } else {
                journal.damaged += 1;
                // Only the last line of a shard has no end; it may still be written.
                let is_last = !line.ends_with(b"\n");
                is_strange |= !is_last || !is_torn(&line);
                end = if is_last { start } else { next };
            }
            start = next;
        }
        if is_strange || (from == 0 && records == 0 && !is_named_as_shard(shard)) {
            journal.strange.push(shard.to_owned());
        }
        journal.read.insert(shard.with_extension(""), end);
        Ok(journal)
    }

    /// Keeps an entry, unless one that is known of the same run is as good.
    pub(super) fn keep(&mut self, identity: String, entry: Entry) {
        let Some(known) = self.entries.get_mut(&identity) else {
            self.entries.insert(identity, entry);
            return;
        };
        let last = known.last.clone().max(entry.last.clone());
        let is_better = match (&known.failure, &entry.failure) {
            (Some(_), None) => true,
            (None, None) => entry.kept.len() > known.kept.len(),
            (_, Some(_)) => false,
        };
        if is_better {
            *known = entry;
        }
        known.last = last;
    }

    /// All entries, each with the identity of its run.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Entry)> {
        self.entries.iter().map(|(identity, entry)| (identity.as_str(), entry))
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
