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
pub enum Hdf5Error {
    /// The system does not give it.
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
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
    /// Coordinates that are no regular grid.
    #[error(
        "dataset {dataset}: the coordinates of its dimension {dimension} {problem}: expected equidistant ones, resample the heights \
         on a regular grid"
    )]
    Coordinates {
        /// The dataset.
        dataset: String,
        /// The dimension.
        dimension: String,
        /// What its coordinates are.
        problem: String,
    },
    /// A file of Zygo.
    #[error("dataset {dataset} is of a Zygo file (.datx), which is not read as it is; {CONVERSION}")]
    Zygo {
        /// The dataset.
        dataset: String,
    },
    /// A run file that cannot be read.
    #[error(transparent)]
    Run(#[from] ReadError),
    /// A run file of which no map is named.
    #[error(
        "this is a run file: dataset = \"/disc/height\" takes its last map of the disc, dataset = \"/pin/height\" that of the \
         pin, at = \"100 s\" beside it one at another time"
    )]
    WhichMap,
    /// A map that a run file does not have.
    #[error("this run file has no map {map}{}", AtTime(at.as_ref()))]
    NoMap {
        /// Its dataset.
        map: &'static str,
        /// The time asked for and those that there are, s.
        at: Option<(f64, Vec<f64>)>,
    },
    /// A time of what no run recorded.
    #[error("at is a time of a map of heights of a run file, which {found} is not: leave it out")]
    NotRecorded {
        /// What was read.
        found: String,
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
