//! The preparation chain of a surface.

use thiserror::Error;

use super::level::{level, mean};
use super::resample::resample;
use super::{Body, Length, Patch};
use crate::mesh::Mesh;

/// What is taken out of a surface before anything else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Nothing.
    None,
    /// The mean height.
    Mean,
    /// The least-squares plane; of heights that cover the whole ring only the mean and the radial slope.
    Plane,
}

/// The preparation chain; a step that is absent is not done. Applied in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preparation {
    /// Levelling; missing points do not take part.
    pub level: Level,
    /// Whether missing points get the levelled surface's mean; without it they are an error.
    pub fill_missing: bool,
    /// Reinterprets the distance of the points, m.
    pub pixel: Option<f64>,
    /// Cuts what stands higher than this above the mean, m (along the Abbott-Firestone curve).
    pub cutoff: Option<f64>,
    /// Tiles the patch along the sliding direction without a step at the seams.
    pub repeat: bool,
    /// Multiplies the heights.
    pub scale: f64,
}

impl Default for Preparation {
    /// Nothing is done.
    fn default() -> Self {
        Self { level: Level::None, fill_missing: false, pixel: None, cutoff: None, repeat: false, scale: 1.0 }
    }
}

/// Heights before their preparation.
#[derive(Debug, Clone, PartialEq)]
pub enum RawHeights {
    /// One height for every cell of the body, m, column by column.
    OnMesh(Vec<f64>),
    /// A patch with a pitch of its own.
    Patch(Patch),
}

/// Heights ready for the first step.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// One height for every cell of the body, m, column by column.
    pub heights: Vec<f64>,
    /// What was done, one step a line, for people.
    pub report: Vec<String>,
}

/// Why a surface cannot be prepared.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PreparationError {
    /// The grid is none.
    #[error(
        "a grid of {columns} columns and {rows} rows with {points} heights, pitch {} by {}: expected columns times \
         rows heights, at least one, and pitches that are positive and finite",
        Length(*column_pitch), Length(*row_pitch)
    )]
    Grid {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
        /// Heights.
        points: usize,
        /// Pitch along x, m.
        column_pitch: f64,
        /// Pitch along y, m.
        row_pitch: f64,
    },
    /// Points without a height.
    #[error("{missing} of {points} points are missing; fill = \"level\" gives them the mean of the levelled surface")]
    Missing {
        /// Points without a height.
        missing: usize,
        /// All points.
        points: usize,
    },
    /// No point has a height.
    #[error("all {points} points are missing")]
    AllMissing {
        /// All points.
        points: usize,
    },
    /// A number of the chain makes no sense.
    #[error("{key} is {found}, expected {expected}")]
    Value {
        /// Key of the preparation table.
        key: &'static str,
        /// What was asked for, SI units.
        found: f64,
        /// What can be.
        expected: &'static str,
    },
    /// The patch does not cover the track.
    #[error(
        "the patch is {} wide in r, the track {}: a pixel of at least {} lets its {rows} rows cover the track",
        Length(*patch), Length(*track), Length(*pixel)
    )]
    Narrow {
        /// Extent of the patch in r, m.
        patch: f64,
        /// Width of the track, m.
        track: f64,
        /// Smallest pitch that covers the track, m.
        pixel: f64,
        /// Rows of the patch.
        rows: usize,
    },
    /// The patch does not cover the body along the sliding direction.
    #[error(
        "the patch is {} long, the {body} {} at the mean radius: repeat = true tiles the patch without a step at \
         the seams",
        Length(*patch), Length(*length)
    )]
    Short {
        /// Length of the patch, m.
        patch: f64,
        /// Name of the body.
        body: &'static str,
        /// Length of the body, m.
        length: f64,
    },
    /// Not even one column is covered.
    #[error("the patch is {} long, one column {} at the mean radius: a larger pixel is needed", Length(*patch), Length(*column))]
    ShorterThanColumn {
        /// Length of the patch, m.
        patch: f64,
        /// Arc length of a column, m.
        column: f64,
    },
    /// Heights that are no numbers.
    #[error("{count} of {points} prepared heights are not finite: the heights or the scale of {scale} are too large")]
    NotFinite {
        /// Heights that are not finite.
        count: usize,
        /// All heights.
        points: usize,
        /// Factor of the preparation.
        scale: f64,
    },
}

