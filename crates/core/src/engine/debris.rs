//! Debris balance: what wears, what is captured, compacted, returned and emitted (model 4L and 4P).

use crate::engine::coefficients::{Coefficients, PairLoss, StatusPair};
use crate::engine::contact::Contact;
use crate::engine::exact::float;
use crate::engine::lanes::{Chunk, LANES};
use crate::engine::parts::Needs;
use crate::engine::quantum::Quantum;
use crate::engine::strips::strips;
use crate::engine::sums::{RowWeights, Sums};
use crate::model::Volumes;
use crate::model::parameters::{DebrisRule, Parameters};
use crate::model::running_sum::RunningSum;
use serde::{Deserialize, Serialize};

/// Volumes moved since t = 0, m³.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Worn off plateaus of the pin.
    pub worn_pin: RunningSum,
    /// Worn off resin.
    pub worn_resin: RunningSum,
    /// Worn off the disc.
    pub worn_disc: RunningSum,
    /// Build-up of unsupported plateaus.
    pub returned: RunningSum,
    /// Compacted on the pin.
    pub deposited_pin: RunningSum,
    /// Compacted on the disc.
    pub deposited_disc: RunningSum,
    /// Left the contact.
    pub emitted: RunningSum,
}

impl Totals {
    /// Adds what a step moved.
    pub fn add(&mut self, moved: &Volumes) {
        self.worn_pin.add(moved.worn_pin);
        self.worn_resin.add(moved.worn_resin);
        self.worn_disc.add(moved.worn_disc);
        self.returned.add(moved.returned);
        self.deposited_pin.add(moved.deposited_pin);
        self.deposited_disc.add(moved.deposited_disc);
        self.emitted.add(moved.emitted);
    }

    /// Of the worn volume the share that is missing, with this much (m³) in the pools, and `lost` (m³) the volume that the
    /// heights of both surfaces say has gone; 0 if nothing is worn. The larger of what lacks in the account, worn + returned
    /// − deposited − emitted − pool, and of what it has lost more than the surfaces, worn + returned − deposited − lost.
    pub fn balance_residual(&self, pool: f64, lost: f64) -> f64 {
        let worn = self.worn_pin.value() + self.worn_resin.value() + self.worn_disc.value();
        if worn == 0.0 {
            return 0.0;
        }
        let rest = |gone: [f64; 2]| {
            let mut rest = RunningSum::default();
            for term in [
                self.worn_pin.value(),
                self.worn_resin.value(),
                self.worn_disc.value(),
                self.returned.value(),
                -self.deposited_pin.value(),
                -self.deposited_disc.value(),
                -gone[0],
                -gone[1],
            ] {
                rest.add(term);
            }
            rest.value() / worn
        };
        let (account, surfaces) = (rest([self.emitted.value(), pool]), rest([lost, 0.0]));
        if surfaces.abs() > account.abs() { surfaces } else { account }
    }
}

/// What the pools hold, and what went through them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// M, m³: one pool, or one per row.
    pub pools: Vec<RunningSum>,
    /// Volumes moved since t = 0.
    pub totals: Totals,
}

/// The pools of debris and the account of all that went through them.
#[derive(Debug, Clone, PartialEq)]
pub struct Debris {
    /// Whether there are no pools.
    local: bool,
    captured_fraction: f64,
    captured_resin_fraction: f64,
    /// β.
    pad_share: f64,
    needs: Needs,
    /// h_m, m.
    wear_height: f64,
    /// Terms that a sum of a row may have: the columns of the pin, more if there are so many rows that the sums of all of
    /// them would not fit 127 bits.
    terms: usize,
    /// Σ A of the pin cells of each pool, in units of the area.
    pool_area: Vec<i128>,
    /// What a unit of the area is worth, m².
    area_unit: f64,
    /// The largest loss of pin or disc per overlap.
    largest_loss: f64,
    /// Of every kind of pairs, where the kinds are so unlike that one may hide the losses of another; else none.
    unlike: Option<[PairLoss; StatusPair::COUNT]>,
    /// What of the loss of a pair of plateaus may be compacted, per overlap.
    largest_deposit: f64,
    /// M, m³: one pool, or one per row.
    pools: Vec<RunningSum>,
    /// s = M/S of every pool, m; 0 without formation.
    pool_share: Vec<f64>,
    /// The same of every row.
    share: Vec<Chunk>,
    /// Of which the deposits of the step are counted as multiples.
    deposit_quantum: Quantum,
    /// Of which losses of the step are counted as multiples, and what that leaves of them; only where build-up has
    /// properties of its own.
    loss_quanta: [Quantum; 2],
    totals: Totals,
}

