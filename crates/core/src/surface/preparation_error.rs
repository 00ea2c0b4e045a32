//! Why a surface cannot be prepared.

use std::fmt;

use thiserror::Error;

use super::Length;

/// Why a surface cannot be prepared.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PreparationError {
    /// The grid is none.
    #[error(
        "a grid of {columns} columns and {rows} rows with {points} heights, pitch {} by {}: expected columns times \
         rows heights, at least one, and pitches that are positive and finite",
        Length(*column_pitch), Length(*row_pitch)
    )]
    Grid {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
        /// Heights.
        points: usize,
        /// Pitch along x, m.
        column_pitch: f64,
        /// Pitch along y, m.
        row_pitch: f64,
    },
    /// Points without a height.
    #[error(
        "{missing} of {points} points are missing{}; fill = \"level\" gives them the mean of the levelled surface, \
         fill = \"interpolate\" heights between those around them",
        AsOutliers(*outliers)
    )]
    Missing {
        /// Points without a height.
        missing: usize,
        /// Those of them that were taken out as outliers.
        outliers: usize,
        /// All points.
        points: usize,
    },
    /// Half of the heights are the same.
    #[error(
        "half of the points or more have the same height, so that their median absolute deviation tells no outliers: \
         leave outliers out"
    )]
    NoDeviation,
    /// No point has a height.
    #[error("all {points} points are missing")]
    AllMissing {
        /// All points.
        points: usize,
    },
    /// A number of the chain makes no sense.
    #[error("{key} is {found}, expected {expected}")]
    Value {
        /// Key of the preparation table.
        key: &'static str,
        /// What was asked for, SI units.
        found: f64,
        /// What can be.
        expected: &'static str,
    },
    /// The patch does not cover the track.
    #[error(
        "the patch is {} wide in r, the track {}: repeat = true tiles the patch without a step at the seams, extend = \"statistics\" \
         makes a surface with the statistics of the patch",
        Length(*patch), Length(*track)
    )]
    Narrow {
        /// Extent of the patch in r, m.
        patch: f64,
        /// Width of the track, m.
        track: f64,
    },
    /// The patch does not cover the body along the sliding direction.
    #[error(
        "the patch is {} long, the {body} {} at the mean radius: repeat = true tiles the patch without a step at \
         the seams, extend = \"statistics\" makes a surface with the statistics of the patch",
        Length(*patch), Length(*length)
    )]
    Short {
        /// Length of the patch, m.
        patch: f64,
        /// Name of the body.
        body: &'static str,
        /// Length of the body, m.
        length: f64,
    },
    /// Not even one cell is covered.
    #[error(
        "the patch is {} by {}, a cell {} by {}: all of its roughness lies within one cell; take smaller cells, or measure a larger area",
        Length(patch[0]), Length(patch[1]), Length(cell[0]), Length(cell[1])
    )]
    SmallerThanCell {
        /// Extents of the patch along x and y, m.
        patch: [f64; 2],
        /// Extents of a cell, m.
        cell: [f64; 2],
    },
    /// Too few cells to tell the statistics.
    #[error(
        "the patch covers {columns} by {rows} cells of {} by {}, and its statistics show in {least} by {least} at least: take \
         smaller cells, or measure a larger area",
        Length(cell[0]), Length(cell[1])
    )]
    FewCells {
        /// Whole cells along x.
        columns: usize,
        /// Whole cells along y.
        rows: usize,
        /// Extents of a cell, m.
        cell: [f64; 2],
        /// Fewest cells in either direction.
        least: usize,
    },
    /// The field of the extension would be too large.
    #[error(
        "extending the patch by its statistics needs a field of {columns} by {rows} cells, more than is made: crop the patch, or take a \
         smaller ring"
    )]
    TooLarge {
        /// Columns of the field.
        columns: usize,
        /// Rows of the field.
        rows: usize,
    },
    /// Heights that are no numbers.
    #[error("{count} of {points} heights are not finite: the heights or the scale of {scale} are too large")]
    NotFinite {
        /// Heights that are not finite.
        count: usize,
        /// All heights.
        points: usize,
        /// Factor of the preparation.
        scale: f64,
    },
}

/// How many of the missing points are outliers, in words.
struct AsOutliers(usize);

impl fmt::Display for AsOutliers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 0 { Ok(()) } else { write!(f, ", {} of them as outliers", self.0) }
    }
}
