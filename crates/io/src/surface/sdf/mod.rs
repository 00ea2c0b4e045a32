//! Surface data files, SDF: ISO-1.0 and ISO-2.0 (ISO 25178-71) and their predecessor BCR-1.0, ASCII and binary.
//!
//! A file has three records: header, data, and a trailer of free text, which is not read. The data are `NumProfiles`
//! profiles, y growing with their number (falling in BCR-1.0), of `NumPoints` points, x growing; a height is the stored
//! number times `Zscale`, in m. A point that was not measured is `BAD` in ASCII and the smallest number of the data
//! type in binary; in BCR-1.0 it is the largest number of the data type in both.
//!
//! ASCII: lines "Name = Value", a line "*", heights, a line "*", trailer, a line "*"; BCR-1.0 besides has comments, from ";"
//! to the end of a line, and words for the codes of some fields. Binary: 81 bytes of header (85 in ISO-2.0), little endian, then the data.

mod header;

use std::io::{self, BufRead, ErrorKind, Read, Write};

use header::Header;
use plateau_core::surface::Patch;

pub(super) use header::without_margin;
pub use header::{Dialect, Encoding, Position, SdfError, SdfKind, Surface};

/// Reads an SDF file of `length` bytes, from its start. Memory beyond the heights is a few profiles.
pub fn read(mut source: impl BufRead, length: u64) -> Result<Surface, SdfError> {
    match source.fill_buf()?.first() {
        Some(b'b' | b'B') => binary(source, length),
        _ => ascii(source, length),
    }
}

/// Heights of an ASCII file in one line.
const PER_LINE: usize = 8;

/// Writes heights as binary64 numbers with the scale 1, so that none is rounded: binary, ISO-1.0, or ISO-2.0 where a side has more
/// points than two bytes count; where points are missing ISO-1.0 ASCII, for every program knows the word for them, while some take
/// their mark in binary64 for a height (SurfaceTopography 1.27.1 does). `date` is `DDMMYYYYhhmm`.
pub(super) fn write(mut out: impl Write, patch: &Patch, date: &str) -> io::Result<()> {
    let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
    let profiles = (0..rows).map(|row| heights[row..].iter().step_by(rows));
    // The mark of a missing point is no height of a binary file.
    if heights.iter().any(|height| height.is_nan() || *height == f64::MIN) {
        write!(
            out,
            "aISO-1.0\r\nManufacID = Plateau\r\nCreateDate = {date}\r\nModDate = {date}\r\nNumPoints = {columns}\r\n\
             NumProfiles = {rows}\r\nXscale = {column_pitch:e}\r\nYscale = {row_pitch:e}\r\nZscale = 1\r\n\
             Zresolution = -1\r\nCompression = 0\r\nDataType = 7\r\nCheckType = 0\r\n*\r\n"
        )?;
        // `e` gives as many digits as the number needs to be read back exactly.
        let word = |height: &f64| if height.is_nan() { "BAD".to_owned() } else { format!("{height:e}") };
        for profile in profiles {
            for line in profile.map(word).collect::<Vec<_>>().chunks(PER_LINE) {
                write!(out, "{}\r\n", line.join(" "))?;
            }
        }
        return out.write_all(b"*\r\n*\r\n");
    }
    let (magic, size) = if columns.max(rows) > u16::MAX.into() { ("bISO-2.0", 4) } else { ("bISO-1.0", 2) };
    write!(out, "{magic}{:10}{date:12}{date:12}", "Plateau")?;
    for count in [columns, rows] {
        out.write_all(&(count as u64).to_le_bytes()[..size])?;
    }
    // Zscale, and a negative Zresolution: not known.
    for real in [column_pitch, row_pitch, 1.0, -1.0] {
        out.write_all(&real.to_le_bytes())?;
    }
    // Compression, DataType, CheckType.
    out.write_all(&[0, 7, 0])?;
    profiles.flatten().try_for_each(|height| out.write_all(&height.to_le_bytes()))
}

/// Longest line and longest word that are kept, in bytes; what is longer is cut off and then is no field or number.
const LONGEST: usize = 1000;

/// Lines and words of a text. A line ends with a line feed, a carriage return or both.
pub(super) struct Lexer<R> {
    source: R,
    line: usize,
    /// Byte behind which the rest of a line is skipped.
    pub(super) comment: Option<u8>,
    text: Vec<u8>,
}

