//! Heights as a surface file has them, and what a scene says of them, where the file may say it, too: also that they are a profile, and
//! what surface that stands for.

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, Length, Patch};
use thiserror::Error;

use super::format::Format;
pub use crate::scene::{Lay, ReadOptions};

/// Heights as a file has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Format of the file.
    pub format: Format,
    /// Points along x, the sliding direction.
    pub columns: usize,
    /// Points along y, outward.
    pub rows: usize,
    /// Distance of neighbouring points along x and y, m; none if neither file nor user tell it.
    pub pitch: Option<[f64; 2]>,
    /// True if the file does not say in which unit its distances are, and they were taken in that of its heights.
    pub is_pitch_assumed: bool,
    /// Heights, m, column by column: the point (column x, row y) is at `x * rows + y`; NaN where there is none.
    pub heights: Vec<f64>,
    /// True if peaks are positive whatever the body, as an instrument gives them; else heights are those of the model.
    pub instrument: bool,
    /// Body whose cells these are heights of, as a run recorded them; none for other heights.
    pub body: Option<Body>,
    /// Direction of the lay, if the heights are a profile, in one row.
    pub profile_lay: Option<Lay>,
    /// Facts that the file states of itself and that a user may want to see, one a line.
    pub notes: Vec<String>,
    /// Faults of the file that do not change its heights, such as a checksum that does not fit.
    pub warnings: Vec<String>,
}

impl Measured {
    /// Heights of an instrument of which nothing else is to be said: column by column, m, on so many columns and rows.
    pub fn new(format: Format, [columns, rows]: [usize; 2], pitch: Option<[f64; 2]>, heights: Vec<f64>) -> Self {
        Self {
            format,
            columns,
            rows,
            pitch,
            is_pitch_assumed: false,
            heights,
            instrument: true,
            body: None,
            profile_lay: None,
            notes: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Takes the heights as a profile: in one row, with one pitch.
    pub(super) fn take_as_profile(&mut self, lay: Lay) -> Result<(), ProfileError> {
        let size = (self.columns, self.rows);
        let along = match size {
            (2.., 1) => 0,
            (1, 2..) => 1,
            _ => return Err(ProfileError::NotALine { size }),
        };
        self.pitch = self.pitch.map(|pitch| [pitch[along]; 2]);
        (self.columns, self.rows) = (self.heights.len(), 1);
        self.profile_lay = Some(lay);
        Ok(())
    }

    /// Size and pitch in words.
    pub fn describe(&self) -> String {
        let pitch = match self.pitch {
            None => "pitch unknown".to_owned(),
            Some([x, y]) if x == y => format!("{} pitch", Length(x)),
            Some([x, y]) => format!("{} by {} pitch", Length(x), Length(y)),
        };
        if self.profile_lay.is_some() {
            return format!("profile of {} points, {pitch}", self.columns);
        }
        format!("{} x {} points, {pitch}", self.columns, self.rows)
    }
}

/// Largest relative difference of what file and scene state at which it is the same: headers have few digits.
const SAME: f64 = 0.01;

/// Disagreement of file and scene.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "the file states a {key} of {}, the scene {}: leave out {key}",
    Length(*file), Length(*scene)
)]
pub struct Disagreement {
    /// Key of the scene.
    pub key: &'static str,
    /// Length that the file states, m.
    pub file: f64,
    /// Length that the scene states, m.
    pub scene: f64,
}

/// Returns the length that file or scene state, m; where both do, the scene's.
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

/// Returns the bytes that a file of so many bytes can hold at most when it is deflated.
pub(super) fn inflated(bytes: usize) -> usize {
    bytes.saturating_mul(MOST_INFLATED)
}

/// Lists the parts of a kind that a file has: the first ones, and how many more; or that there is nothing.
pub(super) fn present<T>(all: &[T], name: impl Fn(&T) -> String, nothing: &str) -> String {
    const NAMED: usize = 12;
    if all.is_empty() {
        return nothing.to_owned();
    }
    let mut names: Vec<String> = all.iter().take(NAMED).map(name).collect();
    if all.len() > NAMED {
        names.push(format!("and {} more", all.len() - NAMED));
    }
    format!("it has {}", names.join(", "))
}

/// Reason why a file gives no profile, or a profile no surface.
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

/// The surface of grooves that a profile of points this far apart, m, stands for, with the size that `body` needs along the grooves: one
/// column as long as the body, or one row as wide as the track. Across the grooves it is as long as the profile. Besides, what becomes of
/// the profile, in words.
///
/// Without grooves it is the profile itself, in one row as wide as its pitch.
pub(super) fn grooves(heights: Vec<f64>, pitch: f64, lay: Lay, body: Body, mesh: &Mesh) -> (Patch, &'static str) {
    let points = heights.len();
    let row = |row_pitch: f64| (points, 1, pitch, row_pitch);
    let ((columns, rows, column_pitch, row_pitch), told) = match lay {
        Lay::Along => {
            ((1, points, body.length(mesh), pitch), "profile across grooves along sliding, the same all along")
        }
        Lay::Across => {
            let track = mesh.rows() as f64 * mesh.row_height();
            (row(track), "profile along sliding across grooves, the same from edge to edge")
        }
        Lay::Isotropic => (row(pitch), "profile of a surface without a direction"),
    };
    (Patch { columns, rows, column_pitch, row_pitch, heights }, told)
}
