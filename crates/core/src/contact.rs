//! Load balance of the rigid pin on a Winkler foundation (model 4.1; paper 2.2, Eqs. 2 to 5).
//!
//! The load is convex and piecewise linear in the displacement. So a [`Reading`] of the pairs against a bracket of
//! displacements, sums for the pairs that touch at its lower end and a list of the few that begin to touch within it,
//! holds all that is needed to solve the balance exactly where the solution lies within the bracket; where it does not,
//! the reading tells where to read next.

use thiserror::Error;

use crate::exact::dot;
use crate::kernel::{Bracket, NearPair, Reading, told_apart};
use crate::mesh::Mesh;
use crate::pair::{Pair, Table};

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

/// What a reading says about the balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// The balance is solved.
    Solved,
    /// The solution lies elsewhere, probably between these two displacements, m.
    Between(f64, f64),
    /// Nothing touches within the bracket.
    Apart,
}

/// The contact of one step: the displacement that carries the load, and what touches there.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// k A by pair and row, N/m.
    stiffness: Table,
    /// Pairs that are told apart.
    pairs: &'static [usize],
    /// δ, m; none before the first step.
    displacement: Option<f64>,
    /// Σ k A u, N.
    load: f64,
    /// Σ k A over cells in contact, N/m.
    slope: f64,
    /// |Σ k A u − F_N| / F_N.
    residual: f64,
    /// Σ u of every pair and row, m.
    overlap: Table,
    /// Cells in contact of every pair and row.
    touching: Table,
    /// Cells in contact of every row.
    touching_rows: Vec<f64>,
}

impl Contact {
    /// Contact of a pin that has not touched yet; `stiffness` is k A.
    pub fn new(mesh: &Mesh, stiffness: &Table, distinct: bool) -> Self {
        let rows = || std::array::from_fn::<_, { Pair::COUNT }, _>(|_| vec![0.0; mesh.rows()]);
        Self {
            stiffness: stiffness.clone(),
            pairs: told_apart(distinct),
            displacement: None,
            load: 0.0,
            slope: 0.0,
            residual: 0.0,
            overlap: rows(),
            touching: rows(),
            touching_rows: vec![0.0; mesh.rows()],
        }
    }

    /// Solves Σ k A (δ − g)₊ = F_N where δ lies within the bracket of a reading.
    ///
    /// # Errors
    /// [`ContactError`] when the numbers leave the finite range or rounding leaves no overlap.
    pub fn balance(
        &mut self,
        reading: &mut Reading,
        bracket: &Bracket,
        normal_force: f64,
    ) -> Result<Verdict, ContactError> {
        self.take_sums(reading, bracket);
        let by_stiffness = |rows: &Table| self.pairs.iter().map(|pair| dot(&rows[*pair], &self.stiffness[*pair])).sum();
        let (low_load, low_slope): (f64, f64) = (by_stiffness(&self.overlap), by_stiffness(&self.touching));
        let low = bracket.low;
        if !(low_load.is_finite() && low.is_finite()) {
            return Err(ContactError::NotFinite { displacement: low, load: low_load, normal_force });
        }
        if low_load > normal_force {
            // Newton's method from above: it does not overshoot.
            let next = low - (low_load - normal_force) / low_slope;
            let (step, tiny) = (low - next, rounding(low, next, bracket));
            return Ok(Verdict::Between(next - (0.25 * step).max(tiny), next + (step / 1024.0).max(tiny)));
        }
        // In an order that does not depend on who read what.
        reading.near.sort_unstable_by(|a, b| a.gap.total_cmp(&b.gap).then((a.row, a.pair).cmp(&(b.row, b.pair))));
        let (mut at, mut load, mut slope) = (low, low_load, low_slope);
        let solution = |at: f64, load: f64, slope: f64| at + (normal_force - load) / slope;
        for pair in &reading.near {
            if slope > 0.0 && solution(at, load, slope) <= pair.gap {
                break;
            }
            load += slope * (pair.gap - at);
            slope += self.stiffness_of(pair);
            at = pair.gap;
        }
        if slope == 0.0 {
            return Ok(Verdict::Apart);
        }
        let displacement = solution(at, load, slope);
        if displacement - low < bracket.width {
            self.settle(displacement, &reading.near, low, (low_load, low_slope), normal_force)?;
            return Ok(Verdict::Solved);
        }
        if !displacement.is_finite() {
            return Err(ContactError::NotFinite { displacement, load, normal_force });
        }
        // Newton's method from below: the solution is not above.
        let high = low + bracket.width;
        let step = displacement - high;
        Ok(Verdict::Between(high, displacement + (step / 1024.0).max(rounding(high, displacement, bracket))))
    }

