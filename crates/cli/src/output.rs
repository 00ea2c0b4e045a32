//! Files that a command leaves beside its run file: whole, or not at all.

use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use plateau_io::input;
use plateau_io::temporary::Temporary;

use crate::failure::Failure;

/// Refuses an output path that is taken, has no directory, is one of the inputs or a link to nothing; before any work is done for
/// it.
pub fn check(path: &Path, force: bool, inputs: &[PathBuf]) -> Result<(), Failure> {
    let shown = path.display();
    if path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(Failure::input(format!("cannot write {shown}: it names a folder; name a file")));
    }
    let directory = directory(path);
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
///
/// # Errors
/// [`Failure::Input`] when there is a file that is not to be replaced or none can be made there, [`Failure::Run`] when the
/// system fails while it is written.
pub fn write(path: &Path, content: &[u8], force: bool) -> Result<(), Failure> {
    // The target of a link is replaced, not the link: who names a file may name it by one.
    let target = if force { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() };
    write_at(path, &target, content, force)
}

/// As [`write()`], a file in a folder that was named: a link of its name is not followed but replaced, for it was somebody else who
/// made it lead elsewhere.
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

/// No file can be made where one was asked for.
fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let directory = directory(path).display();
    let path = path.display();
    let message =
        format_args!("cannot write {path}: {error}; make the directory {directory} writable, or name a file elsewhere");
    Failure::because(error, message)
}

/// The folder in which a path is.
pub fn directory(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn exists(path: &Path) -> Failure {
    Failure::input(format!("{} exists; give --force to replace it, or write elsewhere", path.display()))
}
