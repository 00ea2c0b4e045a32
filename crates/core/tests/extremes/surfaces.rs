//! Surfaces of cases: their statistics do not matter, but they are the same everywhere.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::{Base, InitialSurfaces};

use crate::scenes::random_surfaces;

/// A disc 6 µm rough and a pin 2 µm rough, two fifths of it fibre.
pub fn rough(mesh: &Mesh) -> InitialSurfaces {
    random_surfaces(mesh, 1)
}

/// The same with every height times `factor`.
pub fn scaled(mut surfaces: InitialSurfaces, factor: f64) -> InitialSurfaces {
    surfaces.disc_height.iter_mut().chain(&mut surfaces.pin_height).for_each(|height| *height *= factor);
    surfaces
}

/// The same with a pin of one base.
pub fn all(mut surfaces: InitialSurfaces, base: Base) -> InitialSurfaces {
    surfaces.pin_base.fill(base);
    surfaces
}

/// The same with one disc cell at `height`, m.
pub fn with_disc_cell(mut surfaces: InitialSurfaces, height: f64) -> InitialSurfaces {
    let middle = surfaces.disc_height.len() / 2;
    surfaces.disc_height[middle] = height;
    surfaces
}
