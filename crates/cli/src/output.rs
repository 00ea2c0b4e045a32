//! Files that a command leaves beside its run file: whole, or not at all.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use plateau_io::temporary::Temporary;

use crate::failure::Failure;

/// Refuses an output path that is taken, has no directory or is one of the inputs; before any work is done for it.
///
/// # Errors
/// [`Failure::Input`].
pub fn check(path: &Path, force: bool, inputs: &[PathBuf]) -> Result<(), Failure> {
    let shown = path.display();
    let directory = directory(path);
    if !directory.is_dir() {
        let directory = directory.display();
        return Err(Failure::input(format_args!("cannot write {shown}: {directory} is no directory; make it first")));
    }
    let Ok(there) = fs::symlink_metadata(path) else { return Ok(()) };
    if there.is_dir() || fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        return Err(Failure::input(format_args!("{shown} is no regular file and is not replaced; name another file")));
    }
    let real = path.canonicalize().ok();
    if real.is_some() && inputs.iter().any(|input| input.canonicalize().ok() == real) {
        return Err(Failure::input(format_args!("{shown} is an input and is not replaced; name another file")));
    }
    if force { Ok(()) } else { Err(exists(path)) }
}

/// Writes a file that appears under its name when it is complete.
///
/// # Errors
/// [`Failure::Input`] when there is a file that is not to be replaced, [`Failure::Run`] when the system refuses.
pub fn write(path: &Path, content: &[u8], force: bool) -> Result<(), Failure> {
    // The target of a link is replaced, not the link.
    let target = if force { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() };
    let temporary = Temporary::beside(&target);
    let written = fs::write(temporary.path(), content).and_then(|()| temporary.publish(force));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => exists(path),
        _ => Failure::run(format_args!("cannot write {}: {error}", path.display())),
    })
}

fn directory(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn exists(path: &Path) -> Failure {
    Failure::input(format_args!("{} exists; give --force to replace it, or name another file", path.display()))
}
