//! What a disk may hold after a loss of power: every call of a program that changes a file is written down, and replayed up to any
//! of them onto a disk that has what was synchronised, and of the rest what the worst of file systems may have kept.
//!
//! | after the last `fsync` | what may be there |
//! |---|---|
//! | of a folder: files made, renamed, linked, removed in it | the first so many of these, for folders are kept in a log |
//! | of a file: its length | any length that it has had since |
//! | of a file: what was written | of every page any state that it has had since, or one up to some sector and another behind it |

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::fault::shim;
use crate::program::{Outcome, WorkingDirectory, run};
use crate::scenes::Stream;

/// Bytes that the system writes together, and those that a disk does.
const PAGE: usize = 4096;
const SECTOR: usize = 512;

/// Files by their names in the working directory.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Has a command run on the machine as it is after so many starts, none being as it really is.
///
/// # Panics
/// When no file can be made.
pub fn after_starts(command: &mut Command, starts: usize) {
    if starts == 0 {
        return;
    }
    static BOOTS: OnceLock<tempfile::TempDir> = OnceLock::new();
    let boots = BOOTS.get_or_init(|| tempfile::tempdir().expect("a temporary directory"));
    let boot = boots.path().join(starts.to_string());
    if !boot.exists() {
        // Another test may read it at any time: it is made complete.
        let made = tempfile::NamedTempFile::new_in(boots.path()).expect("a temporary file");
        fs::write(made.path(), format!("00000000-0000-0000-0000-{starts:012}\n")).expect("the number of a start");
        made.persist(&boot).expect("a file of that name");
    }
    command.env("LD_PRELOAD", shim("journal")).env("PLATEAU_BOOT", boot);
}

/// A call that changes a file or a folder. Names are those in the working directory.
#[derive(Debug, Clone)]
enum Call {
    Create { inode: u64, name: String },
    Write { inode: u64, at: usize, bytes: Vec<u8> },
    Truncate { inode: u64, size: usize },
    Sync { inode: u64, name: String },
    Rename { old: String, new: String },
    Link { old: String, new: String },
    Unlink { name: String },
    Folder { name: String },
}

/// What a command did to the files of its working directory, in order.
#[derive(Debug)]
pub struct Journal {
    /// Inode and content of the files that were there before.
    before: BTreeMap<String, (u64, Vec<u8>)>,
    calls: Vec<Call>,
}

/// A file on the disk, and what is on its way there.
#[derive(Debug, Clone, Default)]
struct File {
    synchronised: Vec<u8>,
    /// Its contents after each call since, the newest last, with the part that differs from the one before.
    since: Vec<Vec<u8>>,
}

/// A change of a folder that is not on the disk yet.
#[derive(Debug, Clone)]
enum Entry {
    Set { name: String, file: usize },
    Move { old: String, new: String },
    Remove { name: String },
    Folder { name: String },
}

impl Entry {
    /// The folder whose synchronisation brings it to the disk.
    fn folder(&self) -> &Path {
        let (Self::Set { name, .. } | Self::Move { new: name, .. } | Self::Remove { name } | Self::Folder { name }) =
            self;
        Path::new(name).parent().unwrap_or(Path::new(""))
    }
}

/// Names of files and folders; a folder has no file.
type Names = BTreeMap<String, Option<usize>>;

fn apply(names: &mut Names, entry: &Entry) {
    match entry {
        Entry::Set { name, file } => drop(names.insert(name.clone(), Some(*file))),
        Entry::Move { old, new } => {
            if let Some(file) = names.remove(old) {
                names.insert(new.clone(), file);
            }
        }
        Entry::Remove { name } => drop(names.remove(name)),
        Entry::Folder { name } => drop(names.insert(name.clone(), None)),
    }
}

impl Journal {
    /// Runs a command of a working directory, and writes down what it does to the files there.
    ///
    /// # Panics
    /// When the journal cannot be read, or the program does something that it does not tell.
    pub fn of(directory: &WorkingDirectory, mut command: Command) -> (Outcome, Self) {
        let before = directory.content().into_iter().filter_map(|(path, bytes)| {
            let inode = fs::symlink_metadata(&path).expect("a file").ino();
            Some((in_directory(directory, &path)?, (inode, bytes?)))
        });
        let before = before.collect();
        let elsewhere = tempfile::tempdir().expect("a temporary directory");
        let file = elsewhere.path().join("journal");
        command.env("LD_PRELOAD", shim("journal")).env("PLATEAU_JOURNAL", &file);
        let outcome = run(command);
        let journal = Self { before, calls: calls(directory, &fs::read(file).expect("a journal")) };
        let is_file = |(path, bytes): (PathBuf, Option<Vec<u8>>)| Some((in_directory(directory, &path)?, bytes?));
        let there: Files = directory.content().into_iter().filter_map(is_file).collect();
        assert!(journal.at_end() == there, "the journal does not tell all that happened to the files");
        (outcome, journal)
    }

