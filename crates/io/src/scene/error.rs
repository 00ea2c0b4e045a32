//! Problems and warnings of a scene, and their places in a text; of a scene or a study that is not TOML, the problem in words.

use std::cell::Cell;
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use serde::{Serialize, Serializer};
use thiserror::Error;

use crate::text::{self, short, shown_on_one_line, shown_problem, shown_title};

/// Origin of a value: the place where it was given.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// A place in a scene file; line and column (in characters) count from 1.
    Place {
        /// The file.
        file: Arc<Path>,
        /// Line.
        line: usize,
        /// Column.
        column: usize,
    },
    /// A scene file as a whole.
    File(Arc<Path>),
    /// An argument `--set key=value`.
    Set(Arc<str>),
    /// Nowhere: the program's own default.
    Default,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Place { file, line, column } => write!(f, "{}:{line}:{column}", file.display()),
            Self::File(file) => write!(f, "{}", file.display()),
            Self::Set(argument) => write!(f, "--set {}", shown_on_one_line(&shown_title(argument))),
            Self::Default => write!(f, "default"),
        }
    }
}

/// Text of a file, whose bytes it tells by line and column.
pub(crate) struct Locator<'a> {
    pub(crate) file: Arc<Path>,
    text: &'a str,
    /// Byte at which each line starts.
    lines: Vec<usize>,
    /// The place that was asked for last: line, byte, column. The next one is mostly behind it, maybe on a line of a megabyte.
    last: Cell<(usize, usize, usize)>,
}

impl<'a> Locator<'a> {
    pub(crate) fn new(file: Arc<Path>, text: &'a str) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { file, text, lines, last: Cell::new((0, 0, 1)) }
    }

    /// Line and column of the first byte of a span.
    pub(crate) fn origin(&self, span: Range<usize>) -> Origin {
        let line = self.lines.partition_point(|start| *start <= span.start).max(1);
        let (from, first) = match self.last.get() {
            (last, byte, column) if last == line && byte <= span.start => (byte, column),
            _ => (self.lines[line - 1], 1),
        };
        let column = self.text.get(from..span.start).map_or(0, |before| before.chars().count()) + first;
        self.last.set((line, span.start, column));
        Origin::Place { file: self.file.clone(), line, column }
    }
}

/// One thing that is wrong: where, which key, what was found, what was expected, what to do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{origin}: {}{}", key.as_ref().map_or_else(String::new, |key| format!("{}: ", short(key))), shown_problem(message))]
pub struct Problem {
    /// Place of what is wrong.
    pub origin: Origin,
    /// Full path of the key, if there is one.
    pub key: Option<String>,
    /// Message: what was found, what was expected, what to do.
    pub message: String,
    /// Number of the error of the system, where that did not give the file.
    pub system: Option<i32>,
}

impl Problem {
    pub(crate) fn new(origin: &Origin, key: &str, message: impl Into<String>) -> Self {
        Self { key: Some(key.to_owned()), ..Self::without_key(origin, message) }
    }

    pub(crate) fn without_key(origin: &Origin, message: impl Into<String>) -> Self {
        Self { origin: origin.clone(), key: None, message: message.into(), system: None }
    }
}

/// Reason why a scene cannot be run: everything that was found wrong with it, in the order of the text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", text::problems(.problems))]
pub struct SceneError {
    problems: Vec<Problem>,
}

impl SceneError {
    /// Problems, at least one.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    pub(super) fn new(mut problems: Vec<Problem>) -> Self {
        problems.sort_by(|a, b| a.origin.cmp(&b.origin));
        Self { problems }
    }
}

impl From<Problem> for SceneError {
    fn from(problem: Problem) -> Self {
        Self { problems: vec![problem] }
    }
}

/// One thing that a scene can hardly mean: where, which key, what was found, which bound it misses, what to do.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// Origin of the key.
    #[serde(serialize_with = "as_text")]
    pub place: Origin,
    /// Full path of the key.
    pub key: String,
    /// The value found, in words, with its number.
    pub found: String,
    /// The bound that it misses, with its number.
    pub bound: String,
    /// Advice.
    pub advice: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, key, found, bound, advice } = self;
        write!(f, "{place}: {key}: {found}, {bound}; {advice}")
    }
}

fn as_text<S: Serializer>(place: &Origin, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(place)
}

/// Tells whether a document with these keys is a study: every one has both.
pub(crate) fn is_study(has: impl Fn(&str) -> bool) -> bool {
    has("design") && has("factor")
}

/// Message of the parser on a text, and more of what is often wrong.
pub(crate) fn not_toml(text: &str, error: &toml::de::Error) -> String {
    let message = error.message();
    // The parser points at the second of two equal keys, and does not name it.
    let twice = error.span().filter(|_| message == "duplicate key").and_then(|span| text.get(span));
    match twice {
        // Of these a study has several.
        Some(key) if ["factor", "response"].contains(&key) => {
            format!("[{key}] is there already: write [[{key}]], with two brackets, for each")
        }
        Some(key) => format!("{} is there already in this table, further up: keep one of them", short(key)),
        None => match error.span().and_then(|span| with_comma(text, span.start)) {
            Some(found) => format!("{} has a comma, write {}", short(found), short(&found.replacen(',', ".", 1))),
            None => format!("this is not TOML: {}", shown_title(message)),
        },
    }
}

/// The number with a decimal comma that the parser stopped in, at its comma or behind it.
fn with_comma(text: &str, at: usize) -> Option<&str> {
    let is_part = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b',' | b'-' | b'+');
    let bytes = text.as_bytes();
    let before = bytes.get(..at)?.iter().rev().take_while(|byte| is_part(byte)).count();
    let behind = bytes[at..].iter().take_while(|byte| is_part(byte)).count();
    let found = text.get(at - before..at + behind)?;
    let number = found.replacen(',', ".", 1);
    (found.matches(',').count() == 1 && !found.ends_with(',') && number.parse::<f64>().is_ok()).then_some(found)
}

#[cfg(test)]
#[path = "../../tests/unit/syntax.rs"]
mod tests;
