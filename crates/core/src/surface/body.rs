//! The two bodies as grids: how many cells, how large, closed or not.

use crate::model::mesh::Mesh;

/// Which surface of the pair.
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
