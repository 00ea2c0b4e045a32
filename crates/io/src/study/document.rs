//! Text of a study file (docs/study.md): its keys, their places, checks of names, and messages of the TOML reader in other words.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use toml::{Spanned, Value};

use crate::scene::{Locator, Origin, Problem};
use crate::text::{nearest, odd_character, short, shown_title, too_long};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub version: Spanned<i64>,
    pub title: Option<String>,
    pub base: Option<Spanned<String>>,
    #[serde(default)]
    pub set: Vec<Spanned<String>>,
    pub design: Spanned<String>,
    pub resolution: Option<Spanned<u32>>,
    pub generators: Option<Spanned<Vec<String>>>,
    pub points: Option<Spanned<usize>>,
    pub trajectories: Option<Spanned<usize>>,
    pub levels: Option<Spanned<usize>>,
    pub alpha: Option<Spanned<String>>,
    pub centre_points: Option<Spanned<usize>>,
    pub file: Option<Spanned<String>>,
    pub order: Option<Spanned<String>>,
    pub seed: Option<Spanned<u64>>,
    pub replicates: Option<Replicates>,
    pub directory: Option<String>,
    pub series: Option<Vec<Spanned<String>>>,
    #[serde(default)]
    pub factor: Vec<Factor>,
    #[serde(default)]
    pub response: Vec<Response>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub fit: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Replicates {
    pub keys: Option<Spanned<Vec<Spanned<String>>>>,
    pub seeds: Spanned<Vec<Spanned<i64>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Factor {
    pub name: Option<Spanned<String>>,
    /// Keys that are set; absent of a factor that is set elsewhere, as on a rig.
    pub key: Option<Spanned<Keys>>,
    pub levels: Option<Spanned<Vec<Spanned<Value>>>>,
    pub range: Option<Spanned<[Spanned<Value>; 2]>>,
    pub scale: Option<Spanned<String>>,
}

/// One key path, or several that are always set alike.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Keys(pub Vec<String>);

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = || Error::custom("expected a key path such as \"operation.normal_force\", or a list");
        match Value::deserialize(deserializer)? {
            Value::String(key) => Ok(Self(vec![key])),
            Value::Array(keys) if !keys.is_empty() => {
                let keys = keys.iter().map(|key| key.as_str().map(str::to_owned));
                keys.collect::<Option<_>>().map(Self).ok_or_else(expected)
            }
            _ => Err(expected()),
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Response {
    pub name: Spanned<String>,
    pub dataset: Option<Spanned<String>>,
    pub imported: Option<Spanned<bool>>,
    pub unit: Option<Spanned<String>>,
    pub transform: Option<Spanned<String>>,
    pub at: Option<Spanned<String>>,
    pub mean: Option<Spanned<Mean>>,
    pub reaches: Option<Spanned<f64>>,
    pub event: Option<Spanned<Value>>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub measured: Option<IgnoredAny>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub uncertainty: Option<IgnoredAny>,
    pub measured_file: Option<Spanned<String>>,
    #[expect(dead_code, reason = "`plateau fit` reads it")]
    pub correlation_time: Option<IgnoredAny>,
}

/// Time over which a mean is taken.
#[derive(Debug)]
pub(super) enum Mean {
    /// `"last tenth"`.
    LastTenth,
    /// Start and end of that time.
    Between([Spanned<String>; 2]),
}

impl<'de> Deserialize<'de> for Mean {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MeanVisitor)
    }
}

struct MeanVisitor;

impl<'de> Visitor<'de> for MeanVisitor {
    type Value = Mean;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"last tenth\", or two times such as [\"50 s\", \"100 s\"]")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Mean, E> {
        if text == "last tenth" {
            Ok(Mean::LastTenth)
        } else {
            Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut times: A) -> Result<Mean, A::Error> {
        let mut next = |count| times.next_element()?.ok_or_else(|| A::Error::invalid_length(count, &MeanVisitor));
        let between = [next(0)?, next(1)?];
        match times.next_element::<Spanned<String>>()? {
            None => Ok(Mean::Between(between)),
            Some(_) => Err(A::Error::invalid_length(3, &self)),
        }
    }
}

/// Beginning of the message of an unknown key, which parts it from the keys that there are.
const BEGINNING: &str = "unknown field `";

/// Messages of the reader, and the same in other words.
const WORDS: [(&str, &str); 5] = [
    ("unknown field `", "unknown key `"),
    ("missing field `", "missing key `"),
    (
        "invalid type: map, expected a sequence",
        "this is one table, expected a list of them: write [[factor]], [[response]]",
    ),
    ("expected a sequence", "expected a list in brackets, such as [\"5 N\", \"20 N\"]"),
    ("an array of length 2", "two values in brackets, such as [\"5 N\", \"20 N\"]"),
];

/// The message in other words, with the key that was meant, where one is like it.
pub(super) fn with_advice(message: &str) -> String {
    let parts = message.strip_prefix(BEGINNING).and_then(|rest| rest.split_once('`'));
    let advice = parts.and_then(|(found, rest)| {
        // Every other part between backquotes is a key.
        let meant = nearest(found, rest.split('`').skip(1).step_by(2))?;
        Some(format!("; did you mean \"{meant}\"?"))
    });
    let message = match parts {
        Some((found, rest)) => format!("{BEGINNING}{}`{rest}", short(found)),
        None => shown_title(message).into_owned(),
    };
    let message = WORDS.iter().fold(message, |message, (said, better)| message.replacen(said, better, 1));
    message + &advice.unwrap_or_default()
}

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

impl Locator<'_> {
    pub(super) fn problem<T>(&self, found: &Spanned<T>, key: &str, message: impl Into<String>) -> Problem {
        Problem::new(&self.origin(found.span()), key, message)
    }

    /// Meaning of a word that is one of some; where none is given, that of the first.
    pub(super) fn choice<T: Copy>(
        &self,
        found: Option<&Spanned<String>>,
        key: &str,
        choices: &[(&str, T)],
    ) -> Result<T, Problem> {
        let Some(found) = found else { return Ok(choices[0].1) };
        if let Some((_, meaning)) = choices.iter().find(|(word, _)| word == found.get_ref()) {
            return Ok(*meaning);
        }
        let words: Vec<String> = choices.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        let (others, last) = words.split_at(words.len() - 1);
        let message = format!("\"{}\", expected {} or {}", short(found.get_ref()), others.join(", "), last.concat());
        Err(self.problem(found, key, message))
    }

    /// Checks a name as [`check_name`](Self::check_name) does, of what is told by its name alone, so that it may not be empty.
    pub(super) fn check_label(&self, name: &str, at: impl FnOnce() -> Origin, key: &str, problems: &mut Vec<Problem>) {
        if name.trim().is_empty() {
            problems.push(Problem::new(&at(), key, "the name is empty, expected a word: tables and figures show it"));
        } else if let Some(unseen) = unseen(name) {
            problems.push(Problem::new(&at(), key, unseen));
        } else {
            self.check_name(name, at, key, problems);
        }
    }

    /// Refuses a name that cannot be shown on one line or is too long for it, in messages, tables and figures.
    pub(super) fn check_name(&self, name: &str, at: impl FnOnce() -> Origin, key: &str, problems: &mut Vec<Problem>) {
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
#[path = "../../tests/unit/study/document.rs"]
mod tests;
