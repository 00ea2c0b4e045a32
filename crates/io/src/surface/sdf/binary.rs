//! Binary SDF: 81 bytes of header (85 in ISO-2.0), little endian, then the data.

use std::io::{BufRead, ErrorKind, Read};

use super::error::{Position, SdfError};
use super::header::{Header, RawHeader, Surface};
use super::kind::{Dialect, Encoding, SdfKind};

/// Bytes before the counts: magic 8, ManufacID 10, CreateDate 12, ModDate 12.
const COUNTS: usize = 42;
/// Bytes after the counts: Xscale, Yscale, Zscale, Zresolution 8 each, Compression, DataType, CheckType 1 each.
const AFTER_COUNTS: usize = 35;
/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;
/// How much of a trailer is looked at.
const TRAILER: u64 = 4096;

pub(super) fn read(mut source: impl BufRead, length: u64) -> Result<Surface, SdfError> {
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
    let header = header(&rest, count_size, dialect)?;
    let size = header.data_type.size();
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
        let (mut index, mut infinite) = (0, None);
        header.data_type.decode(chunk, dialect, |number| {
            let height = number * header.z_scale;
            if height.is_infinite() && infinite.is_none() {
                infinite = Some((index, height));
            }
            index += 1;
            heights.push(height);
        });
        if let Some((index, height)) = infinite {
            return Err(SdfError::Height {
                at: Position::Byte(offset + index * size),
                found: height.to_string(),
                expected: "a finite number times Zscale",
            });
        }
    }
    let mut trailer = Vec::new();
    source.take(TRAILER).read_to_end(&mut trailer)?;
    let warnings = trailer_warning(&trailer, needed, length).into_iter().collect();
    Ok(Surface { patch: header.patch(heights), warnings })
}

/// Up to `count` bytes, fewer only at the end of the file.
fn take(source: &mut impl Read, count: usize) -> Result<Vec<u8>, SdfError> {
    let mut bytes = Vec::with_capacity(count);
    source.take(count as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn header(bytes: &[u8], count_size: usize, dialect: Dialect) -> Result<Header, SdfError> {
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
    RawHeader {
        points: count(0),
        profiles: count(count_size),
        x_scale: real(0),
        y_scale: real(1),
        z_scale: real(2),
        compression: code(0),
        data_type: code(1),
        check_type: code(2),
    }
    .check(dialect)
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
