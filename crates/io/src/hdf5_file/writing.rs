//! HDF5 files opened for writing, attributes, and dimension scales: what gives the axes of a dataset names and coordinates in h5py, xarray
//! and netCDF4.
//!
//! The conventions are those of the HDF5 "Dimension Scale Specification": a scale has the attributes CLASS and NAME, and
//! REFERENCE_LIST names its users; a user's DIMENSION_LIST holds references to its scales.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use hdf5::file::{File, FileBuilder};
use hdf5::types::{FixedAscii, VarLenArray, VarLenUnicode};
use hdf5::{Dataset, Datatype, H5Type, Location, ObjectReference1};

use super::inspection::in_words;

/// Chunk cache of a dataset: slots, bytes, and 1 for "a chunk that is full goes first".
///
/// Nothing is read back, so it need hold no more than the chunk of a series that is being filled; a chunk of a map is written
/// at once. Every dataset has one that grows to its size.
const CHUNK_CACHE: (usize, usize, f64) = (31, 16 * 1024, 1.0);

/// Opens a file for writing, in the format that readers can follow.
///
/// Without locks, since many network file systems have none. They would protect nothing: HDF5 gives them up when
/// readers are let in, and marks the file itself as being written.
pub(crate) fn open_for_writing(path: &Path) -> hdf5::Result<File> {
    let (slots, bytes, preemption) = CHUNK_CACHE;
    FileBuilder::new()
        .with_fapl(|list| list.libver_v110().file_locking(false).chunk_cache(slots, bytes, preemption))
        .open_rw(path)
}

/// Sets a text attribute, new or not.
pub(crate) fn write_text(location: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    // HDF5 ends a text at a null character; there is no other way to store one.
    let text = VarLenUnicode::from_str(&text.replace('\0', "\u{fffd}")).map_err(in_words)?;
    match location.attr(name) {
        Ok(attribute) => attribute.write_scalar(&text),
        Err(_) => location.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text),
    }
}

/// Adds an attribute that is one number.
pub(crate) fn write_number<T: H5Type>(location: &Location, name: &str, number: T) -> hdf5::Result<()> {
    location.new_attr::<T>().create(name)?.write_scalar(&number)
}

/// An HDF5 file without any objects. Its root group keeps the order in which links are made, and has one attribute,
/// CLASS = "DIMENSION_SCALE" as the specification wants it: 16 bytes, null-terminated.
///
/// The crate `hdf5` makes null-padded strings only, with which the HDF5 library does not recognise a dimension scale.
/// This file is where the type comes from; every run file starts as a copy of it. What says how a file is organised lies in
/// pages of 4 KiB here, so that a process that is killed while it writes has written the whole of a piece or nothing of it: a
/// system ends a write at the end of a page of memory. It was made by h5py:
/// ```python
/// options = dict(libver=("v110", "v110"), track_order=True, fs_strategy="page", fs_page_size=4096)
/// with h5py.File("empty.h5", "w", **options) as file:
///     text = h5py.h5t.C_S1.copy(); text.set_size(16); text.set_strpad(h5py.h5t.STR_NULLTERM)
///     attribute = h5py.h5a.create(file.id, b"CLASS", text, h5py.h5s.create(h5py.h5s.SCALAR))
///     attribute.write(numpy.array(b"DIMENSION_SCALE", dtype="S16"))
/// ```
pub(crate) const EMPTY_FILE: &[u8] = include_bytes!("empty.h5");

/// Attribute of a dataset: the scales of its dimensions.
const DIMENSION_LIST: &str = "DIMENSION_LIST";

type Text = FixedAscii<16>;

/// One entry of REFERENCE_LIST: a dataset, and which of its axes the scale describes.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
struct Axis {
    dataset: ObjectReference1,
    dimension: i32,
}

/// The dimension scales of a file that started as [`EMPTY_FILE`].
pub(crate) struct Dimensions {
    file: File,
    text: Datatype,
    users: BTreeMap<&'static str, Vec<Axis>>,
}

impl Dimensions {
    /// Takes the string type out of the file.
    pub(crate) fn new(file: &File) -> hdf5::Result<Self> {
        let text = file.attr("CLASS")?.dtype()?;
        file.delete_attr("CLASS")?;
        Ok(Self { file: file.clone(), text, users: BTreeMap::new() })
    }

    /// Makes the dataset with this path the scale of the dimension that has its name.
    pub(crate) fn make_scale(&mut self, dataset: &Dataset, name: &'static str) -> hdf5::Result<()> {
        let title = name.rsplit('/').next().unwrap_or(name);
        for (attribute, value) in [("CLASS", "DIMENSION_SCALE"), ("NAME", title)] {
            let value = Text::from_ascii(value).map_err(in_words)?;
            dataset.new_attr_builder().empty_as(self.text.clone()).create(attribute)?.write_scalar(&value)?;
        }
        self.users.insert(name, Vec::new());
        Ok(())
    }

    /// Names the axes of a dataset by scales made before.
    pub(crate) fn attach(&mut self, dataset: &Dataset, dimensions: &[&'static str]) -> hdf5::Result<()> {
        let itself: ObjectReference1 = self.file.reference(&dataset.name())?;
        let mut scales = Vec::with_capacity(dimensions.len());
        for (dimension, name) in (0..).zip(dimensions) {
            scales.push(VarLenArray::from_slice(&[self.file.reference::<ObjectReference1>(name)?]));
            self.users.entry(name).or_default().push(Axis { dataset: itself, dimension });
        }
        dataset
            .new_attr::<VarLenArray<ObjectReference1>>()
            .shape(scales.len())
            .create(DIMENSION_LIST)?
            .write_raw(&scales)
    }

    /// Writes into every scale which datasets it describes.
    pub(crate) fn finish(self) -> hdf5::Result<()> {
        for (name, users) in self.users.iter().filter(|(_, users)| !users.is_empty()) {
            let scale = self.file.dataset(name)?;
            scale.new_attr::<Axis>().shape(users.len()).create("REFERENCE_LIST")?.write_raw(users)?;
        }
        Ok(())
    }
}
