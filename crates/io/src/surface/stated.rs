//! What both a file and a scene may state: they must not contradict each other.

use plateau_core::surface::Length;
use thiserror::Error;

/// What file and scene state is the same if it differs by no more than this fraction: headers have few digits.
const SAME: f64 = 0.01;

/// File and scene disagree.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "the file states a {key} of {}, the scene {}: leave out {key} (pixel and scale in the prepare table read a file \
     differently than it says)",
    Length(*file), Length(*scene)
)]
pub struct Disagreement {
    /// Key of the scene.
    pub key: &'static str,
    /// What the file says, m.
    pub file: f64,
    /// What the scene says, m.
    pub scene: f64,
}

/// What file or scene state, m; where both do, the scene's.
pub(super) fn agreed(key: &'static str, file: Option<f64>, scene: Option<f64>) -> Result<Option<f64>, Disagreement> {
    match (file, scene) {
        (Some(file), Some(scene)) if (file - scene).abs() > SAME * scene => Err(Disagreement { key, file, scene }),
        _ => Ok(scene.or(file)),
    }
}

/// The pitch along x and y that file or scene state, m.
pub(super) fn agreed_pitch(file: Option<[f64; 2]>, scene: Option<[f64; 2]>) -> Result<Option<[f64; 2]>, Disagreement> {
    for axis in 0..2 {
        agreed("pitch", file.map(|pitch| pitch[axis]), scene.map(|pitch| pitch[axis]))?;
    }
    Ok(scene.or(file))
}
