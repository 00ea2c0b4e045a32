//! Types of stored numbers, and which of them say that a point was not measured.

use super::kind::Dialect;

/// Type of the stored numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DataType {
    Uint8,
    Uint16,
    Uint32,
    Binary32,
    Int8,
    Int16,
    Int32,
    Binary64,
}

/// From here on a binary32 or a binary64 number of BCR-1.0 marks a point that was not measured.
const BCR_MISSING_32: f32 = 3.4e38;
pub(super) const BCR_MISSING_64: f64 = 1.7e308;

impl DataType {
    /// The type with this code. Only BCR-1.0 has unsigned integers: ISO 25178-71 marks missing points by the smallest
    /// number of a type, which for them is a height. ISO-1.0 itself has the codes 5 to 7; 3 and 4, which ISO-2.0
    /// adds, mean the same wherever they occur.
    pub(super) fn from_code(code: i64, dialect: Dialect) -> Option<Self> {
        Some(match code {
            0 if dialect == Dialect::Bcr1 => Self::Uint8,
            1 if dialect == Dialect::Bcr1 => Self::Uint16,
            2 if dialect == Dialect::Bcr1 => Self::Uint32,
            3 => Self::Binary32,
            4 => Self::Int8,
            5 => Self::Int16,
            6 => Self::Int32,
            7 => Self::Binary64,
            _ => return None,
        })
    }

    /// The codes of a dialect, in words.
    pub(super) fn codes(dialect: Dialect) -> &'static str {
        match dialect {
            Dialect::Bcr1 => {
                "0 (uint8), 1 (uint16), 2 (uint32), 3 (binary32), 4 (int8), 5 (int16), 6 (int32) or 7 (binary64)"
            }
            Dialect::Iso1 | Dialect::Iso2 => "3 (binary32), 4 (int8), 5 (int16), 6 (int32) or 7 (binary64)",
        }
    }

    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Uint8 | Self::Int8 => 1,
            Self::Uint16 | Self::Int16 => 2,
            Self::Uint32 | Self::Int32 | Self::Binary32 => 4,
            Self::Binary64 => 8,
        }
    }

    /// Smallest and largest number of an integer type.
    fn integers(self) -> Option<(i64, i64)> {
        match self {
            Self::Uint8 => Some((u8::MIN.into(), u8::MAX.into())),
            Self::Uint16 => Some((u16::MIN.into(), u16::MAX.into())),
            Self::Uint32 => Some((u32::MIN.into(), u32::MAX.into())),
            Self::Int8 => Some((i8::MIN.into(), i8::MAX.into())),
            Self::Int16 => Some((i16::MIN.into(), i16::MAX.into())),
            Self::Int32 => Some((i32::MIN.into(), i32::MAX.into())),
            Self::Binary32 | Self::Binary64 => None,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Uint8 => "a uint8 number",
            Self::Uint16 => "a uint16 number",
            Self::Uint32 => "a uint32 number",
            Self::Binary32 => "a binary32 number",
            Self::Int8 => "an int8 number",
            Self::Int16 => "an int16 number",
            Self::Int32 => "an int32 number",
            Self::Binary64 => "a binary64 number",
        }
    }

    /// The number that a text states, NaN if it says that none was measured; nothing if it is no number of this type.
    pub(super) fn parse(self, text: &[u8], dialect: Dialect) -> Option<f64> {
        // NaN is not of the standard, but some programs write it.
        if text.eq_ignore_ascii_case(b"BAD") || text.eq_ignore_ascii_case(b"NaN") {
            return Some(f64::NAN);
        }
        let text = std::str::from_utf8(text).ok()?;
        let bcr = dialect == Dialect::Bcr1;
        if let Some((smallest, largest)) = self.integers() {
            let integer: i64 = text.parse().ok()?;
            let missing = bcr && integer == largest;
            return (smallest..=largest).contains(&integer).then_some(if missing { f64::NAN } else { integer as f64 });
        }
        let number: f64 = text.parse().ok()?;
        let from = if self == Self::Binary32 { f64::from(BCR_MISSING_32) } else { BCR_MISSING_64 };
        Some(if bcr && number >= from { f64::NAN } else { number })
    }

    /// Gives `take` every number of `bytes`, NaN where none was measured: ISO 25178-71 marks those by the smallest
    /// number of the type, BCR-1.0 by the largest; NaN is what some programs write.
    pub(super) fn decode(self, bytes: &[u8], dialect: Dialect, mut take: impl FnMut(f64)) {
        let bcr = dialect == Dialect::Bcr1;
        macro_rules! integers {
            ($type:ty) => {{
                let missing = if bcr { <$type>::MAX } else { <$type>::MIN };
                for raw in bytes.as_chunks().0 {
                    let number = <$type>::from_le_bytes(*raw);
                    take(if number == missing { f64::NAN } else { f64::from(number) });
                }
            }};
        }
        macro_rules! reals {
            ($type:ty, $bcr_missing:expr) => {
                for raw in bytes.as_chunks().0 {
                    let number = <$type>::from_le_bytes(*raw);
                    let missing = if bcr { number >= $bcr_missing } else { number == <$type>::MIN };
                    take(if missing { f64::NAN } else { f64::from(number) });
                }
            };
        }
        match self {
            Self::Uint8 => integers!(u8),
            Self::Uint16 => integers!(u16),
            Self::Uint32 => integers!(u32),
            Self::Int8 => integers!(i8),
            Self::Int16 => integers!(i16),
            Self::Int32 => integers!(i32),
            Self::Binary32 => reals!(f32, BCR_MISSING_32),
            Self::Binary64 => reals!(f64, BCR_MISSING_64),
        }
    }
}
