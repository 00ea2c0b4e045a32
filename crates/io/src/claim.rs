//! Claims: one process at a time writes a run file and its checkpoints.
//!
//! Whoever begins to write `run.h5` first makes `run.h5.lock` beside it, which says who that is, and removes it in the
//! end. The file is made complete under another name and then linked, which fails where there is one; where a file system
//! has no links it is made by an open that fails where there is one. So no locks of the system are needed, which network
//! file systems may lack.
//!
//! A process that was killed leaves its lock. Another process of the same machine sees that, and takes it over: it locks that file for
//! the system, which a kill ends, looks whether it still is there, and replaces it. So of several that find a lock left over one gets it,
//! and nobody takes a new one for it. Where a file system knows no such locks, that holds unless two do so at the very same moment.
//!
//! Of a process of another machine nobody can see whether it lives. Where others wait for what it has, as those that share a study, it
//! touches its lock now and then: [`Claim::touch`]. Who has seen for long that nobody touches it takes it over: [`Claim::of_silent`]. Only
//! changes count, so clocks need not agree.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::process::{Life, Process, Writer, writer_of};
use crate::temporary::{self, Temporary, folder};
use crate::text::{is_plain, short};
use crate::timestamp::iso_8601;

/// Version of the format.
const VERSION: u32 = 2;
/// Beginning of every lock.
const START: &str = "{\"plateau_lock\":";
/// More bytes than any lock has.
const LARGEST: u64 = 4096;
/// Number of times that a lock that is not complete is read, and how long is waited before: without links it is first made, then filled.
const LOOKS: u32 = 20;
const PAUSE: Duration = Duration::from_millis(50);

/// The right to write a run file and what lies beside it, until it is dropped.
#[derive(Debug)]
#[must_use]
pub struct Claim {
    lock: PathBuf,
    owner: Owner,
    /// Process that had the lock and left it.
    before: Option<Process>,
}

/// A lock as somebody saw it: which, and when it was touched last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seen {
    number: String,
    touched: SystemTime,
}

/// Content of a lock.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Owner {
    /// [`VERSION`].
    plateau_lock: u32,
    writer: Process,
    /// Time at which the claim was made, ISO 8601.
    since: String,
    /// Word that only this lock has.
    number: String,
}

/// Content that locks of every version have.
#[derive(Deserialize)]
struct Version {
    plateau_lock: u32,
}

/// Reason why a file, named first, is not claimed.
#[derive(Debug, Error)]
pub enum ClaimError {
    /// A living process of this machine has it, since that time, ISO 8601.
    #[error("{} is being written by process {}, since {}; stop that first, or write elsewhere", .0.display(), .1, short(.2))]
    Here(PathBuf, u32, String),
    /// Nobody here can tell whether the process that has it lives.
    #[error("{0}")]
    Elsewhere(String),
    /// Something else has the name of the lock, or another version of the program has it, or had.
    #[error("{0}")]
    Foreign(String),
    /// Nobody can tell who has it, or no lock can be made, for what the system says.
    #[error("{0}")]
    System(String, #[source] io::Error),
}

impl ClaimError {
    /// Tells whether the disk is full: nothing that another name would mend.
    pub fn lacks_space(&self) -> bool {
        let full = [ErrorKind::StorageFull, ErrorKind::QuotaExceeded, ErrorKind::FileTooLarge];
        matches!(self, Self::System(_, error) if full.contains(&error.kind()))
    }
}

impl Claim {
    /// Claims a file, which need not be there. Its folder must be. Where it is a link, what that points to is claimed.
    pub fn of(path: &Path) -> Result<Self, ClaimError> {
        Self::with(path, None)
    }

    /// Claims as [`of`](Self::of) does, and takes over the lock of a process of another machine if it still is as [`seen`](Self::seen).
    pub fn of_silent(path: &Path, seen: &Seen) -> Result<Self, ClaimError> {
        Self::with(path, Some(seen))
    }

