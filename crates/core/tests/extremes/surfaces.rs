//! Surfaces of cases: their statistics do not matter, but they are the same everywhere.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::{Base, InitialSurfaces};

/// A reproducible stream of numbers in 0..1 (SplitMix64).
struct Stream(u64);

impl Iterator for Stream {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        Some(((word ^ (word >> 31)) >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// A disc 6 µm rough and a pin 2 µm rough, two fifths of it fibre.
pub fn rough(mesh: &Mesh) -> InitialSurfaces {
    let mut stream = Stream(1);
    let disc_height = stream.by_ref().map(|number| 6e-6 * (number - 1.0)).take(mesh.disc_cells()).collect();
    let pin_height = stream.by_ref().map(|number| 2e-6 * number).take(mesh.pin_cells()).collect();
    let base = |number| if number < 0.4 { Base::Primary } else { Base::Resin };
    InitialSurfaces { disc_height, pin_height, pin_base: stream.map(base).take(mesh.pin_cells()).collect() }
}

/// Both perfectly flat, the pin of one base.
pub fn flat(mesh: &Mesh, base: Base) -> InitialSurfaces {
    InitialSurfaces {
        disc_height: vec![0.0; mesh.disc_cells()],
        pin_height: vec![0.0; mesh.pin_cells()],
        pin_base: vec![base; mesh.pin_cells()],
    }
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
