//! How a patch comes to lie along the track: cropped, unrolled, turned, flipped.

use super::Patch;
use super::crop::Crop;
use super::flip::Flip;
use super::preparation_error::PreparationError;
use super::rotate::Turn;
use super::unroll::Unroll;

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
