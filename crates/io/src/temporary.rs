//! Files that appear under their name when they are complete, with names until then that nobody can guess.

use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Hexadecimal digits of a word.
const DIGITS: usize = 16;

/// A new word.
pub(crate) fn unique_word() -> String {
    // The system seeds it.
    format!("{:0DIGITS$x}", RandomState::new().hash_one(std::process::id()))
}

/// Tells whether a text may be one of these words.
pub(crate) fn is_unique_word(text: &str) -> bool {
    text.len() == DIGITS && text.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}

/// A file beside the one that it becomes. It is removed when this is dropped, unless it has got its name.
#[derive(Debug)]
pub struct Temporary {
    path: PathBuf,
    target: PathBuf,
}

impl Temporary {
    /// A new file beside `target`, empty and open for writing, of a name that nobody knows beforehand.
    pub fn create(target: &Path) -> io::Result<(Self, File)> {
        loop {
            let own = target.file_name().unwrap_or_default().to_string_lossy();
            let name = format!(".{own}.plateau-{}-{}.tmp", std::process::id(), unique_word());
            let path = target.with_file_name(name);
            match File::create_new(&path) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                file => return Ok((Self { path, target: target.to_owned() }, file?)),
            }
        }
    }

    /// Removes what processes that were killed left beside a target that is claimed. Those of living ones of this machine
    /// stay; where the system does not tell who lives, all do.
    pub fn remove_abandoned(target: &Path) {
        let own = target.file_name().unwrap_or_default().to_string_lossy();
        Self::remove_abandoned_of(folder(target), |name| name == own);
    }

    /// The same of all targets in a folder that have such names.
    pub fn remove_abandoned_of(folder: &Path, is_target: impl Fn(&str) -> bool) {
        let processes = Path::new("/proc");
        let Ok(entries) = fs::read_dir(folder).map(Iterator::flatten) else { return };
        for entry in entries.filter(|_| processes.join("self").exists()) {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
            let is_left = |(target, process): (&str, &str)| is_target(target) && !processes.join(process).exists();
            if is_file && parts_of(&name).is_some_and(is_left) {
                // Somebody else may have been quicker.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// Path of the file until it is published.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name; takes the place of another, whose permissions it gets, only with `replace`.
    pub fn publish(self, replace: bool) -> io::Result<()> {
        // Else a loss of power could leave an empty file of this name.
        File::open(&self.path)?.sync_all()?;
        if replace {
            self.permit_as(&self.target);
            return fs::rename(&self.path, &self.target);
        }
        // A link fails where a file has appeared meanwhile; a rename would replace it.
        match fs::hard_link(&self.path, &self.target) {
            Err(_) if fs::symlink_metadata(&self.target).is_ok() => Err(ErrorKind::AlreadyExists.into()),
            // Some file systems have no hard links.
            Err(_) => fs::rename(&self.path, &self.target),
            Ok(()) => Ok(()),
        }
    }

    /// Gives the file the permissions of another, if there is that.
    pub fn permit_as(&self, other: &Path) {
        if let Ok(there) = fs::symlink_metadata(other)
            && there.is_file()
        {
            // Some file systems have none.
            let _ = fs::set_permissions(&self.path, there.permissions());
        }
    }

    /// Gives the file its name, in place of another if there is one: when this returns, it is on the disk under its name.
    ///
    /// # Errors
    /// What the system says; the file that was there then still is.
    pub fn publish_durably(self) -> io::Result<()> {
        let folder = folder(&self.target).to_owned();
        self.publish(true)?;
        // Some network file systems know nothing like that; the file has its name in any case.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// The folder that a file is in.
pub fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Target and process in the name of a temporary file.
fn parts_of(name: &str) -> Option<(&str, &str)> {
    let (target, rest) = name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once(".plateau-")?;
    let (process, rest) = rest.split_once('-')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    // Earlier versions had a count for the word.
    (is_number(process) && (is_unique_word(rest) || is_number(rest))).then_some((target, process))
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // Gone already where it was renamed; otherwise there is nobody left to tell.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
#[path = "../tests/unit/temporary.rs"]
mod tests;