impl Preparation {
    /// Brings heights onto every cell of `body`: mirrored along x if asked for, levelled, filled, read with another
    /// pitch, cut, repeated, scaled.
    ///
    /// Heights that are already on the mesh come through bit for bit when nothing is asked for. With `pixel` they are
    /// taken as a patch of that pitch; `repeat` alone leaves them alone, for they cover the whole body.
    ///
    /// # Errors
    /// [`PreparationError`] when points are missing and not filled, the patch does not cover the body, or a number
    /// makes no sense.
    pub fn apply(&self, raw: RawHeights, mirror: bool, body: Body, mesh: &Mesh) -> Result<Prepared, PreparationError> {
        self.check()?;
        let mut report = Vec::new();
        let (mut patch, on_mesh) = self.as_patch(raw, body, mesh);
        check_grid(&patch)?;
        let closed = on_mesh && body == Body::Disc;
        if mirror {
            let columns: Vec<&[f64]> = patch.heights.chunks_exact(patch.rows).rev().collect();
            patch.heights = columns.concat();
            report.push("mirrored along the sliding direction".to_owned());
        }
        self.level_and_fill(&mut patch, closed, &mut report)?;
        if let Some(pixel) = self.pixel {
            (patch.column_pitch, patch.row_pitch) = (pixel, pixel);
            report.push(format!("pixel pitch taken as {}", Length(pixel)));
        }
        if let Some(cutoff) = self.cutoff {
            let cut = cut(&mut patch.heights, cutoff);
            report.push(format!("cut at {} above the mean: {:.3} % of points", Length(cutoff), 100.0 * cut));
        }
        let mut heights = if on_mesh {
            patch.heights
        } else {
            let heights = resample(&patch, self.repeat, body, mesh)?;
            report.push(self.describe_resampling(&patch, body, mesh));
            heights
        };
        if self.scale != 1.0 {
            heights.iter_mut().for_each(|height| *height *= self.scale);
            report.push(format!("heights times {}", self.scale));
        }
        let count = heights.iter().filter(|height| !height.is_finite()).count();
        if count > 0 {
            return Err(PreparationError::NotFinite { count, points: heights.len(), scale: self.scale });
        }
        Ok(Prepared { heights, report })
    }

    fn check(&self) -> Result<(), PreparationError> {
        let refuse = |key, found, expected| Err(PreparationError::Value { key, found, expected });
        match (self.pixel, self.cutoff) {
            (Some(pixel), _) if !(pixel > 0.0 && pixel.is_finite()) => {
                refuse("pixel", pixel, "a positive, finite length in m")
            }
            (_, Some(cutoff)) if !cutoff.is_finite() => refuse("cutoff", cutoff, "a finite length in m"),
            _ if !self.scale.is_finite() => refuse("scale", self.scale, "a finite number"),
            _ => Ok(()),
        }
    }

    /// The heights as a patch, and whether they are on the mesh and stay there.
    fn as_patch(&self, raw: RawHeights, body: Body, mesh: &Mesh) -> (Patch, bool) {
        match raw {
            RawHeights::Patch(patch) => (patch, false),
            RawHeights::OnMesh(heights) => {
                let patch = Patch {
                    columns: body.columns(mesh),
                    rows: mesh.rows(),
                    column_pitch: mesh.column_width(),
                    row_pitch: mesh.row_height(),
                    heights,
                };
                (patch, self.pixel.is_none())
            }
        }
    }

    fn level_and_fill(
        &self,
        patch: &mut Patch,
        closed: bool,
        report: &mut Vec<String>,
    ) -> Result<(), PreparationError> {
        let (missing, points) = (patch.missing(), patch.heights.len());
        if missing == points {
            return Err(PreparationError::AllMissing { points });
        }
        if missing > 0 && !self.fill_missing {
            return Err(PreparationError::Missing { missing, points });
        }
        level(&mut patch.heights, patch.rows, self.level, closed);
        match self.level {
            Level::None => {}
            Level::Mean => report.push("levelled by the mean".to_owned()),
            Level::Plane if closed => report.push("levelled by the mean and the radial slope".to_owned()),
            Level::Plane => report.push("levelled by the least-squares plane".to_owned()),
        }
        if missing > 0 {
            let mean = mean(&patch.heights);
            patch.heights.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = mean);
            report.push(format!("{missing} of {points} points were missing and got the mean of the others"));
        }
        Ok(())
    }

    fn describe_resampling(&self, patch: &Patch, body: Body, mesh: &Mesh) -> String {
        let size = format!("patch of {} by {}", Length(patch.length()), Length(patch.height()));
        match (self.repeat, body) {
            (true, Body::Disc) => {
                let times = body.length(mesh) / patch.length();
                format!("{size} repeated {times:.2} times round the ring, mirrored at the seams")
            }
            (true, Body::Pin) => format!("{size} repeated along the pin, mirrored at the seams"),
            (false, Body::Disc) => format!(
                "{size} laid round the ring without repeating: a step may be left where the ring closes \
                 (repeat = true leaves none)"
            ),
            (false, Body::Pin) => format!("{size} laid over the pin"),
        }
    }
}

fn check_grid(patch: &Patch) -> Result<(), PreparationError> {
    let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
    let sized = !heights.is_empty() && columns.checked_mul(rows) == Some(heights.len());
    let pitched = column_pitch > 0.0 && row_pitch > 0.0 && patch.length().is_finite() && patch.height().is_finite();
    if sized && pitched {
        Ok(())
    } else {
        Err(PreparationError::Grid { columns, rows, points: heights.len(), column_pitch, row_pitch })
    }
}

/// Cuts what stands higher than `cutoff` above the mean down to that level, in place; gives the fraction of points cut:
/// the material ratio of the Abbott-Firestone curve at that level.
fn cut(heights: &mut [f64], cutoff: f64) -> f64 {
    let ceiling = mean(heights) + cutoff;
    let mut count = 0usize;
    for height in heights.iter_mut().filter(|height| **height > ceiling) {
        *height = ceiling;
        count += 1;
    }
    count as f64 / heights.len() as f64
}
