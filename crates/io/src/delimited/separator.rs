//! What parts the cells of a line.

use std::borrow::Cow;

/// What parts the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// One of these characters; a cell may be empty.
    Character(char),
    /// A comma with a blank behind it, where those without one are decimal.
    CommaAndBlank,
    /// Any number of blanks.
    Blanks,
}

impl Separator {
    /// The separator of a line: the first of semicolon, tab and comma that it has, else blanks.
    pub(crate) fn of(line: &str) -> Self {
        [';', '\t', ','].into_iter().find(|mark| line.contains(*mark)).map_or(Self::Blanks, Self::Character)
    }

    /// The cells of a line without blanks around them, as they stand in it. A separator between quotation marks parts nothing. One
    /// separator after the last cell is taken off if `terminated`.
    pub(crate) fn parts(self, line: &str, terminated: bool) -> impl Iterator<Item = &str> {
        let (mut characters, mut pairs, mut blanks) = (None, None, None);
        match self {
            Self::Character(mark) => {
                let line = line.trim_matches(|c: char| c.is_whitespace() && c != mark);
                let line = if terminated { line.strip_suffix(mark).unwrap_or(line) } else { line };
                let has_quotes = line.contains('"');
                // What is no blank and stands before a quotation mark: one that opens a cell is its first character.
                let (mut quoted, mut before) = (false, mark);
                let parts = move |character: char| {
                    if has_quotes {
                        quoted ^= character == '"' && (quoted || before == mark || before == '"');
                        before = if character.is_whitespace() && character != mark { before } else { character };
                    }
                    character == mark && !quoted
                };
                characters = Some(line.split(parts));
            }
            Self::CommaAndBlank => {
                let line = line.trim();
                let line = if terminated { line.strip_suffix(',').unwrap_or(line) } else { line };
                pairs = Some(line.split(", "));
            }
            Self::Blanks => blanks = Some(line.split_whitespace()),
        }
        let parts = characters.into_iter().flatten().chain(pairs.into_iter().flatten());
        parts.chain(blanks.into_iter().flatten()).map(str::trim)
    }

    /// The cells of a line, as [`Separator::parts`], without quotation marks around them.
    pub(crate) fn cells(self, line: &str, terminated: bool) -> impl Iterator<Item = &str> {
        self.parts(line, terminated).map(|cell| cell.trim_matches('"').trim())
    }

    /// Whether a line ends with a separator.
    pub(crate) fn ends(self, line: &str) -> bool {
        match self {
            Self::Character(mark) => line.trim_end_matches(|c: char| c.is_whitespace() && c != mark).ends_with(mark),
            Self::CommaAndBlank => line.trim_end().ends_with(','),
            Self::Blanks => false,
        }
    }
}

/// The text of a cell, of which quotation marks around it are no part (RFC 4180: two of them within stand for one); none where the mark
/// that opens it is not closed.
pub(super) fn unquoted(cell: &str) -> Option<Cow<'_, str>> {
    let Some(rest) = cell.strip_prefix('"') else { return Some(Cow::Borrowed(cell)) };
    let text = rest.strip_suffix('"')?;
    if !text.contains('"') {
        return Some(Cow::Borrowed(text.trim()));
    }
    let plain = text.replace("\"\"", "");
    (!plain.contains('"')).then(|| Cow::Owned(text.replace("\"\"", "\"").trim().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_parted_by_the_strongest_separator() {
        let cells = |line: &str, terminated| {
            Separator::of(line).cells(line, terminated).map(str::to_owned).collect::<Vec<_>>().join("|")
        };
        assert_eq!(cells(" 1  2\u{a0}3 ", false), "1|2|3");
        assert_eq!(cells("1, 2 ,,4", false), "1|2||4");
        assert_eq!(cells("1;2,5; ", false), "1|2,5|");
        assert_eq!(cells("1;2,5; ", true), "1|2,5");
        assert_eq!(cells("\t1\t\t3", false), "|1||3");
        assert_eq!(cells("\"1.5\",\"2\"", false), "1.5|2");
        assert_eq!(cells("\"1,5\", \"2,5\",\"\"", false), "1,5|2,5|");
    }

    #[test]
    fn quotation_marks_are_those_of_rfc_4180() {
        let texts = |line: &str| {
            let texts = Separator::Character(',').parts(line, false).map(unquoted).collect::<Vec<_>>();
            texts.into_iter().map(|text| text.map_or_else(|| "?".to_owned(), Cow::into_owned)).collect::<Vec<_>>()
        };
        assert_eq!(texts(r#"a "b",2"#), [r#"a "b""#, "2"]);
        assert_eq!(texts(r#"5",7"#), [r#"5""#, "7"]);
        assert_eq!(texts(r#""a, ""b"", c", "" ,"""","x"#), [r#"a, "b", c"#, "", "\"", "?"]);
        assert_eq!(texts(r#""a" b,1"#), ["?", "1"]);
    }
}
