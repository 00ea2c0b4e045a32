//! Output of a command: text on standard output, tables in it, tables as comma-separated values; and files beside its run file, whole, or
//! not at all.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use plateau_io::input;
use plateau_io::temporary::{Temporary, folder};
use plateau_io::text::{cell, is_plain, shown};
use serde::Serialize;

use crate::failure::Failure;

/// Refuses an output path that is taken, has no directory, is one of the inputs or a link to nothing; before any work is done for
/// it.
pub fn check(path: &Path, force: bool, inputs: &[PathBuf]) -> Result<(), Failure> {
    let shown = path.display();
    if path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(Failure::input(format!("cannot write {shown}: it names a folder; name a file")));
    }
    let directory = folder(path);
    if !directory.is_dir() {
        let directory = directory.display();
        return Err(Failure::input(format!("cannot write {shown}: {directory} is not a directory; make it first")));
    }
    let Ok(there) = fs::symlink_metadata(path) else { return Ok(()) };
    let real = fs::metadata(path);
    // Whether it is meant to be made there, or the link to be replaced, nobody knows.
    if there.is_symlink() && real.is_err() {
        let to = fs::read_link(path).unwrap_or_default();
        let to = to.display();
        let what = format!("{shown} is a link to {to}, which is not there; remove it, or name another file");
        return Err(Failure::input(what));
    }
    if there.is_dir() || real.is_ok_and(|real| !real.is_file()) {
        return Err(Failure::input(format!("{shown} is not a regular file and is not replaced; name another file")));
    }
    if input::is_one_of(path, inputs) {
        return Err(Failure::input(format!("{shown} is an input and is not replaced; name another file")));
    }
    if force { Ok(()) } else { Err(exists(path)) }
}

/// The ending of a name, in small letters; empty where it has none.
pub fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Writes a file that appears under its name when it is complete.
pub fn write(path: &Path, content: &[u8], force: bool) -> Result<(), Failure> {
    // The target of a link is replaced, not the link: who names a file may name it by one.
    let target = if force { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() };
    write_at(path, &target, content, force)
}

/// Writes as [`write()`] does, in a folder that was named: a link of the file's name is not followed but replaced, for it was somebody else
/// who made it lead elsewhere.
pub fn write_in_folder(path: &Path, content: &[u8], force: bool) -> Result<(), Failure> {
    write_at(path, path, content, force)
}

fn write_at(path: &Path, target: &Path, content: &[u8], force: bool) -> Result<(), Failure> {
    let (temporary, mut file) = Temporary::create(target).map_err(|error| unwritable(path, &error))?;
    file.write_all(content).and_then(|()| temporary.publish(force)).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => exists(path),
        _ => Failure::run(format_args!("cannot write {}: {error}", path.display())),
    })
}

/// Makes a folder, with those that it is in, unless it is there.
pub fn make_directory(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|error| {
        let reason = if path.exists() { "there is a file of that name".to_owned() } else { error.to_string() };
        let path = path.display();
        Failure::because(&error, format_args!("cannot make the folder {path}: {reason}; name another one with -o"))
    })
}

/// Fails because no file can be made where one was asked for.
fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let (directory, path) = (folder(path).display(), path.display());
    let message =
        format_args!("cannot write {path}: {error}; make the directory {directory} writable, or name a file elsewhere");
    Failure::because(error, message)
}

fn exists(path: &Path) -> Failure {
    Failure::input(format!("{} exists; give --force to replace it, or write elsewhere", path.display()))
}

/// Prints text on standard output. Text of others in it cannot do anything to the terminal.
pub fn print(text: &str) -> Result<(), Failure> {
    printed(io::stdout().lock().write_all(shown(text).as_bytes()))
}

pub fn print_json(document: &impl Serialize) -> Result<(), Failure> {
    print(&json(document)?)
}

/// One JSON document for people, with the end of its last line.
pub fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(document).map(|text| text + "\n").map_err(Failure::run)
}

/// Result of writing to standard output.
pub fn printed(written: io::Result<()>) -> Result<(), Failure> {
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::run(format_args!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A text without characters that would move, hide or turn what follows them.
pub fn on_one_line(text: &str) -> String {
    text.chars().map(|letter| if is_plain(letter) { letter } else { ' ' }).collect()
}

/// A heading, which may be anybody's title, and rows of a name and a value, aligned.
pub fn table(heading: &str, rows: &[(impl AsRef<str>, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.as_ref().chars().count()).max().unwrap_or(0);
    let mut text = format!("{}\n", on_one_line(heading));
    for (name, value) in rows {
        let name = name.as_ref();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name}{}  {value}", blanks(name, width));
    }
    text
}

/// A heading and rows below the names of columns: the first one to the left, the others to the right.
pub fn columns(heading: &str, names: &[&str], rows: &[Vec<String>]) -> String {
    let header: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    let lines = || std::iter::once(&header).chain(rows);
    let width = |column: usize| lines().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..names.len()).map(|column| width(column).unwrap_or(0)).collect();
    let line = |cells: &Vec<String>| {
        let cells = cells.iter().zip(&widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("{cell}{}", blanks(cell, *width)),
            _ => format!("{}{cell}", blanks(cell, *width)),
        });
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    format!("{heading}\n{}", lines().map(line).collect::<String>())
}

/// Blanks that a text lacks to a width: of more than 65 535, which formats take, too.
fn blanks(text: &str, width: usize) -> String {
    " ".repeat(width.saturating_sub(text.chars().count()))
}

/// A heading and lines below it.
pub fn list(heading: &str, lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
    format!("{heading}\n{lines}")
}

/// Lines of cells, those that need it in quotation marks, and those that a spreadsheet would compute marked as text.
pub fn csv_table<Line>(lines: impl IntoIterator<Item = Line>) -> String
where
    Line: IntoIterator,
    Line::Item: AsRef<str>,
{
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    for line in lines {
        // Writing to memory cannot fail.
        let _ = writer.write_record(line.into_iter().map(|text| cell(text.as_ref()).into_owned()));
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

#[cfg(test)]
#[path = "../tests/unit/output.rs"]
mod tests;
