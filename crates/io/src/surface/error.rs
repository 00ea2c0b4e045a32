//! Reasons why the initial surfaces of a scene cannot be made, and why an HDF5 file or a text file gives none.

use std::io;
use std::path::PathBuf;

use plateau_core::surface::micrograph::MicrographError;
use plateau_core::surface::{FibreError, PreparationError, SynthesisError};
use thiserror::Error;

use super::format::{CONVERSION, Format, Instrument};
use super::image::ImageError;
use super::measured::{Disagreement, MOST_POINTS, ProfileError};
use super::npy::NpyError;
use super::sdf::SdfError;
use crate::delimited::Decimal;
use crate::hdf5_file::OpenError;
use crate::memory::NoRoom;
use crate::number;
use crate::run_file::ReadError;
use crate::text::list;

/// Reason why the initial surfaces of a scene cannot be made; `key` is the scene's table that asked for it.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum SurfaceError {
    #[error("{key}: {}: {reason}", path.display())]
    File {
        key: &'static str,
        path: PathBuf,
        #[source]
        reason: FileError,
    },
    #[error("{key}: {reason}")]
    Synthesis { key: &'static str, reason: SynthesisError },
    #[error("{key}: {reason}")]
    Fibre { key: &'static str, reason: FibreError },
    #[error("{key}: {source_name}: {reason}")]
    Preparation { key: &'static str, source_name: String, reason: PreparationError },
}

/// Reason why a surface file cannot be read.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum FileError {
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
    #[error("this is a folder, expected a surface file: name one in it")]
    Folder,
    #[error("this is not a regular file")]
    NotAFile,
    #[error("this is not a surface file that is known ({found}); {READABLE}{}", by_conversion(*is_binary))]
    Unknown { found: String, is_binary: bool },
    #[error("this is {}, which is not read as it is; {CONVERSION}{}", .0.name, skipped(.0.is_text))]
    Instrument(Instrument),
    #[error("this is {0}, which is not read: save the sheet with the heights as CSV")]
    Workbook(&'static str),
    #[error("this is a damaged zip archive: {0}")]
    Zip(String),
    #[error("this is {0}, expected an image: PNG, TIFF or JPEG")]
    NotAnImage(Format),
    #[error("this is {0}, expected an HDF5 file with integers 0 = none and 1 = primary")]
    NotABase(Format),
    #[error("the file states {found}, expected {expected}: is it damaged, or its unit another?")]
    Absurd { found: String, expected: String },
    #[error("this is {format}, which has no datasets: leave out dataset = \"{dataset}\"")]
    NoDatasets { format: Format, dataset: String },
    #[error("this is {format}, for which {key} has no meaning: leave it out")]
    Meaningless { format: Format, key: &'static str },
    #[error(transparent)]
    Disagree(#[from] Disagreement),
    #[error(
        "the dataset is of the other body, whose z has the other sign: disc.surface takes /disc/height, pin.surface /pin/height"
    )]
    OtherBody,
    #[error(
        "the file does not say the distance of its points: pitch = \"50 um\" below file in the scene does, for example"
    )]
    NoPitchOfFile,
    #[error(
        "{what}there are {} columns and {} rows, expected {} and {} for the whole body; as a patch they need a pitch: \
         pitch = \"50 um\" below file in the scene, for example",
        found.0, found.1, mesh.0, mesh.1
    )]
    NoPitch { what: String, found: (usize, usize), mesh: (usize, usize) },
    #[error(transparent)]
    Sdf(#[from] SdfError),
    #[error(transparent)]
    Hdf5(Box<Hdf5Error>),
    #[error(transparent)]
    Npy(#[from] NpyError),
    #[error(transparent)]
    Image(#[from] ImageError),
    #[error(
        "{reason}; a TIFF of an instrument (JPK .jpk, Park, Olympus .lext) has its heights elsewhere in the file: {CONVERSION}"
    )]
    Tiff { reason: ImageError },
    #[error(transparent)]
    Micrograph(#[from] MicrographError),
    #[error(transparent)]
    Text(#[from] TextError),
    #[error(transparent)]
    Profile(#[from] ProfileError),
}

impl FileError {
    /// Tells whether the Python package may convert the file.
    pub fn may_be_converted(&self) -> bool {
        match self {
            Self::Instrument(_) | Self::Tiff { .. } => true,
            Self::Unknown { is_binary, .. } => *is_binary,
            Self::Hdf5(error) => matches!(**error, Hdf5Error::Zygo { .. }),
            _ => false,
        }
    }
}

/// Advises how else a text can be read; empty for a file that is none.
fn skipped(is_text: bool) -> &'static str {
    if is_text { "; or say how many lines stand before its table: skip = 12, for example" } else { "" }
}

impl From<Hdf5Error> for FileError {
    fn from(error: Hdf5Error) -> Self {
        Self::Hdf5(Box::new(error))
    }
}

const READABLE: &str = "SDF, HDF5, NumPy arrays, PNG, TIFF and text are read";

/// The line that converts a file that another program may know, behind what to do about any file; nothing for another.
fn by_conversion(is_binary: bool) -> String {
    if is_binary { format!("; if it is of an instrument, {CONVERSION}") } else { String::new() }
}

/// Reason why an HDF5 file gives no surface.
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
    #[error("this run file has no map {map}{}", at_time(at.as_ref()))]
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
fn at_time(at: Option<&(f64, Vec<f64>)>) -> String {
    let seconds = |time: &f64| format!("{} s", number::plain(*time));
    match at {
        None => ": output.maps of its scene says which are recorded".to_owned(),
        Some((at, times)) => format!(" at {}, its maps are at {}", seconds(at), list(times.iter().map(seconds), ", ")),
    }
}

/// Reason why a text file gives no surface. Lines count from 1.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum TextError {
    #[error("the file has no line of numbers")]
    NoNumbers,
    #[error(
        "the file does not say the unit of its heights: unit = \"um\" below file in the scene does, or \"2.9e-8 m\" for what the \
         number 1 stands for"
    )]
    NoUnit,
    #[error(
        "line {line}: found \"{found}\", expected numbers, a comment (#), \"name = value\", or the names of columns \
         x, y, z: {}", advice(*skip)
    )]
    Line { line: usize, found: String, skip: Option<usize> },
    #[error("line {line}, column {column}: {}", in_words(*fault, found, beside.as_deref()))]
    Cell { line: usize, column: usize, found: String, fault: Fault, beside: Option<Box<str>> },
    #[error(
        "line {line}, column {column}: a coordinate is missing, expected a number: only heights may be missing; are the columns in another \
         order than x, y, z? Names above them say which is which, such as x z y"
    )]
    NoCoordinate { line: usize, column: usize },
    #[error(
        "line {line}: another table begins here, {sign} (\"{found}\"), and a surface has one: dataset = \"1\" below file in the scene \
         chooses the first of the {tables}; if all is one surface, take blank lines and headers out of it"
    )]
    Several { line: usize, sign: &'static str, found: String, tables: usize },
    #[error("dataset = \"{dataset}\", expected the number of a table of the file, which has {tables}")]
    NoTable { dataset: String, tables: usize },
    #[error(
        "line {line}, column {column}: \"{found}\" may be {} or {}: decimal = \",\" below file in the scene says the first; of a file with \
         thousands separators save one without",
        found.replace(',', "."), found.replace(',', "")
    )]
    AmbiguousComma { line: usize, column: usize, found: String },
    #[error(
        "line {line}: commas of \"{found}\" may be decimal or may part numbers: decimal = \",\" below file in the scene says \
         the first, decimal = \".\" the second"
    )]
    CommaOrColumns { line: usize, found: String },
    #[error(
        "line {line}: \"{found}\" has commas between the numbers and within them, for none has \"{part}\" as a number of its own: save \
         the file with decimal points, or with semicolons between the numbers"
    )]
    CommaTwice { line: usize, found: String, part: String },
    #[error("line {line} has {found} numbers, expected {expected} as in line {first}")]
    Ragged { line: usize, found: usize, expected: usize, first: usize },
    #[error("the header states {expected} {what}, but the file has {found}")]
    Count { what: &'static str, expected: u64, found: usize },
    #[error(transparent)]
    Disagree(#[from] Disagreement),
    #[error(
        "{lines} lines of three numbers, the first two on no grid: a list of points needs x and y on a regular grid, a \
         matrix more columns (or the format .npy)"
    )]
    ThreeColumns { lines: usize },
    #[error(
        "all points have the same {axis}, expected a surface; for a profile say profile_lay = \"along\", \"across\" or \
         \"isotropic\" below file in the scene"
    )]
    Profile { axis: char },
    #[error("line {line}: {axis} = {found} lies off the regular grid from {first} in steps of {step}")]
    Irregular { line: usize, axis: char, found: f64, first: f64, step: f64 },
    #[error("the {points} points lie on a grid of {} x {}, which they hardly fill: expected a regular grid", grid.0, grid.1)]
    Sparse { points: usize, grid: (usize, usize) },
    #[error("line {line} has the same x and y as line {first}")]
    Twice { line: usize, first: usize },
    #[error("skip = {skip} leaves no line of the file")]
    AllSkipped { skip: u64 },
    #[error(
        "{lines} lines of {columns} {}: for a profile say profile_lay = \"along\", \"across\" or \"isotropic\" below file in the scene; a \
         surface needs more columns", if *columns == 1 { "number" } else { "numbers" }
    )]
    IsProfile { columns: usize, lines: usize },
    #[error(
        "profile_lay takes the file as a profile, but it has {lines} lines of {columns} numbers: expected heights in one line \
         or one column, distances and heights in two columns, or columns with names such as x [mm], z [um]"
    )]
    NoProfile { columns: usize, lines: usize },
    #[error("the profile has {points} point, expected two or more")]
    ShortProfile { points: usize },
    #[error(
        "the file does not say the unit of the distances along the profile, which are {} apart: pitch = \"0.5 um\" beside \
         file, for example, says how far the points are apart, or name the columns, such as x [mm], z [um]",
        short(*step)
    )]
    NoDistanceUnit { step: f64 },
    #[error(
        "line {line}: the distance {found} comes after {before}: along a profile distances only grow, or only fall"
    )]
    Disorder { line: usize, found: f64, before: f64 },
    #[error(
        "line {line}: the distance {found} is {:.0} % of the spacing {} off its even place {}, neighbours are {} to {} apart: \
         expected evenly spaced points; have the instrument or another program resample the profile",
        100.0 * (found - expected).abs() / step, short(*step), short(*expected), short(gaps[0]), short(gaps[1])
    )]
    Uneven { line: usize, found: f64, expected: f64, step: f64, gaps: [f64; 2] },
}

