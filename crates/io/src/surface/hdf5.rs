//! Heights and fibre maps in HDF5 files: shape (columns, rows), heights in m.

use std::path::Path;

use hdf5::Dataset;
use hdf5::types::{TypeDescriptor, VarLenUnicode};
use ndarray::ArrayView2;
use plateau_core::model::state::Base;
use plateau_core::surface::Patch;
use thiserror::Error;

use super::options::MOST_POINTS;
use crate::hdf5_file::{self, OpenError, text_attribute};
use crate::memory::{NoRoom, refuse_beyond};
use crate::text::short;

/// Why an HDF5 file gives no surface.
#[derive(Debug, Error)]
pub enum Hdf5Error {
    /// The library cannot make sense of it.
    #[error("cannot be read as HDF5: {0}")]
    Library(#[from] hdf5::Error),
    /// Some of it is in other files.
    #[error("{0}; copy what it points to into this file, for only files that are read whole are named in results")]
    Elsewhere(String),
    /// The dataset is not there.
    #[error("the file has no dataset \"{dataset}\"; {present}")]
    Missing {
        /// The dataset asked for.
        dataset: String,
        /// The datasets of the file.
        present: String,
    },
    /// No dataset was named and the file does not leave one choice.
    #[error("the file has {found} datasets with {wanted}, expected one: name it with dataset = \"...\"; {present}")]
    Ambiguous {
        /// How many could be meant.
        found: usize,
        /// What is looked for.
        wanted: String,
        /// The datasets of the file.
        present: String,
    },
    /// The dataset holds something else.
    #[error("dataset {dataset} has {found}, expected {wanted}")]
    Unsuitable {
        /// The dataset.
        dataset: String,
        /// Its type and shape.
        found: String,
        /// What is looked for.
        wanted: String,
    },
    /// More points than are read.
    #[error("dataset {dataset} has shape ({}, {}), which is more than the {MOST_POINTS} points that are read", shape.0, shape.1)]
    TooLarge {
        /// The dataset.
        dataset: String,
        /// Its shape.
        shape: (usize, usize),
    },
    /// An attribute that says something else.
    #[error("dataset {dataset} has the attribute {found}, expected {expected}")]
    Attribute {
        /// The dataset.
        dataset: String,
        /// The attribute and its value.
        found: String,
        /// What can be.
        expected: &'static str,
    },
    /// More than memory holds.
    #[error("the heights of dataset {dataset} need {no_room}")]
    Memory {
        /// The dataset.
        dataset: String,
        /// How much is needed, and is there.
        no_room: NoRoom,
    },
    /// Infinite heights.
    #[error(
        "{count} of {points} heights in dataset {dataset} are infinite, expected heights in m, NaN for a missing point"
    )]
    Infinite {
        /// The dataset.
        dataset: String,
        /// Infinite heights.
        count: usize,
        /// All heights.
        points: usize,
    },
    /// A base that is none.
    #[error("dataset {dataset} has {found} at (column {column}, row {row}), expected 0 = none or 1 = primary")]
    Base {
        /// The dataset.
        dataset: String,
        /// What stands there.
        found: i64,
        /// Pin column.
        column: usize,
        /// Row.
        row: usize,
    },
}

/// Datasets named in a message.
const NAMED: usize = 12;

impl From<OpenError> for Hdf5Error {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Hdf5(error) => Self::Library(error),
            elsewhere => Self::Elsewhere(elsewhere.to_string()),
        }
    }
}

/// What is looked for.
#[derive(Clone, Copy)]
enum Wanted {
    Heights,
    /// Shape (columns, rows).
    Base((usize, usize)),
}

impl Wanted {
    fn fits(self, dataset: &Dataset) -> bool {
        let number = descriptor(dataset);
        match (self, dataset.shape()[..].as_ref()) {
            (Self::Heights, [_, _]) => matches!(number, Some(TypeDescriptor::Float(_))),
            (Self::Base(expected), &[columns, rows]) => {
                (columns, rows) == expected
                    && matches!(
                        number,
                        Some(
                            TypeDescriptor::Integer(_)
                                | TypeDescriptor::Unsigned(_)
                                | TypeDescriptor::Enum(_)
                                | TypeDescriptor::Boolean
                        )
                    )
            }
            _ => false,
        }
    }

