//! Formats of surface files.

use std::fmt;

use super::instrument::Instrument;
use super::sdf::SdfKind;

/// Formats of surface files that are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// HDF5.
    Hdf5,
    /// SDF (ISO 25178-71, BCR-1.0).
    Sdf(SdfKind),
    /// X3P (ISO 25178-72).
    X3p,
    /// One NumPy array.
    Npy,
    /// Several NumPy arrays in a zip archive.
    Npz,
    /// PNG image.
    Png,
    /// TIFF image.
    Tiff,
    /// Matrix of numbers or list of points as text.
    Text,
    /// An instrument's own format; such files are not read.
    Instrument(Instrument),
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hdf5 => "an HDF5 file",
            Self::Sdf(kind) => return write!(f, "an SDF {kind} file"),
            Self::X3p => "an X3P file",
            Self::Npy => "a NumPy array file (.npy)",
            Self::Npz => "an archive of NumPy arrays (.npz)",
            Self::Png => "a PNG image",
            Self::Tiff => "a TIFF image",
            Self::Text => "a text file",
            Self::Instrument(instrument) => instrument.name,
        })
    }
}