    /// Sums over the cells that touch at the lower end of the bracket, in metres.
    fn take_sums(&mut self, reading: &Reading, bracket: &Bracket) {
        let (quantum, anchor) = (bracket.quantum.value(), bracket.quantum.anchor_bits());
        for pair in self.pairs {
            let counts = reading.touching[*pair].0.as_flattened();
            let sums = reading.overlap[*pair].0.as_flattened();
            let rows = self.touching[*pair].iter_mut().zip(&mut self.overlap[*pair]);
            for ((touching, overlap), (count, sum)) in rows.zip(counts.iter().zip(sums)) {
                *touching = *count as f64;
                *overlap = sum.wrapping_sub(count.wrapping_mul(anchor)) as f64 * quantum;
            }
        }
    }

    fn stiffness_of(&self, pair: &NearPair) -> f64 {
        self.stiffness[usize::from(pair.pair)][pair.row as usize]
    }

    /// Takes the sums from the lower end of the bracket to the displacement.
    fn settle(
        &mut self,
        displacement: f64,
        near: &[NearPair],
        low: f64,
        (low_load, low_slope): (f64, f64),
        normal_force: f64,
    ) -> Result<(), ContactError> {
        let above = displacement - low;
        for pair in self.pairs {
            for (overlap, touching) in self.overlap[*pair].iter_mut().zip(&self.touching[*pair]) {
                *overlap += touching * above;
            }
        }
        (self.load, self.slope) = (low_load + low_slope * above, low_slope);
        for pair in near.iter().take_while(|pair| pair.gap < displacement) {
            let (index, row) = (usize::from(pair.pair), pair.row as usize);
            let overlap = displacement - pair.gap;
            self.touching[index][row] += 1.0;
            self.overlap[index][row] += overlap;
            self.load += self.stiffness_of(pair) * overlap;
            self.slope += self.stiffness_of(pair);
        }
        let (first, others) = self.pairs.split_first().unwrap_or((&0, &[]));
        self.touching_rows.copy_from_slice(&self.touching[*first]);
        for pair in others {
            self.touching_rows.iter_mut().zip(&self.touching[*pair]).for_each(|(sum, touching)| *sum += touching);
        }
        if self.slope == 0.0 {
            return Err(ContactError::NotCarried { displacement, normal_force });
        }
        self.residual = ((self.load - normal_force) / normal_force).abs();
        self.displacement = Some(displacement);
        Ok(())
    }

    /// δ, m; 0 before the first step.
    pub fn displacement(&self) -> f64 {
        self.displacement.unwrap_or(0.0)
    }

    /// Cells in contact by row.
    pub fn touching(&self) -> &[f64] {
        &self.touching_rows
    }

    /// Pairs that are told apart, by [`Pair::index`].
    pub fn pairs(&self) -> &'static [usize] {
        self.pairs
    }

    /// Cells in contact of each pair, by row.
    pub fn touching_by_pair(&self) -> &Table {
        &self.touching
    }

    /// Σ u over the cells in contact of each pair by row, m.
    pub fn overlap_by_pair(&self) -> &Table {
        &self.overlap
    }

    /// Contact area Σ A over cells in contact, m².
    pub fn area(&self, mesh: &Mesh) -> f64 {
        dot(&self.touching_rows, mesh.area())
    }

    /// Σ p A, N.
    pub fn load(&self) -> f64 {
        self.load
    }

    /// Mean overlap of the cells in contact, each counted by its stiffness, m.
    pub fn mean_overlap(&self) -> f64 {
        if self.slope > 0.0 { self.load / self.slope } else { 0.0 }
    }

    /// |Σ k A u − F_N| / F_N of the last balance.
    pub fn residual(&self) -> f64 {
        self.residual
    }
}

/// A distance that rounding does not lose between displacements of this size, m.
fn rounding(a: f64, b: f64, bracket: &Bracket) -> f64 {
    16.0 * f64::EPSILON * (a.abs() + b.abs()) + 4.0 * bracket.quantum.value()
}
