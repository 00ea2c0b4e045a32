//! Text in messages: text of others, made such that it changes nothing but itself where it is shown (no character of it moves the
//! cursor, hides what follows, or turns the direction of letters); lists, of which as much is told as anybody reads, twenty or what has
//! room in 4000 letters; and names that may be meant by a mistyped one.

use std::borrow::Cow;
use std::fmt::{Display, Write as _};

/// Letters of a name that a message shows.
const SHOWN: usize = 60;

/// Tells whether a character is shown as itself: no control character (Unicode category Cc), none that turns the direction of what
/// follows (Unicode Standard Annex 9, section 2), and none that XML 1.0 has no place for.
pub fn is_plain(letter: char) -> bool {
    let turns =
        matches!(letter, '\u{200e}' | '\u{200f}' | '\u{061c}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !letter.is_control() && !turns && !matches!(letter, '\u{2028}' | '\u{2029}' | '\u{fffe}' | '\u{ffff}')
}

/// The first character of a text that is not shown as itself, in words.
pub fn odd_character(text: &str) -> Option<String> {
    let odd = text.chars().find(|letter| !is_plain(*letter))?;
    Some(match odd {
        '\n' | '\r' => "a line break".to_owned(),
        '\t' => "a tab".to_owned(),
        odd => format!("the control character U+{:04X}", u32::from(odd)),
    })
}

/// Letters of a name, a title or a level, at most: so many are read, and fit a table or a figure.
const LONGEST_NAME: usize = 200;

/// Letters of what is said of one thing that is wrong, at most: more than any such message has of its own.
const LONGEST_PROBLEM: usize = 2000;

/// Letters of a message in all, at most: lists are cut before (see [`crate::text`]), and no path is longer.
const LONGEST_MESSAGE: usize = 8000;

/// Says that a name, a title or a level has more letters than are taken.
pub fn too_long(text: &str) -> Option<String> {
    // There are no more letters than bytes, and nobody counts a gigabyte of them.
    if text.len() <= LONGEST_NAME || text.chars().nth(LONGEST_NAME).is_none() {
        return None;
    }
    let letters = text.chars().count();
    Some(format!("\"{}\" has {letters} letters, expected at most {LONGEST_NAME}; shorten it", short(text)))
}

/// Shortens a text to what a message or a heading has room for.
pub fn short(text: &str) -> Cow<'_, str> {
    beginning(text, SHOWN)
}

/// Shortens a title to what is shown: somebody else may have made it as long as he likes.
pub fn shown_title(text: &str) -> Cow<'_, str> {
    beginning(text, LONGEST_NAME)
}

/// Shortens what is said of one thing that is wrong to what is read, with whatever of a stranger's text is in it.
pub fn shown_problem(text: &str) -> Cow<'_, str> {
    beginning(text, LONGEST_PROBLEM)
}

/// Shortens a message to what is read.
pub fn shown_message(message: &str) -> Cow<'_, str> {
    beginning(message, LONGEST_MESSAGE)
}

pub(crate) fn beginning(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

/// A text of one or more lines as it can be shown: other control characters are written as `\u{1b}`.
pub fn shown(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| is_plain(letter) || letter == '\n' || letter == '\t')
}

/// A text as it can be shown within a line.
pub fn shown_on_one_line(text: &str) -> Cow<'_, str> {
    escaped(text, is_plain)
}

fn escaped(text: &str, stays: impl Fn(char) -> bool) -> Cow<'_, str> {
    if text.chars().all(&stays) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for letter in text.chars() {
        match letter {
            letter if stays(letter) => shown.push(letter),
            '\n' => shown.push_str("\\n"),
            '\r' => shown.push_str("\\r"),
            '\t' => shown.push_str("\\t"),
            // Writing to a String cannot fail.
            letter => _ = write!(shown, "\\u{{{:x}}}", u32::from(letter)),
        }
    }
    Cow::Owned(shown)
}

