//! Load balance of the rigid pin on a Winkler foundation (model 4.1; paper 2.2, Eqs. 2 to 5).
//!
//! The load is convex and piecewise linear in the displacement. So a reading of the pairs against a bracket of
//! displacements, sums for the pairs that touch at its lower end and a list of the few that begin to touch within it,
//! holds all that is needed to solve the balance exactly where the solution lies within the bracket; where it does not,
//! the reading tells where to read next.

use serde::{Deserialize, Serialize};

use crate::engine::coefficients::StatusPair;
use crate::engine::exact::float;
use crate::engine::kernel::{Bracket, NearPair, PLATEAU};
use crate::engine::sums::{PairSums, RawLoss, RowWeights, Sums};
use crate::model::REACH;
use crate::model::error::ContactError;
use crate::model::friction::{ContactSums, StatusContact};
use crate::model::material::Status;

/// Result of solving the balance with one reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// The balance is solved.
    Solved,
    /// The solution lies elsewhere, probably between these two displacements, m.
    Between(f64, f64),
    /// Nothing touches within the bracket.
    Apart,
}

/// Areas in contact and raw losses there.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Touching {
    /// Area Σ A over cells in contact, in units of the area.
    pub area: i128,
    /// Area Σ A over bare resin in contact, in units of the area.
    pub resin_area: i128,
    /// Raw volume that plateaus of the pin lose; only where build-up has the properties of what it lies on.
    pub pin_loss: RawLoss,
    /// Raw volume that the disc loses, m³; only where build-up has the properties of what it lies on.
    pub disc_loss: f64,
}

/// Loads that all cells carry at a displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carried {
    /// Displacement δ, m.
    pub displacement: f64,
    /// Load Σ k A u by pair, N.
    pub loads: [f64; StatusPair::COUNT],
    /// Residual |Σ k A u − F_N| / F_N, 1.
    pub residual: f64,
}

/// The contact of one step: the displacement that carries the load, and what touches there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Displacement δ, m; none before the first step.
    displacement: Option<f64>,
    /// Load Σ k A u, N.
    load: f64,
    /// Slope Σ k A over cells in contact, N/m.
    slope: f64,
    /// Part of the load that the rounding of the overlaps may hide, N.
    doubt: f64,
    /// Residual |Σ k A u − F_N| / F_N, 1; unless refined, with the doubt over F_N.
    residual: f64,
    /// Distance of δ above the lower end of the bracket, m.
    above: f64,
    /// Quantum of the overlaps at the lower end, m.
    quantum: f64,
    touching: Touching,
    /// Area of one unit, m².
    area_unit: f64,
    /// Load and area by status of the pin, where friction differs between them.
    statuses: Option<[StatusContact; 3]>,
}

impl Contact {
    /// Contact of a pin that has not touched yet; with sums by status, if they are needed.
    pub fn new(weights: &RowWeights, by_status: bool) -> Self {
        Self {
            statuses: by_status.then(Default::default),
            displacement: None,
            load: 0.0,
            slope: 0.0,
            doubt: 0.0,
            residual: 0.0,
            above: 0.0,
            quantum: 0.0,
            touching: Touching::default(),
            area_unit: weights.area.unit(),
        }
    }

    /// Tells whether the contact has sums by status.
    pub fn has_statuses(&self) -> bool {
        self.statuses.is_some()
    }

