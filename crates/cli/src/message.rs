//! Messages on standard error: in colour on a terminal, unless NO_COLOR is set.

use std::fmt;
use std::io::{self, Write as _};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use console::Style;
use plateau_io::text::{shown, shown_message};

static WARNINGS: AtomicBool = AtomicBool::new(true);
static QUIET: AtomicBool = AtomicBool::new(false);
static VERBOSE: AtomicBool = AtomicBool::new(false);
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// Sets how much is said, as `-q` and `-v` ask for: errors alone, or also what is done to surfaces.
pub fn set_level(quiet: bool, verbose: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
    VERBOSE.store(verbose, Ordering::Relaxed);
}

/// Level of messages, as the option that asks for it.
pub fn level_as_option() -> Option<&'static str> {
    if is_quiet() { Some("--quiet") } else { is_verbose().then_some("--verbose") }
}

/// Tells whether nothing but errors is said.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Tells whether more is said than one needs.
pub fn is_verbose() -> bool {
    VERBOSE.load(Ordering::Relaxed)
}

/// From now on there are no warnings: another process of the same job gives them.
pub fn no_warnings() {
    WARNINGS.store(false, Ordering::Relaxed);
}

/// Says why the program cannot do what was asked.
pub fn error(message: impl fmt::Display) {
    let style = Style::new().red().bold().for_stderr();
    say_in(style.apply_to("plateau:"), message, |text| with_coloured_marks(text, &style));
}

/// Says what deserves attention though the program goes on.
pub fn warning(message: impl fmt::Display) {
    COUNT.fetch_add(1, Ordering::Relaxed);
    if may_be_said() {
        let word = Style::new().yellow().bold().for_stderr().apply_to("warning:");
        say(format_args!("plateau: {word}"), message);
    }
}

/// Number of warnings until now, also of those that `-q` keeps back.
pub fn warnings() -> usize {
    COUNT.load(Ordering::Relaxed)
}

/// Says what is worth knowing.
pub fn note(message: impl fmt::Display) {
    if may_be_said() {
        say("plateau:", message);
    }
}

fn may_be_said() -> bool {
    WARNINGS.load(Ordering::Relaxed) && !is_quiet()
}

/// Text of others cannot do anything to the terminal, nor fill it. Where standard error takes nothing (a full disc, a reader gone) the exit
/// status still tells; `eprintln!` would panic.
fn say(who: impl fmt::Display, message: impl fmt::Display) {
    say_in(who, message, str::to_owned);
}

/// Says it in the look that is given to it last, in one piece: other processes may write there, too.
fn say_in(who: impl fmt::Display, message: impl fmt::Display, look: impl Fn(&str) -> String) {
    let message = message.to_string();
    let line = format!("{who} {}\n", look(&shown_message(&shown(&message))));
    let _ = io::stderr().write_all(line.as_bytes());
}

/// The marks below lines of a file in a style.
fn with_coloured_marks(message: &str, style: &Style) -> String {
    let with_mark = |line: &str| match line.strip_suffix('^') {
        Some(before) if before.trim() == "|" => format!("{before}{}", style.apply_to("^")),
        _ => line.to_owned(),
    };
    message.split('\n').map(with_mark).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
#[path = "../tests/unit/message.rs"]
mod tests;
