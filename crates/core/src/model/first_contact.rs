//! The contact of the first step, known before there is a simulation (model 4.1).
//!
//! Cell by cell and in plain sums, for those who want to know what load and surfaces lead to. A simulation balances every
//! step by itself, to the last bit the same on any number of workers.

use crate::model::material::Status;
use crate::model::parameters::Parameters;
use crate::model::state::{Base, InitialSurfaces};

/// Contact of the first step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstContact {
    /// δ, m.
    pub displacement: f64,
    /// Σ A over cells in contact, resin included, m².
    pub contact_area: f64,
    /// Σ p A / Σ A over cells in contact, resin included, Pa.
    pub mean_pressure: f64,
    /// The largest overlap u = δ − g of a pair that carries, m.
    pub largest_overlap: f64,
}

/// One pair of cells: its gap g, m, its stiffness k A, N/m, and its area A, m².
struct Pair {
    gap: f64,
    stiffness: f64,
    area: f64,
}

impl FirstContact {
    /// Solves Σ k A (δ − g)₊ = F_N for the pin where it is set down. None where no finite displacement carries the load, of
    /// which the simulation says why.
    pub fn of(parameters: &Parameters, surfaces: &InitialSurfaces) -> Option<Self> {
        let mut pairs = pairs(parameters, surfaces);
        pairs.sort_unstable_by(|one, other| one.gap.total_cmp(&other.gap));
        let mut at = pairs.first()?.gap;
        let (lowest, force) = (at, parameters.usual_load());
        let [mut load, mut slope, mut contact_area] = [0.0; 3];
        // Straight from one gap to the next: the load is piecewise linear in δ.
        for pair in &pairs {
            if slope > 0.0 && at + (force - load) / slope <= pair.gap {
                break;
            }
            load += slope * (pair.gap - at);
            slope += pair.stiffness;
            contact_area += pair.area;
            at = pair.gap;
        }
        let displacement = at + (force - load) / slope;
        let (mean_pressure, largest_overlap) = (force / contact_area, displacement - lowest);
        displacement.is_finite().then_some(Self { displacement, contact_area, mean_pressure, largest_overlap })
    }
}

/// The pairs under the pin that carry.
fn pairs(parameters: &Parameters, surfaces: &InitialSurfaces) -> Vec<Pair> {
    let Parameters { mesh, materials, foundation_height, .. } = parameters;
    let stiffness = |base| {
        let status = if base == Base::Resin { Status::Resin } else { Status::Primary };
        materials.combined_modulus(status, false) / foundation_height
    };
    let [resin, fibre] = [Base::Resin, Base::Primary].map(stiffness);
    let mut pairs = Vec::with_capacity(mesh.pin_cells());
    for column in 0..mesh.pin_columns() {
        let pin = mesh.column(column).zip(mesh.column(mesh.disc_column(column, 0)));
        for ((cell, under), area) in pin.zip(mesh.area()).filter(|((cell, _), _)| mesh.is_present(*cell)) {
            let stiffness = if surfaces.pin_base[cell] == Base::Resin { resin } else { fibre };
            let gap = surfaces.pin_height[cell] - surfaces.disc_height[under];
            pairs.push(Pair { gap, stiffness: stiffness * area, area: *area });
        }
    }
    pairs.retain(|pair| pair.stiffness > 0.0);
    pairs
}

#[cfg(test)]
#[path = "../../tests/unit/model/first_contact.rs"]
mod tests;
