//! The state of disc, pin and debris: heights, and the status that follows from them (model section 2).

use crate::model::material::Status;
use crate::model::mesh::Mesh;
use crate::model::parameters::{DebrisRule, Parameters};

/// Base of a pin cell: what is there before any wear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Base {
    /// Resin.
    Resin = 0,
    /// Fibre.
    Primary = 1,
}

impl Base {
    /// Tells whether the base is resin.
    #[inline(always)]
    pub fn is_resin(self) -> bool {
        self == Self::Resin
    }
}

/// Disc ring: one value per cell, column by column (see [`Mesh`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Disc {
    /// z_d, m, positive toward the pin.
    pub height: Vec<f64>,
    /// b_d ≤ z_d, m: top of what is not compacted debris.
    pub substrate: Vec<f64>,
}

impl Disc {
    /// Status of every cell as it is reported, column by column.
    pub fn reported_statuses(&self) -> impl Iterator<Item = Status> + '_ {
        let cells = self.height.iter().zip(&self.substrate);
        cells.map(|(height, substrate)| reported_disc_status(*height, *substrate))
    }
}

/// Pin: one value per cell, column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// z_p, m, on the disc's axis: wear raises it, away from the disc.
    pub height: Vec<f64>,
    /// b_p ≥ z_p, m: surface of what is not compacted debris.
    pub substrate: Vec<f64>,
    /// Resin or fibre.
    pub base: Vec<Base>,
}

impl Pin {
    /// Status of every cell as the rules take it, column by column.
    pub fn statuses(&self) -> impl Iterator<Item = Status> + '_ {
        self.cells().map(|(height, substrate, is_resin)| pin_status(height, substrate, is_resin))
    }

    /// Status of every cell as it is reported, column by column.
    pub fn reported_statuses(&self) -> impl Iterator<Item = Status> + '_ {
        self.cells().map(|(height, substrate, is_resin)| reported_pin_status(height, substrate, is_resin))
    }

    /// z_p and b_p of every cell, m, and whether its base is resin.
    fn cells(&self) -> impl Iterator<Item = (f64, f64, bool)> + '_ {
        let cells = self.height.iter().zip(&self.substrate).zip(&self.base);
        cells.map(|((height, substrate), base)| (*height, *substrate, base.is_resin()))
    }
}

/// Status of a disc cell: secondary where the surface stands above the substrate.
pub fn disc_status(height: f64, substrate: f64) -> Status {
    if height > substrate { Status::Secondary } else { Status::Primary }
}

/// Status of a pin cell: secondary where debris stands out of the substrate toward the disc, else its base.
pub fn pin_status(height: f64, substrate: f64, is_resin: bool) -> Status {
    match is_resin {
        _ if height < substrate => Status::Secondary,
        true => Status::Resin,
        false => Status::Primary,
    }
}

/// Thickness from which on a build-up is reported as a plateau, m: below, rounding would decide over what is one. The rules take every
/// build-up.
const LEAST_REPORTED: f64 = 1e-15;

/// Status of a disc cell as it is reported.
pub fn reported_disc_status(height: f64, substrate: f64) -> Status {
    if height - substrate >= LEAST_REPORTED { Status::Secondary } else { Status::Primary }
}

/// Status of a pin cell as it is reported.
pub fn reported_pin_status(height: f64, substrate: f64, is_resin: bool) -> Status {
    if substrate - height >= LEAST_REPORTED { Status::Secondary } else { pin_status(substrate, substrate, is_resin) }
}

/// The two surfaces before the first step.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialSurfaces {
    /// z_d of every disc cell, m.
    pub disc_height: Vec<f64>,
    /// z_p of every pin cell, m; without meaning beyond the pin's outline, as are the bases.
    pub pin_height: Vec<f64>,
    /// Base of every pin cell.
    pub pin_base: Vec<Base>,
}

impl InitialSurfaces {
    /// Tells whether every field has the size that the mesh asks for.
    pub fn fits(&self, mesh: &Mesh) -> bool {
        self.disc_height.len() == mesh.disc_cells()
            && self.pin_height.len() == mesh.pin_cells()
            && self.pin_base.len() == mesh.pin_cells()
    }

    /// z_ref, m: the highest height of the disc.
    pub fn reference_height(&self) -> f64 {
        // −0 becomes 0, as it does in the engine's fields: a cell that is filled up takes over the bits.
        self.disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 0.0
    }
}

/// The state of disc, pin and debris between two steps (model 2).
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// z_d and b_d.
    pub disc: Disc,
    /// z_p, b_p and base.
    pub pin: Pin,
    /// z_ref, m: the highest initial height of the disc.
    pub reference_height: f64,
    /// M, m³: one pool for the contact, one for each row, or none with local debris.
    pub pools: Vec<f64>,
    /// n: steps done.
    pub steps: u64,
    /// Columns by which the disc was turned before the first step: 0 but to see whether that changes anything.
    pub turned: u64,
}

impl State {
    /// State at n = 0: b = z in every cell, M = 0.
    pub fn new(parameters: &Parameters, surfaces: InitialSurfaces) -> Self {
        let reference_height = surfaces.reference_height();
        let InitialSurfaces { disc_height, pin_height, pin_base } = surfaces;
        let pools = match parameters.plateaus.debris {
            DebrisRule::Local => 0,
            DebrisRule::Contact => 1,
            DebrisRule::Track => parameters.mesh.rows(),
        };
        Self {
            reference_height,
            disc: Disc { substrate: disc_height.clone(), height: disc_height },
            pin: Pin { substrate: pin_height.clone(), height: pin_height, base: pin_base },
            pools: vec![0.0; pools],
            steps: 0,
            turned: 0,
        }
    }
}
