//! What a scene says of a surface file, where the file may say it, too: also that it is a profile, and what surface that stands for.

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, Length, Patch};
use thiserror::Error;

pub use crate::scene::{Lay, ReadOptions};

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

/// Heights along a line, with what a user takes them for.
#[derive(Debug, Clone, PartialEq)]
pub struct StylusProfile {
    /// Distance of neighbouring points, m.
    pub pitch: f64,
    /// Heights, m; NaN where there is none.
    pub heights: Vec<f64>,
    /// The lay of the surface that the profile stands for.
    pub lay: Lay,
}

/// Why a file gives no profile, or a profile no surface.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum ProfileError {
    #[error("profile_lay takes the file as a profile, but it has {} x {} points: leave out profile_lay", size.0, size.1)]
    NotALine { size: (usize, usize) },
    #[error("a profile has one pitch, the scene gives two: pitch = \"0.5 um\", for example")]
    TwoPitches,
    #[error(
        "the file does not say the distance of its points: pitch = \"0.5 um\" below file in the scene does, for example"
    )]
    NoPitch,
    #[error(
        "profile_lay = \"isotropic\" asks for random heights with the statistics of the profile in every direction: \
         extend = \"statistics\" in the prepare table of the same body makes them"
    )]
    Isotropic,
}

impl StylusProfile {
    /// The surface of grooves that the profile stands for, with the size that `body` needs along the grooves: one column
    /// as long as the body, or one row as wide as the track. Across the grooves it is as long as the profile.
    ///
    /// Without grooves it is the profile itself, in one row as wide as its pitch.
    pub fn into_patch(self, body: Body, mesh: &Mesh) -> Patch {
        let Self { pitch, heights, lay } = self;
        let points = heights.len();
        let row = |row_pitch: f64| (points, 1, pitch, row_pitch);
        let (columns, rows, column_pitch, row_pitch) = match lay {
            Lay::Along => (1, points, body.length(mesh), pitch),
            Lay::Across => row(mesh.rows() as f64 * mesh.row_height()),
            Lay::Isotropic => row(pitch),
        };
        Patch { columns, rows, column_pitch, row_pitch, heights }
    }

    /// What becomes of the profile, in words.
    pub fn describe(&self) -> &'static str {
        match self.lay {
            Lay::Along => "profile across grooves along sliding, the same all along",
            Lay::Across => "profile along sliding across grooves, the same from edge to edge",
            Lay::Isotropic => "profile of a surface without a direction",
        }
    }
}
