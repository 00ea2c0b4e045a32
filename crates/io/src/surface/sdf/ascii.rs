//! ASCII SDF: lines "Name = Value", a line "*", heights, a line "*", trailer, a line "*".

use plateau_core::surface::Patch;

use super::error::{Position, SdfError};
use super::header::{DataType, Header, RawHeader};
use crate::surface::format::without_margin;

const MAGIC: &[u8] = b"aISO-1.0";

pub(super) fn read(content: &[u8]) -> Result<Patch, SdfError> {
    let mut lines = content.split(|byte| *byte == b'\n').enumerate().map(|(index, line)| (index + 1, line));
    let first = lines.by_ref().map(|(_, line)| without_margin(line).trim_ascii_end()).find(|line| !line.is_empty());
    if first != Some(MAGIC) {
        let found = first.unwrap_or_default();
        return Err(SdfError::Magic { found: found[..found.len().min(MAGIC.len() + 2)].escape_ascii().to_string() });
    }
    let header = read_header(&mut lines)?;
    // A height takes at least two bytes: compared before anything is allocated.
    if header.heights() > content.len() as u128 / 2 {
        return Err(SdfError::Truncated {
            found: content.len(),
            needed: 2 * header.heights(),
            what: format!("{} x {} heights", header.points, header.profiles),
        });
    }
    let profiles = read_heights(&mut lines, &header)?;
    Ok(super::patch(&header, &profiles))
}

fn is_end(line: &[u8]) -> bool {
    line.trim_ascii() == b"*"
}

fn read_header<'a>(lines: &mut impl Iterator<Item = (usize, &'a [u8])>) -> Result<Header, SdfError> {
    let mut fields: Vec<(String, String, Position)> = Vec::new();
    let mut last = 1;
    for (number, line) in lines {
        last = number;
        let at = Position::Line(number);
        if is_end(line) {
            return Fields { fields, end: at }.header();
        }
        let text = String::from_utf8_lossy(line.trim_ascii());
        if text.is_empty() {
            continue;
        }
        let Some((name, value)) = text.split_once('=') else {
            let found = text.chars().take(40).collect();
            return Err(SdfError::NotAField { at, found });
        };
        let name = name.trim();
        if fields.iter().any(|(known, ..)| known.eq_ignore_ascii_case(name)) {
            return Err(SdfError::Twice { at, field: name.to_owned() });
        }
        fields.push((name.to_owned(), value.trim().to_owned(), at));
    }
    Err(SdfError::Unclosed { record: "header", at: Position::Line(last) })
}

struct Fields {
    fields: Vec<(String, String, Position)>,
    end: Position,
}

impl Fields {
    fn header(&self) -> Result<Header, SdfError> {
        RawHeader {
            points: self.integer("NumPoints")?,
            profiles: self.integer("NumProfiles")?,
            x_scale: self.real("Xscale")?,
            y_scale: self.real("Yscale")?,
            z_scale: self.real("Zscale")?,
            compression: self.integer("Compression")?,
            data_type: self.integer("DataType")?,
            check_type: self.integer("CheckType")?,
        }
        .check()
    }

    fn integer(&self, field: &'static str) -> Result<(i64, Position), SdfError> {
        self.parse(field, "a whole number")
    }

    fn real(&self, field: &'static str) -> Result<(f64, Position), SdfError> {
        self.parse(field, "a positive, finite number")
    }

    fn parse<T: std::str::FromStr>(
        &self,
        field: &'static str,
        expected: &'static str,
    ) -> Result<(T, Position), SdfError> {
        let (_, value, at) = self
            .fields
            .iter()
            .find(|(name, ..)| name.eq_ignore_ascii_case(field))
            .ok_or(SdfError::MissingField { at: self.end, field })?;
        match value.parse() {
            Ok(number) => Ok((number, *at)),
            Err(_) => Err(SdfError::Field { at: *at, field, found: format!("\"{value}\""), expected }),
        }
    }
}

fn read_heights<'a>(
    lines: &mut impl Iterator<Item = (usize, &'a [u8])>,
    header: &Header,
) -> Result<Vec<f64>, SdfError> {
    let (points, profiles) = (header.points, header.profiles);
    let expected = points * profiles;
    let mut heights = Vec::with_capacity(expected);
    let mut last = 1;
    for (number, line) in lines {
        last = number;
        let at = Position::Line(number);
        if is_end(line) {
            if heights.len() < expected {
                return Err(SdfError::Count { at, found: heights.len(), points, profiles });
            }
            return Ok(heights);
        }
        for token in line.split(u8::is_ascii_whitespace).filter(|token| !token.is_empty()) {
            if heights.len() == expected {
                return Err(SdfError::TooMany { at, points, profiles });
            }
            let height = height(token, header).map_err(|expected| {
                let found = token[..token.len().min(40)].escape_ascii().to_string();
                SdfError::Height { at, found, expected }
            })?;
            heights.push(height);
        }
    }
    // Without the closing line the last number might be cut short.
    Err(SdfError::Unclosed { record: "data", at: Position::Line(last) })
}

/// One height, m, NaN for `BAD` (and for `NaN`, which some programs write); otherwise what was expected.
fn height(token: &[u8], header: &Header) -> Result<f64, &'static str> {
    if token.eq_ignore_ascii_case(b"BAD") || token.eq_ignore_ascii_case(b"NaN") {
        return Ok(f64::NAN);
    }
    let data_type: DataType = header.data_type;
    let wrong = data_type.name();
    let text = std::str::from_utf8(token).map_err(|_| wrong)?;
    let number = match data_type.integers() {
        Some((smallest, largest)) => {
            let integer: i64 = text.parse().map_err(|_| wrong)?;
            if !(smallest..=largest).contains(&integer) {
                return Err(wrong);
            }
            integer as f64
        }
        None => text.parse().map_err(|_| wrong)?,
    };
    let height = number * header.z_scale;
    if height.is_finite() { Ok(height) } else { Err("a finite number times Zscale, or BAD") }
}
