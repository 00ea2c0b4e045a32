//! Files that appear under their name when they are complete.

use std::fs;
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
        let name = format!(".plateau-{}-{number}.tmp", std::process::id());
        Self { path: target.with_file_name(name), target: target.to_owned() }
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
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // Gone already where it was renamed; otherwise there is nobody left to tell.
        let _ = fs::remove_file(&self.path);
    }
}
