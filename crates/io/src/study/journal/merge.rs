//! Many shards made one, so that their number stays bounded.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write as _};
use std::path::Path;

use super::index::Journal;
use super::shard::{COMPLETE, create_file, host_in_names, shards};

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

/// Whether a shard belongs to a process of this machine that is no more.
fn is_of_the_dead(shard: &Path, host: &str) -> bool {
    let name = shard.file_name().map_or_else(Default::default, |name| name.to_string_lossy());
    let mut parts = name.split('_');
    let own = parts.next() == Some(host_in_names(host).as_str());
    let process = parts.next().and_then(|process| process.parse::<u32>().ok());
    // Without /proc nobody is known to be gone.
    let knows = Path::new("/proc/self").exists();
    own && knows && process.is_some_and(|process| !Path::new("/proc").join(process.to_string()).exists())
}