    fn with(path: &Path, silent: Option<&Seen>) -> Result<Self, ClaimError> {
        let lock = lock_of(path);
        let claim = Self::take(path, &lock, silent)?;
        Temporary::remove_abandoned(&lock);
        Ok(claim)
    }

    /// The lock of a file as it is now, if there is one.
    pub fn seen(path: &Path) -> Option<Seen> {
        let lock = lock_of(path);
        let number = read(path, &lock).ok()??.number;
        // What is opened is as it is now, also on network file systems.
        Some(Seen { number, touched: File::open(&lock).ok()?.metadata().ok()?.modified().ok()? })
    }

    /// Shows others that this process lives.
    pub fn touch(&self) {
        if self.is_in_place() {
            // Who sees nothing for long takes the claim over; then the work is done twice.
            let _ = File::options().append(true).open(&self.lock).and_then(|lock| lock.set_modified(SystemTime::now()));
        }
    }

    fn is_in_place(&self) -> bool {
        read(&self.lock, &self.lock).is_ok_and(|there| there.as_ref() == Some(&self.owner))
    }

    fn take(path: &Path, lock: &Path, silent: Option<&Seen>) -> Result<Self, ClaimError> {
        let system = |error| {
            let directory = folder(lock).display();
            let advice = "make the directory writable, or write elsewhere with -o FILE";
            ClaimError::System(format!("cannot make a file in {directory}: {error}; {advice}"), error)
        };
        let owner = Owner::this();
        let text = serde_json::to_string(&owner).map_err(|error| system(error.into()))? + "\n";
        loop {
            let (temporary, mut file) = Temporary::create(lock).map_err(system)?;
            // After a power failure, too, it is complete or not there.
            file.write_all(text.as_bytes()).and_then(|()| file.sync_all()).map_err(system)?;
            if make(temporary.path(), lock, &text).map_err(system)? {
                return Ok(Self { lock: lock.to_owned(), owner, before: None });
            }
            let Some(there) = read(path, lock)? else { continue };
            let is_silent = || silent.is_some() && Self::seen(path).as_ref() == silent;
            let is_gone = match there.writer.life() {
                Life::Ended => true,
                Life::Unknown => is_silent(),
                Life::Lives => false,
            };
            if !is_gone {
                return Err(there.refusal(path, lock));
            }
            // Whoever writes the file on this machine lives, whatever the lock says.
            if let Writer::Process(process) = writer_of(path) {
                return Err(ClaimError::Here(path.to_owned(), process, there.since));
            }
            let Ok(left) = File::open(lock) else { continue };
            if let Err(TryLockError::WouldBlock) = left.try_lock() {
                thread::sleep(PAUSE / LOOKS);
                continue;
            }
            // Only who has locked that file replaces it, and nobody else would remove it.
            if read(path, lock)?.is_some_and(|now| now == there) {
                fs::rename(temporary.path(), lock).map_err(system)?;
                return Ok(Self { lock: lock.to_owned(), owner, before: Some(there.writer) });
            }
        }
    }

    /// The process that wrote the file before and ended without giving up its claim.
    pub fn before(&self) -> Option<&Process> {
        self.before.as_ref()
    }

    /// Tells whether a file could be claimed now, for a quick answer; touches nothing. True where there is the lock of a process that
    /// has ended, so that it is known who wrote the file last.
    pub fn check(path: &Path) -> Result<bool, ClaimError> {
        let lock = lock_of(path);
        match read(path, &lock)? {
            Some(there) if there.writer.life() != Life::Ended => Err(there.refusal(path, &lock)),
            there => Ok(there.is_some()),
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // Somebody may have removed the lock, and another process made its own. Nobody is left to tell what fails.
        if self.is_in_place() {
            let _ = fs::remove_file(&self.lock);
        }
    }
}

impl Owner {
    fn this() -> Self {
        Self {
            plateau_lock: VERSION,
            writer: Process::this(),
            since: iso_8601(SystemTime::now()),
            number: temporary::unique_word(),
        }
    }

