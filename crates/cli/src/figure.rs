//! Figures that the Python package draws from data of this program.

use std::fs;
use std::path::Path;
use std::process::Stdio;

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

/// Figures of a kind ("accuracy", "surfaces", "fibre-map") from data, a file or a folder: names and contents, page by page, each in
/// all these formats, with more options of the word.
///
/// # Errors
/// [`Failure::Run`] where the package is missing or fails, with what it says.
pub fn draw(kind: &str, data: &Path, formats: &[&str], options: &[&str]) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let folder = tempfile::tempdir().map_err(|error| Failure::run(format_args!("no temporary folder: {error}")))?;
    let mut command = hand_over::command(WORD)?;
    command.arg(kind).arg(data).arg("-o").arg(folder.path());
    command.args(options);
    for format in formats {
        command.args(["--format", format]);
    }
    let done = command.stdin(Stdio::null()).stderr(Stdio::piped()).stdout(Stdio::piped()).output();
    let done = done.map_err(|error| Failure::run(format_args!("plateau-{WORD}: {error}")))?;
    if !done.status.success() {
        let said = String::from_utf8_lossy(&done.stderr);
        let reason = said.lines().last().map_or("no figure was drawn", |line| line.trim_start_matches("plateau: "));
        return Err(Failure::run(reason));
    }
    // A line for each file: its path.
    let said = String::from_utf8_lossy(&done.stdout);
    let read = |path: &str| {
        let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
        fs::read(folder.path().join(&name)).map(|content| (name, content))
    };
    said.lines().map(read).collect::<Result<_, _>>().map_err(|error| Failure::run(format_args!("a figure: {error}")))
}