    /// Solves Σ k A (δ − g)₊ = F_N where δ lies within the bracket that the sums and the list of near pairs are of. The near pairs that
    /// touch then come first.
    ///
    /// # Errors
    /// [`ContactError`] when the numbers leave the range of the engine or rounding leaves no overlap.
    pub fn balance(
        &mut self,
        weights: &RowWeights,
        sums: &Sums,
        near: &mut [NearPair],
        bracket: &Bracket,
        normal_force: f64,
    ) -> Result<Verdict, ContactError> {
        let at_low = load_at_low(weights, sums, bracket);
        let (low_load, low_slope, _) = at_low;
        let low = bracket.low;
        // Beyond, what fills up the strips would touch, too.
        if !(low_load.is_finite() && low.abs() + bracket.width < REACH) {
            return Err(ContactError::NotFinite { displacement: low, load: low_load, normal_force });
        }
        if low_load > normal_force {
            // Newton's method from above: it does not overshoot.
            let next = low - (low_load - normal_force) / low_slope;
            let (step, tiny) = (low - next, rounding(low, next, bracket));
            return Ok(Verdict::Between(next - (0.25 * step).max(tiny), next + (step / 1024.0).max(tiny)));
        }
        let solution = |at: f64, load: f64, slope: f64| at + (normal_force - load) / slope;
        // Where it would be if no more pairs touched: as each carries a part, the solution is not above, but for rounding.
        let mut bound = if low_slope > 0.0 { solution(low, low_load, low_slope) } else { f64::INFINITY };
        let (displacement, load) = loop {
            let (mut at, mut load, mut slope) = (low, low_load, low_slope);
            for pair in sorted_up_to(bound, near) {
                if slope > 0.0 && solution(at, load, slope) <= pair.gap {
                    break;
                }
                load += slope * (pair.gap - at);
                slope += weights.stiffness_of(pair);
                at = pair.gap;
            }
            if slope == 0.0 {
                return Ok(Verdict::Apart);
            }
            let displacement = solution(at, load, slope);
            if displacement > bound {
                bound = f64::INFINITY;
            } else {
                break (displacement, load);
            }
        };
        if displacement - low < bracket.width {
            self.settle(weights, sums, near, bracket, displacement, at_low);
            if self.slope == 0.0 {
                return Err(ContactError::NotCarried { displacement, normal_force });
            }
            self.residual = ((self.load - normal_force).abs() + self.doubt) / normal_force;
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

    /// Takes the contact at a displacement near that of the sums, of which the loads are known better than by them.
    pub fn refine(
        &mut self,
        weights: &RowWeights,
        sums: &Sums,
        near: &mut [NearPair],
        bracket: &Bracket,
        carried: &Carried,
    ) {
        let Carried { displacement, loads, residual } = carried;
        let near = sorted_up_to(*displacement, near);
        self.settle(weights, sums, near, bracket, *displacement, load_at_low(weights, sums, bracket));
        (self.load, self.residual) = (loads.iter().sum(), *residual);
        if let Some(statuses) = &mut self.statuses {
            statuses.iter_mut().for_each(|status| status.load = 0.0);
            let pairs = loads.iter().enumerate();
            pairs.for_each(|(pair, load)| statuses[usize::from(status_of(pair))].load += load);
        }
    }

    /// Takes the sums from the lower end of the bracket to the displacement.
    fn settle(
        &mut self,
        weights: &RowWeights,
        sums: &Sums,
        near: &[NearPair],
        bracket: &Bracket,
        displacement: f64,
        at_low: (f64, f64, f64),
    ) {
        let above = displacement - bracket.low;
        (self.displacement, self.above, self.quantum) = (Some(displacement), above, bracket.quantum.value());
        (self.load, self.slope, self.doubt) = at_low;
        self.load += self.slope * above;
        self.settle_statuses(weights, sums, near, bracket, displacement);
        let touching = &mut self.touching;
        *touching = Touching::default();
        for pair in weights.pairs {
            let sums = &sums.pairs[*pair];
            if sums.area == 0 {
                continue;
            }
            touching.area += sums.area;
            if is_bare_resin(*pair) {
                touching.resin_area += sums.area;
            }
            if *pair == PLATEAU {
                touching.pin_loss = RawLoss { low: sums.pin_loss, rate: sums.pin_loss_rate, ..touching.pin_loss };
            }
            let loss = float(sums.disc_loss) * bracket.quantum.value() + float(sums.disc_loss_rate) * above;
            touching.disc_loss += loss * weights.disc_loss[*pair].unit();
        }
        let distinct = weights.needs.distinct;
        for near in near.iter().take_while(|near| near.gap < displacement) {
            let (pair, row) = (usize::from(near.pair), near.row as usize);
            let overlap = displacement - near.gap;
            let area = i128::from(weights.area.row(row));
            touching.area += area;
            if is_bare_resin(pair) {
                touching.resin_area += area;
            }
            if !distinct {
                if pair == PLATEAU {
                    touching.pin_loss.near.add(weights.near_loss(row, overlap));
                }
                touching.disc_loss += weights.disc_loss[pair].value(row) * overlap;
            }
            self.load += weights.stiffness_of(near) * overlap;
            self.slope += weights.stiffness_of(near);
        }
    }

    /// Takes the sums by status of the pin to the displacement, where friction asks for them.
    fn settle_statuses(
        &mut self,
        weights: &RowWeights,
        sums: &Sums,
        near: &[NearPair],
        bracket: &Bracket,
        displacement: f64,
    ) {
        let Some(statuses) = &mut self.statuses else { return };
        *statuses = Default::default();
        let above = displacement - bracket.low;
        for pair in weights.pairs {
            let all = |sum: fn(&PairSums) -> i128| float(sum(&sums.pairs[*pair]));
            let unit = weights.stiffness[*pair].unit();
            let status = &mut statuses[usize::from(status_of(*pair))];
            status.load +=
                (all(|sums| sums.load) * bracket.quantum.value() + all(|sums| sums.stiffness) * above) * unit;
            status.area += all(|sums| sums.area) * self.area_unit;
        }
        for near in near.iter().take_while(|near| near.gap < displacement) {
            let status = &mut statuses[usize::from(status_of(usize::from(near.pair)))];
            status.load += weights.stiffness_of(near) * (displacement - near.gap);
            status.area += weights.area.value(near.row as usize);
        }
    }

    /// Tells which kinds of pairs touch, by the sums and the near pairs that the balance was solved with.
    pub fn touching_pairs(&self, sums: &Sums, near: &[NearPair]) -> [bool; StatusPair::COUNT] {
        let mut touching = sums.pairs.map(|sums| sums != PairSums::default());
        for near in near.iter().take_while(|near| near.gap < self.displacement()) {
            touching[usize::from(near.pair)] = true;
        }
        touching
    }

    /// Part of an overlap that may be rounding, m.
    pub fn rounding(&self) -> f64 {
        2.0 * self.quantum + 4.0 * f64::EPSILON * self.displacement().abs()
    }

    /// Returns the sums of the contact under a load (N) that friction needs.
    pub fn sums(&self, load: f64) -> ContactSums {
        ContactSums { load, area: self.area(), statuses: self.statuses }
    }

    /// Displacement δ, m; 0 before the first step.
    pub fn displacement(&self) -> f64 {
        self.displacement.unwrap_or(0.0)
    }

    /// Returns the areas in contact and the raw losses there.
    pub fn touching(&self) -> &Touching {
        &self.touching
    }

    /// Contact area Σ A over cells in contact, m².
    pub fn area(&self) -> f64 {
        float(self.touching.area) * self.area_unit
    }

    /// Load Σ p A, N.
    pub fn load(&self) -> f64 {
        self.load
    }

    /// Mean overlap of the cells in contact, each counted by its stiffness, m.
    pub fn mean_overlap(&self) -> f64 {
        if self.slope > 0.0 { self.load / self.slope } else { 0.0 }
    }

    /// Raw volume that plateaus of the pin lose, m³, where all have the same properties, less what others would have lost.
    pub fn raw_loss(&self, weights: &RowWeights, all: &RawLoss, less: &RawLoss) -> f64 {
        let mut near = all.near;
        near.subtract(less.near);
        let low = float(all.low - less.low) * self.quantum + float(all.rate - less.rate) * self.above;
        low * weights.pin_loss[PLATEAU].unit() + weights.raw.value(near)
    }

    /// Part of the load that the rounding of the overlaps may hide, N.
    pub fn doubt(&self) -> f64 {
        self.doubt
    }

    /// Slope Σ k A over cells in contact, N/m.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Residual |Σ k A u − F_N| / F_N of the last balance, 1; unless refined, with the doubt over F_N.
    pub fn residual(&self) -> f64 {
        self.residual
    }
}

/// Brings pairs with gaps up to a bound, m, to the front, and sorts these alone, in an order that does not depend on who read what.
fn sorted_up_to(bound: f64, near: &mut [NearPair]) -> &[NearPair] {
    let mut count = 0;
    for place in 0..near.len() {
        if near[place].gap <= bound {
            near.swap(count, place);
            count += 1;
        }
    }
    let sorted = &mut near[..count];
    sorted.sort_unstable_by(|a, b| a.gap.total_cmp(&b.gap).then_with(|| (a.row, a.pair).cmp(&(b.row, b.pair))));
    sorted
}

/// Returns Σ k A (low − g)₊ (N), its slope (N/m), and the part of the load that the rounding of the overlaps may hide (N): four
/// standard deviations of what so many roundings of up to half a quantum carry.
fn load_at_low(weights: &RowWeights, sums: &Sums, bracket: &Bracket) -> (f64, f64, f64) {
    let (mut load, mut slope, mut squares) = (0.0, 0.0, 0.0);
    for pair in weights.pairs {
        let all = |sum: fn(&PairSums) -> i128| float(sum(&sums.pairs[*pair]));
        let unit = weights.stiffness[*pair].unit();
        load += all(|sums| sums.load) * (unit * bracket.quantum.value());
        let stiffness = all(|sums| sums.stiffness) * unit;
        slope += stiffness;
        squares += weights.largest_stiffness[*pair] * stiffness;
    }
    (load, slope, 4.0 * bracket.quantum.value() * (squares / 12.0).sqrt())
}

/// Tells whether the pin of a pair is bare resin.
fn is_bare_resin(pair: usize) -> bool {
    status_of(pair) == Status::Resin as u8
}

/// Number of the pin's status in a pair.
fn status_of(pair: usize) -> u8 {
    (pair / 2) as u8
}

/// A distance that rounding does not lose between displacements of this size, m.
fn rounding(a: f64, b: f64, bracket: &Bracket) -> f64 {
    16.0 * f64::EPSILON * (a.abs() + b.abs()) + 4.0 * bracket.quantum.value()
}
