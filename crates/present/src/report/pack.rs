//! Numbers as text: byte by byte of all of them, deflated, in base64.
//!
//! The bytes of equal weight stand together, the lowest first; where numbers are alike, so are the higher ones, which
//! deflate then makes short. Browsers inflate it with `DecompressionStream("deflate")`.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::deflate::deflate;

/// Floating-point numbers, 8 bytes each.
pub fn doubles(values: &[f64]) -> String {
    pack(values.iter().map(|value| value.to_le_bytes()))
}

/// Floating-point numbers rounded to 4 bytes each.
pub fn singles(values: impl ExactSizeIterator<Item = f64>) -> String {
    pack(values.map(|value| (value as f32).to_le_bytes()))
}

/// Increasing indices, as differences from the one before of 4 bytes each.
pub fn indices(values: &[usize]) -> String {
    let before = |at: usize| at.checked_sub(1).map_or(0, |before| values[before]);
    pack(values.iter().enumerate().map(|(at, value)| ((value - before(at)) as u32).to_le_bytes()))
}

/// Codes of one byte each.
pub fn bytes(codes: impl ExactSizeIterator<Item = u8>) -> String {
    pack(codes.map(|code| [code]))
}

/// Codes of two bytes each.
pub fn words(codes: impl ExactSizeIterator<Item = u16>) -> String {
    pack(codes.map(u16::to_le_bytes))
}

/// A text in UTF-8.
pub fn text(text: &str) -> String {
    bytes(text.bytes())
}

fn pack<const N: usize>(values: impl ExactSizeIterator<Item = [u8; N]>) -> String {
    let count = values.len();
    let mut planes = vec![0; N * count];
    for (index, value) in values.enumerate() {
        for (plane, byte) in value.into_iter().enumerate() {
            planes[plane * count + index] = byte;
        }
    }
    STANDARD.encode(deflate(&planes))
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use flate2::read::ZlibDecoder;

    fn unpack(text: &str) -> Vec<u8> {
        let mut bytes = Vec::new();
        ZlibDecoder::new(&STANDARD.decode(text).unwrap()[..]).read_to_end(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn bytes_of_equal_weight_stand_together() {
        // 1.5 = 0x3fc00000 and -2 = 0xc0000000 in IEEE 754.
        assert_eq!(unpack(&super::singles([1.5, -2.0].into_iter())), [0, 0, 0, 0, 0xc0, 0, 0x3f, 0xc0]);
        assert_eq!(unpack(&super::words([0x0102, 0xfffe].into_iter())), [2, 0xfe, 1, 0xff]);
        assert_eq!(unpack(&super::indices(&[3, 5, 300])), [3, 2, 0x27, 0, 0, 1, 0, 0, 0, 0, 0, 0]);
        assert_eq!(unpack(&super::bytes([7, 9].into_iter())), [7, 9]);
        assert_eq!(unpack(&super::text("µ")), [0xc2, 0xb5]);
        assert_eq!(unpack(&super::doubles(&[])), [0; 0]);
    }
}
