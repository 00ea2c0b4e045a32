//! Digests of what a run file holds, by which anyone can tell whether it is still what was written: SHA-256, 64 hexadecimal
//! digits.
//!
//! Every dataset has the attribute `sha256`, the digest of its values as they lie in memory, the least byte first; a map
//! has one for each moment. The root has digests of all attributes: see [`super::attribute_digests`].

use std::collections::BTreeMap;
use std::str::FromStr;

use hdf5::File;
use hdf5::types::VarLenUnicode;
use sha2::{Digest, Sha256};

use crate::hdf5_file::writing::write_text;

/// Attribute of a dataset.
pub(super) const DIGEST: &str = "sha256";

/// Digests of the datasets that grow, taken of the values that are handed to the library.
#[derive(Debug, Default)]
pub(super) struct Digests {
    /// Of the datasets with one dimension, up to now.
    columns: BTreeMap<String, Sha256>,
    /// Of the maps, one for each moment.
    maps: BTreeMap<&'static str, Vec<String>>,
}

impl Digests {
    /// Values that were appended to a dataset with one dimension.
    pub(super) fn append(&mut self, path: &str, values: &[f64]) {
        update(self.columns.entry(path.to_owned()).or_default(), values);
    }

    /// A map that was appended.
    pub(super) fn append_map(&mut self, path: &'static str, digest: String) {
        self.maps.entry(path).or_default().push(digest);
    }

    /// How many maps there are.
    pub(super) fn maps(&self) -> usize {
        self.maps.values().map(Vec::len).sum()
    }

    /// Whether a map was the same at every one of several moments.
    pub(super) fn is_constant(&self, path: &str) -> bool {
        let digests = self.maps.get(path).map_or(&[][..], Vec::as_slice);
        digests.len() > 1 && digests.iter().all(|digest| *digest == digests[0])
    }

    /// Writes the digests of all that was appended.
    pub(super) fn write(&self, file: &File) -> hdf5::Result<()> {
        for (path, hasher) in &self.columns {
            write_text(&*file.dataset(path)?, DIGEST, &format!("{:x}", hasher.clone().finalize()))?;
        }
        for (path, digests) in &self.maps {
            let texts: Result<Vec<_>, _> = digests.iter().map(|digest| VarLenUnicode::from_str(digest)).collect();
            let texts = texts.map_err(|error| hdf5::Error::from(error.to_string()))?;
            file.dataset(path)?.new_attr_builder().with_data(&texts).create(DIGEST)?;
        }
        Ok(())
    }
}

/// Digest of floating-point values.
pub(super) fn of_floats(values: &[f64]) -> String {
    let mut hasher = Sha256::new();
    update(&mut hasher, values);
    format!("{:x}", hasher.finalize())
}

/// Digest of statuses.
pub(super) fn of_bytes(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// Takes floating-point values as they lie in memory, the least byte first.
fn update(hasher: &mut Sha256, values: &[f64]) {
    for values in values.chunks(512) {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        hasher.update(bytes);
    }
}
