//! Run files as a reader sees them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use hdf5::file::OpenMode;
use hdf5::types::{TypeDescriptor, VarLenAscii, VarLenUnicode};
use hdf5::{Dataset, Group, H5Type};

use crate::program::WorkingDirectory;

/// A status as docs/run-file.md numbers and names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, H5Type)]
#[repr(u8)]
#[allow(non_camel_case_types)]
pub enum StoredStatus {
    /// Resin.
    none = 0,
    /// Fibre, or coating.
    primary = 1,
    /// Build-up.
    secondary = 2,
}

/// Shape and values of a dataset, bit for bit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Content {
    /// Shape.
    pub shape: Vec<usize>,
    /// The bits of every value.
    pub bits: Vec<u64>,
}

/// The datasets that differ, each with the first index at which it does.
///
/// # Panics
/// When the files do not hold the same datasets.
pub fn differences(one: &BTreeMap<String, Content>, other: &BTreeMap<String, Content>) -> Vec<String> {
    assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
    let different = one.iter().zip(other.values()).filter(|((_, one), other)| one != other);
    different
        .map(|((path, one), other)| {
            let index = one.bits.iter().zip(&other.bits).position(|(one, other)| one != other);
            format!("{path} of shape {:?} from index {index:?} on", one.shape)
        })
        .collect()
}

/// The datasets of which `part` does not hold the start of what `whole` holds.
pub fn differences_of_start(whole: &BTreeMap<String, Content>, part: &BTreeMap<String, Content>) -> Vec<String> {
    let paths = whole.keys().chain(part.keys().filter(|path| !whole.contains_key(*path)));
    let differs = |path: &&String| match (whole.get(*path), part.get(*path)) {
        (Some(whole), Some(part)) => whole.shape[1..] != part.shape[1..] || !whole.bits.starts_with(&part.bits),
        _ => true,
    };
    paths.filter(differs).cloned().collect()
}

/// Asserts of a run file that a stopped run left, if it did, that after `plateau repair` it holds the start of the whole run.
///
/// # Panics
/// When it does not.
pub fn assert_holds_start(directory: &WorkingDirectory, name: &str, whole: &BTreeMap<String, Content>) {
    let [file, copy] = [name, "copy.h5"].map(|name| directory.path(name));
    if file.exists() {
        fs::copy(file, &copy).expect("a copy");
        directory.plateau(["repair", "copy.h5"]).quiet_success();
        assert_eq!(differences_of_start(whole, &RunFile::open(&copy).content()), [""; 0]);
        directory.remove("copy.h5");
    }
}

/// How a test opens every HDF5 file: without a lock. Commands that other tests start in the meantime inherit the open file, and a
/// lock would stay as long as they run.
fn without_lock(path: impl AsRef<Path>, mode: OpenMode) -> hdf5::Result<hdf5::File> {
    hdf5::File::with_options().with_fapl(|list| list.file_locking(false)).open_as(path, mode)
}

/// A new HDF5 file that a test fills.
///
/// # Panics
/// When it cannot be made.
pub fn created(path: impl AsRef<Path>) -> hdf5::File {
    without_lock(path, OpenMode::Create).expect("a new HDF5 file")
}

/// An HDF5 file that a test changes.
///
/// # Panics
/// When it cannot be opened.
pub fn changed(path: impl AsRef<Path>) -> hdf5::File {
    without_lock(path, OpenMode::ReadWrite).expect("an HDF5 file")
}

/// Writes a text among the attributes of the root, in place of one of that name.
///
/// # Panics
/// When it cannot be written.
pub fn set_text(path: impl AsRef<Path>, attribute: &str, text: &str) {
    let file = changed(path);
    let _ = file.delete_attr(attribute);
    let text: VarLenUnicode = text.parse().expect("a text without null");
    let made = file.new_attr::<VarLenUnicode>().create(attribute).expect("an attribute");
    made.write_scalar(&text).expect("its text");
    file.close().expect("the end of the file");
}

/// An HDF5 file that is read. Whatever cannot be read ends the test.
#[derive(Debug)]
pub struct RunFile {
    file: hdf5::File,
}

impl RunFile {
    /// Opens a file that nobody writes.
    ///
    /// # Panics
    /// When it cannot be opened.
    pub fn open(path: impl AsRef<Path>) -> Self {
        let path = path.as_ref();
        let file = without_lock(path, OpenMode::Read).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Self { file }
    }

    /// Opens a file that is being written, or was when its writer was killed.
    ///
    /// # Errors
    /// Those of the HDF5 library.
    pub fn follow(path: impl AsRef<Path>) -> hdf5::Result<Self> {
        without_lock(path, OpenMode::ReadSWMR).map(|file| Self { file })
    }

    /// Whether there is an object of that path.
    pub fn has(&self, path: &str) -> bool {
        self.file.link_exists(path)
    }

