//! Errors of a surface that cannot be prepared or made.

use thiserror::Error;

use super::Length;

/// Error of a surface that cannot be prepared.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum PreparationError {
    #[error(
        "a grid of {columns} columns and {rows} rows with {points} heights, pitch {} by {}: expected columns times \
         rows heights, at least one, and pitches that are positive and finite",
        Length(*column_pitch), Length(*row_pitch)
    )]
    Grid { columns: usize, rows: usize, points: usize, column_pitch: f64, row_pitch: f64 },
    #[error(
        "{missing} of {points} points are missing{}; fill = \"level\" gives them the mean of the levelled surface, \
         fill = \"interpolate\" heights between those around them",
        as_outliers(*outliers)
    )]
    Missing { missing: usize, outliers: usize, points: usize },
    #[error(
        "half of the points or more have the same height, so that their median absolute deviation tells no outliers: \
         leave outliers out"
    )]
    NoDeviation,
    #[error("all {points} points are missing{}", as_all_outliers(*outliers))]
    AllMissing { outliers: usize, points: usize },
    #[error("{key} is {found:?}, expected {expected}")]
    Value { key: &'static str, found: f64, expected: &'static str },
    #[error(
        "{key} goes from {} to {}, expected two lengths from 0 m to the patch's {}, the smaller one first",
        Length(*from), Length(*to), Length(*length)
    )]
    Crop { key: &'static str, from: f64, to: f64, length: f64 },
    #[error(
        "{key} from {} to {} has no point of the patch, whose points are {} apart, the first at half of that",
        Length(*from), Length(*to), Length(*pitch)
    )]
    CropWithoutPoint { key: &'static str, from: f64, to: f64, pitch: f64 },
    #[error(
        "unroll.radii are {} and {}, expected the inner radius, not negative, and then a larger outer one",
        Length(*inner), Length(*outer)
    )]
    Radii { inner: f64, outer: f64 },
    #[error(
        "the ring round unroll.centre would have {points:.0} points, the patch has {patch}, at radii from {} to {}: check \
         the centre, which counts from the patch's first corner, or give unroll.radii",
        Length(radii[0]), Length(radii[1])
    )]
    UnrollTooLarge { points: f64, patch: usize, radii: [f64; 2] },
    #[error("{}, measured are radii from {} to {}: check unroll.centre", not_found(*wanted), Length(found[0]), Length(found[1]))]
    UnrollNothing { wanted: Option<[f64; 2]>, found: [f64; 2] },
    #[error(
        "{key} is {}, expected at least two pixels, {}, and at most the shorter side of the heights, {}",
        Length(*found), Length(*shortest), Length(*longest)
    )]
    NestingIndex { key: &'static str, found: f64, shortest: f64, longest: f64 },
    #[error(
        "s_filter is {}, l_filter {}: waves between the two are kept, so s_filter is to be the shorter one",
        Length(*s_filter), Length(*l_filter)
    )]
    Filters { s_filter: f64, l_filter: f64 },
    #[error("the patch is {} wide in r, the track {}: {LARGER}", Length(*patch), Length(*track))]
    Narrow { patch: f64, track: f64 },
    #[error("the patch is {} long, the {body} {} at the mean radius: {LARGER}", Length(*patch), Length(*length))]
    Short { patch: f64, body: &'static str, length: f64 },
    #[error(
        "{} by {} whole cells lie in the patch of {} by {}, expected at least {least} by {least} for its statistics: check its \
         pitch or pixel, measure a larger patch, take smaller cells, or tile it with repeat = true in place of extend",
        cells[0], cells[1], Length(patch[0]), Length(patch[1])
    )]
    FewCells { patch: [f64; 2], cells: [usize; 2], least: usize },
    #[error(
        "the patch of {} by {} has {} by {} cells, whose statistics ask for a field of {} by {} cells, more than there is room \
         for: check its pitch or pixel, crop it, or tile it with repeat = true in place of extend",
        Length(patch[0]), Length(patch[1]), cells[0], cells[1], field[0], field[1]
    )]
    LargeField { patch: [f64; 2], cells: [usize; 2], field: [usize; 2] },
    #[error("{count} of {points} heights are not finite: the heights or the scale of {scale} are too large")]
    NotFinite { count: usize, points: usize, scale: f64 },
}

/// Advice about a patch that is smaller than the body.
const LARGER: &str = "repeat = true tiles the patch at its own scale without a step at the seams, extend = \"statistics\" makes \
                      heights with its statistics";

/// Says how many of the missing points are outliers.
fn as_outliers(outliers: usize) -> String {
    if outliers == 0 { String::new() } else { format!(", {outliers} of them as outliers") }
}

/// Says how many of the points, of which none is left, are outliers, and what to do then.
fn as_all_outliers(outliers: usize) -> String {
    let advice = if outliers == 0 { "" } else { ": give outliers or outlier_slope a larger limit, or leave it out" };
    as_outliers(outliers) + advice
}

/// Says what part of a ring was not found.
fn not_found(radii: Option<[f64; 2]>) -> String {
    match radii {
        Some([inner, outer]) => {
            format!("in no direction the heights reach over unroll.radii, {} to {}", Length(inner), Length(outer))
        }
        None => "no four neighbouring points of a ring were measured".to_owned(),
    }
}

/// Error of a synthetic surface that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum SynthesisError {
    #[error("rms_height is {found} m, expected 0 or more and finite")]
    RmsHeight { found: f64 },
    #[error("{key} is {found} m, expected more than 0 and finite")]
    CorrelationLength { key: &'static str, found: f64 },
    #[error(
        "{key} is {}, expected at most {} here (the ring's circumference, or 2^20 cells): \
         a surface that varies so slowly is flat on this mesh, use flat = true",
        Length(*found), Length(*longest)
    )]
    CorrelationTooLong { key: &'static str, found: f64, longest: f64 },
    #[error("hurst is {found}, expected 0 to 1")]
    Hurst { found: f64 },
    #[error(
        "roll_off is {}, expected a wavelength from {} (two cells) to {} (the ring's circumference, or 2^20 cells)",
        Length(*found), Length(*shortest), Length(*longest)
    )]
    RollOff { found: f64, shortest: f64, longest: f64 },
    #[error(
        "short_cutoff is {}, expected a wavelength from {} (two cells) to the roll_off of {}",
        Length(*found), Length(*shortest), Length(*roll_off)
    )]
    ShortCutoff { found: f64, shortest: f64, roll_off: f64 },
    #[error(
        "skewness {skewness} with kurtosis {found}: with this skewness the kurtosis is expected to be at least {least:.4} \
         and at most {most} (3 is normal; below skewness² + 1 there is no distribution, and near it all heights are two)"
    )]
    Kurtosis { skewness: f64, found: f64, least: f64, most: f64 },
    #[error(
        "a field of {columns} by {rows} cells would be needed so that its ends do not feel each other: use a shorter \
         correlation length or roll_off"
    )]
    TooLarge { columns: usize, rows: usize },
    #[error("patch is {}, expected at least two columns of {} and a finite length", Length(*found), Length(*column_width))]
    Patch { found: f64, column_width: f64 },
    #[error("patch repeats the heights round the ring, which a pin does not close: leave it out")]
    PatchOnPin,
    #[error(
        "nothing but the mean is left of a field of {columns} columns and {rows} rows with {key} {}: \
         use a shorter {key}, a longer patch or flat = true",
        Length(*length)
    )]
    OnlyMean { columns: usize, rows: usize, key: &'static str, length: f64 },
}
