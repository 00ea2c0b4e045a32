//! Dialect of a text of numbers: its lines, the separator of cells, the decimal mark, and the beginning of another table, below a blank
//! line or with a line of a header where rows stand above and below.

use std::borrow::Cow;

/// What stands between the whole number and its fraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Decimal {
    /// 0.5
    #[default]
    Point,
    /// 0,5
    Comma,
}

impl Decimal {
    /// The mark of a number, which may have a unit behind it; none of what is no number, has no fraction, or has digits in groups.
    pub(crate) fn of(cell: &str) -> Option<Self> {
        let is_whole = |text: &str| text.trim_start_matches(['+', '-']).bytes().all(|byte| byte.is_ascii_digit());
        let is_fraction =
            |text: &str| text.starts_with(|first: char| first.is_ascii_digit()) && !text.contains([',', '.']);
        let at = cell.find([',', '.'])?;
        let is_number = is_whole(&cell[..at]) && is_fraction(&cell[at + 1..]);
        is_number.then(|| if cell[at..].starts_with(',') { Self::Comma } else { Self::Point })
    }
}

/// Character that parts the cells of a line.
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

    /// Tells whether a line ends with a separator.
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

/// The lines of a text, each with its number, counted from 1. Line ends are those of any system.
pub fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> + Clone {
    let line_end = if text.contains('\n') { '\n' } else { '\r' };
    text.strip_suffix(line_end)
        .unwrap_or(text)
        .split(line_end)
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim_end_matches('\r')))
}

/// The lines of a text that are not blank, without a first line `sep=;`, which is for spreadsheets.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> + Clone {
    let first = usize::from(stated_separator(text).is_some());
    numbered(text).skip(first).filter(|(_, line)| !line.trim().is_empty())
}

/// Character that parts columns where the first line says so, as spreadsheets take it: `sep=;`.
pub(crate) fn stated_separator(text: &str) -> Option<char> {
    let (_, first) = numbered(text).next()?;
    let (name, mark) = first.trim_matches([' ', '"']).split_at_checked(4)?;
    [';', ',', '\t'].into_iter().find(|own| name.eq_ignore_ascii_case("sep=") && mark.chars().eq([*own]))
}

/// Kind of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Says what stands below: names, a unit, a pitch.
    Header,
    /// A row of the table.
    Row,
    /// Says nothing of the table.
    Comment,
}

/// The first line of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Start<'a> {
    pub(crate) line: usize,
    pub(crate) text: &'a str,
    /// Sign that it is one.
    pub(crate) sign: &'static str,
}

/// The first lines of the blocks of a text below its first block. Of its lines the blank ones are left out.
pub(crate) fn starts<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    kind: impl Fn(&str) -> Kind,
) -> impl Iterator<Item = Start<'a>> {
    let (mut has_rows, mut last, mut start) = (false, 0, None);
    lines.filter_map(move |(line, text)| {
        let kind = kind(text);
        let sign = match kind {
            _ if line > last + 1 => Some("below a blank line"),
            Kind::Header => Some("with a header"),
            Kind::Row | Kind::Comment => None,
        };
        last = line;
        if let Some(sign) = sign.filter(|_| has_rows && start.is_none()) {
            start = Some(Start { line, text, sign });
        }
        if kind != Kind::Row {
            return None;
        }
        has_rows = true;
        start.take()
    })
}

#[cfg(test)]
#[path = "../../tests/unit/delimited/dialect.rs"]
mod tests;