    fn describe(self) -> String {
        match self {
            Self::Heights => "floating-point numbers and 2 dimensions (columns, rows)".to_owned(),
            Self::Base((columns, rows)) => format!("integers and shape (pin_columns, rows) = ({columns}, {rows})"),
        }
    }
}

/// Heights of an HDF5 file, column by column.
pub(super) struct Heights {
    pub(super) dataset: String,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Distance of neighbouring points along x and y, m, if the dataset states it.
    pub(super) pitch: Option<[f64; 2]>,
    pub(super) heights: Vec<f64>,
}

/// Reads heights, m: floating-point numbers with 2 dimensions (columns, rows), NaN where there is none. Without a name
/// the file's only suitable dataset is taken. Its attribute `units` may say that, `pitch` the distance of the points.
///
/// # Errors
/// [`Hdf5Error`] when the file is damaged or the dataset missing, unsuitable or infinite.
pub(super) fn heights(path: &Path, dataset: Option<&str>) -> Result<Heights, Hdf5Error> {
    let (dataset, pitch) = hdf5_file::guarded(0, || {
        let dataset = find(path, dataset, Wanted::Heights)?;
        refuse_other_units(&dataset)?;
        let pitch = pitch(&dataset)?;
        Ok::<_, Hdf5Error>((dataset, pitch))
    })?;
    let (name, (columns, rows)) = (dataset.name(), bounded_shape(&dataset)?);
    hdf5_file::refuse_hollow(&dataset)?;
    // The heights, and what the library converts or inflates at a time, at most all of them.
    let needed = (2 * columns * rows * size_of::<f64>()) as u64;
    refuse_beyond(needed).map_err(|no_room| Hdf5Error::Memory { dataset: name.clone(), no_room })?;
    let heights = hdf5_file::guarded(columns * rows * size_of::<f64>(), || dataset.read_raw::<f64>())?;
    let count = heights.iter().filter(|height| height.is_infinite()).count();
    if count > 0 {
        return Err(Hdf5Error::Infinite { dataset: name, count, points: heights.len() });
    }
    Ok(Heights { dataset: name, columns, rows, pitch, heights })
}

/// Refuses heights that say of themselves that they are not in m.
fn refuse_other_units(dataset: &Dataset) -> Result<(), Hdf5Error> {
    let Some(found) = text_attribute(dataset, "units")? else { return Ok(()) };
    if ["m", "metre", "metres", "meter", "meters"].contains(&found.as_str()) {
        return Ok(());
    }
    let found = format!("units = \"{}\"", short(&found).escape_debug());
    Err(Hdf5Error::Attribute { dataset: dataset.name(), found, expected: "\"m\"" })
}

/// The attribute `pitch`, m: one length, or those along x and y.
fn pitch(dataset: &Dataset) -> Result<Option<[f64; 2]>, Hdf5Error> {
    let Ok(attribute) = dataset.attr("pitch") else { return Ok(None) };
    let number = attribute.dtype()?.to_descriptor()?;
    let lengths = match (number, attribute.space()?.size()) {
        (TypeDescriptor::Float(_) | TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_), 1 | 2) => {
            attribute.read_raw::<f64>()?
        }
        _ => Vec::new(),
    };
    // One length is that along both.
    let lengths = if let [both] = lengths[..] { vec![both; 2] } else { lengths };
    match lengths[..] {
        [x, y] if x > 0.0 && y > 0.0 && x.is_finite() && y.is_finite() => Ok(Some([x, y])),
        _ => Err(Hdf5Error::Attribute {
            dataset: dataset.name(),
            found: format!("pitch = {lengths:?}"),
            expected: "the distance of points along x and y in m, positive and finite",
        }),
    }
}

/// Writes the heights of a patch as the dataset `/height` of a new file: float64, shape (columns, rows), m, NaN where a
/// point is missing, with the attributes `units` and `pitch` (m, along x and y).
///
/// # Errors
/// [`Hdf5Error::Library`] when the file cannot be written, or the patch has other than columns times rows heights.
pub fn write(path: &Path, patch: &Patch) -> Result<(), Hdf5Error> {
    let shape = (patch.columns, patch.rows);
    let heights =
        ArrayView2::from_shape(shape, &patch.heights).map_err(|error| hdf5::Error::from(error.to_string()))?;
    let file = hdf5::File::create(path)?;
    let dataset = file.new_dataset_builder().with_data(heights).create("height")?;
    for (name, text) in [("units", "m"), ("long_name", "height, columns along the sliding direction, rows outward")] {
        let text: VarLenUnicode = text.parse().map_err(|error| hdf5::Error::from(format!("{error}")))?;
        dataset.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text)?;
    }
    let pitch = [patch.column_pitch, patch.row_pitch];
    dataset.new_attr::<f64>().shape(2).create("pitch")?.write_raw(&pitch)?;
    // The library writes some values when the dataset is closed, and then nobody hears that it failed.
    file.flush()?;
    drop(dataset);
    file.close()?;
    Ok(())
}

