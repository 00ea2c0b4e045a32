//! Figures that the Python package draws from data of this program.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::failure::Failure;
use crate::hand_over;
use crate::output;

/// Formats of figures, which are the endings of their names.
pub const FORMATS: [&str; 3] = ["png", "svg", "pdf"];
/// The word of the package that draws.
const WORD: &str = "figure";

/// The format that the ending of a name tells, if it is one.
pub fn format_of(path: &Path) -> Option<&'static str> {
    let ending = output::ending(path);
    FORMATS.into_iter().find(|format| *format == ending)
}

/// A folder for data of figures, which goes with the value.
///
/// # Errors
/// [`Failure::Run`] where there is none to be had.
pub fn temporary_folder() -> Result<TempDir, Failure> {
    tempfile::tempdir().map_err(|error| Failure::run(format_args!("no temporary folder: {error}")))
}

/// Figures of a kind ("accuracy", "surfaces", "fibre-map") from data, a file or a folder: names and contents, page by page, each in
/// all these formats, with more options of the word.
///
/// # Errors
/// [`Failure::Run`] where the package is missing or fails, with what it says.
pub fn draw(kind: &str, data: &Path, formats: &[&str], options: &[&str]) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let folder = temporary_folder()?;
    let mut arguments = vec![OsStr::new(kind), data.as_os_str(), OsStr::new("-o"), folder.path().as_os_str()];
    arguments.extend(options.iter().map(OsStr::new));
    arguments.extend(formats.iter().flat_map(|format| ["--format", format]).map(OsStr::new));
    let done = hand_over::asked(WORD, arguments)?;
    if !done.status.success() {
        return Err(Failure::run(hand_over::reason(&done, "no figure was drawn")));
    }
    // A line for each file: its path.
    let said = String::from_utf8_lossy(&done.stdout);
    let read = |path: &str| {
        let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
        fs::read(folder.path().join(&name)).map(|content| (name, content))
    };
    said.lines().map(read).collect::<Result<_, _>>().map_err(|error| Failure::run(format_args!("a figure: {error}")))
}
