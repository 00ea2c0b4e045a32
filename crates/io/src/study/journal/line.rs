//! A record as a line of a shard: its checksum (CRC-32) and JSON.

use std::io::{self, BufRead, Read as _};

use super::super::record::Record;
use crate::limits;

/// The line of a record, with its end.
pub(super) fn line(record: &Record) -> io::Result<Vec<u8>> {
    let json = serde_json::to_vec(record)?;
    let mut line = format!("{:08x} ", crc32fast::hash(&json)).into_bytes();
    line.extend_from_slice(&json);
    line.push(b'\n');
    if line.len() as u64 > limits::RECORD {
        let message = limits::more(line.len(), limits::RECORD, "bytes for the series of a run");
        return Err(io::Error::other(message + ": sample less often, or keep fewer series"));
    }
    Ok(line)
}

/// What a line says; none if it is torn or damaged.
pub(super) fn parse(line: &[u8]) -> Option<Record> {
    let (sum, json) = line.strip_suffix(b"\n")?.split_at_checked(9)?;
    let sum = std::str::from_utf8(sum).ok()?.strip_suffix(' ')?;
    let intact = u32::from_str_radix(sum, 16).ok()? == crc32fast::hash(json);
    serde_json::from_slice(json).ok().filter(|_| intact)
}

/// Whether a line without end may be the beginning of a record: as much of a checksum, a blank and a brace as is there.
pub(super) fn is_torn(line: &[u8]) -> bool {
    line.iter().take(10).enumerate().all(|(at, byte)| match at {
        0..8 => byte.is_ascii_hexdigit(),
        8 => *byte == b' ',
        _ => *byte == b'{',
    })
}

/// Reads a line with its end; how many bytes it has in the file. One that has more than `most` bytes is left empty.
pub(super) fn next_line(reader: &mut impl BufRead, line: &mut Vec<u8>, most: u64) -> io::Result<usize> {
    line.clear();
    let length = reader.by_ref().take(most).read_until(b'\n', line)?;
    if (length as u64) < most || line.ends_with(b"\n") {
        return Ok(length);
    }
    *line = Vec::new();
    Ok(length + reader.skip_until(b'\n')?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_end_takes_no_memory() {
        let mut text = "ab\ncdefghij\nkl\nmnop".as_bytes();
        let (mut line, mut lines) = (Vec::new(), Vec::new());
        loop {
            match next_line(&mut text, &mut line, 4).unwrap() {
                0 => break,
                length => lines.push((length, String::from_utf8(line.clone()).unwrap())),
            }
        }
        let expected = [(3, "ab\n"), (9, ""), (3, "kl\n"), (4, "")];
        assert_eq!(lines, expected.map(|(length, text)| (length, text.to_owned())));
    }
}
