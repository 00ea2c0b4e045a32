//! ASCII SDF: lines "Name = Value", a line "*", heights, a line "*", trailer, a line "*".
//!
//! BCR-1.0 besides has comments, from ";" to the end of a line, and words for the codes of some fields.

use std::io::BufRead;

use plateau_core::surface::Patch;

use super::error::{Position, SdfError};
use super::header::{Header, RawHeader, Surface};
use super::kind::{Dialect, Encoding, SdfKind, without_margin};
use super::lexer::Lexer;

/// Most fields of a header; the standard has 12.
const MOST_FIELDS: usize = 100;

pub(super) fn read(source: impl BufRead, length: u64) -> Result<Surface, SdfError> {
    let mut text = Lexer::new(source);
    let dialect = read_magic(&mut text)?;
    text.comment = (dialect == Dialect::Bcr1).then_some(b';');
    let header = read_fields(&mut text, dialect)?.header()?;
    // A height takes at least two bytes: compared before anything is allocated.
    if header.heights() > u128::from(length) / 2 {
        return Err(SdfError::Truncated {
            found: length,
            needed: 2 * header.heights(),
            what: format!("{} x {} heights", header.points, header.profiles),
        });
    }
    let patch = read_heights(&mut text, &header)?;
    Ok(Surface { patch, warnings: Vec::new() })
}

fn read_magic(text: &mut Lexer<impl BufRead>) -> Result<Dialect, SdfError> {
    while let Some((_, line)) = text.line()? {
        let line = without_margin(line);
        if !line.is_empty() {
            return dialect(line);
        }
    }
    Err(SdfError::Magic { found: String::new() })
}

/// The dialect that the first line names.
fn dialect(line: &[u8]) -> Result<Dialect, SdfError> {
    if let Some(SdfKind { dialect, encoding: Encoding::Ascii }) = SdfKind::from_magic(line) {
        let rest = line[8..].trim_ascii();
        if rest.is_empty() || (dialect == Dialect::Bcr1 && rest.starts_with(b";")) {
            return Ok(dialect);
        }
    }
    Err(SdfError::Magic { found: line[..line.len().min(10)].escape_ascii().to_string() })
}

fn read_fields(text: &mut Lexer<impl BufRead>, dialect: Dialect) -> Result<Fields, SdfError> {
    let mut fields: Vec<(String, String, Position)> = Vec::new();
    while let Some((number, line)) = text.line()? {
        let at = Position::Line(number);
        if line == b"*" {
            return Ok(Fields { dialect, fields, end: at });
        }
        let line = String::from_utf8_lossy(line);
        if line.is_empty() {
            continue;
        }
        let (Some((name, value)), true) = (line.split_once('='), fields.len() < MOST_FIELDS) else {
            return Err(SdfError::NotAField { at, found: short(line.as_bytes()) });
        };
        let name = name.trim();
        if fields.iter().any(|(known, ..)| known.eq_ignore_ascii_case(name)) {
            return Err(SdfError::Twice { at, field: short(name.as_bytes()) });
        }
        fields.push((name.to_owned(), value.trim().to_owned(), at));
    }
    Err(SdfError::Unclosed { record: "header", at: Position::Line(text.number()) })
}

fn not(field: &'static str, value: &str, at: Position, expected: &'static str) -> SdfError {
    SdfError::Field { at, field, found: format!("\"{}\"", short(value.as_bytes())), expected }
}

/// What is shown of a text.
fn short(text: &[u8]) -> String {
    text[..text.len().min(40)].escape_ascii().to_string()
}

struct Fields {
    dialect: Dialect,
    fields: Vec<(String, String, Position)>,
    end: Position,
}

impl Fields {
    fn header(&self) -> Result<Header, SdfError> {
        RawHeader {
            points: self.integer("NumPoints", &[])?,
            profiles: self.integer("NumProfiles", &[])?,
            x_scale: self.real("Xscale")?,
            y_scale: self.real("Yscale")?,
            z_scale: self.real("Zscale")?,
            compression: self.integer("Compression", &[("null", 0), ("none", 0), ("rll", 1)])?,
            data_type: self.integer(
                "DataType",
                &[
                    ("uchar", 0),
                    ("uinteger", 1),
                    ("ulongint", 2),
                    ("float", 3),
                    ("char", 4),
                    ("integer", 5),
                    ("longint", 6),
                    ("double", 7),
                ],
            )?,
            check_type: self.integer("CheckType", &[("null", 0), ("none", 0), ("uinttrace", 1)])?,
        }
        .check(self.dialect)
    }

    /// A whole number, for which BCR-1.0 may have one of the words.
    fn integer(&self, field: &'static str, words: &[(&str, i64)]) -> Result<(i64, Position), SdfError> {
        let (value, at) = self.field(field)?;
        let word = words.iter().find(|(word, _)| self.dialect == Dialect::Bcr1 && word.eq_ignore_ascii_case(value));
        let number = word.map(|(_, number)| *number).or_else(|| value.parse().ok());
        number.map(|number| (number, at)).ok_or_else(|| not(field, value, at, "a whole number"))
    }

    fn real(&self, field: &'static str) -> Result<(f64, Position), SdfError> {
        let (value, at) = self.field(field)?;
        value.parse().map(|number| (number, at)).map_err(|_| not(field, value, at, "a positive, finite number"))
    }

    fn field(&self, field: &'static str) -> Result<(&str, Position), SdfError> {
        let found = self.fields.iter().find(|(name, ..)| name.eq_ignore_ascii_case(field));
        found.map(|(_, value, at)| (value.as_str(), *at)).ok_or(SdfError::MissingField { at: self.end, field })
    }
}

fn read_heights(text: &mut Lexer<impl BufRead>, header: &Header) -> Result<Patch, SdfError> {
    let (points, profiles) = (header.points, header.profiles);
    let mut heights = header.room();
    while let Some((number, word)) = text.word()? {
        let at = Position::Line(number);
        if word == b"*" {
            return match heights.missing() {
                0 => Ok(header.patch(heights)),
                _ => Err(SdfError::Count { at, found: heights.len(), points, profiles }),
            };
        }
        if heights.missing() == 0 {
            return Err(SdfError::TooMany { at, points, profiles });
        }
        let wrong = |expected| SdfError::Height { at, found: short(word), expected };
        let stored = header.data_type.parse(word, header.dialect).ok_or_else(|| wrong(header.data_type.name()))?;
        let height = stored * header.z_scale;
        if height.is_infinite() {
            return Err(wrong("a finite number times Zscale, or BAD"));
        }
        heights.push(height);
    }
    // Without the closing line the last number might be cut short.
    Err(SdfError::Unclosed { record: "data", at: Position::Line(text.number()) })
}
