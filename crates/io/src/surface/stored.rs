//! Numbers as files store them.

use half::f16;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Number {
    pub(super) kind: Kind,
    /// Bytes: 1, 2, 4 or 8; of floating-point numbers not 1.
    pub(super) size: usize,
    pub(super) is_big_endian: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Float,
    Signed,
    Unsigned,
}

impl Number {
    /// The smallest and the largest of an integer type, as a double.
    pub(super) fn integers(self) -> Option<[f64; 2]> {
        let count = libm::ldexp(1.0, 8 * self.size as i32);
        match self.kind {
            Kind::Float => None,
            Kind::Signed => Some([-0.5 * count, 0.5 * count - 1.0]),
            Kind::Unsigned => Some([0.0, count - 1.0]),
        }
    }

    /// The number of these bytes as a double; integers of more than 53 bits are rounded.
    pub(super) fn read(self, bytes: &[u8]) -> f64 {
        // Sign-extended later: the number's bytes, the most significant first, at the end of eight.
        let mut raw = [0; 8];
        for (at, byte) in bytes.iter().enumerate() {
            raw[if self.is_big_endian { 8 - self.size + at } else { 7 - at }] = *byte;
        }
        let bits = u64::from_be_bytes(raw);
        match (self.kind, self.size) {
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Signed, _) => {
                let unused = 64 - 8 * self.size;
                ((bits << unused) as i64 >> unused) as f64
            }
            (Kind::Float, 2) => f16::from_bits(bits as u16).to_f64(),
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
        }
    }
}
