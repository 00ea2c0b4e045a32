//! Limits for files that anybody may have made. What is larger is refused, with both numbers in the message.
//!
//! Surfaces have bounds of their own besides: points of a grid, and what deflate can make of the bytes that are there.

/// Bytes of a study: brackets take fifty times their size while they are read.
pub const STUDY: u64 = 4 << 20;
/// Bytes of a table of load and speed, or of the points of a design.
pub const TABLE: u64 = 64 << 20;
/// Rows of such a table.
pub const ROWS: usize = 1_000_000;
/// Values of the points of a design, rows times columns.
pub const CELLS: usize = 10_000_000;
/// Bytes of heights as text: what becomes of them needs several times that.
pub const SURFACE_TEXT: u64 = 1 << 30;
/// Bytes of heights as an array or an image.
pub const SURFACE: u64 = 4 << 30;
/// Bytes of a line of a journal, which holds the series of a run.
pub const RECORD: u64 = 256 << 20;
/// Numbers in a line of a journal.
pub const RECORD_NUMBERS: usize = 1 << 27;
/// Scenes that extend each other.
pub const LAYERS: usize = 64;

/// Says that there is more of something than is read.
pub(crate) fn more(found: impl std::fmt::Display, most: impl std::fmt::Display, what: &str) -> String {
    format!("{found} {what}, expected at most {most}")
}
