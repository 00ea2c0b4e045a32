//! Problem of a scene or a study that is not TOML, in words.

use toml::de::Error;

use crate::text::{short, shown_title};

/// Tells whether a document with these keys is a study: every one has both.
pub(crate) fn is_study(has: impl Fn(&str) -> bool) -> bool {
    has("design") && has("factor")
}

/// Message of the parser on a text, and more of what is often wrong.
pub(crate) fn problem(text: &str, error: &Error) -> String {
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
mod tests {
    use toml::Table;

    use super::*;

    fn said(text: &str) -> String {
        problem(text, &text.parse::<Table>().unwrap_err())
    }

    #[test]
    fn what_is_often_wrong_is_named() {
        assert_eq!(said("load = 4,5"), "4,5 has a comma, write 4.5");
        assert_eq!(
            said("[a]\nload = 1\nload = 2"),
            "load is there already in this table, further up: keep one of them"
        );
        assert!(said("load = ").starts_with("this is not TOML: "), "{}", said("load = "));
    }
}
