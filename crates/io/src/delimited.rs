//! Text of numbers that others have written: surfaces, cycles, designs, values that were measured. All of it is read by one rule: the text
//! of a file is decoded, workbooks and archives are refused; its lines are numbered; its dialect is told, which is the separator of cells,
//! the decimal mark, and the beginning of another table, below a blank line or with a line of a header where rows stand above and below.
//!
//! A table whose first line names its columns is CSV as programs and spreadsheets write it. Where a spreadsheet writes commas in numbers,
//! it parts columns by semicolons: such a table, and one with tabs, is read too. Lines that begin with # are passed over.

use std::borrow::Cow;
use std::io::{self, Cursor, ErrorKind};
use std::path::Path;

use zip::ZipArchive;

use crate::input;
use crate::text::short;

/// The bytes 0x80 to 0x9f of Windows-1252; the others are those of Latin-1 (WHATWG Encoding Standard, index windows-1252).
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘', '’',
    '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Tells whether a text has two bytes a character: by its byte order mark, or by its first two characters, which are of ASCII.
pub(crate) fn is_utf16(content: &[u8]) -> bool {
    utf16(content).is_some()
}

/// The unit of UTF-16 that two bytes make.
type Unit = fn([u8; 2]) -> u16;

/// Way in which two bytes make a unit, and where the first one stands; none if the text has one byte a character.
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

/// The text of a table: of a regular file of at most so many bytes.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<String> {
    let content = input::read(path, most)?;
    let refuse = |what: &str| Err(io::Error::new(ErrorKind::InvalidData, format!("this is {what}")));
    if content.starts_with(b"PK\x03\x04") {
        let archive = ZipArchive::new(Cursor::new(&content));
        return refuse(&match archive.ok().and_then(|archive| workbook(archive.file_names_raw())) {
            Some(book) => format!("{book}, expected text: save its sheet as CSV"),
            None => "a zip archive, expected text: unpack it, and name the file in it".to_owned(),
        });
    }
    if content.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") {
        return refuse("a workbook (.xls) or another document, expected text: save its sheet as CSV");
    }
    let text = decode(&content);
    if text.contains('\0') {
        return refuse("no text, expected a table in CSV");
    }
    Ok(text.into_owned())
}

/// Kind of a workbook, by the names of the entries of a zip archive; none of another archive.
pub(crate) fn workbook<'a>(names: impl Iterator<Item = &'a [u8]>) -> Option<&'static str> {
    // The folder of the sheets in Office Open XML, and what every document of OpenDocument has.
    names.into_iter().find_map(|name| match name {
        b"content.xml" => Some("a workbook (.ods)"),
        name => name.starts_with(b"xl/").then_some("a workbook (.xlsx)"),
    })
}

/// Mark between a whole number and its fraction.
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
fn unquoted(cell: &str) -> Option<Cow<'_, str>> {
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
    Row,
    /// Says nothing of the table.
    Comment,
}

/// The first line of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Start<'a> {
    pub(crate) line: usize,
    pub(crate) text: &'a str,
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

pub(crate) struct Named<'a> {
    separator: char,
    /// True if a separator ends every line.
    terminated: bool,
    /// The names of the columns.
    pub(crate) head: Line<'a>,
    rows: Vec<(usize, &'a str)>,
}

pub(crate) struct Line<'a> {
    /// Number of the line in the file, from 1.
    pub(crate) number: usize,
    text: &'a str,
    pub(crate) cells: Vec<Cell<'a>>,
}

pub(crate) struct Cell<'a> {
    /// Text of the cell, without quotation marks; numbers with a decimal point.
    pub(crate) text: Cow<'a, str>,
    /// The byte of the line at which it begins.
    at: usize,
}

/// Problem with a table; line and column of the text count from 1.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) line: usize,
    pub(crate) column: usize,
    pub(crate) message: String,
}

