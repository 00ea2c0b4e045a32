//! The file of a run that was ended before its first checkpoint, kept while the run begins anew: its samples are all that there is of
//! it until the new one has come as far.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use plateau_io::run_file::RunFile;

/// Names that are tried.
const MOST: usize = 1000;

/// A run file that has a second name, which goes again unless it is to stay.
pub struct Kept {
    place: PathBuf,
    /// Where it was moved from, on file systems where a file has one name only.
    moved_from: Option<PathBuf>,
    /// Whether the name is new: there may be a file of before that holds as much.
    is_new: bool,
    stays: bool,
}

impl Kept {
    /// Keeps a run file of so many samples as `RUN.before-resume`. Where a file of an earlier beginning of the same run has that name,
    /// the one with more samples is kept; what else has it stays, and another name is taken.
    ///
    /// # Errors
    /// What the system says.
    pub fn of(path: &Path, samples: usize) -> io::Result<Self> {
        for count in 1..=MOST {
            let place = place(path, count);
            match samples_of_same(&place, path) {
                Some(there) if there >= samples => {
                    return Ok(Self { place, moved_from: None, is_new: false, stays: true });
                }
                // All of them are the first of those that are kept now.
                Some(_) => fs::remove_file(&place)?,
                None => {}
            }
            match fs::hard_link(path, &place) {
                Ok(()) => return Ok(Self { place, moved_from: None, is_new: true, stays: false }),
                Err(_) if fs::symlink_metadata(&place).is_ok() => {}
                // Some file systems have no hard links.
                Err(_) => {
                    fs::rename(path, &place)?;
                    return Ok(Self { place, moved_from: Some(path.to_owned()), is_new: true, stays: false });
                }
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    /// Lets it stay; where it is.
    pub fn stay(mut self) -> PathBuf {
        self.stays = true;
        self.place.clone()
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if self.stays || !self.is_new {
            return;
        }
        // Nobody is left to tell.
        let _ = match &self.moved_from {
            Some(path) => fs::rename(&self.place, path),
            None => fs::remove_file(&self.place),
        };
    }
}

/// `run.h5.before-resume`, then `run.h5.before-resume-2` and so on.
fn place(path: &Path, count: usize) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".before-resume");
    if count > 1 {
        name.push(format!("-{count}"));
    }
    path.with_file_name(name)
}

/// Samples in a file of the same scene, surfaces and program, which are the same as far as they go; none of another file.
fn samples_of_same(place: &Path, run: &Path) -> Option<usize> {
    if !fs::symlink_metadata(place).is_ok_and(|there| there.is_file()) {
        return None;
    }
    let [there, run] = [RunFile::open(place).ok()?, RunFile::open(run).ok()?];
    let alike = |name: &str| there.attribute(name) == run.attribute(name);
    ["scene", "program", "source_revision", "inputs"].into_iter().all(alike).then(|| there.time().len())
}
