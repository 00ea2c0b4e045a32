//! The numbers that an array can hold.

use super::error::NpyError;
use crate::text::short;

/// A type of number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Number {
    kind: Kind,
    /// Bytes: 1, 2, 4 or 8.
    size: usize,
    big_endian: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Float,
    Signed,
    Unsigned,
}

impl Number {
    /// Reads a type such as `<f8`.
    pub(super) fn of(descr: &str) -> Result<Self, NpyError> {
        let unknown = || NpyError::Type { found: format!("\"{}\"", short(descr).escape_debug()) };
        let mut characters = descr.chars();
        let (order, kind, size) = (characters.next(), characters.next(), characters.as_str());
        let kind = match kind {
            Some('f') => Kind::Float,
            Some('i') => Kind::Signed,
            Some('u') => Kind::Unsigned,
            _ => return Err(unknown()),
        };
        let size = match (size, kind) {
            ("1", Kind::Signed | Kind::Unsigned) => 1,
            ("2", _) => 2,
            ("4", _) => 4,
            ("8", _) => 8,
            _ => return Err(unknown()),
        };
        match (order, size) {
            (Some('<'), _) | (Some('|'), 1) => Ok(Self { kind, size, big_endian: false }),
            (Some('>'), _) => Ok(Self { kind, size, big_endian: true }),
            _ => Err(unknown()),
        }
    }

    /// Bytes of a number.
    pub(super) fn size(self) -> usize {
        self.size
    }

    pub(super) fn is_integer(self) -> bool {
        self.kind != Kind::Float
    }

    /// Reads numbers as doubles; integers of more than 53 bits are rounded.
    pub(super) fn read(self, data: &[u8]) -> Vec<f64> {
        data.chunks_exact(self.size).map(|bytes| self.one(bytes)).collect()
    }

    fn one(self, bytes: &[u8]) -> f64 {
        // Sign-extended later: the number's bytes, the most significant first, at the end of eight.
        let mut raw = [0; 8];
        for (at, byte) in bytes.iter().enumerate() {
            raw[if self.big_endian { 8 - self.size + at } else { 7 - at }] = *byte;
        }
        let bits = u64::from_be_bytes(raw);
        match (self.kind, self.size) {
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Signed, _) => {
                let unused = 64 - 8 * self.size;
                ((bits << unused) as i64 >> unused) as f64
            }
            (Kind::Float, 2) => half(bits as u16),
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
        }
    }
}

/// A number of IEEE 754 binary16.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let exponent = i32::from(bits >> 10 & 0x1f);
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    sign * match exponent {
        0 => fraction * 2.0_f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction) * 2.0_f64.powi(exponent - 15),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_in_both_orders() {
        for (descr, bytes, expected) in [
            ("|u1", vec![0xfe], 254.0),
            ("|i1", vec![0xfe], -2.0),
            ("<i1", vec![0x7f], 127.0),
            ("<u2", vec![0x34, 0x12], 4660.0),
            (">u2", vec![0x12, 0x34], 4660.0),
            ("<i2", vec![0xff, 0xff], -1.0),
            (">i4", vec![0xff, 0xff, 0xff, 0x00], -256.0),
            ("<u4", vec![0, 0, 0, 0x80], 2_147_483_648.0),
            ("<i8", (-5_i64).to_le_bytes().to_vec(), -5.0),
            (">u8", u64::MAX.to_be_bytes().to_vec(), 18_446_744_073_709_551_616.0),
            ("<f4", 0.1_f32.to_le_bytes().to_vec(), f64::from(0.1_f32)),
            (">f8", (-1.5e-6_f64).to_be_bytes().to_vec(), -1.5e-6),
            // Examples of IEEE 754 binary16: 1/3, the largest number, the smallest subnormal one, -2.
            ("<f2", vec![0x55, 0x35], 0.333_251_953_125),
            (">f2", vec![0x7b, 0xff], 65504.0),
            ("<f2", vec![0x01, 0x00], 5.960_464_477_539_063e-8),
            ("<f2", vec![0x00, 0xc0], -2.0),
            ("<f2", vec![0x00, 0xfc], f64::NEG_INFINITY),
        ] {
            let number = Number::of(descr).unwrap();
            assert_eq!((number.size(), number.read(&bytes)), (bytes.len(), vec![expected]), "{descr}");
        }
        assert!(Number::of("<f2").unwrap().read(&[0x01, 0x7c])[0].is_nan());
    }

    #[test]
    fn what_is_no_real_number_is_refused() {
        for descr in ["|b1", "<c16", "|O", "<U3", "|S5", "<f16", "<M8[ns]", "f8", "|f8", "=f8", "<f1", "", "<", "é"] {
            assert!(Number::of(descr).is_err(), "{descr}");
        }
    }
}
