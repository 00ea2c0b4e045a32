//! What `plateau check` reports of a pin that is no rectangle.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::outline::Outline;
use serde::Serialize;

use crate::number;

/// The pin within its outline.
#[derive(Debug, Serialize)]
pub(super) struct OutlineReport {
    shape: &'static str,
    /// m.
    diameter: f64,
    /// Cells of the pin that are there.
    cells: usize,
    /// Their area, m².
    area: f64,
}

impl OutlineReport {
    /// That of a mesh; none for a rectangle.
    pub(super) fn of(mesh: &Mesh) -> Option<Self> {
        match mesh.outline() {
            Outline::Rectangle => None,
            Outline::Disc { radius } => {
                Some(Self { shape: "disc", diameter: 2.0 * radius, cells: mesh.present_cells(), area: mesh.pin_area() })
            }
        }
    }

    /// In words.
    pub(super) fn text(&self) -> String {
        format!(
            "a circle of {} mm in diameter: {} cells, {} mm²",
            number::short(self.diameter * 1e3),
            number::grouped(self.cells as u64),
            number::short(self.area * 1e6)
        )
    }
}