    /// How many calls there are.
    pub fn calls(&self) -> usize {
        self.calls.len()
    }

    /// Everything, as if it had come to the disk.
    fn at_end(&self) -> Files {
        self.killed_after(self.calls.len())
    }

    /// What there is when the process is killed after so many calls, but the machine goes on.
    pub fn killed_after(&self, calls: usize) -> Files {
        let mut disk = Disk::new(&self.before);
        self.calls[..calls].iter().for_each(|call| disk.take(call));
        disk.entries.iter().for_each(|entry| apply(&mut disk.names, entry));
        let files = disk.names.into_iter().filter_map(|(name, file)| Some((name, file?)));
        files.map(|(name, file)| (name, disk.files[file].newest().to_vec())).collect()
    }

    /// What the disk holds when the power is lost after so many calls; what of the rest has come to it is drawn by lot.
    pub fn disk_after(&self, calls: usize, random: &mut Stream) -> Files {
        let mut disk = Disk::new(&self.before);
        self.calls[..calls].iter().for_each(|call| disk.take(call));
        let kept = below(random, disk.entries.len() + 1);
        disk.entries[..kept].iter().for_each(|entry| apply(&mut disk.names, entry));
        let names = &disk.names;
        let is_there = |name: &str| {
            let mut folders = Path::new(name).ancestors().skip(1).filter(|folder| *folder != Path::new(""));
            folders.all(|folder| names.get(&*folder.to_string_lossy()) == Some(&None))
        };
        let files = names.iter().filter(|(name, _)| is_there(name)).filter_map(|(name, file)| Some((name, (*file)?)));
        files.map(|(name, file)| (name.clone(), disk.files[file].after_loss(random))).collect()
    }
}

/// The disk, and what is on its way there.
struct Disk {
    files: Vec<File>,
    by_inode: BTreeMap<u64, usize>,
    names: Names,
    entries: Vec<Entry>,
}

impl Disk {
    fn new(before: &BTreeMap<String, (u64, Vec<u8>)>) -> Self {
        let mut disk =
            Self { files: Vec::new(), by_inode: BTreeMap::new(), names: BTreeMap::new(), entries: Vec::new() };
        for (name, (inode, bytes)) in before {
            disk.by_inode.insert(*inode, disk.files.len());
            disk.names.insert(name.clone(), Some(disk.files.len()));
            disk.files.push(File { synchronised: bytes.clone(), since: Vec::new() });
            let folders = Path::new(name).ancestors().skip(1).filter(|folder| *folder != Path::new(""));
            for folder in folders {
                disk.names.insert(folder.to_string_lossy().into_owned(), None);
            }
        }
        disk
    }

    /// The file of a name, as programs see it.
    fn file_of(&self, name: &str) -> Option<usize> {
        let mut names = self.names.clone();
        self.entries.iter().for_each(|entry| apply(&mut names, entry));
        names.get(name).copied().flatten()
    }

    fn take(&mut self, call: &Call) {
        match call {
            Call::Create { inode, name } => {
                // The number of a file that is gone may be that of a new one.
                self.by_inode.insert(*inode, self.files.len());
                self.entries.push(Entry::Set { name: name.clone(), file: self.files.len() });
                self.files.push(File::default());
            }
            Call::Write { inode, at, bytes } => {
                if let Some(file) = self.by_inode.get(inode) {
                    self.files[*file].write(*at, bytes);
                }
            }
            Call::Truncate { inode, size } => {
                if let Some(file) = self.by_inode.get(inode) {
                    self.files[*file].resize(*size);
                }
            }
            Call::Sync { inode, name } => match self.by_inode.get(inode) {
                Some(file) if self.file_of(name) == Some(*file) => self.files[*file].synchronise(),
                _ => self.synchronise_folder(Path::new(name)),
            },
            Call::Rename { old, new } => self.entries.push(Entry::Move { old: old.clone(), new: new.clone() }),
            Call::Link { old, new } => {
                let file = self.file_of(old).expect("a file to link");
                self.entries.push(Entry::Set { name: new.clone(), file });
            }
            Call::Unlink { name } => self.entries.push(Entry::Remove { name: name.clone() }),
            Call::Folder { name } => self.entries.push(Entry::Folder { name: name.clone() }),
        }
    }

    fn synchronise_folder(&mut self, folder: &Path) {
        let (done, left) = std::mem::take(&mut self.entries).into_iter().partition(|entry| entry.folder() == folder);
        self.entries = left;
        let done: Vec<Entry> = done;
        done.iter().for_each(|entry| apply(&mut self.names, entry));
    }
}

