//! Load balance of the rigid pin on a Winkler foundation (model 4.1; paper 2.2, Eqs. 2 to 5).

use thiserror::Error;

use crate::material::Status;
use crate::mesh::Mesh;
use crate::pair::{Pair, Pairs};
use crate::state::{Disc, Pin};

/// Cells that are summed side by side; fixed, so that sums do not depend on the machine.
const LANES: usize = 8;

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

/// The contact of one step: what faces what, how far apart, and the displacement that carries the load.
#[derive(Debug, Clone)]
pub struct Contact {
    /// g = z_p − z_d of every pin cell, m.
    gap: Vec<f64>,
    /// k A of every pin cell, N/m.
    stiffness: Vec<f64>,
    /// Statuses of every pin cell and the disc cell under it at the start of the step.
    pair: Vec<Pair>,
    /// δ, m; none before the first step.
    displacement: Option<f64>,
    /// Σ k A u, N.
    load: f64,
    /// |Σ k A u − F_N| / F_N.
    residual: f64,
    /// Cells in contact, by row.
    touching: Vec<u32>,
    /// Load evaluations of the last balance.
    iterations: u32,
}

/// Load and its slope at one displacement.
#[derive(Debug, Clone, Copy, Default)]
struct LoadSums {
    /// Σ k A u, N.
    load: f64,
    /// Σ k A over cells in contact, N/m.
    slope: f64,
}

impl Contact {
    /// Contact of a pin that has not touched yet.
    pub fn new(mesh: &Mesh) -> Self {
        let cells = mesh.pin_cells();
        Self {
            gap: vec![0.0; cells],
            stiffness: vec![0.0; cells],
            pair: vec![Pair::new(Status::None, false); cells],
            displacement: None,
            load: 0.0,
            residual: 0.0,
            touching: vec![0; mesh.rows()],
            iterations: 0,
        }
    }

    /// Faces every pin cell with the disc cell under it in step `step`: gap, statuses and stiffness of each pair.
    pub fn face(&mut self, mesh: &Mesh, pairs: &Pairs, disc: &Disc, pin: &Pin, step: u64) {
        let rows = mesh.rows();
        for column in 0..mesh.pin_columns() {
            let pin_start = column * rows;
            let disc_start = mesh.disc_column(column, step) * rows;
            for row in 0..rows {
                let (pin_cell, disc_cell) = (pin_start + row, disc_start + row);
                let pair = Pair::new(pin.status(pin_cell), disc.height[disc_cell] > disc.substrate[disc_cell]);
                self.gap[pin_cell] = pin.height[pin_cell] - disc.height[disc_cell];
                self.pair[pin_cell] = pair;
                self.stiffness[pin_cell] = pairs.stiffness(pair) * mesh.area()[row];
            }
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
        let rows = mesh.rows();
        let mut displacement = self.displacement.unwrap_or_else(|| self.upper_bound(normal_force));
        let mut before = f64::NAN;
        self.iterations = 0;
        loop {
            let sums = self.load_at(displacement, rows);
            self.iterations += 1;
            let residual = ((sums.load - normal_force) / normal_force).abs();
            if !residual.is_finite() {
                return Err(ContactError::NotFinite { displacement, load: sums.load, normal_force });
            }
            let next = if sums.slope > 0.0 {
                displacement + (normal_force - sums.load) / sums.slope
            } else {
                self.upper_bound(normal_force)
            };
            if residual <= tolerance || next == displacement || next == before || self.iterations == MOST_ITERATIONS {
                (self.load, self.residual) = (sums.load, residual);
                break;
            }
            (before, displacement) = (displacement, next);
        }
        self.displacement = Some(displacement);
        self.count_touching(displacement, rows);
        Ok(())
    }

    /// Σ k A u and its slope at a displacement: column sums in fixed lanes, added up column by column.
    fn load_at(&self, displacement: f64, rows: usize) -> LoadSums {
        let mut total = LoadSums::default();
        for (gap, stiffness) in self.gap.chunks_exact(rows).zip(self.stiffness.chunks_exact(rows)) {
            let column = column_load(displacement, gap, stiffness);
            total.load += column.load;
            total.slope += column.slope;
        }
        total
    }

    /// The displacement at which the first cell would carry the load alone: never below the solution, and in contact.
    fn upper_bound(&self, normal_force: f64) -> f64 {
        self.gap
            .iter()
            .zip(&self.stiffness)
            .map(|(gap, stiffness)| gap + normal_force / stiffness)
            .fold(f64::INFINITY, f64::min)
    }

    fn count_touching(&mut self, displacement: f64, rows: usize) {
        self.touching.fill(0);
        for gap in self.gap.chunks_exact(rows) {
            for (count, gap) in self.touching.iter_mut().zip(gap) {
                *count += u32::from(*gap < displacement);
            }
        }
    }

    /// δ, m; 0 before the first step.
    pub fn displacement(&self) -> f64 {
        self.displacement.unwrap_or(0.0)
    }

    /// u = (δ − g)₊ of a pin cell, m.
    pub fn overlap(&self, cell: usize) -> f64 {
        (self.displacement() - self.gap[cell]).max(0.0)
    }

    /// The statuses that faced each other at a pin cell at the start of the step.
    pub fn pair(&self, cell: usize) -> Pair {
        self.pair[cell]
    }

    /// Cells in contact, by row.
    pub fn touching(&self) -> &[u32] {
        &self.touching
    }

    /// Contact area Σ A over cells in contact, m².
    pub fn area(&self, mesh: &Mesh) -> f64 {
        self.touching.iter().zip(mesh.area()).map(|(count, area)| f64::from(*count) * area).sum()
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
    pub fn pressures<'a>(&'a self, pairs: &'a Pairs) -> impl Iterator<Item = f64> + 'a {
        let displacement = self.displacement.unwrap_or(f64::NEG_INFINITY);
        self.gap.iter().zip(&self.pair).map(move |(gap, pair)| {
            let overlap = displacement - gap;
            if overlap > 0.0 { pairs.stiffness(*pair) * overlap } else { 0.0 }
        })
    }
}

/// Load and slope of one column.
#[inline]
fn column_load(displacement: f64, gap: &[f64], stiffness: &[f64]) -> LoadSums {
    let mut load = [0.0; LANES];
    let mut slope = [0.0; LANES];
    let gaps = gap.chunks_exact(LANES);
    let stiffnesses = stiffness.chunks_exact(LANES);
    let rest = gaps.remainder().iter().zip(stiffnesses.remainder());
    for (gap, stiffness) in gaps.zip(stiffnesses) {
        for lane in 0..LANES {
            let overlap = displacement - gap[lane];
            let carried = if overlap > 0.0 { stiffness[lane] } else { 0.0 };
            load[lane] += carried * overlap;
            slope[lane] += carried;
        }
    }
    for (lane, (gap, stiffness)) in rest.enumerate() {
        let overlap = displacement - gap;
        let carried = if overlap > 0.0 { *stiffness } else { 0.0 };
        load[lane] += carried * overlap;
        slope[lane] += carried;
    }
    LoadSums { load: load.iter().sum(), slope: slope.iter().sum() }
}
