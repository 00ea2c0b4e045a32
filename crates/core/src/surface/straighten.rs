//! A patch brought to lie along the track: cropped, unrolled, turned, flipped.

use super::error::PreparationError;
use super::heights::{change, rms};
use super::rotate::Turn;
use super::unroll::Unroll;
use super::{Length, Patch};

/// Lengths that differ by less than this part of the patch are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// The part of a patch that is kept.
///
/// Lengths count from the patch's first corner: the outer edges of its first column and its innermost row, half a pitch
/// before their points. A direction that is absent is kept whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crop {
    /// Range along the sliding direction, m.
    pub along: Option<[f64; 2]>,
    /// Range across it, outward, m.
    pub across: Option<[f64; 2]>,
}

impl Crop {
    /// Cuts the part out of the patch: every point at `from` or behind it and before `to`.
    ///
    /// Gives where the first corner of what is left was in the whole patch, m along and across, and what was done.
    pub(super) fn cut_out(&self, patch: &mut Patch) -> Result<([f64; 2], String), PreparationError> {
        let [first_column, end_column] = points("crop.along", self.along, patch.columns, patch.column_pitch)?;
        let [first_row, end_row] = points("crop.across", self.across, patch.rows, patch.row_pitch)?;
        let before = rms(&patch.heights);
        let whole = format!("{} x {}", patch.columns, patch.rows);
        let columns = patch.heights.chunks_exact(patch.rows).take(end_column).skip(first_column);
        let heights = columns.flat_map(|column| &column[first_row..end_row]).copied().collect();
        *patch = Patch { columns: end_column - first_column, rows: end_row - first_row, heights, ..*patch };
        let origin = [first_column as f64 * patch.column_pitch, first_row as f64 * patch.row_pitch];
        let step = format!(
            "cropped to {} by {} from {}, {} of its first corner: {} x {} of {whole} points, {}",
            Length(patch.length()),
            Length(patch.height()),
            Length(origin[0]),
            Length(origin[1]),
            patch.columns,
            patch.rows,
            change(before, &patch.heights)
        );
        Ok((origin, step))
    }
}

/// The first point in a range, and the one behind the last.
fn points(
    key: &'static str,
    range: Option<[f64; 2]>,
    count: usize,
    pitch: f64,
) -> Result<[usize; 2], PreparationError> {
    let Some([from, to]) = range else { return Ok([0, count]) };
    let length = count as f64 * pitch;
    let slack = SAME_LENGTH * length;
    // NaN is refused, too.
    if !(from >= -slack && to <= length + slack && from < to) {
        return Err(PreparationError::Crop { key, from, to, length });
    }
    // Point i lies at (i + ½) pitch.
    let first_behind = |place: f64| (libm::ceil(place / pitch - 0.5).max(0.0) as usize).min(count);
    let [first, end] = [first_behind(from), first_behind(to)];
    if first < end { Ok([first, end]) } else { Err(PreparationError::CropWithoutPoint { key, from, to, pitch }) }
}

/// Direction in which heights are reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flip {
    /// Reversal along the sliding direction: the first column becomes the last.
    Along,
    /// Reversal across it: the innermost row becomes the outermost.
    Across,
    /// Reversal in both directions: half a turn.
    Both,
}

impl Flip {
    /// Reverses the patch; says what was done.
    pub(super) fn reverse(self, patch: &mut Patch) -> String {
        let direction = match self {
            Self::Along => {
                reverse_along(patch);
                "along the sliding direction"
            }
            Self::Across => {
                reverse_across(patch);
                "across the sliding direction"
            }
            Self::Both => {
                patch.heights.reverse();
                "along and across the sliding direction"
            }
        };
        format!("flipped {direction}")
    }
}

/// Reverses the order of the columns.
pub(super) fn reverse_along(patch: &mut Patch) {
    let columns: Vec<&[f64]> = patch.heights.chunks_exact(patch.rows).rev().collect();
    patch.heights = columns.concat();
}

/// Reverses the order of the rows.
fn reverse_across(patch: &mut Patch) {
    patch.heights.chunks_exact_mut(patch.rows).for_each(<[f64]>::reverse);
}

/// Crops, unrolls, turns and flips the patch, in this order; gives what was done, one step a line.
pub(super) fn straighten(
    patch: &mut Patch,
    crop: Option<Crop>,
    unroll: Option<Unroll>,
    turn: Turn,
    flip: Option<Flip>,
) -> Result<Vec<String>, PreparationError> {
    let (mut origin, mut report) = ([0.0; 2], Vec::new());
    if let Some(crop) = crop {
        let (corner, step) = crop.cut_out(patch)?;
        origin = corner;
        report.push(step);
    }
    if let Some(unroll) = unroll {
        report.push(unroll.unroll(patch, origin)?);
    }
    report.extend(turn.turn(patch));
    report.extend(flip.map(|flip| flip.reverse(patch)));
    Ok(report)
}
