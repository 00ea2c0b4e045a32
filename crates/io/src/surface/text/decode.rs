//! From the bytes of a file to its lines.

use std::borrow::Cow;

/// Whether a text has two bytes a character, by its byte order mark.
pub(in crate::surface) fn is_utf16(content: &[u8]) -> bool {
    content.starts_with(b"\xff\xfe") || content.starts_with(b"\xfe\xff")
}

/// The text of a file: UTF-8, UTF-16 with its byte order mark, else Latin-1, in which "µ" is the byte 181.
///
/// What is damaged becomes U+FFFD, which no number has.
pub(super) fn decode(content: &[u8]) -> Cow<'_, str> {
    if is_utf16(content) {
        let unit: fn([u8; 2]) -> u16 = if content[0] == 0xff { u16::from_le_bytes } else { u16::from_be_bytes };
        // A last byte without its pair is half a character.
        let (pairs, _) = content[2..].as_chunks::<2>();
        let characters = char::decode_utf16(pairs.iter().map(|pair| unit(*pair)));
        return Cow::Owned(characters.map(|character| character.unwrap_or(char::REPLACEMENT_CHARACTER)).collect());
    }
    let content = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    match std::str::from_utf8(content) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(content.iter().map(|byte| char::from(*byte)).collect()),
    }
}

/// The lines of a text that are not blank, each with its number, counted from 1. Line ends are those of any system.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> + Clone {
    let line_end = if text.contains('\n') { '\n' } else { '\r' };
    text.split(line_end)
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim_end_matches('\r')))
        .filter(|(_, line)| !line.trim().is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text() {
        let text = "x [µm]\r\n1";
        let utf16 = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect()
        };
        let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
        for content in [text.as_bytes(), &utf16(u16::to_le_bytes), &utf16(u16::to_be_bytes), &latin] {
            assert_eq!(decode(content), text);
        }
        assert_eq!(decode(b"\xef\xbb\xbfa"), "a");
        assert_eq!(decode(b"\xff\xfe1\0\x00\xd8\x32"), "1\u{fffd}");
        assert_eq!(decode(b"\xff\xfe"), "");
    }

    #[test]
    fn lines_end_as_on_any_system() {
        for text in ["1\n\n2\n", "1\r\n\r\n2\r\n", "1\r\r2\r", "1\r\r\n\r\r\n2\r\r\n"] {
            assert_eq!(lines(text).collect::<Vec<_>>(), [(1, "1"), (3, "2")], "{text:?}");
        }
    }
}
