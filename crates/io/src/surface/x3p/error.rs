//! Why an X3P file cannot be read.

use thiserror::Error;

/// Why an X3P file cannot be read.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum X3pError {
    /// The archive itself is damaged.
    #[error("this is a damaged zip archive: {0}")]
    Archive(String),
    /// An entry is not there.
    #[error("the archive has no entry \"{name}\"; {present}")]
    NoEntry {
        /// The entry.
        name: String,
        /// Entries that are there.
        present: String,
    },
    /// Several surfaces.
    #[error("the archive has \"{0}main.xml\" and \"{1}main.xml\", expected one surface: pack one of the folders alone", folders[0], folders[1])]
    Folders {
        /// Two folders with a surface each.
        folders: [String; 2],
    },
    /// An entry cannot be unpacked.
    #[error("{name} cannot be unpacked: {reason}")]
    Entry {
        /// The entry.
        name: String,
        /// What the archive's reader said.
        reason: String,
    },
    /// An entry that measured heights cannot be.
    #[error("{name} unpacks {compressed} bytes to {size}, which no measured surface does; the file is not read")]
    Bomb {
        /// The entry.
        name: String,
        /// Bytes in the archive.
        compressed: u64,
        /// Bytes unpacked.
        size: u64,
    },
    /// An entry has another size than the matrix asks for.
    #[error("{name} has {found} bytes, expected {needed} for {what}")]
    Size {
        /// The entry.
        name: String,
        /// Its size in bytes.
        found: u64,
        /// The size asked for.
        needed: u128,
        /// What for.
        what: String,
    },
    /// `main.xml` is no XML.
    #[error("main.xml: byte {at}: {reason}")]
    Xml {
        /// Where, counted from 0.
        at: u64,
        /// What is wrong there.
        reason: String,
    },
    /// An element of `main.xml` is missing.
    #[error("main.xml has no {element}")]
    NoElement {
        /// The element, with those around it.
        element: &'static str,
    },
    /// An element of `main.xml` says what cannot be or is not read.
    #[error("main.xml: {element} is \"{found}\", expected {expected}")]
    Element {
        /// The element, with those around it.
        element: String,
        /// What it says.
        found: String,
        /// What is read.
        expected: &'static str,
    },
    /// Not as many points in `main.xml` as the matrix has.
    #[error("main.xml: the DataList has {found} numbers, expected {needed} for {what}")]
    Count {
        /// Numbers that are there.
        found: usize,
        /// Numbers that are needed.
        needed: u128,
        /// What for.
        what: String,
    },
    /// A point is none.
    #[error("the point (column {column}, row {row}) has {found}, expected {expected}")]
    Point {
        /// Along x, from 0.
        column: usize,
        /// Along y, from 0.
        row: usize,
        /// Its height or coordinate.
        found: f64,
        /// What can be.
        expected: &'static str,
    },
    /// Coordinates that are no regular grid.
    #[error(
        "the {axis} coordinates are not equidistant: number {index} is {found} m, expected {expected} m; resample the \
         surface on a regular grid"
    )]
    NotEquidistant {
        /// x or y.
        axis: &'static str,
        /// Which along the axis, from 0.
        index: usize,
        /// The coordinate, m.
        found: f64,
        /// What a regular grid has there, m.
        expected: f64,
    },
}
