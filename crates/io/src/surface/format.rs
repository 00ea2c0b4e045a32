//! Formats of surface files, and those of instruments, which the Python package converts.

use std::fmt;
use std::path::Path;

use super::sdf::SdfKind;
use crate::delimited::{decode, lines};

/// An instrument's own format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instrument {
    /// Name of the format, with its article.
    pub name: &'static str,
    /// True for a text, which can also be read as a table if its header is skipped.
    pub is_text: bool,
}

/// Advice on a file in such a format.
pub(super) const CONVERSION: &str = "convert it: plateau surface convert FILE -o FILE.h5, which comes with the Python package (pip install \
    'plateau-brake[all]')";

/// Offset, first bytes and name of formats as SurfaceTopography and surfalize tell them.
const SIGNATURES: &[(usize, &[u8], &str)] = &[
    (0, b"AliconaImaging", "an Alicona file (.al3d)"),
    (0, b"FRTM_GLIDERV", "an FRT MicroProf file (.frt)"),
    (0, b"DIGITAL SURF", "a Digital Surf file (.sur)"),
    (0, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a compound file (of Mitutoyo, Mahr or Mountains, or a document)"),
    (0, b"GWYP", "a Gwyddion file (.gwy)"),
    (0, b"\x88\x1b\x03\x6f", "a Zygo MetroPro file (.dat)"),
    (0, b"\x88\x1b\x03\x70", "a Zygo MetroPro file (.dat)"),
    (0, b"\x88\x1b\x03\x71", "a Zygo MetroPro file (.dat)"),
    (2, b"Directory", "a Wyko file (.opd)"),
    (0, b"VCA DATA\x01\0\0\x55", "a Dektak file (.OPDx)"),
    (0, b"OmniSurf3D", "an OmniSurf3D file (.os3d)"),
    (0, b"Binary TrueMap Data File", "a TrueMap file (.tmd)"),
    (0, b"VK3_", "a Keyence file (.vk3)"),
    (0, b"VK4_", "a Keyence file (.vk4)"),
    (0, b"VK6", "a Keyence file (.vk6)"),
    (0, b"VK7", "a Keyence file (.vk7)"),
    (0, b"KPK0", "a Keyence file (.zon)"),
    (0, b"KPK1", "a Keyence file (.zon)"),
    (0, b"Zeta-Instruments", "a Zeta file (.zmg)"),
    (0, b"OLYMPUSRAWFORMAT", "an Olympus file (.oir)"),
    (0, b"\x01\xb0\x93\xff", "an NT-MDT file (.mdt)"),
    (0, b"?*File list", "a Bruker Nanoscope file"),
    (0, b"\\*File list", "a Bruker Nanoscope file"),
    (0, b"WSxM file copyright", "a WSxM file"),
    (0, b"fileType  ", "an Agilent file (.mi)"),
    (0, b"[DataSet]\r\n", "a Nanosurf file (.nid, .ezd)"),
    (0, b"fileformat = bcr", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"\xff\xfef\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"\xfe\xff\0f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"CDF\x01", "a netCDF-3 file (.nc)"),
    (0, b"CDF\x02", "a netCDF-3 file (.nc)"),
    (0, b"CDF\x05", "a netCDF-3 file (.nc)"),
    (0, b"DSCOMPRESSED", "a compressed Digital Surf file (.sur)"),
    (4, b"hdat_", "a Heliotis file (.hdat)"),
    (0, b"SIMPLE  =", "a FITS file"),
];

/// Endings of binary formats without a signature that is sure, and their names.
const ENDINGS: &[(&str, &str)] = &[("ibw", "an Igor binary wave (.ibw)"), ("nms", "a NanoFocus file (.nms)")];

/// Zip archives, told by their entries.
pub(super) const X3P: Instrument = Instrument::binary("an X3P file (.x3p)");
pub(super) const PLUX: Instrument = Instrument::binary("a Sensofar file (.plux)");
pub(super) const WORKBOOK: Instrument =
    Instrument::binary("a workbook (.xlsx), whose sheet of heights a spreadsheet saves as CSV; or one of Mitutoyo");

/// A Sensofar file starts with the day on which it was measured, such as "Fri Mar 15 10:12:00 2013", in 128 bytes.
const PLU: Instrument = Instrument::binary("a Sensofar file (.plu, .apx)");

/// Beginnings of the first lines of text exports, but for blanks and quotation marks, and the names of these. One line tells a format.
const LINES: &[(&str, &str)] = &[
    ("Wyko ASCII Data File Format", "a text export of Wyko (.asc)"),
    ("Zygo XYZ Data File", "a text export of Zygo (.xyz)"),
    ("Zygo ASCII Data File", "a text export of Zygo (.asc)"),
    ("Scan Parameters", "a text export of Dektak (.csv)"),
    ("# File Format = ASCII", "a text export of SPIP (.asc)"),
    ("height conversion factor (->", "a text export of a holographic microscope (.txt)"),
    ("XY Calibration", "a text export of Keyence (.csv)"),
    ("XY-Justierung", "a text export of Keyence (.csv)"),
];
/// Lines of a text that are looked at.
const FIRST_LINES: usize = 40;

impl Instrument {
    const fn binary(name: &'static str) -> Self {
        Self { name, is_text: false }
    }
}

/// Tells the format of a binary file whose beginning says nothing by the ending of its path, if that is known.
pub(super) fn by_ending(path: &Path) -> Option<Instrument> {
    let ending = path.extension()?;
    let (_, name) = ENDINGS.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known))?;
    Some(Instrument::binary(name))
}

/// Tells the format of a file that starts like this, if it is one of an instrument.
pub(super) fn recognise(head: &[u8]) -> Option<Instrument> {
    let at = |offset: usize, signature: &[u8]| head.get(offset..).is_some_and(|rest| rest.starts_with(signature));
    let is_day = ["Mon ", "Tue ", "Wed ", "Thu ", "Fri ", "Sat ", "Sun "].iter().any(|day| at(0, day.as_bytes()));
    if is_day && head.iter().take(128).any(|byte| *byte == 0) {
        return Some(PLU);
    }
    let known = SIGNATURES.iter().find(|(offset, signature, _)| at(*offset, signature));
    known.map(|(.., name)| Instrument::binary(name)).or_else(|| of_text(head))
}

/// The text export whose beginning this is.
fn of_text(head: &[u8]) -> Option<Instrument> {
    let text = decode(head);
    let begins = |line: &str| {
        let line = line.trim_start_matches(|mark: char| mark == '"' || mark.is_whitespace());
        LINES.iter().find(|(beginning, _)| line.starts_with(beginning))
    };
    let (_, name) = lines(&text).take(FIRST_LINES).find_map(|(_, line)| begins(line))?;
    Some(Instrument { name, is_text: true })
}

/// Formats of surface files that are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// HDF5.
    Hdf5,
    /// SDF (ISO 25178-71, BCR-1.0).
    Sdf(SdfKind),
    /// One NumPy array.
    Npy,
    /// Several NumPy arrays in a zip archive.
    Npz,
    /// PNG image.
    Png,
    /// TIFF image.
    Tiff,
    /// JPEG image, which is read as a picture, not as heights.
    Jpeg,
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
            Self::Npy => "a NumPy array file (.npy)",
            Self::Npz => "an archive of NumPy arrays (.npz)",
            Self::Png => "a PNG image",
            Self::Tiff => "a TIFF image",
            Self::Jpeg => "a JPEG image",
            Self::Text => "a text file",
            Self::Instrument(instrument) => instrument.name,
        })
    }
}