impl<R: BufRead> Lexer<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, line: 1, comment: None, text: Vec::new() }
    }

    /// Number of the line that is being read, from 1.
    pub(super) fn number(&self) -> usize {
        self.line
    }

    /// The next line, with its number, without comment and without blanks around it; nothing at the end.
    pub(super) fn line(&mut self) -> io::Result<Option<(usize, &[u8])>> {
        self.text.clear();
        let number = self.line;
        let Some(mut byte) = self.next()? else { return Ok(None) };
        let mut comment = false;
        while !self.ends_line(byte)? {
            comment |= Some(byte) == self.comment;
            if !comment {
                self.keep(byte);
            }
            let Some(next) = self.next()? else { break };
            byte = next;
        }
        Ok(Some((number, self.text.trim_ascii())))
    }

    /// The next word, with the number of its line; nothing at the end.
    pub(super) fn word(&mut self) -> io::Result<Option<(usize, &[u8])>> {
        self.text.clear();
        let (mut number, mut comment) = (self.line, false);
        while let Some(byte) = self.next()? {
            let ends_line = self.ends_line(byte)?;
            comment = !ends_line && (comment || Some(byte) == self.comment);
            if !comment && !byte.is_ascii_whitespace() {
                self.keep(byte);
            } else if !self.text.is_empty() {
                break;
            } else {
                number = self.line;
            }
        }
        Ok((!self.text.is_empty()).then_some((number, &self.text)))
    }

    fn keep(&mut self, byte: u8) {
        if self.text.len() < LONGEST {
            self.text.push(byte);
        }
    }

    fn next(&mut self) -> io::Result<Option<u8>> {
        let byte = self.source.fill_buf()?.first().copied();
        self.source.consume(usize::from(byte.is_some()));
        Ok(byte)
    }

    fn ends_line(&mut self, byte: u8) -> io::Result<bool> {
        if byte == b'\r' && self.source.fill_buf()?.first() == Some(&b'\n') {
            self.source.consume(1);
        }
        let ends = matches!(byte, b'\r' | b'\n');
        self.line += usize::from(ends);
        Ok(ends)
    }
}

/// Most fields of a header; the standard has 12.
const MOST_FIELDS: usize = 100;

fn ascii(source: impl BufRead, length: u64) -> Result<Surface, SdfError> {
    let mut text = Lexer::new(source);
    let dialect = read_magic(&mut text)?;
    text.comment = (dialect == Dialect::Bcr1).then_some(b';');
    let header = read_fields(&mut text, dialect)?.header()?;
    // A height takes at least two bytes: compared before anything is allocated.
    if header.heights() > u128::from(length) / 2 {
        let what = format!("{} x {} heights", header.points, header.profiles);
        return Err(SdfError::Truncated { found: length, needed: 2 * header.heights(), what });
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
    SdfError::field(field, format!("\"{}\"", short(value.as_bytes())), at, expected)
}

fn short(text: &[u8]) -> String {
    text[..text.len().min(40)].escape_ascii().to_string()
}

struct Fields {
    dialect: Dialect,
    fields: Vec<(String, String, Position)>,
    end: Position,
}

/// Words of BCR-1.0 for types of numbers.
const WORDS: [(&str, i64); 8] = [
    ("uchar", 0),
    ("uinteger", 1),
    ("ulongint", 2),
    ("float", 3),
    ("char", 4),
    ("integer", 5),
    ("longint", 6),
    ("double", 7),
];

impl Fields {
    fn header(&self) -> Result<Header, SdfError> {
        let counts = [self.integer("NumPoints", &[])?, self.integer("NumProfiles", &[])?];
        let scales = [self.real("Xscale")?, self.real("Yscale")?, self.real("Zscale")?];
        let codes = [
            self.integer("Compression", &[("null", 0), ("none", 0), ("rll", 1)])?,
            self.integer("DataType", &WORDS)?,
            self.integer("CheckType", &[("null", 0), ("none", 0), ("uinttrace", 1)])?,
        ];
        Header::checked(self.dialect, counts, scales, codes)
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
                0 => Ok(heights.patch),
                _ => Err(SdfError::Count { at, found: heights.len(), points, profiles }),
            };
        }
        if heights.missing() == 0 {
            return Err(SdfError::TooMany { at, points, profiles });
        }
        let wrong = |expected| SdfError::Height { at, found: short(word), expected };
        let stored = header.data_type.parse(word, header.dialect).ok_or_else(|| wrong(header.data_type.name))?;
        let height = stored * header.z_scale;
        if height.is_infinite() {
            return Err(wrong("a finite number times Zscale, or BAD"));
        }
        heights.push(height);
    }
    // Without the closing line the last number might be cut short.
    Err(SdfError::Unclosed { record: "data", at: Position::Line(text.number()) })
}

