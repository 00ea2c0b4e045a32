//! The dialects of SDF and how their numbers are stored.

use std::fmt;

/// Document that defines a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dialect {
    /// BCR-1.0 (the report of the Community Bureau of Reference), with unsigned integers too.
    Bcr1,
    /// Version 1.0 of ISO 25178-71.
    Iso1,
    /// Version 2.0 of ISO 25178-71:2026: more points a profile, more types of numbers.
    Iso2,
}

/// How numbers are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// As text.
    Ascii,
    /// As they are in memory, little endian.
    Binary,
}

/// A dialect of SDF and how it stores numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SdfKind {
    /// The dialect.
    pub dialect: Dialect,
    /// How numbers are stored.
    pub encoding: Encoding,
}

impl SdfKind {
    const ALL: [Self; 6] = {
        use {Dialect::*, Encoding::*};
        [
            Self { dialect: Bcr1, encoding: Ascii },
            Self { dialect: Bcr1, encoding: Binary },
            Self { dialect: Iso1, encoding: Ascii },
            Self { dialect: Iso1, encoding: Binary },
            Self { dialect: Iso2, encoding: Ascii },
            Self { dialect: Iso2, encoding: Binary },
        ]
    };

    /// The eight bytes that such a file starts with.
    pub fn magic(self) -> &'static str {
        match (self.encoding, self.dialect) {
            (Encoding::Ascii, Dialect::Bcr1) => "aBCR-1.0",
            (Encoding::Ascii, Dialect::Iso1) => "aISO-1.0",
            (Encoding::Ascii, Dialect::Iso2) => "aISO-2.0",
            (Encoding::Binary, Dialect::Bcr1) => "bBCR-1.0",
            (Encoding::Binary, Dialect::Iso1) => "bISO-1.0",
            (Encoding::Binary, Dialect::Iso2) => "bISO-2.0",
        }
    }

    /// The kind of a file that starts like this. BCR-1.0 allows the first letter to be large.
    pub(in crate::surface) fn from_magic(head: &[u8]) -> Option<Self> {
        let (first, rest) = head.split_first()?;
        Self::ALL.into_iter().find(|kind| {
            let magic = kind.magic().as_bytes();
            first.eq_ignore_ascii_case(&magic[0]) && rest.starts_with(&magic[1..])
        })
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bcr1 => "BCR-1.0",
            Self::Iso1 => "ISO-1.0",
            Self::Iso2 => "ISO-2.0",
        })
    }
}

impl fmt::Display for SdfKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let encoding = match self.encoding {
            Encoding::Ascii => "ASCII",
            Encoding::Binary => "binary",
        };
        write!(f, "{} {encoding}", self.dialect)
    }
}

/// Text without a byte order mark and leading blanks.
pub(in crate::surface) fn without_margin(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii_start()
}
