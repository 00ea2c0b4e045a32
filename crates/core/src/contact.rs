//! Load balance of the rigid pin on a Winkler foundation (model 4.1; paper 2.2, Eqs. 2 to 5).

use thiserror::Error;

use crate::kernel::{InstructionSet, add_load, face_column};
use crate::mesh::Mesh;
use crate::pair::Table;
use crate::state::{Disc, Pin};

/// Newton's method ends after finitely many iterations; this bound only keeps rounding from going round in circles.
const MOST_ITERATIONS: u32 = 200;

/// Why no displacement carries the load.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContactError {
    /// Heights or stiffness left the range of floating-point numbers.
    #[error(
        "the load balance has no finite solution (displacement {displacement:e} m carries {load:e} N of \
         {normal_force:e} N): heights, stiffness or load are out of the range of floating-point numbers"
    )]
    NotFinite {
        /// δ reached, m.
        displacement: f64,
        /// Σ k A u there, N.
        load: f64,
        /// F_N, N.
        normal_force: f64,
    },
    /// The overlap that carries the load is less than the rounding of the heights.
    #[error(
        "nothing carries the load of {normal_force:e} N: at gaps of {displacement:e} m the overlap that would is lost in \
         rounding; check the unit and the scale of the heights"
    )]
    NotCarried {
        /// δ reached, m.
        displacement: f64,
        /// F_N, N.
        normal_force: f64,
    },
}

/// The contact of one step: how far every pair is apart, how stiff it is, and the displacement that carries the load.
#[derive(Debug, Clone)]
pub struct Contact {
    instructions: InstructionSet,
    /// g = z_p − z_d of every pin cell, m.
    gap: Vec<f64>,
    /// k A of every pin cell, N/m.
    stiffness: Vec<f64>,
    /// δ, m; none before the first step.
    displacement: Option<f64>,
    /// Σ k A u, N.
    load: f64,
    /// |Σ k A u − F_N| / F_N.
    residual: f64,
    /// Σ k A u of every row at the last displacement tried, N.
    row_load: Vec<f64>,
    /// Σ k A over the cells in contact of every row there, N/m.
    row_slope: Vec<f64>,
    /// Cells in contact of every row there.
    touching: Vec<f64>,
    /// Load evaluations of the last balance.
    iterations: u32,
}

impl Contact {
    /// Contact of a pin that has not touched yet.
    pub fn new(mesh: &Mesh, instructions: InstructionSet) -> Self {
        Self {
            instructions,
            gap: vec![0.0; mesh.pin_cells()],
            stiffness: vec![0.0; mesh.pin_cells()],
            displacement: None,
            load: 0.0,
            residual: 0.0,
            row_load: vec![0.0; mesh.rows()],
            row_slope: vec![0.0; mesh.rows()],
            touching: vec![0.0; mesh.rows()],
            iterations: 0,
        }
    }

    /// Faces every pin cell with the disc cell under it after `turned` columns: gap and stiffness of each pair.
    ///
    /// `distinct` tells whether build-up has a stiffness of its own.
    pub fn face(&mut self, mesh: &Mesh, stiffness: &Table, distinct: bool, disc: &Disc, pin: &Pin, turned: u64) {
        let face = if distinct { face_column::<true> } else { face_column::<false> };
        let columns = self.gap.chunks_exact_mut(mesh.rows()).zip(self.stiffness.chunks_exact_mut(mesh.rows()));
        for (column, (gap, carried)) in columns.enumerate() {
            let under = disc.view(mesh.column(mesh.disc_column(column, turned)));
            face(self.instructions, pin.view(mesh.column(column)), under, stiffness, gap, carried);
        }
    }

    /// Finds δ with Σ k A (δ − g)₊ = F_N, starting from the last step's.
    ///
    /// The load is convex and piecewise linear in δ: after one iteration Newton's method comes from above and never
    /// overshoots.
    ///
    /// # Errors
    /// [`ContactError`] when the numbers leave the finite range.
    pub fn balance(&mut self, mesh: &Mesh, normal_force: f64, tolerance: f64) -> Result<(), ContactError> {
        let mut displacement = self.displacement.unwrap_or_else(|| self.upper_bound(normal_force));
        let mut before = f64::NAN;
        self.iterations = 0;
        loop {
            let (load, slope) = self.load_at(displacement, mesh);
            self.iterations += 1;
            let residual = ((load - normal_force) / normal_force).abs();
            if !residual.is_finite() {
                return Err(ContactError::NotFinite { displacement, load, normal_force });
            }
            let next =
                if slope > 0.0 { displacement + (normal_force - load) / slope } else { self.upper_bound(normal_force) };
            if residual <= tolerance || next == displacement || next == before || self.iterations == MOST_ITERATIONS {
                if slope == 0.0 {
                    return Err(ContactError::NotCarried { displacement, normal_force });
                }
                (self.load, self.residual) = (load, residual);
                break;
            }
            (before, displacement) = (displacement, next);
        }
        self.displacement = Some(displacement);
        Ok(())
    }

    /// Σ k A u and its slope at a displacement: summed along the rows, then over the rows.
    fn load_at(&mut self, displacement: f64, mesh: &Mesh) -> (f64, f64) {
        let Self { instructions, gap, stiffness, row_load, row_slope, touching, .. } = self;
        row_load.fill(0.0);
        row_slope.fill(0.0);
        touching.fill(0.0);
        for (gap, stiffness) in gap.chunks_exact(mesh.rows()).zip(stiffness.chunks_exact(mesh.rows())) {
            add_load(*instructions, displacement, gap, stiffness, row_load, row_slope, touching);
        }
        (row_load.iter().sum(), row_slope.iter().sum())
    }

    /// The displacement at which the first cell would carry the load alone: never below the solution, and in contact.
    fn upper_bound(&self, normal_force: f64) -> f64 {
        self.gap
            .iter()
            .zip(&self.stiffness)
            .map(|(gap, stiffness)| gap + normal_force / stiffness)
            .fold(f64::INFINITY, f64::min)
    }

    /// δ, m; 0 before the first step.
    pub fn displacement(&self) -> f64 {
        self.displacement.unwrap_or(0.0)
    }

    /// Cells in contact by row.
    pub fn touching(&self) -> &[f64] {
        &self.touching
    }

    /// Contact area Σ A over cells in contact, m².
    pub fn area(&self, mesh: &Mesh) -> f64 {
        self.touching.iter().zip(mesh.area()).map(|(count, area)| count * area).sum()
    }

    /// Σ p A, N.
    pub fn load(&self) -> f64 {
        self.load
    }

    /// |Σ k A u − F_N| / F_N of the last balance.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// Load evaluations that the last balance took.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// p = k u of every pin cell in the last step, Pa; all 0 before the first.
    pub fn pressures<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = f64> + 'a {
        let displacement = self.displacement.unwrap_or(f64::NEG_INFINITY);
        let cells = self.gap.iter().zip(&self.stiffness).zip(mesh.area().iter().cycle());
        cells.map(move |((gap, stiffness), area)| {
            let overlap = displacement - gap;
            if overlap > 0.0 { stiffness / area * overlap } else { 0.0 }
        })
    }
}
