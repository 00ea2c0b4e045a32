//! How far the lowlands of the disc are filled, and how much of it is covered (model section 5).

use crate::mesh::Mesh;
use crate::state::Disc;

/// Filling and coverage of every disc column, kept up to date for the columns that passed under the pin.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling {
    /// z_ref, m: highest initial disc height.
    reference: f64,
    /// V(0), m³.
    initial_volume: f64,
    /// Σ A (z_ref − z_d)₊ of every column, m³.
    open_volume: Vec<f64>,
    /// Σ A over the secondary cells of every column, m².
    secondary_area: Vec<f64>,
    /// Step up to which the columns are up to date.
    up_to: u64,
}

impl Filling {
    /// Measures the initial disc.
    pub fn new(mesh: &Mesh, disc: &Disc) -> Self {
        let mut filling = Self {
            reference: disc.height.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            initial_volume: 0.0,
            open_volume: vec![0.0; mesh.disc_columns()],
            secondary_area: vec![0.0; mesh.disc_columns()],
            up_to: 0,
        };
        for column in 0..mesh.disc_columns() {
            filling.measure(mesh, disc, column);
        }
        filling.initial_volume = filling.open_volume.iter().sum();
        filling
    }

    /// Measures the columns that the pin touched since the last call; `turned` counts the columns turned so far.
    pub fn update(&mut self, mesh: &Mesh, disc: &Disc, turned: u64) {
        let steps = turned - self.up_to;
        if steps == 0 {
            return;
        }
        // In step n the pin lies over columns −n .. pin_columns − n, so over `steps` steps a span that much longer.
        let span = (mesh.pin_columns() as u64 - 1).saturating_add(steps).min(mesh.disc_columns() as u64) as usize;
        let first = mesh.disc_column(0, turned - 1);
        for offset in 0..span {
            self.measure(mesh, disc, (first + offset) % mesh.disc_columns());
        }
        self.up_to = turned;
    }

    fn measure(&mut self, mesh: &Mesh, disc: &Disc, column: usize) {
        let column_cells = mesh.column(column);
        let cells = disc.height[column_cells.clone()].iter().zip(&disc.substrate[column_cells]);
        let (mut open, mut secondary) = (0.0, 0.0);
        for ((height, substrate), area) in cells.zip(mesh.area()) {
            open += (self.reference - height).max(0.0) * area;
            secondary += if height > substrate { *area } else { 0.0 };
        }
        self.open_volume[column] = open;
        self.secondary_area[column] = secondary;
    }

    /// 1 − V(t)/V(0); 0 when nothing was open at the start.
    pub fn filled_fraction(&self) -> f64 {
        if self.initial_volume == 0.0 {
            return 0.0;
        }
        1.0 - self.open_volume.iter().sum::<f64>() / self.initial_volume
    }

    /// Area fraction of the whole ring that is secondary plateau.
    pub fn secondary_fraction(&self, mesh: &Mesh) -> f64 {
        self.secondary_area.iter().sum::<f64>() / mesh.disc_area()
    }
}
