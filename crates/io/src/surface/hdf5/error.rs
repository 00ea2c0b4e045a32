//! Why an HDF5 file gives no surface.

use std::{fmt, io};

use thiserror::Error;

use crate::hdf5_file::OpenError;
use crate::memory::NoRoom;
use crate::number;
use crate::run_file::ReadError;
use crate::surface::format::CONVERSION;
use crate::surface::options::MOST_POINTS;
use crate::text::list;

/// Why an HDF5 file gives no surface.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum Hdf5Error {
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
    #[error("cannot be read as HDF5: {0}")]
    Library(#[from] hdf5::Error),
    #[error("{0}; copy what it points to into this file, for only files that are read whole are named in results")]
    Elsewhere(String),
    #[error("the file has no dataset \"{dataset}\"; {present}")]
    Missing { dataset: String, present: String },
    #[error("the file has {found} datasets with {wanted}, expected one: name it with dataset = \"...\"; {present}")]
    Ambiguous { found: usize, wanted: String, present: String },
    #[error("dataset {dataset} has {found}, expected {wanted}")]
    Unsuitable { dataset: String, found: String, wanted: String },
    #[error("dataset {dataset} has shape ({}, {}), which is more than the {MOST_POINTS} points that are read", shape.0, shape.1)]
    TooLarge { dataset: String, shape: (usize, usize) },
    #[error(
        "dataset {dataset}: the coordinates of its dimension {dimension} {problem}: expected equidistant ones, resample the heights \
         on a regular grid"
    )]
    Coordinates { dataset: String, dimension: String, problem: String },
    #[error("dataset {dataset} is of a Zygo file (.datx), which is not read as it is; {CONVERSION}")]
    Zygo { dataset: String },
    #[error(transparent)]
    Run(#[from] ReadError),
    #[error(
        "this is a run file: dataset = \"/disc/height\" takes its last map of the disc, dataset = \"/pin/height\" that of the \
         pin, at = \"100 s\" beside it one at another time"
    )]
    WhichMap,
    #[error("this run file has no map {map}{}", AtTime(at.as_ref()))]
    NoMap { map: &'static str, at: Option<(f64, Vec<f64>)> },
    #[error("at is a time of a map of heights of a run file, which {found} is not: leave it out")]
    NotRecorded { found: String },
    #[error("dataset {dataset} has the attribute {found}, expected {expected}")]
    Attribute { dataset: String, found: String, expected: &'static str },
    #[error("the heights of dataset {dataset} need {no_room}")]
    Memory { dataset: String, no_room: NoRoom },
    #[error(
        "{count} of {points} heights in dataset {dataset} are infinite, expected heights in m, NaN for a missing point"
    )]
    Infinite { dataset: String, count: usize, points: usize },
    #[error("dataset {dataset} has {found} at (column {column}, row {row}), expected 0 = none or 1 = primary")]
    Base { dataset: String, found: i64, column: usize, row: usize },
}

impl From<OpenError> for Hdf5Error {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::System(error) => Self::System(error),
            OpenError::Hdf5(error) => Self::Library(error),
            elsewhere => Self::Elsewhere(elsewhere.to_string()),
        }
    }
}

/// The time that was asked for, and those that there are, in words.
struct AtTime<'a>(Option<&'a (f64, Vec<f64>)>);

impl fmt::Display for AtTime<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = |time: &f64| format!("{} s", number::plain(*time));
        match self.0 {
            None => f.write_str(": output.maps of its scene says which are recorded"),
            Some((at, times)) => {
                write!(f, " at {}, its maps are at {}", seconds(at), list(times.iter().map(seconds), ", "))
            }
        }
    }
}