/// Rows of which each may have sums of 116 bits.
const ROWS: usize = 1 << 10;

impl Debris {
    /// Empty pools.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients, weights: &RowWeights) -> Self {
        let Parameters { mesh, plateaus: rules, .. } = parameters;
        let area_of = |pool| {
            let rows = weights.rows_of(pool);
            let areas = weights.area.rows(rows.clone()).iter().map(|area| i128::from(*area));
            rows.zip(areas).map(|(row, area)| mesh.chord(row).len() as i128 * area).sum()
        };
        Self {
            local: rules.debris == DebrisRule::Local,
            captured_fraction: rules.captured_fraction,
            captured_resin_fraction: rules.captured_of_resin(),
            pad_share: rules.pad_share,
            needs: Needs::of(parameters),
            wear_height: parameters.materials.wear_height,
            terms: mesh.pin_columns().saturating_mul(mesh.rows().div_ceil(ROWS)),
            pool_area: (0..weights.pools()).map(area_of).collect(),
            area_unit: weights.area.unit(),
            largest_loss: largest_loss(coefficients),
            unlike: unlike(coefficients),
            largest_deposit: rules.captured_fraction * coefficients.largest_loss(),
            pools: vec![RunningSum::default(); weights.pools()],
            pool_share: vec![0.0; weights.pools()],
            share: vec![Chunk([0.0; LANES]); strips(mesh.rows())],
            deposit_quantum: Quantum::of(0.0, 1),
            loss_quanta: [Quantum::of(0.0, 1); 2],
            totals: Totals::default(),
        }
    }

    /// Takes over the coefficients of another acceleration.
    pub fn set_coefficients(&mut self, coefficients: &Coefficients) {
        self.largest_loss = largest_loss(coefficients);
        self.unlike = unlike(coefficients);
        self.largest_deposit = self.captured_fraction * coefficients.largest_loss();
    }

    /// What the pools hold, and what went through them.
    pub fn account(&self) -> Account {
        Account { pools: self.pools.clone(), totals: self.totals }
    }

    /// Goes on from an account.
    pub fn set_account(&mut self, Account { pools, totals }: Account) {
        (self.pools, self.totals) = (pools, totals);
    }

    /// Makes ready for the losses and deposits of a step in whose contact no overlap is more than `largest_overlap` (m),
    /// and which pairs of these kinds touch.
    pub fn prepare(
        &mut self,
        contact: &Contact,
        largest_overlap: f64,
        touching: impl FnOnce() -> [bool; StatusPair::COUNT],
    ) {
        let [mut loss, mut deposit] = [self.largest_loss, self.largest_deposit].map(|loss| loss * largest_overlap);
        if let Some(losses) = &self.unlike {
            // No cell carries more than all; of an overlap that is less than its rounding, that is left.
            let overlap = |loss: &PairLoss| {
                (2.0 * loss.per_load / loss.per_overlap * contact.load() + contact.rounding()).min(largest_overlap)
            };
            let of_kind = |(loss, touches): (&PairLoss, bool)| {
                if touches && loss.per_overlap > 0.0 { loss.per_overlap * overlap(loss) } else { 0.0 }
            };
            let largest = losses.iter().zip(touching()).map(of_kind).fold(0.0, f64::max);
            // Else sums keep the quanta that they have always had.
            let closer = |usual: f64, other: f64| if other < usual / UNLIKE { other } else { usual };
            (loss, deposit) = (closer(loss, largest), closer(deposit, self.captured_fraction * largest));
        }
        if self.needs.distinct {
            let coarse = Quantum::of(loss, self.terms);
            self.loss_quanta = [coarse, Quantum::of(coarse.value(), self.terms)];
        }
        if self.needs.local {
            self.deposit_quantum = Quantum::of(deposit, self.terms);
        } else if self.needs.forms {
            self.spread(contact);
        }
    }

    /// Spreads each pool evenly over its cells that do not touch: s = M/S.
    fn spread(&mut self, contact: &Contact) {
        let mut largest = 0.0_f64;
        for (index, (pool, share)) in self.pools.iter().zip(&mut self.pool_share).enumerate() {
            let open = self.pool_area[index] - contact.pools()[index].area;
            // Rounding may leave a trace of debt in a pool that has given nearly all; it is not spread.
            *share = if open > 0 { (pool.value() / (float(open) * self.area_unit)).max(0.0) } else { 0.0 };
            largest = largest.max(*share);
        }
        match *self.pool_share {
            [share] => self.share.fill(Chunk([share; LANES])),
            ref shares => {
                for (chunk, shares) in self.share.iter_mut().zip(shares.chunks(LANES)) {
                    chunk.0[..shares.len()].copy_from_slice(shares);
                }
            }
        }
        self.deposit_quantum = Quantum::of(largest, self.terms);
    }

    /// s of every row, m: the height of debris that is at hand for each cell that does not touch.
    pub fn share(&self) -> &[Chunk] {
        &self.share
    }

    /// Of which this step's deposits are counted as multiples.
    pub fn deposit_quantum(&self) -> Quantum {
        self.deposit_quantum
    }

    /// Of which this step's losses are counted as multiples, and what that leaves of them.
    pub fn loss_quanta(&self) -> [Quantum; 2] {
        self.loss_quanta
    }

    /// Books one step: M ← M + η worn + returned − deposited, emitted += (1 − η) worn, for each pool; with local debris
    /// emitted += worn − deposited, and there is no pool.
    ///
    /// What plateaus lose follows from the contact, less the raw loss of build-up on resin that was worn through, which lost
    /// itself instead; where build-up has properties of its own, all losses were counted. What is compacted is the even deposit on every open cell, and what some got beyond it. Where every open cell got the whole
    /// share, the pool has given all.
    ///
    /// Returns what the step moved.
    pub fn settle(&mut self, weights: &RowWeights, contact: &Contact, sums: &Sums) -> Volumes {
        let mut all = Volumes::default();
        let volume = |sum| weights.volume.value(sum);
        for (index, (touching, sums)) in contact.pools().iter().zip(&sums.pools).enumerate() {
            let worn_resin = self.wear_height * (float(touching.resin_area) * self.area_unit);
            let [worn_pin, worn_disc] = if self.needs.distinct {
                let parts = |counts: [i128; 2]| [0, 1].map(|size| float(counts[size]) * self.loss_quanta[size].value());
                [sums.lost_pin, sums.lost_disc].map(|counts| parts(counts).iter().sum::<f64>() * self.area_unit)
            } else {
                let raw = contact.raw_loss(weights, &touching.pin_loss, &sums.raw_through);
                [raw + volume(sums.worn_through), touching.disc_loss]
            };
            let mut emptied = false;
            let (mut returned, mut deposited_pin, mut deposited_disc) = (0.0, 0.0, 0.0);
            if self.needs.forms {
                let open = self.pool_area[index] - touching.area;
                let share = self.pool_share[index];
                let even_on_pin = share * self.pad_share;
                let deposited = |even: f64, beyond: i128| {
                    float(i128::from(self.deposit_quantum.count(even)) * open + beyond)
                        * (self.area_unit * self.deposit_quantum.value())
                };
                deposited_pin = deposited(even_on_pin, sums.deposited_pin);
                deposited_disc = deposited(share - even_on_pin, sums.deposited_disc);
                deposited_pin += volume(sums.deposited_pin_of_resin);
                deposited_disc += volume(sums.deposited_disc_of_resin);
                emptied = self.local || (open > 0 && !sums.limited);
                returned = volume(sums.returned);
            }

            let [captured, emitted] = match self.local {
                true => [0.0, worn_pin + worn_resin + worn_disc - (deposited_pin + deposited_disc)],
                false => self.part(worn_pin, worn_resin, worn_disc),
            };
            let pool = &mut self.pools[index];
            if emptied {
                // Exactly: what rounding would leave could make a cell of the next step secondary.
                *pool = RunningSum::default();
            }
            pool.add(captured);
            pool.add(returned);
            if !emptied {
                pool.add(-(deposited_pin + deposited_disc));
            }

            let moved = Volumes { worn_pin, worn_resin, worn_disc, returned, deposited_pin, deposited_disc, emitted };
            self.totals.add(&moved);
            all = all + moved;
        }
        all
    }

    /// What of the worn volume stays in the contact and what leaves it, m³: η and 1 − η of it, each for resin and plateaus.
    fn part(&self, worn_pin: f64, worn_resin: f64, worn_disc: f64) -> [f64; 2] {
        let (of_plateaus, of_resin) = (self.captured_fraction, self.captured_resin_fraction);
        // Summed first, as model 4P has it: apart, a scene without the second fraction would get other bits.
        if of_plateaus == of_resin {
            let worn = worn_pin + worn_resin + worn_disc;
            return [of_plateaus * worn, (1.0 - of_plateaus) * worn];
        }
        let plateaus = worn_pin + worn_disc;
        [of_plateaus * plateaus + of_resin * worn_resin, (1.0 - of_plateaus) * plateaus + (1.0 - of_resin) * worn_resin]
    }

    /// M, m³: debris in the contact that is not compacted, over all pools.
    pub fn pool(&self) -> f64 {
        self.pools.iter().map(RunningSum::value).sum()
    }

    /// Volumes moved since t = 0.
    pub fn totals(&self) -> &Totals {
        &self.totals
    }

    /// Of the worn volume the share that is missing: see [`Totals::balance_residual`].
    pub fn balance_residual(&self, lost: f64) -> f64 {
        self.totals.balance_residual(self.pool(), lost)
    }
}