/// Reads a fibre map: integers of shape (columns, rows), 0 = none and 1 = primary; what stands where `is_there` says that there
/// is no cell, does not matter. Gives the dataset's name too.
///
/// # Errors
/// [`Hdf5Error`] when the file is damaged or the dataset missing, unsuitable or holds another number.
pub(super) fn base(
    path: &Path,
    dataset: Option<&str>,
    shape: (usize, usize),
    is_there: impl Fn(usize) -> bool,
) -> Result<(String, Vec<Base>), Hdf5Error> {
    let dataset = hdf5_file::guarded(0, || find(path, dataset, Wanted::Base(shape)))?;
    hdf5_file::refuse_hollow(&dataset)?;
    let name = dataset.name();
    let numbers = hdf5_file::guarded(shape.0 * shape.1 * size_of::<i64>(), || dataset.read_raw::<i64>())?;
    let base = numbers.into_iter().enumerate().map(|(cell, number)| match number {
        0 => Ok(Base::Resin),
        1 => Ok(Base::Primary),
        _ if !is_there(cell) => Ok(Base::Resin),
        found => Err(Hdf5Error::Base { dataset: name.clone(), found, column: cell / shape.1, row: cell % shape.1 }),
    });
    let base = base.collect::<Result<_, _>>()?;
    Ok((name, base))
}

/// The dataset of that name, or the only suitable one.
fn find(path: &Path, dataset: Option<&str>, wanted: Wanted) -> Result<Dataset, Hdf5Error> {
    let (file, mut all) = hdf5_file::open_with_datasets(path)?;
    all.sort_by_key(|dataset| dataset.name());
    let Some(name) = dataset else {
        let mut suitable: Vec<&Dataset> = all.iter().filter(|dataset| wanted.fits(dataset)).collect();
        return match (suitable.pop(), suitable.len()) {
            (Some(only), 0) => Ok(only.clone()),
            (last, others) => Err(Hdf5Error::Ambiguous {
                found: others + usize::from(last.is_some()),
                wanted: wanted.describe(),
                present: list(&all),
            }),
        };
    };
    let Ok(dataset) = file.dataset(name) else {
        return Err(Hdf5Error::Missing { dataset: name.to_owned(), present: list(&all) });
    };
    if wanted.fits(&dataset) {
        Ok(dataset)
    } else {
        Err(Hdf5Error::Unsuitable { dataset: dataset.name(), found: describe(&dataset), wanted: wanted.describe() })
    }
}

fn list(datasets: &[Dataset]) -> String {
    if datasets.is_empty() {
        return "it has no datasets".to_owned();
    }
    let mut names: Vec<String> = datasets
        .iter()
        .take(NAMED)
        .map(|dataset| format!("{} ({})", short(&dataset.name()), describe(dataset)))
        .collect();
    if datasets.len() > NAMED {
        names.push(format!("and {} more", datasets.len() - NAMED));
    }
    format!("it has {}", names.join(", "))
}

fn describe(dataset: &Dataset) -> String {
    let number = descriptor(dataset).map_or_else(|| "an unknown type".to_owned(), |number| number.to_string());
    let shape: Vec<String> = dataset.shape().iter().map(ToString::to_string).collect();
    format!("{number}, shape ({})", shape.join(", "))
}

fn descriptor(dataset: &Dataset) -> Option<TypeDescriptor> {
    dataset.dtype().and_then(|dtype| dtype.to_descriptor()).ok()
}

fn bounded_shape(dataset: &Dataset) -> Result<(usize, usize), Hdf5Error> {
    let shape = dataset.shape();
    let (columns, rows) = (shape.first().copied().unwrap_or(0), shape.get(1).copied().unwrap_or(0));
    match columns.checked_mul(rows) {
        Some(points) if points <= MOST_POINTS => Ok((columns, rows)),
        _ => Err(Hdf5Error::TooLarge { dataset: dataset.name(), shape: (columns, rows) }),
    }
}