/// A cell of a table that spreadsheets take as the text that it is: one that would begin a formula there (`=`, `+`, `-`, `@`)
/// has an apostrophe before it, which spreadsheets take as "this is text". Numbers and quantities stay as they are. What has
/// such an apostrophe already gets another, so that [`text_of_cell`] gives back what was written.
pub fn cell(text: &str) -> Cow<'_, str> {
    if is_formula(text.trim_start_matches('\'')) {
        return Cow::Owned(format!("'{text}"));
    }
    Cow::Borrowed(text)
}

/// The text of a cell, without the apostrophe that [`cell`] has put before it.
pub fn text_of_cell(cell: &str) -> &str {
    let text = cell.strip_prefix('\'').filter(|text| is_formula(text.trim_start_matches('\'')));
    text.unwrap_or(cell)
}

fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r']) && !is_quantity(text)
}

/// Tells whether a text is a number, or one with a unit behind it such as `-5 mm` or `-2 1/K`.
fn is_quantity(text: &str) -> bool {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let of_units = |letter: char| letter.is_alphanumeric() || "/^*%°- ".contains(letter);
    // An operator or a number behind the first one would be computed.
    let begins = unit.is_empty()
        || unit.starts_with("1/")
        || unit.starts_with(|first: char| first.is_alphabetic() || "%°".contains(first));
    number.parse().is_ok_and(f64::is_finite) && begins && unit.chars().all(of_units)
}

/// Likeness (0 to 1, strsim's normalised Damerau-Levenshtein) from which a name counts as mistyped.
const LIKE: f64 = 0.6;
/// Letters of a name that may be mistyped: more than any has. To compare takes time in proportion to them, for each candidate.
const LONGEST_MISTYPED: usize = 200;

/// The candidate that is most like `name`, if one is like enough.
pub(crate) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST_MISTYPED {
        return None;
    }
    let likeness = |candidate: &str| strsim::normalized_damerau_levenshtein(&name.to_lowercase(), candidate);
    candidates
        .into_iter()
        .map(|candidate| (likeness(candidate), candidate))
        .filter(|(likeness, _)| *likeness >= LIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// Problems that are looked for in one text; nobody reads more, and in a file of another kind each word may be one.
pub const MOST_PROBLEMS: usize = 100;

/// Members of a list that are told, at most.
const MOST: usize = 20;
/// Letters of a list, at most, but for the separators and the number of those that are left out.
const ROOM: usize = 4000;

/// Some texts with a separator between them, such as a comma: the first of them, and how many more there are.
pub fn list<T: Display>(texts: impl IntoIterator<Item = T>, separator: &str) -> String {
    let (told, more) = told(texts, separator);
    if more == 0 { told } else { format!("{told}{separator}and {more} more") }
}

/// Problem with a file, a problem a line: the first of them, and how many more were found.
pub fn problems<T: Display>(problems: impl IntoIterator<Item = T>) -> String {
    let mut found = 0;
    let (told, more) = told(problems.into_iter().inspect(|_| found += 1), "\n");
    match more {
        0 => told,
        // Then no others were looked for.
        more if found >= MOST_PROBLEMS => format!("{told}\nand {more} more, at least"),
        more => format!("{told}\nand {more} more"),
    }
}

/// The first of some texts, one of them at least, and how many more there are.
fn told<T: Display>(texts: impl IntoIterator<Item = T>, separator: &str) -> (String, usize) {
    let mut texts = texts.into_iter();
    let (mut told, mut letters, mut count) = (String::new(), 0, 0);
    for text in texts.by_ref() {
        let text = text.to_string();
        let text = beginning(&text, ROOM);
        letters += text.chars().count();
        if count == MOST || count > 0 && letters > ROOM {
            // This one, and those that follow.
            return (told, 1 + texts.count());
        }
        if count > 0 {
            told.push_str(separator);
        }
        told.push_str(&text);
        count += 1;
    }
    (told, 0)
}

#[cfg(test)]
#[path = "../tests/unit/text.rs"]
mod tests;
