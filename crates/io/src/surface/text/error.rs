//! Why a text file gives no surface.

use thiserror::Error;

use crate::surface::options::Disagreement;

/// Why a text file gives no surface. Lines count from 1.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TextError {
    /// Two bytes a character.
    #[error("this is UTF-16 text, expected UTF-8: save it as UTF-8 (iconv -f UTF-16 -t UTF-8)")]
    Utf16,
    /// There are no numbers.
    #[error("the file has no line of numbers")]
    NoNumbers,
    /// Neither file nor scene say what the numbers are.
    #[error(
        "the file does not say the unit of its heights: unit = \"um\" beside file does, or \"2.9e-8 m\" for what the \
         number 1 stands for"
    )]
    NoUnit,
    /// A line before the numbers that says nothing.
    #[error(
        "line {line}: found \"{found}\", expected numbers, a comment (#), \"name = value\", or the names of columns \
         x, y, z"
    )]
    Line {
        /// Where.
        line: usize,
        /// The line.
        found: String,
    },
    /// A cell that is no number.
    #[error(
        "line {line}, column {column}: found \"{found}\", expected a number with a decimal point, or an empty cell, NaN, \
         BAD or *** for a missing point"
    )]
    Number {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
    },
    /// A comma where a point should be.
    #[error("line {line}, column {column}: \"{found}\" has a decimal comma, expected a decimal point")]
    DecimalComma {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
    },
    /// A number that is infinite.
    #[error("line {line}, column {column}: {found} is not finite, expected a finite number, NaN for a missing point")]
    Infinite {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
    },
    /// Lines of different lengths.
    #[error("line {line} has {found} numbers, expected {expected} as in line {first}")]
    Ragged {
        /// Where.
        line: usize,
        /// Cells of that line.
        found: usize,
        /// Cells of the first line of numbers, or names of columns.
        expected: usize,
        /// The first line of numbers, or that of the names.
        first: usize,
    },
    /// The header counts other than what is there.
    #[error("the header states {expected} {what}, but the file has {found}")]
    Count {
        /// Columns or rows.
        what: &'static str,
        /// As the header has it.
        expected: u64,
        /// As the data have it.
        found: usize,
    },
    /// File and scene disagree.
    #[error(transparent)]
    Disagree(#[from] Disagreement),
    /// Three columns that are neither list nor matrix.
    #[error(
        "{lines} lines of three numbers, the first two on no grid: a list of points needs x and y on a regular grid, a \
         matrix more columns (or the format .npy)"
    )]
    ThreeColumns {
        /// Lines of numbers.
        lines: usize,
    },
    /// All points on a line.
    #[error("all points have the same {axis}, expected a surface")]
    Profile {
        /// x or y.
        axis: char,
    },
    /// A point off the grid.
    #[error("line {line}: {axis} = {found} lies off the regular grid from {first} in steps of {step}")]
    Irregular {
        /// Where.
        line: usize,
        /// x or y.
        axis: char,
        /// The coordinate, as in the file.
        found: f64,
        /// Where the grid starts.
        first: f64,
        /// Distance of the grid's lines.
        step: f64,
    },
    /// A list that fills too little of its grid.
    #[error("the {points} points lie on a grid of {} x {}, which they hardly fill: expected a regular grid", grid.0, grid.1)]
    Sparse {
        /// Points of the list.
        points: usize,
        /// Columns and rows of the grid.
        grid: (usize, usize),
    },
    /// Two points at one place.
    #[error("line {line} has the same x and y as line {first}")]
    Twice {
        /// Where.
        line: usize,
        /// The line before.
        first: usize,
    },
}