/// By how much a bound of losses must be closer than the usual one to take its place.
const UNLIKE: f64 = (1 << 20) as f64;

/// The losses of all kinds of pairs, if some kind loses so much more per overlap than another that it could hide it.
fn unlike(coefficients: &Coefficients) -> Option<[PairLoss; StatusPair::COUNT]> {
    let losses = coefficients.pair_losses();
    let lost = || losses.iter().map(|loss| loss.per_overlap).filter(|loss| *loss > 0.0);
    let [least, most] = [lost().fold(f64::INFINITY, f64::min), lost().fold(0.0, f64::max)];
    (most > UNLIKE * least).then_some(losses)
}

/// The largest loss of pin or disc per overlap.
fn largest_loss(coefficients: &Coefficients) -> f64 {
    let [pin, disc] = coefficients.largest_losses();
    pin.max(disc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_balance_sees_what_the_account_cannot() {
        // 3 of 4 m³ worn are deposited, the rest is emitted: the account is right by itself. Heights say whether it is true.
        let mut totals = Totals::default();
        totals.add(&Volumes { worn_pin: 4.0, deposited_disc: 3.0, emitted: 1.0, ..Volumes::default() });
        assert_eq!(totals.balance_residual(0.0, 1.0), 0.0);
        // As if a sum of deposits had lost 2 m³ that are on the disc: surfaces lost less than the account says.
        let mut wrapped = Totals::default();
        wrapped.add(&Volumes { worn_pin: 4.0, deposited_disc: 1.0, emitted: 3.0, ..Volumes::default() });
        assert_eq!(wrapped.balance_residual(0.0, 1.0), 0.5);
        // What the account itself lacks, it sees as before.
        assert_eq!(totals.balance_residual(1.0, 1.0), -0.25);
    }
}
