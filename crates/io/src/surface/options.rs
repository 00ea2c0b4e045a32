//! What a scene says of a surface file, where the file may say it, too, and how much any file may make the program allocate.

use plateau_core::surface::Length;
use thiserror::Error;

use super::stylus_profile::Lay;
use crate::delimited::Decimal;

/// What a user says of a file that the file itself does not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// Dataset in an HDF5 file, array in an .npz archive, or the number of a table in a text.
    pub dataset: Option<String>,
    /// Time of the map of a run file, s; without it the last one is taken.
    pub at: Option<f64>,
    /// What the number 1 stands for, m; for text that does not state its unit, for NumPy arrays in another unit than m
    /// and for images of decimal heights.
    pub unit: Option<f64>,
    /// Distance of neighbouring points along x and y, m; for files that do not state it.
    pub pitch: Option<[f64; 2]>,
    /// Heights of black and white of an image, m.
    pub height_range: Option<[f64; 2]>,
    /// The decimal mark of a text file, where its content does not tell it.
    pub decimal: Option<Decimal>,
    /// Lines of a text file that are not read, from its first. A file of which lines are skipped, also none, is taken as
    /// a table, whatever its first lines tell.
    pub skip: Option<u64>,
    /// The file is a profile, and this is the direction of its lay.
    pub profile_lay: Option<Lay>,
}

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

/// Points of the largest grid that is read (2 GiB of heights): a shape can promise more than any memory holds.
pub(super) const MOST_POINTS: usize = 1 << 28;

/// Bytes that deflate makes of one at most (RFC 1951: 258 bytes of two bits, and a little).
pub(super) const MOST_INFLATED: usize = 1032;

/// What a file of so many bytes can hold at most when it is deflated.
pub(super) fn inflated(bytes: usize) -> usize {
    bytes.saturating_mul(MOST_INFLATED)
}
