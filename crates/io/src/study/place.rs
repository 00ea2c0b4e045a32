//! Where something stands in the text of a study.

use std::path::Path;
use std::sync::Arc;

use toml::Spanned;

use crate::scene::{Origin, Problem};
use crate::text::{odd_character, short, too_long};

/// Says that a name has what nobody sees, a blank at an end or a byte order mark, which tables and command lines lose, so that the name is
/// not found again.
pub(super) fn unseen(name: &str) -> Option<String> {
    let found = match () {
        () if name.contains(MARK) => "has the character U+FEFF, which nobody sees",
        () if name != name.trim() => "has a blank at an end",
        () => return None,
    };
    let name = short(name);
    Some(format!("\"{}\" {found}, so that it is not found again in a table; take it out", name.escape_debug()))
}

/// The byte order mark, or the blank of no width that it was before.
const MARK: char = '\u{feff}';

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
        } else if let Some(unseen) = unseen(name) {
            problems.push(Problem::new(&at(), key, unseen));
        } else {
            self.check_name(name, at, key, problems);
        }
    }

    /// Refuses a name that cannot be shown on one line or is too long for it, in messages, tables and figures.
    pub fn check_name(&self, name: &str, at: impl FnOnce() -> Origin, key: &str, problems: &mut Vec<Problem>) {
        if let Some(found) = odd_character(name) {
            let name = short(name);
            let message = format!("\"{}\" has {found}, expected one line of letters; take it out", name.escape_debug());
            problems.push(Problem::new(&at(), key, message));
        } else if let Some(long) = too_long(name) {
            problems.push(Problem::new(&at(), key, long));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::unseen;

    #[test]
    fn blanks_at_ends_and_marks_are_told() {
        assert_eq!(unseen("load on the pin"), None);
        for name in [" load", "load\u{a0}"] {
            assert!(unseen(name).unwrap().contains("a blank at an end"), "{name:?}");
        }
        let long = unseen(&format!("{} ", "x".repeat(70_000))).unwrap();
        assert!(long.contains("x…\" has a blank at an end") && long.len() < 200, "{long}");
        assert!(unseen("lo\u{feff}ad").unwrap().starts_with("\"lo\\u{feff}ad\" has the character U+FEFF"));
    }
}
