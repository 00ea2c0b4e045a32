//! Binary SDF: 81 bytes of header, little endian, then the data.

use plateau_core::surface::Patch;

use super::error::{Position, SdfError};
use super::header::{DataType, Header, RawHeader};

const MAGIC: &[u8] = b"bISO-1.0";
/// Magic 8, ManufacID 10, CreateDate 12, ModDate 12, NumPoints 2, NumProfiles 2, Xscale, Yscale, Zscale, Zresolution
/// 8 each, Compression, DataType, CheckType 1 each.
const HEADER: usize = 81;

pub(super) fn read(content: &[u8]) -> Result<Patch, SdfError> {
    if !content.starts_with(MAGIC) {
        let found = content[..content.len().min(MAGIC.len())].escape_ascii().to_string();
        return Err(SdfError::Magic { found });
    }
    let Some((bytes, data)) = content.split_first_chunk::<HEADER>() else {
        return Err(SdfError::Truncated {
            found: content.len(),
            needed: HEADER as u128,
            what: "the header".to_owned(),
        });
    };
    let header = header(bytes)?;
    let size = header.data_type.size();
    // Compared before anything is allocated: a header can promise more than any file holds.
    let needed = header.heights() * size as u128;
    if needed > data.len() as u128 {
        return Err(SdfError::Truncated {
            found: content.len(),
            needed: HEADER as u128 + needed,
            what: format!("{} x {} heights of {size} bytes", header.points, header.profiles),
        });
    }
    // What follows the data is the trailer.
    let data = &data[..needed as usize];
    let mut profiles = Vec::with_capacity(data.len() / size);
    for (index, raw) in data.chunks_exact(size).enumerate() {
        let height = number(raw, header.data_type).map_or(f64::NAN, |number| number * header.z_scale);
        if height.is_infinite() {
            return Err(SdfError::Height {
                at: Position::Byte(HEADER + index * size),
                found: height.to_string(),
                expected: "a finite number times Zscale",
            });
        }
        profiles.push(height);
    }
    Ok(super::patch(&header, &profiles))
}

fn header(bytes: &[u8; HEADER]) -> Result<Header, SdfError> {
    let byte = |offset: usize| (i64::from(bytes[offset]), Position::Byte(offset));
    let count =
        |offset: usize| (i64::from(u16::from_le_bytes([bytes[offset], bytes[offset + 1]])), Position::Byte(offset));
    let real = |offset: usize| {
        let mut raw = [0; 8];
        raw.copy_from_slice(&bytes[offset..offset + 8]);
        (f64::from_le_bytes(raw), Position::Byte(offset))
    };
    RawHeader {
        points: count(42),
        profiles: count(44),
        x_scale: real(46),
        y_scale: real(54),
        z_scale: real(62),
        compression: byte(78),
        data_type: byte(79),
        check_type: byte(80),
    }
    .check()
}

/// One stored number; `None` where none was measured: the smallest number of the type (ISO 25178-71), or NaN, which
/// some programs write.
fn number(raw: &[u8], data_type: DataType) -> Option<f64> {
    match (data_type, raw) {
        (DataType::Int8, &[a]) => (a as i8 != i8::MIN).then_some(f64::from(a as i8)),
        (DataType::Int16, &[a, b]) => {
            let number = i16::from_le_bytes([a, b]);
            (number != i16::MIN).then_some(f64::from(number))
        }
        (DataType::Int32, &[a, b, c, d]) => {
            let number = i32::from_le_bytes([a, b, c, d]);
            (number != i32::MIN).then_some(f64::from(number))
        }
        (DataType::Binary32, &[a, b, c, d]) => {
            let number = f32::from_le_bytes([a, b, c, d]);
            (!number.is_nan() && number != f32::MIN).then_some(f64::from(number))
        }
        (DataType::Binary64, &[a, b, c, d, e, f, g, h]) => {
            let number = f64::from_le_bytes([a, b, c, d, e, f, g, h]);
            (!number.is_nan() && number != f64::MIN).then_some(number)
        }
        _ => None,
    }
}
