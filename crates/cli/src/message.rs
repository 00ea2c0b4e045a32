//! Messages on standard error: in colour on a terminal, unless NO_COLOR is set.

use std::fmt;
use std::io::{self, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};

use console::{Style, StyledObject};
use plateau_io::text::{shown, shown_message};

static WARNINGS: AtomicBool = AtomicBool::new(true);
static QUIET: AtomicBool = AtomicBool::new(false);
static VERBOSE: AtomicBool = AtomicBool::new(false);

/// How much is said, as `-q` and `-v` ask for: errors alone, or also what is done to surfaces.
pub fn set_level(quiet: bool, verbose: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
    VERBOSE.store(verbose, Ordering::Relaxed);
}

/// Whether nothing but errors is said.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Whether more is said than one needs.
pub fn is_verbose() -> bool {
    VERBOSE.load(Ordering::Relaxed)
}

/// From now on there are no warnings: another process of the same job gives them.
pub fn no_warnings() {
    WARNINGS.store(false, Ordering::Relaxed);
}

/// Says why the program cannot do what was asked.
pub fn error(message: impl fmt::Display) {
    say(coloured("plateau:", Style::new().red().bold()), message);
}

/// Says what deserves attention though the program goes on.
pub fn warning(message: impl fmt::Display) {
    if may_be_said() {
        say(format_args!("plateau: {}", coloured("warning:", Style::new().yellow().bold())), message);
    }
}

/// Says what is worth knowing.
pub fn note(message: impl fmt::Display) {
    if may_be_said() {
        say("plateau:", message);
    }
}

/// A text in a style where standard error is a terminal that shows it.
fn coloured(text: &str, style: Style) -> StyledObject<&str> {
    style.for_stderr().apply_to(text)
}

fn may_be_said() -> bool {
    WARNINGS.load(Ordering::Relaxed) && !is_quiet()
}

/// Text of others cannot do anything to the terminal, nor fill it. Where standard error takes nothing (a full disc, a reader gone) the exit
/// status still tells; `eprintln!` would panic.
fn say(who: impl fmt::Display, message: impl fmt::Display) {
    let message = message.to_string();
    let _ = writeln!(io::stderr().lock(), "{who} {}", shown_message(&shown(&message)));
}
