//! Journal of a study: its results while many processes make them.
//!
//! Every process appends records to a file of its own, a *shard*: there is never a second writer, so no lock is needed and
//! network file systems will do. A record is one line, a checksum (CRC-32, 8 hexadecimal digits) and JSON; a line that is
//! torn or damaged is passed over, and its run is made again. `name.open` is being written, `name.journal` is complete.
//!
//! Shards that nobody writes any more are merged, so that their number stays bounded however often a study is taken up
//! again: [`merge`](fn@merge). Only those of which every line was understood are: what else has such a name may be somebody's notes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, BufWriter, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;

use super::record::{EVENT, Identity, Outcome, Record};
use crate::{input, limits};

#[cfg(test)]
#[path = "../../tests/unit/study/journal.rs"]
mod tests;

/// The line of a record, with its end.
pub(super) fn line(record: &Record) -> io::Result<Vec<u8>> {
    let json = serde_json::to_vec(record)?;
    let mut line = format!("{:08x} ", crc32fast::hash(&json)).into_bytes();
    line.extend_from_slice(&json);
    line.push(b'\n');
    if line.len() as u64 > limits::RECORD {
        let message = limits::more(line.len(), limits::RECORD, "bytes for the series of a run");
        return Err(io::Error::other(message + ": sample less often, or keep fewer series"));
    }
    Ok(line)
}

/// Record of a line; none if it is torn or damaged.
pub(super) fn parse(line: &[u8]) -> Option<Record> {
    let (sum, json) = line.strip_suffix(b"\n")?.split_at_checked(9)?;
    let sum = std::str::from_utf8(sum).ok()?.strip_suffix(' ')?;
    let intact = u32::from_str_radix(sum, 16).ok()? == crc32fast::hash(json);
    serde_json::from_slice(json).ok().filter(|_| intact)
}

/// Tells whether a line without end may be the beginning of a record: as much of a checksum, a blank and a brace as is there.
fn is_torn(line: &[u8]) -> bool {
    line.iter().take(10).enumerate().all(|(at, byte)| match at {
        0..8 => byte.is_ascii_hexdigit(),
        8 => *byte == b' ',
        _ => *byte == b'{',
    })
}

/// Reads a line with its end; how many bytes it has in the file. One that has more than `most` bytes is left empty.
pub(super) fn next_line(reader: &mut impl BufRead, line: &mut Vec<u8>, most: u64) -> io::Result<usize> {
    line.clear();
    let length = reader.by_ref().take(most).read_until(b'\n', line)?;
    if (length as u64) < most || line.ends_with(b"\n") {
        return Ok(length);
    }
    *line = Vec::new();
    Ok(length + reader.skip_until(b'\n')?)
}

/// Ending of a shard that is being written.
pub(super) const OPEN: &str = "open";
/// Ending of a shard that is complete.
pub(super) const COMPLETE: &str = "journal";

/// A shard that this process writes.
#[derive(Debug)]
pub struct Shard {
    folder: PathBuf,
    file: File,
    pub(super) path: PathBuf,
    host: String,
}

impl Shard {
    /// A new shard in the folder, which is made if it is not there. `host` is the name of this machine.
    pub fn create(folder: &Path, host: &str) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let (file, path) = create_file(folder, host)?;
        Ok(Self { folder: folder.to_owned(), file, path, host: host.to_owned() })
    }

    /// Appends a record. When this returns, it is on the disk.
    ///
    /// # Errors
    /// What the system says; what was written before is not harmed.
    pub fn append(&mut self, record: &Record) -> io::Result<()> {
        let line = line(record)?;
        self.write(&line)?;
        // Another process that took this one for dead has moved the shard away, maybe before it read this line.
        if !self.is_in_place() {
            (self.file, self.path) = create_file(&self.folder, &self.host)?;
            self.write(&line)?;
        }
        Ok(())
    }

    fn write(&mut self, line: &[u8]) -> io::Result<()> {
        self.file.write_all(line)?;
        self.file.sync_data()
    }

    fn is_in_place(&self) -> bool {
        let (own, found) = (self.file.metadata(), fs::metadata(&self.path));
        matches!((own, found), (Ok(own), Ok(found)) if (own.dev(), own.ino()) == (found.dev(), found.ino()))
    }

    /// Says that the shard is complete; one without records is removed.
    ///
    /// # Errors
    /// What the system says; the shard is then still readable.
    pub fn close(self) -> io::Result<()> {
        if !self.is_in_place() {
            return Ok(());
        }
        if self.file.metadata()?.len() == 0 {
            return fs::remove_file(&self.path);
        }
        fs::rename(&self.path, self.path.with_extension(COMPLETE))
    }
}

/// The name of a machine as it stands in names of shards.
fn host_in_names(host: &str) -> String {
    host.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' }).collect()
}

/// A file that nobody else has: host, process, when it was started, and a count.
fn create_file(folder: &Path, host: &str) -> io::Result<(File, PathBuf)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let host = host_in_names(host);
    let (process, now) = (std::process::id(), SystemTime::now().duration_since(SystemTime::UNIX_EPOCH));
    let now = now.map_or(0, |since| since.as_nanos());
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!("{host}_{process}_{now:x}-{count}.{OPEN}"));
        match OpenOptions::new().append(true).create_new(true).open(&path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            file => return Ok((file?, path)),
        }
    }
}

