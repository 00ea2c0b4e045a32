//! A part of a patch cut out of it.

use super::level::rms;
use super::preparation_error::PreparationError;
use super::report::change;
use super::{Length, Patch};

/// Lengths that differ by less than this part of the patch are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// The part of a patch that is kept.
///
/// Lengths count from the patch's first corner: the outer edges of its first column and its innermost row, half a pitch
/// before their points. A direction that is absent is kept whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crop {
    /// From where to where along the sliding direction, m.
    pub along: Option<[f64; 2]>,
    /// From where to where across it, outward, m.
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
