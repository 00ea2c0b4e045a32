//! Why the initial surfaces of a scene cannot be made.

use std::path::PathBuf;
use std::{fmt, io};

use plateau_core::surface::micrograph::MicrographError;
use plateau_core::surface::{FibreError, PreparationError, SynthesisError};
use thiserror::Error;

use super::format::{CONVERSION, Format, Instrument};
use super::hdf5::Hdf5Error;
use super::image::ImageError;
use super::npy::NpyError;
use super::options::{Disagreement, ProfileError};
use super::sdf::SdfError;
use super::text::TextError;

/// Why the initial surfaces of a scene cannot be made; `key` is the scene's table that asked for it.
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

/// Why a surface file cannot be read.
#[derive(Debug, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum FileError {
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
    #[error("this is a folder, expected a surface file: name one in it")]
    Folder,
    #[error("this is not a regular file")]
    NotAFile,
    #[error("this is not a surface file that is known ({found}); {READABLE}{}", ByConversion(*is_binary))]
    Unknown { found: String, is_binary: bool },
    #[error("this is {}, which is not read as it is; {CONVERSION}{}", .0.name, skipped(.0.is_text))]
    Instrument(Instrument),
    #[error("this is {0}, which is not read: save the sheet with the heights as CSV")]
    Workbook(&'static str),
    #[error("this is a damaged zip archive: {0}")]
    Zip(String),
    #[error("this is {0}, expected an image: PNG or TIFF")]
    NotAnImage(Format),
    #[error("cannot be written as PNG: {0}")]
    Write(#[from] png::EncodingError),
    #[error("this is {0}, expected an HDF5 file with integers 0 = none and 1 = primary")]
    NotABase(Format),
    #[error("the file states {found}, expected {expected}: is it damaged, or its unit another?")]
    Absurd { found: String, expected: String },
    #[error("this is {format}, which has no datasets: leave out dataset = \"{dataset}\"")]
    NoDatasets { format: Format, dataset: String },
    #[error(
        "this is {format}, for which {key} has no meaning: leave it out (pixel and scale in the prepare table read a \
         file differently than it says)"
    )]
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
    /// Whether the Python package may convert the file.
    pub fn may_be_converted(&self) -> bool {
        match self {
            Self::Instrument(_) | Self::Tiff { .. } => true,
            Self::Unknown { is_binary, .. } => *is_binary,
            Self::Hdf5(error) => matches!(**error, Hdf5Error::Zygo { .. }),
            _ => false,
        }
    }
}

/// How else a text can be read.
fn skipped(is_text: bool) -> &'static str {
    if is_text { "; or say how many lines stand before its table: skip = 12, for example" } else { "" }
}

impl From<Hdf5Error> for FileError {
    fn from(error: Hdf5Error) -> Self {
        Self::Hdf5(Box::new(error))
    }
}

/// What is read.
const READABLE: &str = "SDF, HDF5, NumPy arrays, PNG, TIFF and text are read";

/// The line that converts a file that another program may know, behind what to do about any file; nothing for another.
struct ByConversion(bool);

impl fmt::Display for ByConversion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 { write!(f, "; if it is of an instrument, {CONVERSION}") } else { Ok(()) }
    }
}
