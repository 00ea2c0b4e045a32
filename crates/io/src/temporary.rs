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
    ///
    /// # Errors
    /// What the system says.
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
    ///
    /// # Errors
    /// What the system says; [`ErrorKind::AlreadyExists`] when there is a file that is not to be replaced.
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
pub(crate) fn folder(path: &Path) -> &Path {
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
mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn a_file_that_is_replaced_keeps_its_permissions() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.h5");
        let mode = || fs::metadata(&path).unwrap().permissions().mode() & 0o777;
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o604)).unwrap();
        for durably in [false, true] {
            let (temporary, _) = Temporary::create(&path).unwrap();
            if durably { temporary.publish_durably() } else { temporary.publish(true) }.unwrap();
            assert_eq!((mode(), fs::read(&path).unwrap().len()), (0o604, 0));
        }
    }

    #[test]
    fn only_what_a_dead_process_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.h5");
        let dead = u32::MAX;
        let word = unique_word();
        let left = format!(".run.h5.plateau-{dead}-{word}.tmp");
        let kept = [
            format!(".run.h5.plateau-{}-{word}.tmp", std::process::id()),
            format!(".run.h5.plateau-{dead}-notes.tmp"),
            format!(".run.h5.plateau-{dead}-{word}"),
            format!(".other.h5.plateau-{dead}-{word}.tmp"),
        ];
        for name in kept.iter().chain([&left]) {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let link = folder.path().join(format!(".run.h5.plateau-{dead}-0.tmp"));
        symlink("elsewhere", &link).unwrap();
        Temporary::remove_abandoned(&path);
        assert!(!folder.path().join(left).exists());
        assert!(kept.iter().all(|name| folder.path().join(name).exists()) && link.is_symlink());
    }
}
