//! Checksums: compared, and told where they do not fit, but no reason to refuse heights.

use std::io::{Read, Seek};

use zip::ZipArchive;

use super::document::{DATA_LINK, Document, MAIN, VALID_LINK};
use super::entry::Entry;

/// Name of the entry with the checksum of `main.xml`, unless Record4 says another.
const CHECKSUM_FILE: &str = "md5checksum.hex";
/// How much of it is read.
const LONGEST: u64 = 4096;

/// MD5 of the entries that were read, in hexadecimal digits.
#[derive(Default)]
pub(super) struct Checksums(Vec<(String, String)>);

impl Checksums {
    pub(super) fn add(&mut self, name: &str, digest: String) {
        self.0.push((name.to_owned(), digest));
    }

    /// What does not fit, in words.
    pub(super) fn compare<R: Read + Seek>(
        &self,
        document: &Document,
        archive: &mut ZipArchive<R>,
        folder: &str,
    ) -> Vec<String> {
        let mut warnings = Vec::new();
        for (link, checksum) in [
            (DATA_LINK, "Record3/DataLink/MD5ChecksumPointData"),
            (VALID_LINK, "Record3/DataLink/MD5ChecksumValidPoints"),
        ] {
            if let (Some(name), Some(expected)) = (document.get(link), document.get(checksum)) {
                warnings.extend(self.differs(name, expected, MAIN));
            }
        }
        let file = document.get("Record4/ChecksumFile").unwrap_or(CHECKSUM_FILE);
        let mut text = Vec::new();
        let read = Entry::open(archive, folder, file).and_then(|entry| {
            let failed = entry.take(LONGEST).read_to_end(&mut text);
            failed.map_err(|error| super::X3pError::Entry { name: file.to_owned(), reason: error.to_string() })
        });
        if let Err(error) = read {
            warnings.push(format!("the checksum of {MAIN} is not compared: {error}"));
        }
        // Lines "digest *name" as md5sum has them.
        for line in String::from_utf8_lossy(&text).lines() {
            let mut words = line.split_whitespace();
            if let Some(expected) = words.next() {
                let name = words.next().map_or(MAIN, |name| name.trim_start_matches('*'));
                warnings.extend(self.differs(name, expected, file));
            }
        }
        warnings
    }

    /// Says if an entry that was read has another digest than expected.
    fn differs(&self, name: &str, expected: &str, place: &str) -> Option<String> {
        let (_, found) = self.0.iter().find(|(known, _)| known == name)?;
        let expected: String = expected.chars().take(40).collect();
        (!expected.eq_ignore_ascii_case(found)).then(|| {
            format!(
                "the MD5 checksum of {name} is {found}, but {place} says {}: it was changed",
                expected.to_lowercase()
            )
        })
    }
}
