//! What lies under the pin's cells, fibre or resin, and what follows from it for its surface.

use crate::model::mesh::Mesh;
use crate::model::state::Base;

/// Area fraction of the pin that is fibre.
pub fn fibre_fraction(base: &[Base], mesh: &Mesh) -> f64 {
    let fibre: f64 =
        base.iter().zip(mesh.pin_areas()).filter(|(base, _)| **base == Base::Primary).map(|(_, area)| area).sum();
    fibre / mesh.pin_area()
}

/// Sets the resin of a pin back from its fibres by `recess`, m: the pin's z grows away from the disc.
pub fn set_back_resin(heights: &mut [f64], base: &[Base], recess: f64) {
    let resin = heights.iter_mut().zip(base).filter(|(_, base)| **base == Base::Resin);
    resin.for_each(|(height, _)| *height += recess);
}
