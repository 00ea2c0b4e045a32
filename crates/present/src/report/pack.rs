//! Numbers as text, also with fewer levels: byte by byte of all of them, deflated, in base64.
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

/// How finely numbers are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fineness {
    /// One byte each: 254 steps.
    Byte,
    /// Two bytes each: 4095 steps, which are shorter when they are deflated than all that two bytes can tell apart.
    Word,
}

impl Fineness {
    /// Steps between the lowest and the highest number; the code above the highest stands for what is no number.
    pub fn steps(self) -> u16 {
        match self {
            Self::Byte => 254,
            Self::Word => 4095,
        }
    }
}

/// The lowest and the highest of those numbers that are finite; both 0 where there is none.
pub fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> [f64; 2] {
    let finite = values.into_iter().copied().filter(|value| value.is_finite());
    let range = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if range[0] <= range[1] { range } else { [0.0; 2] }
}

/// Numbers as codes: number = lowest + code · (highest − lowest)/steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantised {
    /// The lowest and the highest number.
    pub range: [f64; 2],
    /// Steps between them.
    pub fineness: Fineness,
    /// A code for each number.
    pub codes: Vec<u16>,
}

impl Quantised {
    /// Numbers between `range`, of which those that are not finite get the code above the highest.
    pub fn within(range: [f64; 2], values: &[f64], fineness: Fineness) -> Self {
        let steps = f64::from(fineness.steps());
        let width = range[1] - range[0];
        let code = |value: &f64| match value {
            value if !value.is_finite() => fineness.steps() + 1,
            // All alike, or so wide a range that its width is no number.
            _ if !(width > 0.0 && width.is_finite()) => 0,
            value => ((value - range[0]) / width * steps).round() as u16,
        };
        Self { range, fineness, codes: values.iter().map(code).collect() }
    }

    /// Statuses, which are their own codes.
    pub fn statuses(codes: &[u8]) -> Self {
        let steps = f64::from(Fineness::Byte.steps());
        Self { range: [0.0, steps], fineness: Fineness::Byte, codes: codes.iter().copied().map(u16::from).collect() }
    }

    /// The codes as text: as the difference from the code one time before, which is 0 wherever nothing changed. Those of
    /// the first time are told from the codes `before`, or as they are where there are none.
    ///
    /// A time has `cells` codes.
    pub fn packed(&self, cells: usize, before: &[u16]) -> String {
        let differences = (0..self.codes.len()).map(|index| {
            let first = || before.get(index).copied().unwrap_or(0);
            self.codes[index].wrapping_sub(index.checked_sub(cells).map_or_else(first, |index| self.codes[index]))
        });
        match self.fineness {
            Fineness::Byte => bytes(differences.map(|code| code as u8)),
            Fineness::Word => words(differences),
        }
    }
}

#[cfg(test)]
mod tests {
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use flate2::read::ZlibDecoder;
    use std::io::Read as _;

    use super::*;

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

    fn of(values: &[f64], fineness: Fineness) -> Quantised {
        Quantised::within(range(values), values, fineness)
    }

    #[test]
    fn numbers_come_back_within_half_a_step() {
        let values: Vec<f64> = (0..1000).map(|index| (f64::from(index) * 0.37).sin() * 3e-6 - 1e-6).collect();
        for fineness in [Fineness::Byte, Fineness::Word] {
            let quantised = of(&values, fineness);
            let step = (quantised.range[1] - quantised.range[0]) / f64::from(fineness.steps());
            for (value, code) in values.iter().zip(&quantised.codes) {
                let back = quantised.range[0] + f64::from(*code) * step;
                assert!((back - value).abs() <= 0.500_001 * step, "{value} came back as {back}");
            }
        }
    }

    #[test]
    fn what_is_no_number_and_what_is_alike() {
        let quantised = of(&[1.0, f64::NAN, 3.0, f64::INFINITY], Fineness::Byte);
        assert_eq!((quantised.range, &quantised.codes[..]), ([1.0, 3.0], &[0, 255, 254, 255][..]));
        assert_eq!(of(&[2.0; 3], Fineness::Word).codes, [0; 3]);
        assert_eq!(of(&[f64::NAN], Fineness::Word).codes, [4096]);
        assert_eq!(of(&[-1e308, 1e308], Fineness::Byte).codes, [0, 0]);
    }
}
