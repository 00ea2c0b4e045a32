//! Where something stands in the text of a study.

use std::path::Path;
use std::sync::Arc;

use toml::Spanned;

use crate::scene::{Origin, Problem};
use crate::text::{odd_character, too_long};

/// Problems that are looked for: nobody reads more.
pub(super) const MOST_PROBLEMS: usize = 100;

/// Turns a place in the text into line and column.
pub(super) struct Place<'a> {
    pub file: Arc<Path>,
    pub text: &'a str,
}

impl Place<'_> {
    /// Line and column of a byte.
    pub fn at(&self, byte: usize) -> Origin {
        let before = self.text.get(..byte).unwrap_or("");
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |start| start.chars().count()) + 1;
        Origin::Place { file: self.file.clone(), line, column }
    }

    /// What is wrong with something that was found.
    pub fn problem<T>(&self, found: &Spanned<T>, key: &str, message: impl Into<String>) -> Problem {
        Problem::new(&self.at(found.span().start), key, message)
    }

    /// As [`check_name`](Self::check_name), of what is told by its name alone, so that it may not be empty.
    pub fn check_label(&self, name: &str, at: impl FnOnce() -> Origin, key: &str, problems: &mut Vec<Problem>) {
        if name.trim().is_empty() {
            problems.push(Problem::new(&at(), key, "the name is empty, expected a word: tables and figures show it"));
        } else {
            self.check_name(name, at, key, problems);
        }
    }

    /// Refuses a name that cannot be shown on one line or is too long for it, in messages, tables and figures.
    pub fn check_name(&self, name: &str, at: impl FnOnce() -> Origin, key: &str, problems: &mut Vec<Problem>) {
        if let Some(found) = odd_character(name) {
            let message = format!("\"{}\" has {found}, expected one line of letters; take it out", name.escape_debug());
            problems.push(Problem::new(&at(), key, message));
        } else if let Some(long) = too_long(name) {
            problems.push(Problem::new(&at(), key, long));
        }
    }
}
