//! Heights on a rectangular grid, as an instrument gives them, the bodies that get them, and lengths in messages.

use std::fmt;

use crate::model::mesh::Mesh;

/// A length in m, printed with four digits in the unit that suits it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Length(pub f64);

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        let (per_metre, unit) = if size == 0.0 || !size.is_finite() {
            (1.0, "m")
        } else if size < 0.9995e-6 {
            (1e9, "nm")
        } else if size < 0.9995e-3 {
            (1e6, "um")
        } else if size < 0.9995 {
            (1e3, "mm")
        } else {
            (1.0, "m")
        };
        let value = self.0 * per_metre;
        if value.is_finite() && size != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
            return write!(f, "{value:.3e} {unit}");
        }
        // Four significant digits, without the zeros that would pretend more.
        let digits = match value.abs() {
            v if v >= 1000.0 => 0,
            v if v >= 100.0 => 1,
            v if v >= 10.0 => 2,
            v if v >= 1.0 => 3,
            _ => 6,
        };
        let text = format!("{value:.digits$}");
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        write!(f, "{text} {unit}")
    }
}

/// Heights on a rectangular grid with x along the sliding direction and y outward.
///
/// Stored like the mesh, column by column: the point (column x, row y) is at `x * rows + y`. A missing point is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Distance of neighbouring columns, m.
    pub column_pitch: f64,
    /// Distance of neighbouring rows, m.
    pub row_pitch: f64,
    /// Heights, m; NaN where there is none.
    pub heights: Vec<f64>,
}

impl Patch {
    /// Number of points without a height.
    pub fn missing(&self) -> usize {
        self.heights.iter().filter(|height| height.is_nan()).count()
    }

    /// Extent along x, m: every point stands for one pitch.
    pub fn length(&self) -> f64 {
        self.columns as f64 * self.column_pitch
    }

    /// Extent along y, m.
    pub fn height(&self) -> f64 {
        self.rows as f64 * self.row_pitch
    }
}

/// Points that share a side with this one, on a grid of so many points in lines of so many.
pub(super) fn neighbours(point: usize, line: usize, points: usize) -> [Option<usize>; 4] {
    let place = point % line;
    [
        (place > 0).then(|| point - 1),
        (place + 1 < line).then_some(point + 1),
        point.checked_sub(line),
        (point + line < points).then_some(point + line),
    ]
}

/// Body of the pair, disc or pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Body {
    /// The whole ring; x runs round it and closes.
    Disc,
    /// The part of the ring under the pin; x starts at pin column 0 and does not close.
    Pin,
}

impl Body {
    /// The body's name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Disc => "ring",
            Self::Pin => "pin",
        }
    }

    /// Columns of the body's fields.
    pub fn columns(self, mesh: &Mesh) -> usize {
        match self {
            Self::Disc => mesh.disc_columns(),
            Self::Pin => mesh.pin_columns(),
        }
    }

    /// The sign that makes peaks positive: heights are positive toward the other body wherever they are measured or shown, while
    /// the pin's z grows away from the disc.
    pub fn peak_sign(self) -> f64 {
        match self {
            Self::Disc => 1.0,
            Self::Pin => -1.0,
        }
    }

    /// Turns heights of the model into those with positive peaks, or back.
    pub fn turn(self, heights: &mut [f64]) {
        if self == Self::Pin {
            heights.iter_mut().for_each(|height| *height = -*height);
        }
    }

    /// Arc length of the body at the mean radius, m.
    pub fn length(self, mesh: &Mesh) -> f64 {
        self.columns(mesh) as f64 * mesh.column_width()
    }
}
