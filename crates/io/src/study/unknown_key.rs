//! What the reader of a study says, in the words of this guide, and which key was meant where it does not know one.

use crate::scene::schema::nearest;
use crate::text::{short, shown_title};

/// How the message of an unknown key begins, and what parts it from the keys that there are.
const BEGINNING: &str = "unknown field `";

/// What the reader says, and in other words.
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

#[cfg(test)]
mod tests {
    use super::with_advice;

    #[test]
    fn the_key_that_was_meant_is_named() {
        let unknown = "unknown field `factors`, expected one of `version`, `factor`, `response`";
        let said = |message: &str| message.replace("field", "key");
        assert_eq!(with_advice(unknown), format!("{}; did you mean \"factor\"?", said(unknown)));
        let two = "unknown field `seed`, expected `keys` or `seeds`";
        assert_eq!(with_advice(two), format!("{}; did you mean \"seeds\"?", said(two)));
        for other in ["unknown field `foo`, expected `keys` or `seeds`", "missing field `design`"] {
            assert_eq!(with_advice(other), said(other));
        }
        let one = "invalid type: map, expected a sequence";
        assert_eq!(with_advice(one), "this is one table, expected a list of them: write [[factor]], [[response]]");
        let text = "invalid type: string \"5 N\", expected a sequence";
        let told = "invalid type: string \"5 N\", expected a list in brackets, such as [\"5 N\", \"20 N\"]";
        assert_eq!(with_advice(text), told);
        let number = "invalid type: floating point `0.5`, expected an array of length 2";
        let told = "invalid type: floating point `0.5`, expected two values in brackets, such as [\"5 N\", \"20 N\"]";
        assert_eq!(with_advice(number), told);
    }
}
