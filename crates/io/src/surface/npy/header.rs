//! The header of an .npy file: a Python dictionary with type, order and shape.
//!
//! Format: numpy.lib.format, versions 1.0 to 3.0.

use std::io;

use super::error::NpyError;
use crate::surface::options::MOST_POINTS;

const MAGIC: &[u8] = b"\x93NUMPY";

/// NumPy itself refuses longer headers.
const LONGEST: usize = 10_000;

/// Bytes from which a header can be read, if the file is that long.
pub(in crate::surface) const HEAD: usize = MAGIC.len() + 2 + 4 + LONGEST;

/// What a header says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    /// Type as NumPy writes it, for instance `<f8`.
    pub(super) descr: String,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<u64>,
    /// Where the data start.
    pub(super) data: usize,
}

impl Header {
    /// Reads the start of a file.
    pub(super) fn read(content: &[u8]) -> Result<Self, NpyError> {
        let wrong = |found: &[u8], expected| {
            let found = format!("\"{}\"", found[..found.len().min(60)].escape_ascii());
            Err(NpyError::Header { found, expected })
        };
        let Some(rest) = content.strip_prefix(MAGIC) else { return wrong(content, "\"\\x93NUMPY\"") };
        let (length, start) = match *rest {
            [1, 0, a, b, ..] => (usize::from(u16::from_le_bytes([a, b])), 4),
            [2 | 3, 0, a, b, c, d, ..] => (u32::from_le_bytes([a, b, c, d]) as usize, 6),
            [1..=3, 0, ..] => return wrong(rest, "the length of the header"),
            _ => return wrong(&rest[..rest.len().min(2)], "version 1.0, 2.0 or 3.0"),
        };
        if length > LONGEST {
            return wrong(&rest[..start], "a header of at most 10000 bytes");
        }
        let Some(text) = rest.get(start..start + length) else { return wrong(rest, "a header as long as it says") };
        let text = String::from_utf8_lossy(text);
        let mut header = Dictionary { rest: text.trim() }.read()?;
        header.data = MAGIC.len() + start + length;
        Ok(header)
    }

    /// Columns and rows, and how many points they are.
    pub(super) fn grid(&self) -> Result<(usize, usize, usize), NpyError> {
        let [columns, rows] = self.shape[..] else { return Err(NpyError::Shape { found: self.shown_shape() }) };
        if columns == 0 || rows == 0 {
            return Err(NpyError::Shape { found: self.shown_shape() });
        }
        let points = columns.checked_mul(rows).and_then(|points| usize::try_from(points).ok());
        match points.filter(|points| *points <= MOST_POINTS) {
            Some(points) => Ok((columns as usize, rows as usize, points)),
            None => Err(NpyError::TooLarge { shape: (columns, rows), most: MOST_POINTS }),
        }
    }

    pub(super) fn shown_shape(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(u64::to_string).collect();
        format!("({})", sizes.join(", "))
    }
}

/// The literal of a dictionary, read from the front.
struct Dictionary<'a> {
    rest: &'a str,
}

impl<'a> Dictionary<'a> {
    fn read(mut self) -> Result<Header, NpyError> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.expect('{')?;
        while !self.take('}') {
            let key = self.quoted()?;
            self.expect(':')?;
            match key {
                "descr" => descr = Some(self.descr()?),
                "fortran_order" => fortran_order = Some(self.boolean()?),
                "shape" => shape = Some(self.shape()?),
                _ => return self.wrong("the keys descr, fortran_order and shape"),
            }
            if !self.take(',') {
                self.expect('}')?;
                break;
            }
        }
        match (descr, fortran_order, shape) {
            (Some(descr), Some(fortran_order), Some(shape)) => Ok(Header { descr, fortran_order, shape, data: 0 }),
            _ => self.wrong("the keys descr, fortran_order and shape"),
        }
    }

    fn wrong<T>(&self, expected: &'static str) -> Result<T, NpyError> {
        let found: String = self.rest.chars().take(40).flat_map(char::escape_debug).collect();
        Err(NpyError::Header { found: format!("\"{found}\""), expected })
    }

    fn take(&mut self, mark: char) -> bool {
        self.rest = self.rest.trim_start();
        let rest = self.rest.strip_prefix(mark);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn expect(&mut self, mark: char) -> Result<(), NpyError> {
        if self.take(mark) {
            Ok(())
        } else {
            self.wrong("a dictionary {'descr': ..., 'fortran_order': ..., 'shape': ...}")
        }
    }

    fn quoted(&mut self) -> Result<&'a str, NpyError> {
        for quote in ['\'', '"'] {
            if self.take(quote) {
                let Some((text, rest)) = self.rest.split_once(quote) else { return self.wrong("a string that ends") };
                self.rest = rest;
                return Ok(text);
            }
        }
        self.wrong("a string in quotes")
    }

    /// A type; a list of named fields is one too, but holds no heights.
    fn descr(&mut self) -> Result<String, NpyError> {
        match self.quoted() {
            Err(_) if self.rest.starts_with('[') => Err(NpyError::Type { found: "record".to_owned() }),
            other => other.map(str::to_owned),
        }
    }

    fn boolean(&mut self) -> Result<bool, NpyError> {
        self.rest = self.rest.trim_start();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.rest.strip_prefix(word) {
                self.rest = rest;
                return Ok(value);
            }
        }
        self.wrong("True or False")
    }

    fn shape(&mut self) -> Result<Vec<u64>, NpyError> {
        self.expect('(')?;
        let mut shape = Vec::new();
        while !self.take(')') {
            self.rest = self.rest.trim_start();
            let digits = self.rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest.len());
            let (number, rest) = self.rest.split_at(digits);
            let Ok(number) = number.parse() else { return self.wrong("a size of 64 bits") };
            shape.push(number);
            // Python 2 marked long integers.
            self.rest = rest.strip_prefix('L').unwrap_or(rest);
            if !self.take(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(shape)
    }
}

/// Bytes before the dictionary: mark, version and length.
const PREFIX: usize = 10;

/// The bytes before the data of an array of that type, as NumPy writes it, and shape; the last index runs fastest.
///
/// # Errors
/// When the array has so many dimensions that their sizes find no room.
pub(super) fn preamble(descr: &str, shape: &[usize]) -> io::Result<Vec<u8>> {
    // A tuple of one has a comma after it.
    let sizes: String = shape.iter().map(|size| format!("{size}, ")).collect();
    let dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", sizes.trim_end());
    // The data start at a multiple of 64 bytes; the header ends with a line feed.
    let padded = (PREFIX + dictionary.len() + 1).next_multiple_of(64) - PREFIX - 1;
    let dictionary = format!("{dictionary:padded$}\n");
    let length = u16::try_from(dictionary.len()).map_err(io::Error::other)?;
    Ok([b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], dictionary.as_bytes()].concat())
}

#[cfg(test)]
mod tests {
    use super::{Header, preamble};

    #[test]
    fn any_number_of_dimensions_is_read_back() {
        for shape in [&[][..], &[7], &[3, 5], &[2, 3, 5]] {
            let bytes = preamble("<f8", shape).unwrap();
            let header = Header::read(&bytes).unwrap();
            let expected: Vec<u64> = shape.iter().map(|size| *size as u64).collect();
            assert_eq!((header.descr.as_str(), header.fortran_order, header.shape), ("<f8", false, expected));
            assert_eq!((header.data, bytes.len() % 64), (bytes.len(), 0));
        }
    }
}