/// Fault of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum Fault {
    NotANumber,
    /// Decimal mark in place of the other one.
    Mark(Decimal),
    /// Digits in groups of three.
    Grouped,
    Infinite,
}

/// Says what is wrong with a cell; of a wrong mark with a number `beside` it that has the right one.
fn in_words(fault: Fault, found: &str, beside: Option<&str>) -> String {
    match fault {
        Fault::NotANumber => {
            format!("found \"{found}\", expected a number, or an empty cell, NaN, BAD or *** for a missing point")
        }
        Fault::Mark(mark) => format!("\"{found}\" has a decimal {}, {}", name(mark), other(mark, beside)),
        Fault::Grouped => format!(
            "\"{found}\" has digits in groups, expected a number without: save the file without thousands separators"
        ),
        Fault::Infinite => format!("{found} is not finite, expected a finite number, NaN for a missing point"),
    }
}

/// Advises how to leave out lines that are not understood.
fn advice(skip: Option<usize>) -> String {
    match skip {
        Some(lines) => format!("skip = {lines} below file in the scene leaves out the lines before the table"),
        None => "no lines of equally many numbers are seen below; skip = 12 below file in the scene, for example, leaves out the first twelve lines".to_owned(),
    }
}

fn name(mark: Decimal) -> &'static str {
    if mark == Decimal::Comma { "comma" } else { "point" }
}

/// Names the other decimal mark: that of a number `beside` this one, or of the numbers of the file.
fn other(mark: Decimal, beside: Option<&str>) -> String {
    let (other, key) = if mark == Decimal::Comma { (Decimal::Point, '.') } else { (Decimal::Comma, ',') };
    match beside {
        Some(found) => format!("and {found} a decimal {}: save the file with one of them", name(other)),
        None => format!("but numbers of this file have a decimal {} (decimal = \"{key}\")", name(other)),
    }
}

/// A number with six digits, which is enough for a message.
pub(super) fn short(number: f64) -> f64 {
    number::to_digits(number, 6)
}