    /// Shape of a dataset.
    pub fn shape(&self, dataset: &str) -> Vec<usize> {
        self.dataset(dataset).shape()
    }

    /// All values of a dataset.
    ///
    /// # Panics
    /// When there is no such dataset, or it holds no floating-point numbers; so do the functions below.
    pub fn floats(&self, dataset: &str) -> Vec<f64> {
        self.dataset(dataset).read_raw().unwrap_or_else(|error| panic!("{dataset}: {error}"))
    }

    /// All statuses of a dataset.
    pub fn statuses(&self, dataset: &str) -> Vec<StoredStatus> {
        self.dataset(dataset).read_raw().unwrap_or_else(|error| panic!("{dataset}: {error}"))
    }

    /// All statuses of a dataset as numbers, also those of cells beyond the outline of a round pin.
    pub fn bytes(&self, dataset: &str) -> Vec<u8> {
        self.dataset(dataset).read_raw().unwrap_or_else(|error| panic!("{dataset}: {error}"))
    }

    /// The map of one moment, counted from 0.
    pub fn map(&self, dataset: &str, moment: usize) -> Vec<f64> {
        let cells = self.shape(dataset)[1..].iter().product::<usize>();
        self.floats(dataset)[moment * cells..][..cells].to_vec()
    }

    /// The map of the last moment.
    pub fn last_map(&self, dataset: &str) -> Vec<f64> {
        self.map(dataset, self.shape(dataset)[0] - 1)
    }

    /// A number among the attributes of the root.
    pub fn number(&self, attribute: &str) -> f64 {
        let read = self.file.attr(attribute).and_then(|attribute| attribute.read_scalar());
        read.unwrap_or_else(|error| panic!("{attribute}: {error}"))
    }

    /// A text among the attributes of the root.
    pub fn text(&self, attribute: &str) -> String {
        let read = self.file.attr(attribute).and_then(|attribute| attribute.read_scalar::<VarLenUnicode>());
        read.unwrap_or_else(|error| panic!("{attribute}: {error}")).to_string()
    }

    /// A text among the attributes of a dataset.
    pub fn text_of(&self, dataset: &str, attribute: &str) -> String {
        let read = self.dataset(dataset).attr(attribute).and_then(|attribute| attribute.read_scalar::<VarLenUnicode>());
        read.unwrap_or_else(|error| panic!("{dataset}: {attribute}: {error}")).to_string()
    }

    /// Every attribute of the root by its name, as text.
    pub fn attributes(&self) -> BTreeMap<String, String> {
        let names = self.file.attr_names().expect("names of attributes");
        let text = |name: &str| {
            let kind = self.file.attr(name).and_then(|attribute| attribute.dtype()?.to_descriptor());
            match kind.unwrap_or_else(|error| panic!("{name}: {error}")) {
                TypeDescriptor::VarLenUnicode => self.text(name),
                TypeDescriptor::VarLenAscii => {
                    let read = self.file.attr(name).and_then(|attribute| attribute.read_scalar::<VarLenAscii>());
                    read.unwrap_or_else(|error| panic!("{name}: {error}")).to_string()
                }
                _ => self.number(name).to_string(),
            }
        };
        names.into_iter().map(|name| (name.clone(), text(&name))).collect()
    }

    /// Shape of the chunks of a dataset.
    pub fn chunk(&self, dataset: &str) -> Option<Vec<usize>> {
        self.dataset(dataset).chunk()
    }

    /// Every dataset of the file by its path.
    pub fn content(&self) -> BTreeMap<String, Content> {
        let mut content = BTreeMap::new();
        let mut groups: Vec<Group> = vec![self.file.as_group().expect("the root")];
        while let Some(group) = groups.pop() {
            groups.extend(group.groups().expect("groups"));
            for dataset in group.datasets().expect("datasets") {
                let path = dataset.name();
                let kind = dataset.dtype().and_then(|dtype| dtype.to_descriptor()).expect("a known type");
                let bits = match kind {
                    TypeDescriptor::Enum(_) => self.bytes(&path).into_iter().map(u64::from).collect(),
                    TypeDescriptor::Integer(_) => {
                        dataset.read_raw::<i64>().expect("whole numbers").into_iter().map(i64::cast_unsigned).collect()
                    }
                    TypeDescriptor::VarLenUnicode => {
                        let texts = dataset.read_raw::<VarLenUnicode>().expect("texts");
                        let bytes = texts.iter().flat_map(|text| text.as_bytes().iter().copied().chain([0]));
                        bytes.map(u64::from).collect()
                    }
                    _ => self.floats(&path).into_iter().map(f64::to_bits).collect(),
                };
                content.insert(path, Content { shape: dataset.shape(), bits });
            }
        }
        content
    }

    fn dataset(&self, path: &str) -> Dataset {
        self.file.dataset(path).unwrap_or_else(|error| panic!("{path}: {error}"))
    }
}
