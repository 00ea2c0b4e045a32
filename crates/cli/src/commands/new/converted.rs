//! A surface file of an instrument, converted by the Python package.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::hand_over;

/// The word of the package that converts.
const WORD: &str = "surface";

/// Whether there is a package to convert with.
pub fn can_convert() -> bool {
    hand_over::answering(WORD).is_some()
}

/// Converts a file beside the scene: the file that is written.
///
/// # Errors
/// [`Failure`] with what the package says, where it does not read the file either, or another file is in its place.
pub fn converted(scene: &Path, disc: &Path, force: bool) -> Result<PathBuf, Failure> {
    let name = Path::new(disc.file_name().unwrap_or_default()).with_extension("h5");
    let output = scene.with_file_name(name);
    let to = [OsStr::new("convert"), OsStr::new("--output"), output.as_os_str()];
    let from = [OsStr::new("--"), disc.as_os_str()];
    let done = hand_over::asked(WORD, to.into_iter().chain(force.then_some(OsStr::new("--force"))).chain(from))?;
    if done.status.success() {
        return Ok(output);
    }
    let reason = hand_over::reason(&done, "it was not converted");
    Err(if done.status.code() == Some(2) { Failure::input(reason) } else { Failure::run(reason) })
}
