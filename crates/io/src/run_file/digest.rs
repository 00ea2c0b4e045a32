//! Digests of what a run file holds, by which anyone can tell whether it is still what was written: SHA-256, 64 hexadecimal
//! digits.
//!
//! Every dataset has the attribute `sha256`, the digest of its values as they lie in memory, the least byte first; a map
//! has one for each moment. The root has `attributes_sha256`, the digest of what the library itself keeps without a
//! checksum: texts, and which scales a dataset has; and of the order in groups. See [`of_attributes`].

use std::collections::BTreeMap;
use std::str::FromStr;

use hdf5::types::{TypeDescriptor, VarLenArray, VarLenUnicode};
use hdf5::{Attribute, File, IndexType, IterationOrder, Location, LocationType, ObjectReference1, ReferencedObject};
use sha2::{Digest, Sha256};

use crate::hdf5_file::writing::write_text;

/// Attribute of a dataset.
pub(super) const DIGEST: &str = "sha256";
/// Attribute of the root.
pub(super) const ATTRIBUTES_DIGEST: &str = "attributes_sha256";

/// Texts that differ between runs of equal results, and are left out, so that the digest does not.
const OF_THE_EXECUTION: [&str; 4] = ["host", "instruction_set", "start_time", "end_time"];

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

    /// Writes the digests of all that was appended, and that of the attributes. No attribute may be written afterwards.
    pub(super) fn write(&self, file: &File) -> hdf5::Result<()> {
        for (path, hasher) in &self.columns {
            write_text(&*file.dataset(path)?, DIGEST, &format!("{:x}", hasher.clone().finalize()))?;
        }
        for (path, digests) in &self.maps {
            let texts: Result<Vec<_>, _> = digests.iter().map(|digest| VarLenUnicode::from_str(digest)).collect();
            let texts = texts.map_err(|error| hdf5::Error::from(error.to_string()))?;
            file.dataset(path)?.new_attr_builder().with_data(&texts).create(DIGEST)?;
        }
        let digest = of_attributes(file)?;
        write_text(file, ATTRIBUTES_DIGEST, &digest)
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

/// Digest of the texts among the attributes of a run file, of the scales of its datasets, and of what is in its groups: of
/// one line `path@attribute=text` or `path: members` for each, in the order of their bytes. A dataset's scales are the paths
/// in `DIMENSION_LIST`; several texts, paths or members, these as they were made, are separated by commas. What has a line
/// break in it takes more lines. A link has the lines of what it leads to, with its own path. Where and when the run was made
/// is left out.
pub(super) fn of_attributes(file: &File) -> hdf5::Result<String> {
    let mut lines = Vec::new();
    add_attributes(file, "/", file, &mut lines)?;
    let mut groups = vec![file.as_group()?];
    while let Some(group) = groups.pop() {
        let members = group.member_names_by(IndexType::CreationOrder, IterationOrder::Increasing)?;
        lines.push(format!("{}: {}\n", group.name(), members.join(",")));
        for member in &members {
            if group.loc_type_by_name(member)? == LocationType::Dataset {
                let path = format!("{}/{member}", group.name().trim_end_matches('/'));
                add_attributes(file, &path, &*group.dataset(member)?, &mut lines)?;
            }
        }
        for datatype in group.committed_datatypes()? {
            add_attributes(file, &datatype.name(), &datatype, &mut lines)?;
        }
        groups.extend(group.groups()?);
    }
    lines.sort();
    Ok(of_bytes(lines.concat().as_bytes()))
}

fn add_attributes(file: &File, path: &str, location: &Location, lines: &mut Vec<String>) -> hdf5::Result<()> {
    for name in location.attr_names()?.into_iter().filter(|name| name != ATTRIBUTES_DIGEST) {
        // What is left out must be readable all the same.
        let texts = texts(file, &location.attr(&name)?)?.filter(|_| !OF_THE_EXECUTION.contains(&name.as_str()));
        lines.extend(texts.map(|texts| format!("{path}@{name}={}\n", texts.join(","))));
    }
    Ok(())
}

/// What an attribute says, if it is of a kind for which the library keeps no checksum.
pub(super) fn texts(file: &File, attribute: &Attribute) -> hdf5::Result<Option<Vec<String>>> {
    // What an empty one is said to hold is whatever the memory held before.
    if attribute.space()?.is_null() {
        return Ok(None);
    }
    let texts = match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::VarLenUnicode => {
            let texts = attribute.read_raw::<VarLenUnicode>()?;
            // The bytes of a damaged file may be no text.
            texts.iter().map(|text| String::from_utf8_lossy(text.as_bytes()).into_owned()).collect()
        }
        TypeDescriptor::VarLenArray(_) => {
            let scales = attribute.read_raw::<VarLenArray<ObjectReference1>>()?;
            let scales = scales.iter().flat_map(|scales| scales.iter());
            scales.map(|scale| path_of(file, scale)).collect::<hdf5::Result<_>>()?
        }
        _ => return Ok(None),
    };
    Ok(Some(texts))
}

/// Path of the dataset that a reference means.
fn path_of(file: &File, reference: &ObjectReference1) -> hdf5::Result<String> {
    match file.dereference(reference)? {
        ReferencedObject::Dataset(dataset) => Ok(dataset.name()),
        _ => Err("a reference to something else than a dataset".into()),
    }
}

/// Takes floating-point values as they lie in memory, the least byte first.
fn update(hasher: &mut Sha256, values: &[f64]) {
    for values in values.chunks(512) {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        hasher.update(bytes);
    }
}
