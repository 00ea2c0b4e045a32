//! Thickness of the compacted debris on a body: height less what lies below.

use plateau_core::observe::Map;
use plateau_io::run_file::{ReadError, RunFile};

use super::Subject;
use super::moments::floats;
use crate::quantity::{BEYOND, MapLook, RobustRange};

/// Height and substrate of a body.
pub type Body = [Map; 2];

/// Disc and pin.
pub const BODIES: [Body; 2] = [[Map::DiscHeight, Map::DiscSubstrate], [Map::PinHeight, Map::PinSubstrate]];

/// Thickness on every cell, m, column by column; nothing if there are no maps.
pub fn thickness(run: &RunFile, [height, substrate]: Body, index: usize) -> Result<Vec<f64>, ReadError> {
    let (heights, substrates) = (floats(run, height, index)?, floats(run, substrate, index)?);
    let toward = MapLook::of(height).sign();
    Ok(heights.iter().zip(&substrates).map(|(height, substrate)| toward * (height - substrate)).collect())
}

/// The moments that are asked for, else the last one.
pub fn moments_of_thickness(subject: &Subject) -> Vec<usize> {
    let last = || subject.run.map_time().len().checked_sub(1).into_iter().collect();
    if subject.chosen.is_empty() { last() } else { subject.chosen.clone() }
}

/// Thickness that all but the highest half per cent of the covered cells of these runs are below at the moments that are shown, m; none where
/// nothing is covered.
pub fn largest(subjects: &[&Subject], body: Body) -> Result<Option<f64>, ReadError> {
    let mut range = RobustRange::default();
    for subject in subjects {
        for index in moments_of_thickness(subject) {
            let mut covered = thickness(subject.run, body, index)?;
            covered.retain(|thickness| *thickness > 0.0);
            range.add(covered.into_iter());
        }
    }
    Ok(range.quantile(1.0 - BEYOND))
}