/// Tells whether a file has the name that [`create_file`] gives.
fn is_named_as_shard(path: &Path) -> bool {
    let stem = path.file_stem().map_or_else(Default::default, |stem| stem.to_string_lossy());
    let mut parts = stem.rsplitn(3, '_');
    let since = parts.next().and_then(|since| since.split_once('-'));
    let process = parts.next().unwrap_or_default();
    let is = |text: &str, digit: fn(&u8) -> bool| !text.is_empty() && text.as_bytes().iter().all(digit);
    since.is_some_and(|(since, count)| is(since, u8::is_ascii_hexdigit) && is(count, u8::is_ascii_digit))
        && is(process, u8::is_ascii_digit)
        && parts.next().is_some_and(|host| !host.is_empty())
}

/// Every shard, complete or not.
pub(super) fn shards(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    let mut shards = Vec::new();
    for entry in entries {
        let path = entry?.path();
        // To open a pipe would wait for whoever writes into it.
        if path.extension().is_some_and(|ending| ending == OPEN || ending == COMPLETE) && path.is_file() {
            shards.push(path);
        }
    }
    shards.sort();
    Ok(shards)
}

/// Places of the records of a study: one for each run, one that finished rather than one that failed, and of several that finished the one
/// that kept most.
#[derive(Debug, Clone, Default)]
pub struct Journal {
    pub(super) entries: BTreeMap<String, Entry>,
    /// Lines that were torn or damaged.
    pub damaged: usize,
    /// Files with lines that are no records, but for a torn last one: damaged, or of somebody else. They stay as they are.
    pub strange: Vec<PathBuf>,
    /// Extent to which each shard was read, by its name without the ending, bytes.
    read: BTreeMap<PathBuf, u64>,
}

/// Place of a record, and the end of its run.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Reason why the run failed, if it did.
    pub failure: Option<String>,
    /// Wall time, s.
    pub wall_time: f64,
    /// Number of the run when it was made.
    pub run: usize,
    /// The run that the result is of.
    pub of: Identity,
    /// Names of the series that were kept, and of the quantities of events.
    pub kept: Arc<BTreeSet<String>>,
    /// Time at which the run ended that was made last, as its record says; it may be another one.
    pub last: String,
    shard: PathBuf,
    start: u64,
}

impl Journal {
    /// Looks through all shards of a folder; there need not be any.
    pub fn read(folder: &Path) -> io::Result<Self> {
        let mut journal = Self::default();
        journal.read_on(folder)?;
        Ok(journal)
    }

    /// Looks for what was added since.
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

    /// Records of one shard.
    pub(super) fn of(shard: &Path) -> io::Result<Self> {
        Self::from(shard, 0)
    }

    /// Records of one shard from a byte on at which a line begins.
    fn from(shard: &Path, from: u64) -> io::Result<Self> {
        let mut journal = Self::default();
        let mut file = input::open(shard)?;
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
        let mut file = input::open(&self.shard)?;
        file.seek(SeekFrom::Start(self.start))?;
        let mut line = Vec::new();
        next_line(&mut BufReader::with_capacity(1 << 20, file), &mut line, limits::RECORD)?;
        Ok(line)
    }
}

/// Complete shards that are left as they are.
pub(super) const FEW: usize = 8;

/// Merges shards that nobody writes any more, if there are more than a few: complete ones, and those of processes of this
/// machine (`host`) that are gone.
///
/// # Errors
/// What the system says. No record is lost, whenever it happens.
pub fn merge(folder: &Path, host: &str) -> io::Result<()> {
    let mut idle = Vec::new();
    for shard in shards(folder)? {
        if shard.extension().is_some_and(|ending| ending == COMPLETE) {
            idle.push(shard);
        } else if is_of_the_dead(&shard, host) {
            // From here on a writer that is not dead after all sees that its shard is gone and begins another; what it wrote
            // before is in this one.
            let complete = shard.with_extension(COMPLETE);
            match fs::rename(&shard, &complete) {
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                renamed => renamed.map(|()| idle.push(complete))?,
            }
        }
    }
    if idle.len() <= FEW {
        return Ok(());
    }
    let mut journal = Journal::default();
    let mut read = Vec::new();
    for shard in idle {
        match Journal::of(&shard) {
            // Another process merges, too.
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            found => {
                let found = found?;
                if found.strange.is_empty() {
                    found.entries.into_iter().for_each(|(identity, entry)| journal.keep(identity, entry));
                    read.push(shard);
                }
            }
        }
    }
    // Those that stay do not make the others one file anew each time.
    if read.len() <= FEW {
        return Ok(());
    }
    let (file, path) = create_file(folder, host)?;
    let mut writer = BufWriter::new(file);
    for entry in journal.entries.values() {
        match entry.line() {
            Err(error) if error.kind() == ErrorKind::NotFound => return fs::remove_file(path),
            line => writer.write_all(&line?)?,
        }
    }
    writer.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
    fs::rename(&path, path.with_extension(COMPLETE))?;
    File::open(folder)?.sync_all()?;
    for shard in read {
        match fs::remove_file(shard) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    Ok(())
}

/// Tells whether a shard belongs to a process of this machine that is no more.
fn is_of_the_dead(shard: &Path, host: &str) -> bool {
    let name = shard.file_name().map_or_else(Default::default, |name| name.to_string_lossy());
    let mut parts = name.split('_');
    let own = parts.next() == Some(host_in_names(host).as_str());
    let process = parts.next().and_then(|process| process.parse::<u32>().ok());
    // Without /proc nobody is known to be gone.
    let knows = Path::new("/proc/self").exists();
    own && knows && process.is_some_and(|process| !Path::new("/proc").join(process.to_string()).exists())
}
