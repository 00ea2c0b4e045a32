//! Heights as a surface file has them.

use plateau_core::surface::{Body, Length, Patch};

use super::format::Format;
use super::options::{Lay, ProfileError, StylusProfile};

/// Heights as a file has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// What the file is.
    pub format: Format,
    /// Points along x, the sliding direction.
    pub columns: usize,
    /// Points along y, outward.
    pub rows: usize,
    /// Distance of neighbouring points along x and y, m; none if neither file nor user tell it.
    pub pitch: Option<[f64; 2]>,
    /// The file does not say in which unit its distances are, and they were taken in that of its heights.
    pub is_pitch_assumed: bool,
    /// Heights, m, column by column: the point (column x, row y) is at `x * rows + y`; NaN where there is none.
    pub heights: Vec<f64>,
    /// Peaks are positive whatever the body, as an instrument gives them; else heights are those of the model.
    pub instrument: bool,
    /// A run recorded them of the cells of this body.
    pub body: Option<Body>,
    /// The heights are a profile, in one row, and its lay has this direction.
    pub profile_lay: Option<Lay>,
    /// What the file says of itself that a user may want to see, one fact a line.
    pub notes: Vec<String>,
    /// What is wrong with the file but does not change its heights, as a checksum that does not fit.
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

    /// The heights with their pitch, if that is known.
    pub fn into_patch(self) -> Option<Patch> {
        let Self { columns, rows, heights, .. } = self;
        let [column_pitch, row_pitch] = self.pitch?;
        Some(Patch { columns, rows, column_pitch, row_pitch, heights })
    }

    /// The heights as a profile; none if they are not taken as one. `pixel` reinterprets the distance of its points, m.
    ///
    /// # Errors
    /// [`ProfileError`] if the distance of its points is unknown.
    pub fn stylus_profile(&self, pixel: Option<f64>) -> Result<Option<StylusProfile>, ProfileError> {
        let Some(lay) = self.profile_lay else { return Ok(None) };
        let pitch = pixel.or(self.pitch.map(|pitch| pitch[0])).ok_or(ProfileError::NoPitch)?;
        Ok(Some(StylusProfile { pitch, heights: self.heights.clone(), lay }))
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
