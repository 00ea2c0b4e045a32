//! A shard: a file of records that one process writes.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;

use super::super::record::Record;
use super::line::line;

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
    ///
    /// # Errors
    /// What the system says.
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
pub(super) fn host_in_names(host: &str) -> String {
    host.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' }).collect()
}

/// A file that nobody else has: host, process, when it was started, and a count.
pub(super) fn create_file(folder: &Path, host: &str) -> io::Result<(File, PathBuf)> {
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

/// Whether a file has the name that [`create_file`] gives.
pub(super) fn is_named_as_shard(path: &Path) -> bool {
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