/// Bytes before the counts: magic 8, ManufacID 10, CreateDate 12, ModDate 12.
const COUNTS: usize = 42;
/// Bytes after the counts: Xscale, Yscale, Zscale, Zresolution 8 each, Compression, DataType, CheckType 1 each.
const AFTER_COUNTS: usize = 35;
/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;
/// Bytes of a trailer that are looked at.
const TRAILER: u64 = 4096;

fn binary(mut source: impl BufRead, length: u64) -> Result<Surface, SdfError> {
    let start = take(&mut source, COUNTS)?;
    let Some(SdfKind { dialect, encoding: Encoding::Binary }) = SdfKind::from_magic(&start) else {
        return Err(SdfError::Magic { found: start[..start.len().min(8)].escape_ascii().to_string() });
    };
    let truncated = |needed, what| SdfError::Truncated { found: length, needed, what };
    let count_size = if dialect == Dialect::Iso2 { 4 } else { 2 };
    let rest = take(&mut source, 2 * count_size + AFTER_COUNTS)?;
    let header_size = COUNTS + 2 * count_size + AFTER_COUNTS;
    if start.len() + rest.len() < header_size {
        return Err(truncated(header_size as u128, "the header".to_owned()));
    }
    let header = binary_header(&rest, count_size, dialect)?;
    let number = header.data_type.number;
    let (size, marks_missing) = (number.size, header.data_type.marks(dialect));
    // Compared before anything is allocated: a header can promise more than any file holds.
    let needed = header_size as u128 + header.heights() * size as u128;
    let what = || format!("{} x {} heights of {size} bytes", header.points, header.profiles);
    if needed > u128::from(length) {
        return Err(truncated(needed, what()));
    }

    let mut heights = header.room();
    let mut buffer = vec![0; CHUNK];
    while heights.missing() > 0 {
        let offset = header_size + heights.len() * size;
        let chunk = &mut buffer[..CHUNK.min(heights.missing() * size)];
        source.read_exact(chunk).map_err(|error| match error.kind() {
            // The file has become shorter meanwhile.
            ErrorKind::UnexpectedEof => truncated(needed, what()),
            _ => error.into(),
        })?;
        for (index, bytes) in chunk.chunks_exact(size).enumerate() {
            let stored = number.read(bytes);
            let height = if marks_missing(stored) { f64::NAN } else { stored * header.z_scale };
            if height.is_infinite() {
                let (at, found) = (Position::Byte(offset + index * size), height.to_string());
                return Err(SdfError::Height { at, found, expected: "a finite number times Zscale" });
            }
            heights.push(height);
        }
    }
    let mut trailer = Vec::new();
    source.take(TRAILER).read_to_end(&mut trailer)?;
    let warnings = trailer_warning(&trailer, needed, length).into_iter().collect();
    Ok(Surface { patch: heights.patch, warnings })
}

/// Reads `count` bytes, fewer only at the end of the file.
fn take(source: &mut impl Read, count: usize) -> Result<Vec<u8>, SdfError> {
    let mut bytes = Vec::with_capacity(count);
    source.take(count as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn binary_header(bytes: &[u8], count_size: usize, dialect: Dialect) -> Result<Header, SdfError> {
    let at = |offset: usize| Position::Byte(COUNTS + offset);
    let array = |offset: usize, size: usize| {
        let mut raw = [0; 8];
        raw[..size].copy_from_slice(&bytes[offset..offset + size]);
        raw
    };
    let count = |offset: usize| (i64::from_le_bytes(array(offset, count_size)), at(offset));
    let scales = 2 * count_size;
    let real = |index: usize| (f64::from_le_bytes(array(scales + 8 * index, 8)), at(scales + 8 * index));
    let code = |index: usize| (i64::from(bytes[scales + 32 + index]), at(scales + 32 + index));
    Header::checked(dialect, [count(0), count(count_size)], [0, 1, 2].map(real), [0, 1, 2].map(code))
}

/// A trailer is text, filled up with zeros by some programs: bytes of another kind hint at a header that does not fit
/// the data.
fn trailer_warning(trailer: &[u8], start: u128, length: u64) -> Option<String> {
    let odd = trailer.iter().position(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace() && *byte != 0)?;
    let after = u128::from(length).saturating_sub(start);
    Some(format!(
        "the {after} bytes after the heights are not text (byte {}): do NumPoints, NumProfiles and DataType fit the data?",
        start + odd as u128
    ))
}
