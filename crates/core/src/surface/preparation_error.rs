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
        "the patch is {} wide in r, the track {}: a pixel of at least {} lets its {rows} rows cover the track",
        Length(*patch), Length(*track), Length(*pixel)
    )]
    Narrow {
        /// Extent of the patch in r, m.
        patch: f64,
        /// Width of the track, m.
        track: f64,
        /// Smallest pitch that covers the track, m.
        pixel: f64,
        /// Rows of the patch.
        rows: usize,
    },
    /// The patch does not cover the body along the sliding direction.
    #[error(
        "the patch is {} long, the {body} {} at the mean radius: repeat = true tiles the patch without a step at \
         the seams",
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
    /// Not even one column is covered.
    #[error("the patch is {} long, one column {} at the mean radius: a larger pixel is needed", Length(*patch), Length(*column))]
    ShorterThanColumn {
        /// Length of the patch, m.
        patch: f64,
        /// Arc length of a column, m.
        column: f64,
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