    /// Tells whether it may be what this program wrote; it is shown in messages.
    fn is_whole(&self) -> bool {
        let shown = [&self.writer.machine.host, &self.since];
        temporary::is_unique_word(&self.number) && shown.iter().all(|text| text.chars().all(is_plain))
    }

    fn refusal(self, path: &Path, lock: &Path) -> ClaimError {
        let process = self.writer.number;
        if self.writer.life() != Life::Unknown {
            return ClaimError::Here(path.to_owned(), process, self.since);
        }
        ClaimError::Elsewhere(format!(
            "{} is being written by process {process} of the machine {}, since {}, and from here it cannot be told whether that lives; \
             if it has ended, remove {}",
            path.display(),
            short(&self.writer.machine.host),
            short(&self.since),
            lock.display()
        ))
    }
}

/// Path of the lock of a file.
pub fn lock_of(path: &Path) -> PathBuf {
    let real = if path.is_symlink() { path.canonicalize().ok() } else { None };
    let path = real.as_deref().unwrap_or(path);
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".lock");
    path.with_file_name(name)
}

/// Gives a complete file the name of a lock; tells whether that was free.
fn make(complete: &Path, lock: &Path, text: &str) -> io::Result<bool> {
    let Err(error) = fs::hard_link(complete, lock) else { return Ok(true) };
    let identity = |path: &Path| fs::symlink_metadata(path).ok().map(|file| (file.dev(), file.ino()));
    // A network file system may have done it, and lost the answer.
    if identity(lock).is_some_and(|there| Some(there) == identity(complete)) {
        return Ok(true);
    }
    if error.kind() == ErrorKind::AlreadyExists {
        return Ok(false);
    }
    // Some file systems have no hard links.
    let mut file = match File::create_new(lock) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(false),
        file => file?,
    };
    let written = file.write_all(text.as_bytes()).and_then(|()| file.sync_all());
    if written.is_err() {
        let _ = fs::remove_file(lock);
    }
    written.map(|()| true)
}

/// Content of a lock, if there is one.
fn read(path: &Path, lock: &Path) -> Result<Option<Owner>, ClaimError> {
    let (shown, path) = (lock.display(), path.display());
    let unreadable =
        |error| ClaimError::System(format!("cannot read {shown}, which says who writes {path}: {error}"), error);
    let foreign = || {
        let advice = "move it away, or write elsewhere";
        ClaimError::Foreign(format!(
            "{shown} is not a complete lock of plateau, but is where that of {path} would be; {advice}"
        ))
    };
    for _ in 0..LOOKS {
        match fs::symlink_metadata(lock) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(unreadable(error)),
            Ok(there) if !there.is_file() || there.len() > LARGEST => return Err(foreign()),
            Ok(_) => {}
        }
        let mut text = String::new();
        match File::open(lock).and_then(|file| file.take(LARGEST).read_to_string(&mut text)) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) if error.kind() == ErrorKind::InvalidData => return Err(foreign()),
            read => read.map_err(unreadable)?,
        };
        if text.ends_with('\n') || !(text.starts_with(START) || START.starts_with(&text)) {
            let Version { plateau_lock: found } = serde_json::from_str(&text).map_err(|_| foreign())?;
            if found != VERSION {
                return Err(ClaimError::Foreign(format!(
                    "{shown} is a lock of another version of plateau (format {found}, expected {VERSION}): if no process writes {path}, \
                     remove it"
                )));
            }
            let owner = serde_json::from_str::<Owner>(&text).ok().filter(Owner::is_whole);
            return owner.map(Some).ok_or_else(foreign);
        }
        thread::sleep(PAUSE);
    }
    Err(foreign())
}

#[cfg(test)]
#[path = "../tests/unit/claim.rs"]
mod tests;
