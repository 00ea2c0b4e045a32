//! Changes of the bytes of a file.

use proptest::prelude::*;
use proptest::sample::Index;

/// Bytes at the start of a file that are changed more often than others.
const HEAD: usize = 128;

/// A place in a file: in its first bytes, where headers are, or anywhere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    index: Index,
    head: bool,
}

impl Place {
    fn within(self, content: &[u8]) -> usize {
        self.index.index(if self.head { content.len().min(HEAD) } else { content.len() } + 1).min(content.len())
    }
}

/// One change of some bytes.
#[derive(Debug, Clone)]
pub(super) enum Change {
    Flip(Place, u8),
    Put(Place, Vec<u8>),
    Insert(Place, Vec<u8>),
    Remove(Place, u8),
    Repeat(Place, u8, u8),
    Cut(Place),
}

impl Change {
    pub(super) fn apply(&self, content: &mut Vec<u8>) {
        match self {
            Self::Flip(at, bits) => {
                let at = at.within(content);
                if let Some(byte) = content.get_mut(at) {
                    *byte ^= bits;
                }
            }
            Self::Put(at, bytes) => {
                let at = at.within(content);
                content[at..].iter_mut().zip(bytes).for_each(|(old, new)| *old = *new);
            }
            Self::Insert(at, bytes) => {
                let at = at.within(content);
                content.splice(at..at, bytes.iter().copied());
            }
            Self::Remove(at, count) => {
                let at = at.within(content);
                content.drain(at..content.len().min(at + usize::from(*count)));
            }
            Self::Repeat(at, count, times) => {
                let at = at.within(content);
                let bytes = content[at..content.len().min(at + usize::from(*count))].repeat(usize::from(*times));
                content.splice(at..at, bytes);
            }
            Self::Cut(at) => content.truncate(at.within(content)),
        }
    }
}

/// Bytes that readers stumble over: numbers at the limits of their types, words and signs of the formats.
pub(super) fn odd_bytes() -> impl Strategy<Value = Vec<u8>> {
    let reals =
        [f64::NAN, f64::INFINITY, -1.0, 0.0, -0.0, 1e308, 5e-324, 1e-300].map(|real| real.to_le_bytes().to_vec());
    let integers = [0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0x8000, 0xffff, i32::MAX as u32, 1 << 31, u32::MAX]
        .map(|integer| integer.to_le_bytes().to_vec());
    let words = [
        "*",
        "BAD",
        "nan",
        "inf",
        "-1",
        "0",
        "1e999",
        "2147483648",
        "18446744073709551616",
        ";",
        "=",
        ",",
        "\n",
        "\r\n",
        "<",
        "/>",
        "&a;",
        "&#0;",
        "<!DOCTYPE a [<!ENTITY b 'c'>]>",
        "<![CDATA[",
        "]]>",
        "<!--",
        "\0",
        "\u{feff}",
        "I",
        "A",
        "D",
        "NumPoints = 4294967295",
        "<Datum/>",
        "1;2;3",
        "1,234",
        "Bad\t",
        "X Size\t4294967295\n",
        "\"Horizontal\",\"99999999999\"\n",
        "#\n",
        "'fortran_order': True, ",
        "'descr': '<f8', ",
    ];
    let words = words.map(|word| word.as_bytes().to_vec());
    prop_oneof![
        prop::sample::select(reals.to_vec()),
        prop::sample::select(integers.to_vec()),
        prop::sample::select(words.to_vec()),
        prop::collection::vec(any::<u8>(), 1..9),
    ]
}

pub(super) fn changes() -> impl Strategy<Value = Vec<Change>> {
    let place = || (any::<Index>(), any::<bool>()).prop_map(|(index, head)| Place { index, head });
    let change = prop_oneof![
        (place(), any::<u8>()).prop_map(|(at, bits)| Change::Flip(at, bits)),
        (place(), odd_bytes()).prop_map(|(at, bytes)| Change::Put(at, bytes)),
        (place(), odd_bytes()).prop_map(|(at, bytes)| Change::Insert(at, bytes)),
        (place(), any::<u8>()).prop_map(|(at, count)| Change::Remove(at, count)),
        (place(), any::<u8>(), any::<u8>()).prop_map(|(at, count, times)| Change::Repeat(at, count, times)),
        place().prop_map(Change::Cut),
    ];
    prop::collection::vec(change, 1..6)
}
