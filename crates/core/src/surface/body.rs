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

    /// Arc length of the body at the mean radius, m.
    pub fn length(self, mesh: &Mesh) -> f64 {
        self.columns(mesh) as f64 * mesh.column_width()
    }
}
