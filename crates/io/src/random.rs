//! Words that nobody else has.

use std::hash::{BuildHasher, RandomState};

/// Hexadecimal digits of a word.
const DIGITS: usize = 16;

/// A new word.
pub(crate) fn word() -> String {
    // The system seeds it.
    format!("{:0DIGITS$x}", RandomState::new().hash_one(std::process::id()))
}

/// Whether a text may be one of these words.
pub(crate) fn is_word(text: &str) -> bool {
    text.len() == DIGITS && text.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}