impl File {
    fn newest(&self) -> &[u8] {
        self.since.last().unwrap_or(&self.synchronised)
    }

    fn write(&mut self, at: usize, bytes: &[u8]) {
        let mut content = self.newest().to_vec();
        content.resize(content.len().max(at + bytes.len()), 0);
        content[at..at + bytes.len()].copy_from_slice(bytes);
        self.since.push(content);
    }

    fn resize(&mut self, size: usize) {
        let mut content = self.newest().to_vec();
        content.resize(size, 0);
        self.since.push(content);
    }

    fn synchronise(&mut self) {
        if let Some(newest) = self.since.pop() {
            self.synchronised = newest;
            self.since.clear();
        }
    }

    /// A state that it had or has, number 0 being the synchronised one.
    fn state(&self, number: usize) -> &[u8] {
        number.checked_sub(1).map_or(&self.synchronised, |since| &self.since[since])
    }

    /// What is on the disk after the loss: all or nothing of what was not synchronised, the state after one of the calls, or of
    /// every page another state.
    fn after_loss(&self, random: &mut Stream) -> Vec<u8> {
        let states = self.since.len() + 1;
        match below(random, 4) {
            0 => self.synchronised.clone(),
            1 => self.newest().to_vec(),
            2 => self.state(below(random, states)).to_vec(),
            _ => {
                let mut content = vec![0; self.state(below(random, states)).len()];
                for (number, page) in content.chunks_mut(PAGE).enumerate() {
                    let [first, second] = [(); 2].map(|()| below(random, states));
                    // One page in four is torn.
                    let split = if below(random, 4) == 0 { SECTOR * below(random, PAGE / SECTOR) } else { PAGE };
                    for (from, to, state) in [(0, split, first), (split, PAGE, second)] {
                        let state = self.state(state);
                        let to = to.min(page.len()).min(state.len().saturating_sub(number * PAGE));
                        if from < to {
                            page[from..to].copy_from_slice(&state[number * PAGE..][from..to]);
                        }
                    }
                }
                content
            }
        }
    }
}

/// A number below a bound.
fn below(random: &mut Stream, bound: usize) -> usize {
    ((random.uniform() * bound as f64) as usize).min(bound - 1)
}

/// The name of a path in the working directory; none if it lies elsewhere.
fn in_directory(directory: &WorkingDirectory, path: &Path) -> Option<String> {
    Some(path.strip_prefix(directory.path("")).ok()?.to_str()?.to_owned())
}

/// The calls of a journal (`journal.c` says how they are written) that concern the working directory.
fn calls(directory: &WorkingDirectory, mut journal: &[u8]) -> Vec<Call> {
    let mut calls = Vec::new();
    // A file elsewhere may have the number of one here that is gone.
    let mut elsewhere = BTreeSet::new();
    while !journal.is_empty() {
        let end = journal.iter().position(|byte| *byte == b'\n').expect("a whole record");
        let line = std::str::from_utf8(&journal[..end]).expect("a line of words");
        journal = &journal[end + 1..];
        let mut words = line.split(' ');
        let what = words.next().unwrap_or_default();
        let numbers: Vec<usize> = words.map(|word| word.parse().expect("a number")).collect();
        let mut rest = |length: usize| {
            let (taken, rest) = journal.split_at(length);
            journal = rest;
            taken
        };
        let mut name = |length| in_directory(directory, Path::new(std::str::from_utf8(rest(length)).expect("a name")));
        let call = match (what, &numbers[..]) {
            ("create", [inode, length]) => {
                let name = name(*length);
                let _ = if name.is_some() { elsewhere.remove(inode) } else { elsewhere.insert(*inode) };
                name.map(|name| Call::Create { inode: *inode as u64, name })
            }
            ("sync", [inode, length]) => name(*length).map(|name| Call::Sync { inode: *inode as u64, name }),
            ("unlink", [length]) => name(*length).map(|name| Call::Unlink { name }),
            ("folder", [length]) => name(*length).map(|name| Call::Folder { name }),
            ("rename", [one, other]) => {
                let (old, new) = (name(*one), name(*other));
                old.zip(new).map(|(old, new)| Call::Rename { old, new })
            }
            ("link", [one, other]) => {
                let (old, new) = (name(*one), name(*other));
                old.zip(new).map(|(old, new)| Call::Link { old, new })
            }
            ("truncate", [inode, size]) => {
                (!elsewhere.contains(inode)).then_some(Call::Truncate { inode: *inode as u64, size: *size })
            }
            ("write", [inode, at, length]) => {
                let bytes = rest(*length).to_vec();
                (!elsewhere.contains(inode)).then_some(Call::Write { inode: *inode as u64, at: *at, bytes })
            }
            _ => panic!("no call: {line:?}"),
        };
        calls.extend(call);
    }
    calls
}
