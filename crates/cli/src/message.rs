//! Messages on standard error.

use std::fmt;
use std::io::{self, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};

use plateau_io::text::shown;

static WARNINGS: AtomicBool = AtomicBool::new(true);

/// From now on there are no warnings: another process of the same job gives them.
pub fn no_warnings() {
    WARNINGS.store(false, Ordering::Relaxed);
}

/// Says why the program cannot do what was asked.
pub fn error(message: impl fmt::Display) {
    say(format_args!("plateau: {message}"));
}

/// Says what deserves attention though the program goes on.
pub fn warning(message: impl fmt::Display) {
    if WARNINGS.load(Ordering::Relaxed) {
        say(format_args!("plateau: warning: {message}"));
    }
}

/// Says what is worth knowing.
pub fn note(message: impl fmt::Display) {
    if WARNINGS.load(Ordering::Relaxed) {
        say(format_args!("plateau: {message}"));
    }
}

/// Text of others cannot do anything to the terminal. Where standard error takes nothing (a full disc, a reader gone) the exit status still tells; `eprintln!` would panic.
fn say(line: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{}", shown(&line.to_string()));
}
