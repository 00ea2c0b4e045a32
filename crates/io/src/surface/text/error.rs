//! Why a text file gives no surface.

use thiserror::Error;

use crate::delimited::Decimal;
use crate::surface::options::Disagreement;

/// Why a text file gives no surface. Lines count from 1.
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
    #[error(
        "line {line}, column {column}: found \"{found}\", expected a number, or an empty cell, NaN, BAD or *** for a missing \
         point"
    )]
    Number { line: usize, column: usize, found: String },
    #[error(
        "line {line}, column {column}: a coordinate is missing, expected a number: only heights may be missing; are the columns in another \
         order than x, y, z? Names above them say which is which, such as x z y"
    )]
    NoCoordinate { line: usize, column: usize },
    #[error("line {line}, column {column}: \"{found}\" has a decimal {}, {}", name(*mark), other(*mark, beside.as_deref()))]
    Mark { line: usize, column: usize, found: String, mark: Decimal, beside: Option<Box<str>> },
    #[error(
        "line {line}: another table begins here, {sign} (\"{found}\"), and a surface has one: dataset = \"1\" below file in the scene \
         chooses the first of the {tables}; if all is one surface, take blank lines and headers out of it"
    )]
    Several { line: usize, sign: &'static str, found: String, tables: usize },
    #[error("dataset = \"{dataset}\", expected the number of a table of the file, which has {tables}")]
    NoTable { dataset: String, tables: usize },
    #[error(
        "line {line}, column {column}: \"{found}\" has digits in groups, expected a number without: save the file without \
         thousands separators"
    )]
    Grouped { line: usize, column: usize, found: String },
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
    #[error("line {line}, column {column}: {found} is not finite, expected a finite number, NaN for a missing point")]
    Infinite { line: usize, column: usize, found: String },
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

/// How to leave out lines that are not understood.
fn advice(skip: Option<usize>) -> String {
    match skip {
        Some(lines) => format!("skip = {lines} below file in the scene leaves out the lines before the table"),
        None => "no lines of equally many numbers are seen below; skip = 12 below file in the scene, for example, leaves out the first twelve lines".to_owned(),
    }
}

/// A decimal mark in words.
fn name(mark: Decimal) -> &'static str {
    if mark == Decimal::Comma { "comma" } else { "point" }
}

/// Which other mark numbers have than this one.
fn other(mark: Decimal, beside: Option<&str>) -> String {
    let (other, key) = if mark == Decimal::Comma { (Decimal::Point, '.') } else { (Decimal::Comma, ',') };
    match beside {
        Some(found) => format!("and {found} a decimal {}: save the file with one of them", name(other)),
        None => format!("but numbers of this file have a decimal {} (decimal = \"{key}\")", name(other)),
    }
}

/// A number with six digits, which is enough for a message.
pub(super) fn short(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}
