//! From the bytes of a file to its text.

use std::borrow::Cow;

/// The bytes 0x80 to 0x9f of Windows-1252; the others are those of Latin-1 (WHATWG Encoding Standard, index windows-1252).
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘', '’',
    '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Whether a text has two bytes a character: by its byte order mark, or by its first two characters, which are of ASCII.
pub(crate) fn is_utf16(content: &[u8]) -> bool {
    utf16(content).is_some()
}

/// The unit of UTF-16 that two bytes make.
type Unit = fn([u8; 2]) -> u16;

/// How two bytes make a unit, and where the first one stands; none if the text has one byte a character.
fn utf16(content: &[u8]) -> Option<(Unit, usize)> {
    let is_ascii = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    match content {
        [0xff, 0xfe, ..] => Some((u16::from_le_bytes, 2)),
        [0xfe, 0xff, ..] => Some((u16::from_be_bytes, 2)),
        [one, 0, other, 0, ..] if is_ascii(one) && is_ascii(other) => Some((u16::from_le_bytes, 0)),
        [0, one, 0, other, ..] if is_ascii(one) && is_ascii(other) => Some((u16::from_be_bytes, 0)),
        _ => None,
    }
}

/// The text of a file: UTF-8 or UTF-16, with byte order mark or without, else Windows-1252, in which "µ" is the byte 181.
///
/// What is damaged becomes U+FFFD, which no number has.
pub fn decode(content: &[u8]) -> Cow<'_, str> {
    if let Some((unit, start)) = utf16(content) {
        // A last byte without its pair is half a character.
        let (pairs, _) = content[start..].as_chunks::<2>();
        let characters = char::decode_utf16(pairs.iter().map(|pair| unit(*pair)));
        return Cow::Owned(characters.map(|character| character.unwrap_or(char::REPLACEMENT_CHARACTER)).collect());
    }
    let content = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    let character = |byte: &u8| match byte {
        0x80..=0x9f => WINDOWS[usize::from(byte - 0x80)],
        other => char::from(*other),
    };
    match std::str::from_utf8(content) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(content.iter().map(character).collect()),
    }
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
        let [little, big] = [utf16(u16::to_le_bytes), utf16(u16::to_be_bytes)];
        let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
        for content in [text.as_bytes(), &little, &big, &little[2..], &big[2..], &latin] {
            assert_eq!(decode(content), text);
        }
        assert_eq!(decode(b"\xef\xbb\xbfa"), "a");
        assert_eq!(decode(b"\xff\xfe1\0\x00\xd8\x32"), "1\u{fffd}");
        assert_eq!(decode(b"\xff\xfe"), "");
        assert_eq!(decode(b"20 \x80, \x93a\x94, \xb5m"), "20 €, “a”, µm");
    }
}
