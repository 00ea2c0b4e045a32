//! HDF5 files of results: named values over named dimensions, with netCDF-4 conventions as in run files. They appear
//! under their name when they are complete.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::SystemTime;

use hdf5::file::FileBuilder;
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, File, H5Type, Location};
use thiserror::Error;

use crate::hdf5_file::{Dimensions, EMPTY_FILE, in_words, write_number, write_text};
use crate::run_file::layout::CONVENTIONS;
use crate::temporary::Temporary;
use crate::timestamp::iso_8601;

/// Level of compression: higher ones gain nothing.
const DEFLATE: u8 = 1;

/// A name or a short text.
pub type Name = Cow<'static, str>;

/// Content of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Content {
    /// Attributes of the root.
    pub attributes: Vec<(&'static str, Attribute)>,
    /// Dimensions, each with a coordinate of its name.
    pub dimensions: Vec<Coordinate>,
    /// Datasets.
    pub variables: Vec<Variable>,
}

/// Value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// A text.
    Text(String),
    /// A number.
    Number(f64),
    /// A count.
    Integer(i64),
}

/// A dimension and where its values lie along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordinate {
    /// Its name.
    pub name: &'static str,
    /// SI unit.
    pub unit: Name,
    /// Its meaning, in words.
    pub long_name: Name,
    /// One value for each place along the dimension.
    pub values: Vec<f64>,
}

/// A dataset.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: Name,
    /// Names of its dimensions, the slowest first.
    pub dimensions: Vec<&'static str>,
    /// SI unit; empty for texts.
    pub unit: Name,
    /// Its meaning, in words.
    pub long_name: Name,
    /// Other statements about it.
    pub attributes: Vec<(&'static str, Attribute)>,
    /// One value for each place, the last dimension the fastest.
    pub values: Values,
}

/// Values of a dataset.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; NaN where there is none.
    Float(Vec<f64>),
    /// Counts.
    Integer(Vec<i64>),
    /// Texts.
    Text(Vec<String>),
    /// Numbers that come row by row, along two dimensions: see [`write_rows`]. NaN where none came.
    Rows,
}

/// Reason why a file cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("cannot write {}: {reason}", path.display())]
pub struct DatasetFileError {
    /// The file.
    pub path: PathBuf,
    /// Message of the HDF5 library or of the system.
    pub reason: String,
}

/// Writes a file that appears under its name when it is complete; takes the place of another only with `replace`. Variables of
/// [`Values::Rows`] get their rows from `give`, one by one, so that they need not all be in memory.
///
/// # Errors
/// Those of `give`, and [`DatasetFileError`]; after either nothing has changed at `path`.
pub fn write_rows<E: From<DatasetFileError>>(
    path: &Path,
    replace: bool,
    content: &Content,
    give: impl FnOnce(&Rows<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let failed = |reason: String| DatasetFileError { path: path.into(), reason };
    // In a folder of results: a link of that name is replaced, not what it leads to.
    let started = Temporary::create(path).and_then(|(temporary, mut file)| {
        file.write_all(EMPTY_FILE)?;
        Ok(temporary)
    });
    let temporary = started.map_err(|error| failed(error.to_string()))?;
    let (file, datasets) = create(temporary.path(), content).map_err(|error| failed(error.to_string()))?;
    give(&Rows { file: &file, path })?;
    // The library writes some values when a dataset is closed, and then nobody hears that it failed.
    file.flush().map_err(|error| failed(error.to_string()))?;
    drop(datasets);
    file.close().map_err(|error| failed(error.to_string()))?;
    Ok(temporary.publish(replace).map_err(|error| failed(error.to_string()))?)
}

/// Takes the rows of variables of [`Values::Rows`].
#[derive(Debug)]
pub struct Rows<'a> {
    file: &'a File,
    path: &'a Path,
}

