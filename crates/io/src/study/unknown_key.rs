//! Advice where a study has a key that it does not know: which one was meant.

use crate::scene::schema::nearest;
use crate::text::{short, shown_title};

/// How the message of an unknown key begins, and what parts it from the keys that there are.
const BEGINNING: &str = "unknown field `";

/// The message with the key that was meant, where one is like it; other messages as they are.
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
    message + &advice.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::with_advice;

    #[test]
    fn the_key_that_was_meant_is_named() {
        let unknown = "unknown field `factors`, expected one of `version`, `factor`, `response`";
        assert_eq!(with_advice(unknown), format!("{unknown}; did you mean \"factor\"?"));
        let two = "unknown field `seed`, expected `keys` or `seeds`";
        assert_eq!(with_advice(two), format!("{two}; did you mean \"seeds\"?"));
        for other in ["unknown field `foo`, expected `keys` or `seeds`", "missing field `design`"] {
            assert_eq!(with_advice(other), other);
        }
    }
}
