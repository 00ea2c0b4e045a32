//! Why a text file gives no surface.

use thiserror::Error;

use crate::delimited::Decimal;
use crate::surface::options::Disagreement;

/// Why a text file gives no surface. Lines count from 1.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TextError {
    /// There are no numbers.
    #[error("the file has no line of numbers")]
    NoNumbers,
    /// Neither file nor scene say what the numbers are.
    #[error(
        "the file does not say the unit of its heights: unit = \"um\" below file in the scene does, or \"2.9e-8 m\" for what the \
         number 1 stands for"
    )]
    NoUnit,
    /// A line before the numbers that says nothing.
    #[error(
        "line {line}: found \"{found}\", expected numbers, a comment (#), \"name = value\", or the names of columns \
         x, y, z: {}", advice(*skip)
    )]
    Line {
        /// Where.
        line: usize,
        /// The line.
        found: String,
        /// Lines to leave out so that the table is left; none where no table is seen.
        skip: Option<usize>,
    },
    /// A cell that is no number.
    #[error(
        "line {line}, column {column}: found \"{found}\", expected a number, or an empty cell, NaN, BAD or *** for a missing \
         point"
    )]
    Number {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
    },
    /// A point without a place.
    #[error(
        "line {line}, column {column}: a coordinate is missing, expected a number: only heights may be missing; are the columns in another \
         order than x, y, z? Names above them say which is which, such as x z y"
    )]
    NoCoordinate {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
    },
    /// A decimal mark that is not that of the file.
    #[error("line {line}, column {column}: \"{found}\" has a decimal {}, {}", name(*mark), other(*mark, beside.as_deref()))]
    Mark {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
        /// Its mark.
        mark: Decimal,
        /// A number with the other one, and its place.
        beside: Option<Box<str>>,
    },
    /// Several tables, and none is chosen.
    #[error(
        "line {line}: another table begins here, {sign} (\"{found}\"), and a surface has one: dataset = \"1\" below file in the scene \
         chooses the first of the {tables}; if all is one surface, take blank lines and headers out of it"
    )]
    Several {
        /// Where the second begins.
        line: usize,
        /// What tells that it is one.
        sign: &'static str,
        /// Its first line.
        found: String,
        /// How many there are.
        tables: usize,
    },
    /// A table is chosen that is not there.
    #[error("dataset = \"{dataset}\", expected the number of a table of the file, which has {tables}")]
    NoTable {
        /// The choice.
        dataset: String,
        /// How many there are.
        tables: usize,
    },
    /// A number with thousands separators.
    #[error(
        "line {line}, column {column}: \"{found}\" has digits in groups, expected a number without: save the file without \
         thousands separators"
    )]
    Grouped {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
    },
    /// A comma that may be a decimal mark or part digits.
    #[error(
        "line {line}, column {column}: \"{found}\" may be {} or {}: decimal = \",\" below file in the scene says the first; of a file with \
         thousands separators save one without",
        found.replace(',', "."), found.replace(',', "")
    )]
    AmbiguousComma {
        /// Where.
        line: usize,
        /// Which cell, counted from 1.
        column: usize,
        /// The cell.
        found: String,
    },
    /// A comma that may be a decimal mark or part columns.
    #[error(
        "line {line}: commas of \"{found}\" may be decimal or may part numbers: decimal = \",\" below file in the scene says \
         the first, decimal = \".\" the second"
    )]
    CommaOrColumns {
        /// Where.
        line: usize,
        /// The line.
        found: String,
    },
    /// Commas part the numbers, and are their decimal mark as well.
    #[error(
        "line {line}: \"{found}\" has commas between the numbers and within them, for none has \"{part}\" as a number of its own: save \
         the file with decimal points, or with semicolons between the numbers"
    )]
    CommaTwice {
        /// Where.
        line: usize,
        /// The line.
        found: String,
        /// What can only be a part of a number.
        part: String,
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
    #[error(
        "all points have the same {axis}, expected a surface; for a profile say profile_lay = \"along\", \"across\" or \
         \"isotropic\" below file in the scene"
    )]
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
    /// Every line is skipped.
    #[error("skip = {skip} leaves no line of the file")]
    AllSkipped {
        /// Lines that are skipped.
        skip: u64,
    },
    /// A profile where a surface is expected.
    #[error(
        "{lines} lines of {columns} {}: for a profile say profile_lay = \"along\", \"across\" or \"isotropic\" below file in the scene; a \
         surface needs more columns", if *columns == 1 { "number" } else { "numbers" }
    )]
    IsProfile {
        /// Numbers of a line.
        columns: usize,
        /// Lines of numbers.
        lines: usize,
    },
    /// A surface where a profile is expected.
    #[error(
        "profile_lay takes the file as a profile, but it has {lines} lines of {columns} numbers: expected heights in one line \
         or one column, distances and heights in two columns, or columns with names such as x [mm], z [um]"
    )]
    NoProfile {
        /// Numbers of a line.
        columns: usize,
        /// Lines of numbers.
        lines: usize,
    },
    /// A profile of one point.
    #[error("the profile has {points} point, expected two or more")]
    ShortProfile {
        /// Its points.
        points: usize,
    },
    /// Distances of a profile without a unit.
    #[error(
        "the file does not say the unit of the distances along the profile, which are {} apart: pitch = \"0.5 um\" beside \
         file, for example, says how far the points are apart, or name the columns, such as x [mm], z [um]",
        short(*step)
    )]
    NoDistanceUnit {
        /// Distance of neighbours in the unit of the file.
        step: f64,
    },
    /// Distances of a profile that turn back.
    #[error(
        "line {line}: the distance {found} comes after {before}: along a profile distances only grow, or only fall"
    )]
    Disorder {
        /// Where.
        line: usize,
        /// The distance.
        found: f64,
        /// That of the line before.
        before: f64,
    },
    /// Distances of a profile that are not evenly spaced.
    #[error(
        "line {line}: the distance {found} is {:.0} % of the spacing {} off its even place {}, neighbours are {} to {} apart: \
         expected evenly spaced points; have the instrument or another program resample the profile",
        100.0 * (found - expected).abs() / step, short(*step), short(*expected), short(gaps[0]), short(gaps[1])
    )]
    Uneven {
        /// Where.
        line: usize,
        /// The distance.
        found: f64,
        /// Where the point would be if all were evenly spaced.
        expected: f64,
        /// Mean distance of neighbours.
        step: f64,
        /// Smallest and largest distance of neighbours.
        gaps: [f64; 2],
    },
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
