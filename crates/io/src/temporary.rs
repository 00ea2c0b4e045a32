//! Files that appear under their name when they are complete.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// The name of a file beside the one that it becomes. Whatever is there is removed when this is dropped.
#[derive(Debug)]
pub struct Temporary {
    path: PathBuf,
    target: PathBuf,
}

impl Temporary {
    /// A name beside `target` that nobody else has.
    pub fn beside(target: &Path) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("{}{}-{number}.tmp", start_of_name(target), std::process::id());
        Self { path: target.with_file_name(name), target: target.to_owned() }
    }

    /// Removes what processes that were killed left beside a target. Those of living ones of this machine stay; where the
    /// system does not tell who lives, all do.
    pub fn remove_abandoned(target: &Path) {
        let folder = folder(target);
        let (start, processes) = (start_of_name(target), Path::new("/proc"));
        let Ok(entries) = fs::read_dir(folder).map(Iterator::flatten) else { return };
        for entry in entries.filter(|_| processes.join("self").exists()) {
            let name = entry.file_name().to_string_lossy().into_owned();
            let process = name.strip_prefix(&start).and_then(|rest| rest.split_once('-')).map(|(process, _)| process);
            let is_number = |process: &&str| !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit());
            if process.filter(is_number).is_some_and(|process| !processes.join(process).exists()) {
                // Somebody else may have been quicker.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// Where the file is until it is published.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name; takes the place of another only with `replace`.
    ///
    /// # Errors
    /// What the system says; [`ErrorKind::AlreadyExists`] when there is a file that is not to be replaced.
    pub fn publish(self, replace: bool) -> io::Result<()> {
        if replace {
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

    /// Gives the file its name, in place of another if there is one: when this returns, it is on the disk under its name.
    ///
    /// # Errors
    /// What the system says; the file that was there then still is.
    pub fn publish_durably(self) -> io::Result<()> {
        File::open(&self.path)?.sync_all()?;
        let folder = folder(&self.target).to_owned();
        self.publish(true)?;
        // Some network file systems know nothing like that; the file has its name in any case.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// The folder that a file is in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// How the names of the temporary files of a target begin.
fn start_of_name(target: &Path) -> String {
    format!(".{}.plateau-", target.file_name().unwrap_or_default().to_string_lossy())
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // Gone already where it was renamed; otherwise there is nobody left to tell.
        let _ = fs::remove_file(&self.path);
    }
}
