//! Debris balance: what wears, what is compacted and emitted (model 4L).

use crate::engine::coefficients::{Coefficients, PairLoss, StatusPair};
use crate::engine::contact::Contact;
use crate::engine::exact::{Quantum, float};
use crate::engine::parts::Needs;
use crate::engine::sums::{RowWeights, Sums};
use crate::model::Volumes;
use crate::model::parameters::{DebrisRule, Parameters};
use crate::model::sums::RunningSum;
use crate::model::totals::{Account, Totals};

/// The account of all debris.
#[derive(Debug, Clone, PartialEq)]
pub struct Debris {
    captured_fraction: f64,
    captured_resin_fraction: f64,
    needs: Needs,
    /// Wear height h_m, m.
    wear_height: f64,
    /// Terms that a sum of a row may have: the columns of the pin, more if there are so many rows that the sums of all of
    /// them would not fit 127 bits.
    terms: usize,
    /// Area of one unit, m².
    area_unit: f64,
    /// Largest loss of pin or disc per overlap, 1.
    largest_loss: f64,
    /// Losses of every kind of pairs, where the kinds are so unlike that one may hide the losses of another; else none.
    unlike: Option<[PairLoss; StatusPair::COUNT]>,
    /// Largest part of the loss of a pair of plateaus that may be compacted, per overlap, 1.
    largest_deposit: f64,
    /// Quantum of the deposits of the step, m.
    deposit_quantum: Quantum,
    /// Coarse quantum of the losses of the step, and fine one of what that leaves of them, m; only where build-up has properties of
    /// its own.
    loss_quanta: [Quantum; 2],
    account: Account,
}

/// Rows of which each may have sums of 116 bits.
const ROWS: usize = 1 << 10;

impl Debris {
    /// Creates the account of a scene in which nothing has moved yet.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients, weights: &RowWeights) -> Self {
        let Parameters { mesh, plateaus: rules, .. } = parameters;
        // Where nothing forms, debris of a pool stays in it: one serves for all rows.
        let pools = if rules.debris == DebrisRule::Local { 0 } else { 1 };
        Self {
            captured_fraction: rules.captured_fraction,
            captured_resin_fraction: rules.captured_of_resin(),
            needs: Needs::of(parameters),
            wear_height: parameters.materials.wear_height,
            terms: mesh.pin_columns().saturating_mul(mesh.rows().div_ceil(ROWS)),
            area_unit: weights.area.unit(),
            largest_loss: largest_loss(coefficients),
            unlike: unlike(coefficients),
            largest_deposit: rules.captured_fraction * coefficients.largest_loss(),
            deposit_quantum: Quantum::of(0.0, 1),
            loss_quanta: [Quantum::of(0.0, 1); 2],
            account: Account { pools: vec![RunningSum::default(); pools], totals: Totals::default() },
        }
    }

    /// Takes over the coefficients of another acceleration.
    pub fn set_coefficients(&mut self, coefficients: &Coefficients) {
        self.largest_loss = largest_loss(coefficients);
        self.unlike = unlike(coefficients);
        self.largest_deposit = self.captured_fraction * coefficients.largest_loss();
    }

    /// Returns what the pools hold, and the volumes moved since t = 0, m³.
    pub fn account(&self) -> &Account {
        &self.account
    }

    /// Goes on from an account.
    pub fn set_account(&mut self, account: Account) {
        self.account = account;
    }

    /// Makes ready for the losses and deposits of a step in whose contact no overlap is more than `largest_overlap` (m), and in which
    /// pairs of these kinds touch.
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
        if self.needs.forms {
            self.deposit_quantum = Quantum::of(deposit, self.terms);
        }
    }

    /// Quantum of this step's deposits, m.
    pub fn deposit_quantum(&self) -> Quantum {
        self.deposit_quantum
    }

    /// Coarse quantum of this step's losses, and fine one of what that leaves of them, m.
    pub fn loss_quanta(&self) -> [Quantum; 2] {
        self.loss_quanta
    }

    /// Books one step: emitted += worn + returned − deposited, or where nothing forms and there is a pool M ← M + η worn and
    /// emitted += (1 − η) worn. Returns what the step moved.
    ///
    /// What plateaus lose follows from the contact, less the raw loss of build-up on resin that was worn through, which lost
    /// itself instead; where build-up has properties of its own, all losses were counted.
    pub fn settle(&mut self, weights: &RowWeights, contact: &Contact, sums: &Sums) -> Volumes {
        let volume = |sum| weights.volume.value(sum);
        let touching = contact.touching();
        let worn_resin = self.wear_height * (float(touching.resin_area) * self.area_unit);
        let [worn_pin, worn_disc] = if self.needs.distinct {
            let parts = |counts: [i128; 2]| [0, 1].map(|size| float(counts[size]) * self.loss_quanta[size].value());
            [sums.lost_pin, sums.lost_disc].map(|counts| parts(counts).iter().sum::<f64>() * self.area_unit)
        } else {
            let raw = contact.raw_loss(weights, &touching.pin_loss, &sums.raw_through);
            [raw + volume(sums.worn_through), touching.disc_loss]
        };
        let mut moved = Volumes { worn_pin, worn_resin, worn_disc, ..Volumes::default() };
        if self.needs.forms {
            let deposited = |counted: i128| float(counted) * (self.area_unit * self.deposit_quantum.value());
            moved.deposited_pin = deposited(sums.deposited_pin) + volume(sums.deposited_pin_of_resin);
            moved.deposited_disc = deposited(sums.deposited_disc) + volume(sums.deposited_disc_of_resin);
            moved.returned = volume(sums.returned);
        }
        let [captured, emitted] = self.part(&moved);
        moved.emitted = match self.account.pools.first_mut() {
            None => worn_pin + worn_resin + worn_disc + moved.returned - (moved.deposited_pin + moved.deposited_disc),
            Some(pool) => {
                pool.add(captured);
                emitted
            }
        };
        self.account.totals.add(&moved);
        moved
    }

    /// Parts the worn volume into what stays in a pool and what leaves the contact, m³: η and 1 − η of it, each for resin and plateaus.
    fn part(&self, &Volumes { worn_pin, worn_resin, worn_disc, .. }: &Volumes) -> [f64; 2] {
        let (of_plateaus, of_resin) = (self.captured_fraction, self.captured_resin_fraction);
        // Summed first: apart, a scene without the second fraction would get other bits than it always had.
        if of_plateaus == of_resin {
            let worn = worn_pin + worn_resin + worn_disc;
            return [of_plateaus * worn, (1.0 - of_plateaus) * worn];
        }
        let plateaus = worn_pin + worn_disc;
        [of_plateaus * plateaus + of_resin * worn_resin, (1.0 - of_plateaus) * plateaus + (1.0 - of_resin) * worn_resin]
    }
}

/// Factor by which a bound of losses must be closer than the usual one to take its place.
const UNLIKE: f64 = (1 << 20) as f64;

/// The losses of all kinds of pairs, if some kind loses so much more per overlap than another that it could hide it.
fn unlike(coefficients: &Coefficients) -> Option<[PairLoss; StatusPair::COUNT]> {
    let losses = coefficients.pair_losses();
    let lost = || losses.iter().map(|loss| loss.per_overlap).filter(|loss| *loss > 0.0);
    let [least, most] = [lost().fold(f64::INFINITY, f64::min), lost().fold(0.0, f64::max)];
    (most > UNLIKE * least).then_some(losses)
}

/// Largest loss of pin or disc per overlap, 1.
fn largest_loss(coefficients: &Coefficients) -> f64 {
    let [pin, disc] = coefficients.largest_losses();
    pin.max(disc)
}
