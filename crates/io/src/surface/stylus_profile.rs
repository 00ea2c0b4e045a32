//! Profiles, as a stylus instrument gives them, and the surfaces they stand for.

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, Patch};
use thiserror::Error;

/// Direction of the lay of a surface, of which a profile says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lay {
    /// Grooves along the sliding direction: the profile was traced across it, and goes on unchanged along it.
    Along,
    /// Grooves across the sliding direction: the profile was traced along it, and goes on unchanged across it.
    Across,
    /// No direction: a surface that has the statistics of the profile in every direction.
    Isotropic,
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
pub enum ProfileError {
    /// The file holds a surface.
    #[error("profile_lay takes the file as a profile, but it has {} x {} points: leave out profile_lay", size.0, size.1)]
    NotALine {
        /// Columns and rows.
        size: (usize, usize),
    },
    /// Different pitches along x and y were given.
    #[error("a profile has one pitch, the scene gives two: pitch = \"0.5 um\", for example")]
    TwoPitches,
    /// Nothing says the pitch.
    #[error("the file does not say the distance of its points: pitch = \"0.5 um\" beside file does, for example")]
    NoPitch,
    /// The surface cannot be made.
    #[error(
        "profile_lay = \"isotropic\" asks for a surface with the statistics of the profile in every direction, which this \
         version does not make: say \"along\" or \"across\" for grooves, or use synthetic heights with the rms height and the \
         correlation length of the profile"
    )]
    Isotropic,
}

impl StylusProfile {
    /// The surface of grooves that the profile stands for, with the size that `body` needs along the grooves: one column
    /// as long as the body, or one row as wide as the track.
    ///
    /// Across the grooves it is as long as the profile.
    ///
    /// # Errors
    /// [`ProfileError`] for a profile without grooves.
    pub fn into_patch(self, body: Body, mesh: &Mesh) -> Result<Patch, ProfileError> {
        let Self { pitch, heights, lay } = self;
        let points = heights.len();
        match lay {
            Lay::Along => {
                Ok(Patch { columns: 1, rows: points, column_pitch: body.length(mesh), row_pitch: pitch, heights })
            }
            Lay::Across => {
                let width = mesh.rows() as f64 * mesh.row_height();
                Ok(Patch { columns: points, rows: 1, column_pitch: pitch, row_pitch: width, heights })
            }
            Lay::Isotropic => Err(ProfileError::Isotropic),
        }
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