impl Rows<'_> {
    /// A row, from its beginning on; the rest stays NaN.
    pub fn put(&self, name: &str, row: usize, values: &[f64]) -> Result<(), DatasetFileError> {
        let write = || self.file.dataset(name)?.write_slice(values, (row, 0..values.len()));
        write().map_err(|error| DatasetFileError { path: self.path.into(), reason: error.to_string() })
    }
}

/// Now, as run files write points in time.
pub fn now() -> String {
    iso_8601(SystemTime::now())
}

fn create(path: &Path, content: &Content) -> hdf5::Result<(File, Vec<Dataset>)> {
    let file = FileBuilder::new().with_fapl(|list| list.libver_v110().file_locking(false)).open_rw(path)?;
    let mut dimensions = Dimensions::new(&file)?;
    for name in ["conventions", "Conventions"] {
        write_text(&file, name, CONVENTIONS)?;
    }
    write_attributes(&file, &content.attributes)?;
    let mut datasets = Vec::with_capacity(content.dimensions.len() + content.variables.len());
    let mut lengths = BTreeMap::new();
    for Coordinate { name, unit, long_name, values } in &content.dimensions {
        lengths.insert(*name, values.len());
        let scale = dataset(&file, name, &[values.len()], unit, long_name, values)?;
        dimensions.make_scale(&scale, name)?;
        datasets.push(scale);
    }
    for Variable { name, dimensions: along, unit, long_name, attributes, values } in &content.variables {
        let shape: Vec<usize> = along.iter().map(|name| lengths.get(name).copied().unwrap_or(0)).collect();
        let dataset = match values {
            Values::Float(values) => dataset(&file, name, &shape, unit, long_name, values)?,
            Values::Integer(values) => dataset(&file, name, &shape, unit, long_name, values)?,
            Values::Rows => rows(&file, name, &shape, unit, long_name)?,
            Values::Text(texts) => {
                let texts: Result<Vec<_>, _> =
                    texts.iter().map(|text| VarLenUnicode::from_str(&text.replace('\0', "\u{fffd}"))).collect();
                let texts = texts.map_err(in_words)?;
                dataset(&file, name, &shape, unit, long_name, &texts)?
            }
        };
        write_attributes(&dataset, attributes)?;
        dimensions.attach(&dataset, along)?;
        datasets.push(dataset);
    }
    dimensions.finish()?;
    Ok((file, datasets))
}

fn write_attributes(location: &Location, attributes: &[(&'static str, Attribute)]) -> hdf5::Result<()> {
    attributes.iter().try_for_each(|(name, attribute)| match attribute {
        Attribute::Text(text) => write_text(location, name, text),
        Attribute::Number(number) => write_number(location, name, *number),
        Attribute::Integer(integer) => write_number(location, name, *integer),
    })
}

fn dataset<T: H5Type>(
    file: &File,
    name: &str,
    shape: &[usize],
    unit: &str,
    long_name: &str,
    values: &[T],
) -> hdf5::Result<Dataset> {
    let dataset = file.new_dataset::<T>().shape(shape).create(name)?;
    dataset.write_raw(values)?;
    describe(&dataset, unit, long_name)?;
    Ok(dataset)
}

/// A dataset whose rows come later.
fn rows(file: &File, name: &str, shape: &[usize], unit: &str, long_name: &str) -> hdf5::Result<Dataset> {
    let builder = file.new_dataset::<f64>().fill_value(f64::NAN);
    let dataset = match shape {
        // A row is what is written and read at once; an empty one cannot be a chunk.
        [_, columns] if shape.iter().all(|length| *length > 0) => {
            builder.chunk((1, *columns)).shuffle().deflate(DEFLATE).shape(shape).create(name)?
        }
        _ => builder.shape(shape).create(name)?,
    };
    describe(&dataset, unit, long_name)?;
    Ok(dataset)
}

fn describe(dataset: &Dataset, unit: &str, long_name: &str) -> hdf5::Result<()> {
    if !unit.is_empty() {
        write_text(dataset, "units", unit)?;
    }
    write_text(dataset, "long_name", long_name)
}

#[cfg(test)]
#[path = "../tests/unit/dataset_file.rs"]
mod tests;
