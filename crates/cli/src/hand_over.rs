//! Words that other programs answer: `plateau WORD` is `plateau-WORD`, beside this program or on the path; and figures, which the Python
//! package draws from data of this program.

use std::ffi::{OsStr, OsString};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::{env, fs, io};

use tempfile::TempDir;

use crate::failure::Failure;
use crate::{message, output};

/// Names this program to the one that answers, which calls it.
const PROGRAM: &str = "PLATEAU_PROGRAM";
/// Tells the one that answers, and what it calls, which word was handed over.
const HANDED: &str = "PLATEAU_HANDED";
/// Words that the Python package answers.
const OF_PYTHON: [&str; 9] = ["sweep", "fit", "compare", "cycle", "plot", "report", "export", "figure", "surface"];

/// Becomes the program that answers a word, with these arguments; comes back only where that fails.
pub fn hand_over(word: &str, arguments: impl IntoIterator<Item = OsString>) -> Result<(), Failure> {
    let mut command = command(word)?;
    let error: io::Error = command.args(arguments).args(message::level_as_option()).exec();
    Err(Failure::because(&error, format_args!("{}: {error}", command.get_program().display())))
}

/// The program that answers a word, to be started.
fn command(word: &str) -> Result<Command, Failure> {
    let Some(answering) = answering(word) else {
        let package = if OF_PYTHON.contains(&word) {
            "it comes with the Python package: pip install 'plateau-brake[all]'; in a checkout ./plateau has it"
        } else {
            "install it"
        };
        return Err(Failure::run(format!(
            "plateau-{word} answers this, and is neither beside the program nor on PATH; {package}"
        )));
    };
    if env::var_os(HANDED).is_some_and(|handed| handed == word) {
        let message = format!("{} does not answer `{word}` itself, but asks this program again", answering.display());
        return Err(Failure::run(message));
    }
    let mut command = Command::new(&answering);
    command.env(HANDED, word);
    if let Ok(program) = env::current_exe() {
        command.env(PROGRAM, program);
    }
    Ok(command)
}

/// Runs the program that answers a word with these arguments, without a terminal, and returns what it says.
pub fn asked(word: &str, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Result<Output, Failure> {
    let mut command = command(word)?;
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.output().map_err(|error| Failure::run(format_args!("plateau-{word}: {error}")))
}

/// The program that answers a word, if there is one.
pub fn answering(word: &str) -> Option<PathBuf> {
    let name = format!("plateau-{word}");
    let beside = env::current_exe().ok().and_then(|program| program.parent().map(Path::to_owned));
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = beside.into_iter().chain(env::split_paths(&path).filter(|folder| folder.is_absolute()));
    folders.map(|folder| folder.join(&name)).find(|file| is_program(file))
}

/// Tells whether a word names a program and no path.
pub fn is_word(word: &OsStr) -> bool {
    word.to_str()
        .is_some_and(|word| !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-'))
}

fn is_program(file: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    file.metadata().is_ok_and(|found| found.is_file() && found.permissions().mode() & 0o111 != 0)
}

/// Has the package describe the surfaces of a folder, as a table or as JSON; their parameters are then in the folder's document.
pub fn described(folder: &Path, as_json: bool) -> Result<String, Failure> {
    let options =
        [OsStr::new("describe"), folder.as_os_str()].into_iter().chain(as_json.then_some(OsStr::new("--json")));
    succeeded(asked("surface", options)?, "the surfaces were not described")
        .map(|done| String::from_utf8_lossy(&done.stdout).into_owned())
}

/// Returns the answer of a program that succeeded; else fails with its reason, or with these words.
pub fn succeeded(answer: Output, otherwise: &str) -> Result<Output, Failure> {
    match answer.status.code() {
        Some(0) => Ok(answer),
        Some(2) => Err(Failure::input(reason(&answer, otherwise))),
        _ => Err(Failure::run(reason(&answer, otherwise))),
    }
}

/// Returns the reason of a failure: the last line on standard error, or these words where nothing is there.
fn reason(answer: &Output, otherwise: &str) -> String {
    let said = String::from_utf8_lossy(&answer.stderr);
    said.lines().last().map_or(otherwise, |line| line.trim_start_matches("plateau: ")).to_owned()
}

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
pub fn temporary_folder() -> Result<TempDir, Failure> {
    tempfile::tempdir().map_err(|error| Failure::run(format_args!("no temporary folder: {error}")))
}

/// Figures of a kind ("accuracy", "surfaces", "fibre-map") from data, a file or a folder: names and contents, page by page, each in
/// all these formats, with more options of the word.
pub fn draw(kind: &str, data: &Path, formats: &[&str], options: &[&str]) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let folder = temporary_folder()?;
    let mut arguments = vec![OsStr::new(kind), data.as_os_str(), OsStr::new("-o"), folder.path().as_os_str()];
    arguments.extend(options.iter().map(OsStr::new));
    arguments.extend(formats.iter().flat_map(|format| ["--format", format]).map(OsStr::new));
    let done = asked(WORD, arguments)?;
    if !done.status.success() {
        return Err(Failure::run(reason(&done, "no figure was drawn")));
    }
    // A line for each file: its path.
    let said = String::from_utf8_lossy(&done.stdout);
    let read = |path: &str| {
        let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
        fs::read(folder.path().join(&name)).map(|content| (name, content))
    };
    said.lines().map(read).collect::<Result<_, _>>().map_err(|error| Failure::run(format_args!("a figure: {error}")))
}
