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
    #[error("all {points} points are missing{}", AsAllOutliers(*outliers))]
    AllMissing {
        /// Those of them that were taken out as outliers.
        outliers: usize,
        /// All points.
        points: usize,
    },
    /// A number of the chain makes no sense.
    #[error("{key} is {found:?}, expected {expected}")]
    Value {
        /// Key of the preparation table.
        key: &'static str,
        /// What was asked for, SI units.
        found: f64,
        /// What can be.
        expected: &'static str,
    },
    /// A part of the patch that it does not have.
    #[error(
        "{key} goes from {} to {}, expected two lengths from 0 m to the patch's {}, the smaller one first",
        Length(*from), Length(*to), Length(*length)
    )]
    Crop {
        /// Key of the preparation table.
        key: &'static str,
        /// Where the part begins, m.
        from: f64,
        /// Where it ends, m.
        to: f64,
        /// Extent of the patch, m.
        length: f64,
    },
    /// A part of the patch that is narrower than a pixel.
    #[error(
        "{key} from {} to {} has no point of the patch, whose points are {} apart, the first at half of that",
        Length(*from), Length(*to), Length(*pitch)
    )]
    CropWithoutPoint {
        /// Key of the preparation table.
        key: &'static str,
        /// Where the part begins, m.
        from: f64,
        /// Where it ends, m.
        to: f64,
        /// Distance of the points, m.
        pitch: f64,
    },
    /// Radii that are none, or not in order.
    #[error(
        "unroll.radii are {} and {}, expected the inner radius, not negative, and then a larger outer one",
        Length(*inner), Length(*outer)
    )]
    Radii {
        /// The first, m.
        inner: f64,
        /// The second, m.
        outer: f64,
    },
    /// A ring of which next to nothing was measured.
    #[error(
        "the ring round unroll.centre would have {points:.0} points, the patch has {patch}, at radii from {} to {}: check \
         the centre, which counts from the patch's first corner, or give unroll.radii",
        Length(radii[0]), Length(radii[1])
    )]
    UnrollTooLarge {
        /// Points of the ring.
        points: f64,
        /// Points of the patch.
        patch: usize,
        /// Smallest and largest radius of a measured point, m.
        radii: [f64; 2],
    },
    /// No sector of a ring was measured.
    #[error("{}, measured are radii from {} to {}: check unroll.centre", Wanted(*wanted), Length(found[0]), Length(found[1]))]
    UnrollNothing {
        /// Inner and outer radius that were asked for, m.
        wanted: Option<[f64; 2]>,
        /// Smallest and largest radius of a measured point, m.
        found: [f64; 2],
    },
    /// A filter that is too short or too long for the patch.
    #[error(
        "{key} is {}, expected at least two pixels, {}, and at most the shorter side of the heights, {}",
        Length(*found), Length(*shortest), Length(*longest)
    )]
    NestingIndex {
        /// Key of the preparation table.
        key: &'static str,
        /// What was asked for, m.
        found: f64,
        /// Two pixels, m.
        shortest: f64,
        /// The shorter side, m.
        longest: f64,
    },
    /// Filters that leave nothing between them.
    #[error(
        "s_filter is {}, l_filter {}: waves between the two are kept, so s_filter is to be the shorter one",
        Length(*s_filter), Length(*l_filter)
    )]
    Filters {
        /// Nesting index of the S-filter, m.
        s_filter: f64,
        /// Nesting index of the L-filter, m.
        l_filter: f64,
    },
    /// The patch does not cover the track.
    #[error("the patch is {} wide in r, the track {}: {LARGER}", Length(*patch), Length(*track))]
    Narrow {
        /// Extent of the patch in r, m.
        patch: f64,
        /// Width of the track, m.
        track: f64,
    },
    /// The patch does not cover the body along the sliding direction.
    #[error("the patch is {} long, the {body} {} at the mean radius: {LARGER}", Length(*patch), Length(*length))]
    Short {
        /// Length of the patch, m.
        patch: f64,
        /// Name of the body.
        body: &'static str,
        /// Length of the body, m.
        length: f64,
    },
    /// The patch has too few cells for statistics.
    #[error(
        "{} by {} whole cells lie in the patch of {} by {}, expected at least {least} by {least} for its statistics: check its \
         pitch or pixel, measure a larger patch, take smaller cells, or tile it with repeat = true in place of extend",
        cells[0], cells[1], Length(patch[0]), Length(patch[1])
    )]
    FewCells {
        /// Length and height of the patch, m.
        patch: [f64; 2],
        /// Cells along and across sliding.
        cells: [usize; 2],
        /// Fewest of them in either direction.
        least: usize,
    },
    /// The field from which the heights are taken would be too large.
    #[error(
        "the patch of {} by {} has {} by {} cells, whose statistics ask for a field of {} by {} cells, more than there is room \
         for: check its pitch or pixel, crop it, or tile it with repeat = true in place of extend",
        Length(patch[0]), Length(patch[1]), cells[0], cells[1], field[0], field[1]
    )]
    LargeField {
        /// Length and height of the patch, m.
        patch: [f64; 2],
        /// Cells of the patch, along and across sliding.
        cells: [usize; 2],
        /// Cells of the field.
        field: [usize; 2],
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

/// What to do about a patch that is smaller than the body.
const LARGER: &str = "repeat = true tiles the patch at its own scale without a step at the seams, extend = \"statistics\" makes \
                      heights with its statistics";

/// How many of the missing points are outliers, in words.
struct AsOutliers(usize);

impl fmt::Display for AsOutliers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 0 { Ok(()) } else { write!(f, ", {} of them as outliers", self.0) }
    }
}

/// How many of the points, of which none is left, are outliers, in words, and what to do then.
struct AsAllOutliers(usize);

impl fmt::Display for AsAllOutliers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let advice = if self.0 == 0 { "" } else { ": give outliers or outlier_slope a larger limit, or leave it out" };
        write!(f, "{}{advice}", AsOutliers(self.0))
    }
}

/// What part of a ring was not found, in words.
struct Wanted(Option<[f64; 2]>);

impl fmt::Display for Wanted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some([inner, outer]) => {
                write!(f, "in no direction the heights reach over unroll.radii, {} to {}", Length(inner), Length(outer))
            }
            None => write!(f, "no four neighbouring points of a ring were measured"),
        }
    }
}
