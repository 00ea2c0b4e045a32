//! Load balance of the rigid pin on a Winkler foundation (model 4.1; paper 2.2, Eqs. 2 to 5).

use thiserror::Error;

use crate::field::{Field, Rows, zero_rows};
use crate::kernel::{Load, count_touching, face_column, load_of_column};
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
        "the load balance has no finite solution (displacement {displacement} m carries {load} N of {normal_force} N): \
         heights, stiffness or load are out of the range of floating-point numbers"
    )]
    NotFinite {
        /// δ reached, m.
        displacement: f64,
        /// Σ k A u there, N.
        load: f64,
        /// F_N, N.
        normal_force: f64,
    },
}

/// The contact of one step: how far every pair is apart, how stiff it is, and the displacement that carries the load.
#[derive(Debug, Clone)]
pub struct Contact {
    /// g = z_p − z_d of every pin cell, m.
    gap: Field<f64>,
    /// k A of every pin cell, N/m.
    stiffness: Field<f64>,
    /// δ, m; none before the first step.
    displacement: Option<f64>,
    /// Σ k A u, N.
    load: f64,
    /// |Σ k A u − F_N| / F_N.
    residual: f64,
    /// Cells in contact by row.
    touching: Rows,
    /// Load evaluations of the last balance.
    iterations: u32,
}

impl Contact {
    /// Contact of a pin that has not touched yet.
    pub fn new(mesh: &Mesh) -> Self {
        let zero = Field::new(mesh, &vec![0.0; mesh.pin_cells()], 0.0);
        Self {
            gap: zero.clone(),
            stiffness: zero,
            displacement: None,
            load: 0.0,
            residual: 0.0,
            touching: zero_rows(mesh.rows()),
            iterations: 0,
        }
    }

    /// Faces every pin cell with the disc cell under it after `turned` columns: gap and stiffness of each pair.
    ///
    /// `distinct` tells whether build-up has a stiffness of its own.
    pub fn face(&mut self, mesh: &Mesh, stiffness: &Table, distinct: bool, disc: &Disc, pin: &Pin, turned: u64) {
        let face = if distinct { face_column::<true> } else { face_column::<false> };
        for column in 0..mesh.pin_columns() {
            face(
                pin.view(column),
                disc.view(mesh.disc_column(column, turned)),
                stiffness,
                self.gap.column_mut(column),
                self.stiffness.column_mut(column),
            );
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
            let Load { load, slope } = self.load_at(displacement, mesh);
            self.iterations += 1;
            let residual = ((load - normal_force) / normal_force).abs();
            if !residual.is_finite() {
                return Err(ContactError::NotFinite { displacement, load, normal_force });
            }
            let next =
                if slope > 0.0 { displacement + (normal_force - load) / slope } else { self.upper_bound(normal_force) };
            if residual <= tolerance || next == displacement || next == before || self.iterations == MOST_ITERATIONS {
                (self.load, self.residual) = (load, residual);
                break;
            }
            (before, displacement) = (displacement, next);
        }
        self.displacement = Some(displacement);
        self.touching.as_flattened_mut().fill(0.0);
        for column in 0..mesh.pin_columns() {
            count_touching(displacement, self.gap.column(column), &mut self.touching);
        }
        Ok(())
    }

    /// Σ k A u and its slope at a displacement, added up column by column.
    fn load_at(&self, displacement: f64, mesh: &Mesh) -> Load {
        let mut total = Load::default();
        for column in 0..mesh.pin_columns() {
            let column = load_of_column(displacement, self.gap.column(column), self.stiffness.column(column));
            total.load += column.load;
            total.slope += column.slope;
        }
        total
    }

    /// The displacement at which the first cell would carry the load alone: never below the solution, and in contact.
    fn upper_bound(&self, normal_force: f64) -> f64 {
        self.gap
            .cells()
            .zip(self.stiffness.cells())
            .map(|(gap, stiffness)| gap + normal_force / stiffness)
            .fold(f64::INFINITY, f64::min)
    }

    /// δ, m; 0 before the first step.
    pub fn displacement(&self) -> f64 {
        self.displacement.unwrap_or(0.0)
    }

    /// Cells in contact by row.
    pub fn touching(&self) -> &Rows {
        &self.touching
    }

    /// Contact area Σ A over cells in contact, m².
    pub fn area(&self, mesh: &Mesh) -> f64 {
        self.touching.as_flattened().iter().zip(mesh.area()).map(|(count, area)| count * area).sum()
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
        let cells = self.gap.cells().zip(self.stiffness.cells()).zip(mesh.area().iter().cycle());
        cells.map(move |((gap, stiffness), area)| {
            let overlap = displacement - gap;
            if overlap > 0.0 { stiffness / area * overlap } else { 0.0 }
        })
    }
}
