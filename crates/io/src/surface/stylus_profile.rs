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
    #[error(
        "the file does not say the distance of its points: pitch = \"0.5 um\" below file in the scene does, for example"
    )]
    NoPitch,
    /// Nothing says how the surface is made of the profile.
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
