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
pub enum SurfaceError {
    /// A file cannot be read.
    #[error("{key}: {}: {reason}", path.display())]
    File {
        /// Table of the scene.
        key: &'static str,
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        reason: FileError,
    },
    /// Synthetic heights cannot be made.
    #[error("{key}: {reason}")]
    Synthesis {
        /// Table of the scene.
        key: &'static str,
        /// What is wrong with the settings.
        reason: SynthesisError,
    },
    /// A synthetic fibre map cannot be made.
    #[error("{key}: {reason}")]
    Fibre {
        /// Table of the scene.
        key: &'static str,
        /// What is wrong with the settings.
        reason: FibreError,
    },
    /// Heights cannot be prepared.
    #[error("{key}: {source_name}: {reason}")]
    Preparation {
        /// Table of the scene.
        key: &'static str,
        /// The file they come from, or what else they are.
        source_name: String,
        /// What is wrong with heights or preparation.
        reason: PreparationError,
    },
}

/// Why a surface file cannot be read.
#[derive(Debug, Error)]
pub enum FileError {
    /// The operating system refused.
    #[error("cannot be read: {0}")]
    System(#[from] io::Error),
    /// A folder.
    #[error("this is a folder, expected a surface file: name one in it")]
    Folder,
    /// A device or the like.
    #[error("this is not a regular file")]
    NotAFile,
    /// Nobody knows what it is.
    #[error("this is not a surface file that is known ({found}); {READABLE}{}", ByConversion(*is_binary))]
    Unknown {
        /// What the file starts with.
        found: String,
        /// It may be of an instrument whose format another program knows.
        is_binary: bool,
    },
    /// An instrument's own format.
    #[error("this is {}, which is not read as it is; {CONVERSION}{}", .0.name, skipped(.0.is_text))]
    Instrument(Instrument),
    /// A table of a spreadsheet.
    #[error("this is {0}, which is not read: save the sheet with the heights as CSV")]
    Workbook(&'static str),
    /// A zip archive that cannot be opened.
    #[error("this is a damaged zip archive: {0}")]
    Zip(String),
    /// `image` names something else.
    #[error("this is {0}, expected an image: PNG or TIFF")]
    NotAnImage(Format),
    /// A picture cannot be written.
    #[error("cannot be written as PNG: {0}")]
    Write(#[from] png::EncodingError),
    /// A fibre map in a format of heights.
    #[error("this is {0}, expected an HDF5 file with integers 0 = none and 1 = primary")]
    NotABase(Format),
    /// A pitch or a height that no surface has.
    #[error("the file states {found}, expected {expected}: is it damaged, or its unit another?")]
    Absurd {
        /// The number.
        found: String,
        /// Numbers that are read.
        expected: String,
    },
    /// `dataset` was given for a file that has none.
    #[error("this is {format}, which has no datasets: leave out dataset = \"{dataset}\"")]
    NoDatasets {
        /// The format.
        format: Format,
        /// The dataset asked for.
        dataset: String,
    },
    /// A key was given that the format has no use for.
    #[error(
        "this is {format}, for which {key} has no meaning: leave it out (pixel and scale in the prepare table read a \
         file differently than it says)"
    )]
    Meaningless {
        /// The format.
        format: Format,
        /// The key.
        key: &'static str,
    },
    /// File and scene disagree.
    #[error(transparent)]
    Disagree(#[from] Disagreement),
    /// Heights that a run recorded of the other body.
    #[error(
        "the dataset is of the other body, whose z has the other sign: disc.surface takes /disc/height, pin.surface /pin/height"
    )]
    OtherBody,
    /// The pitch of measured heights is unknown.
    #[error(
        "the file does not say the distance of its points: pitch = \"50 um\" below file in the scene does, for example"
    )]
    NoPitchOfFile,
    /// The shape is not that of the mesh and the pitch is unknown.
    #[error(
        "{what}there are {} columns and {} rows, expected {} and {} for the whole body; as a patch they need a pitch: \
         pitch = \"50 um\" below file in the scene, for example",
        found.0, found.1, mesh.0, mesh.1
    )]
    NoPitch {
        /// Which heights of the file, if it may have others.
        what: String,
        /// Columns and rows of the file.
        found: (usize, usize),
        /// Columns and rows of the body.
        mesh: (usize, usize),
    },
    /// A damaged or unusual SDF file.
    #[error(transparent)]
    Sdf(#[from] SdfError),
    /// A damaged or unsuitable HDF5 file.
    #[error(transparent)]
    Hdf5(Box<Hdf5Error>),
    /// A damaged or unsuitable NumPy file.
    #[error(transparent)]
    Npy(#[from] NpyError),
    /// A damaged or unsuitable image.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A TIFF file whose first image gives no surface.
    #[error(
        "{reason}; a TIFF of an instrument (JPK .jpk, Park, Olympus .lext) has its heights elsewhere in the file: {CONVERSION}"
    )]
    Tiff {
        /// What is wrong with the first image.
        reason: ImageError,
    },
    /// An image that gives no fibre map.
    #[error(transparent)]
    Micrograph(#[from] MicrographError),
    /// Text that holds no surface.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A file that is taken as a profile.
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
