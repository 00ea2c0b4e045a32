//! Heights of disc and pin, and the status that follows from them (model section 2).

use crate::field::Field;
use crate::kernel::{DiscView, PinView};
use crate::material::Status;
use crate::mesh::Mesh;

/// Base of a pin cell: what is there before any wear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Base {
    /// Resin.
    None = 0,
    /// Fibre.
    Primary = 1,
}

/// A height that nothing reaches: fills the last group of every pin column.
const OUT_OF_REACH: f64 = f64::MAX / 4.0;

/// Disc ring.
#[derive(Debug, Clone, PartialEq)]
pub struct Disc {
    /// z_d, m, positive toward the pin.
    pub height: Field<f64>,
    /// b_d ≤ z_d, m: top of what is not compacted debris.
    pub substrate: Field<f64>,
}

impl Disc {
    /// Disc before the first step: no build-up anywhere.
    pub fn new(mesh: &Mesh, height: &[f64]) -> Self {
        let height = Field::new(mesh, height, 0.0);
        Self { substrate: height.clone(), height }
    }

    /// One column of it.
    #[inline]
    pub fn view(&self, column: usize) -> DiscView<'_> {
        DiscView { height: self.height.column(column), substrate: self.substrate.column(column) }
    }

    /// Status of every cell, column by column: secondary where the surface stands above the substrate.
    pub fn statuses(&self) -> impl Iterator<Item = Status> + '_ {
        let cells = self.height.cells().zip(self.substrate.cells());
        cells.map(|(height, substrate)| if height > substrate { Status::Secondary } else { Status::Primary })
    }
}

/// Pin.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// z_p, m, on the disc's axis: wear raises it, away from the disc.
    pub height: Field<f64>,
    /// b_p ≥ z_p, m: surface of what is not compacted debris.
    pub substrate: Field<f64>,
    /// Resin or fibre.
    pub base: Field<Base>,
}

impl Pin {
    /// Pin before the first step: no build-up anywhere.
    pub fn new(mesh: &Mesh, height: &[f64], base: &[Base]) -> Self {
        let height = Field::new(mesh, height, OUT_OF_REACH);
        Self { substrate: height.clone(), height, base: Field::new(mesh, base, Base::Primary) }
    }

    /// One column of it.
    #[inline]
    pub fn view(&self, column: usize) -> PinView<'_> {
        PinView {
            height: self.height.column(column),
            substrate: self.substrate.column(column),
            base: self.base.column(column),
        }
    }

    /// Status of every cell, column by column: secondary where debris stands out of the substrate toward the disc,
    /// else its base.
    pub fn statuses(&self) -> impl Iterator<Item = Status> + '_ {
        let cells = self.height.cells().zip(self.substrate.cells()).zip(self.base.cells());
        cells.map(|((height, substrate), base)| match base {
            _ if height < substrate => Status::Secondary,
            Base::None => Status::None,
            Base::Primary => Status::Primary,
        })
    }
}

/// The two surfaces before the first step.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialSurfaces {
    /// z_d of every disc cell, m.
    pub disc_height: Vec<f64>,
    /// z_p of every pin cell, m.
    pub pin_height: Vec<f64>,
    /// Base of every pin cell.
    pub pin_base: Vec<Base>,
}

impl InitialSurfaces {
    /// Whether every field has the size that the mesh asks for.
    pub fn fits(&self, mesh: &Mesh) -> bool {
        self.disc_height.len() == mesh.disc_cells()
            && self.pin_height.len() == mesh.pin_cells()
            && self.pin_base.len() == mesh.pin_cells()
    }
}