impl<'a> Named<'a> {
    /// The table of a text; none of one without a line.
    pub(crate) fn of(text: &'a str) -> Result<Option<Self>, Fault> {
        let is_comment = |line: &str| line.trim_start().starts_with('#');
        let mut lines = lines(text).skip_while(|(_, line)| is_comment(line));
        let Some((number, names)) = lines.next() else { return Ok(None) };
        let kind = |line: &str| match () {
            () if is_comment(line) => Kind::Comment,
            () if line.trim() == names.trim() => Kind::Header,
            () => Kind::Row,
        };
        if let Some(start) = starts(lines.clone(), kind).next() {
            let message = format!(
                "another table begins here, {}: a table has one line of names and no blank lines between its rows; take these out, or put \
                 what stands below into a file of its own",
                start.sign
            );
            return Err(Fault { line: start.line, column: 1, message });
        }
        let rows: Vec<_> = lines.filter(|(_, line)| kind(line) == Kind::Row).collect();
        let separator = stated_separator(text).unwrap_or_else(|| separator(names));
        let ends = |line: &str| Separator::Character(separator).ends(line);
        let terminated = ends(names) && rows.iter().all(|(_, line)| ends(line));
        let head = line(number, names, separator, terminated)?;
        Ok(Some(Self { separator, terminated, head, rows }))
    }

    /// The lines below the names, each with as many cells as it has.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Result<Line<'a>, Fault>> {
        // The first number with a decimal mark.
        let mut first: Option<(Decimal, String)> = None;
        self.rows.iter().map(move |(number, text)| {
            let mut line = line(*number, text, self.separator, self.terminated)?;
            for place in 0..if self.separator == ',' { 0 } else { line.cells.len() } {
                let cell = &line.cells[place].text;
                let Some(mark) = Decimal::of(cell) else { continue };
                let column = line.column(place);
                let (expected, there) = first
                    .get_or_insert_with(|| (mark, format!("\"{}\" in line {number}, column {column}", short(cell))));
                if mark != *expected {
                    let message = format!(
                        "\"{}\" and {there}: a decimal point and a decimal comma in one table; save it with one of them, and without \
                         thousands separators",
                        short(cell)
                    );
                    return Err(line.fault(place, message));
                }
                if mark == Decimal::Comma {
                    line.cells[place].text = Cow::Owned(cell.replacen(',', ".", 1));
                }
            }
            Ok(line)
        })
    }
}

impl Line<'_> {
    /// Problem with a cell, or at the end of the line where there is no such cell.
    pub(crate) fn fault(&self, place: usize, message: String) -> Fault {
        Fault { line: self.number, column: self.column(place), message }
    }

    /// The column of the text at which a cell begins, or that of the end of the line.
    fn column(&self, place: usize) -> usize {
        let at = self.cells.get(place).map_or(self.text.len(), |cell| cell.at);
        self.text[..at].chars().count() + 1
    }
}

/// The cells of a line.
fn line(number: usize, text: &str, separator: char, terminated: bool) -> Result<Line<'_>, Fault> {
    let mut line = Line { number, text, cells: Vec::new() };
    for part in Separator::Character(separator).parts(text, terminated) {
        let at = part.as_ptr().addr() - text.as_ptr().addr();
        let closed = unquoted(part);
        line.cells.push(Cell { at, text: closed.clone().unwrap_or_default() });
        if closed.is_none() {
            let message =
                "a quotation mark opens this cell, and none closes it in its line; take it out, or the line break";
            return Err(line.fault(line.cells.len() - 1, message.to_owned()));
        }
    }
    Ok(line)
}

/// Character that parts the columns of these names: semicolons only where there are more of them than commas, for names may have one.
fn separator(names: &str) -> char {
    let count = |mark: char| names.matches(mark).count();
    match (count('\t'), count(';') > count(',')) {
        (1.., _) => '\t',
        (0, true) => ';',
        (0, false) => ',',
    }
}

#[cfg(test)]
#[path = "../tests/unit/delimited.rs"]
mod tests;
