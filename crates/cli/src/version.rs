//! Which program this is.

use plateau_run::Program;

/// Revision of the source that the program was built from.
pub const REVISION: &str = env!("PLATEAU_REVISION");

/// Version and revision, as `--version` prints them.
pub const WITH_REVISION: &str = concat!(env!("CARGO_PKG_VERSION"), " (revision ", env!("PLATEAU_REVISION"), ")");

/// This program, as run files name it.
pub fn this() -> Program {
    Program { name: program(), revision: REVISION.into() }
}

/// Name and version.
pub fn program() -> String {
    format!("plateau {}", env!("CARGO_PKG_VERSION"))
}
