//! A surface file of an instrument, converted by the Python package.

use std::path::{Path, PathBuf};
use std::process::Stdio;

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
    let mut command = hand_over::command(WORD)?;
    command.arg("convert").arg("--output").arg(&output).args(force.then_some("--force")).arg("--").arg(disc);
    let done = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).output();
    let done = done.map_err(|error| Failure::run(format_args!("plateau-{WORD}: {error}")))?;
    if done.status.success() {
        return Ok(output);
    }
    let said = String::from_utf8_lossy(&done.stderr);
    let reason = said.lines().last().map_or("it was not converted", |line| line.trim_start_matches("plateau: "));
    Err(if done.status.code() == Some(2) { Failure::input(reason) } else { Failure::run(reason) })
}
