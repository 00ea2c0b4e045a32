//! Debris balance: what wears, what is captured, compacted, returned and emitted (model 4.4 and 4.5).

use std::ops::Range;

use crate::contact::Contact;
use crate::exact::{Exact, Quantum, RowIntegers, dot};
use crate::kernel::{Chunk, LANES, Moved};
use crate::pair::{Coefficients, Table};
use crate::parameters::{DebrisPool, Parameters};
use crate::parts::Needs;
use crate::strips::strips;
use crate::sum::RunningSum;

/// Volumes moved since t = 0, m³.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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

/// The pools of debris and the account of all that went through them.
#[derive(Debug, Clone, PartialEq)]
pub struct Debris {
    captured_fraction: f64,
    /// β.
    pad_share: f64,
    needs: Needs,
    /// h_m, m.
    wear_height: f64,
    /// Columns of the pin.
    columns: usize,
    /// A of every row, m².
    area: Vec<f64>,
    /// Raw volume that plateaus of the pin lose per overlap, by pair and row, m².
    pin_loss: Table,
    /// The same of the disc.
    disc_loss: Table,
    /// Power of two that is above any loss per overlap.
    loss_exponent: i32,
    /// M, m³: one pool, or one per row.
    pools: Vec<RunningSum>,
    /// s = M/S of every row, m; all 0 without formation.
    share: Vec<Chunk>,
    /// Of which the deposits of the step are counted as multiples.
    deposits: Quantum,
    /// Room for a value of every row.
    rows: Vec<f64>,
    totals: Totals,
}

impl Debris {
    /// Empty pools.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients) -> Self {
        let Parameters { mesh, plateaus: rules, .. } = parameters;
        let pools = match rules.debris_pool {
            DebrisPool::Contact => 1,
            DebrisPool::Track => mesh.rows(),
        };
        let by_area = |table: &Table| {
            table.each_ref().map(|rows| rows.iter().zip(mesh.area()).map(|(loss, area)| loss * area).collect())
        };
        let losses = coefficients.pin.iter().chain(&coefficients.disc).flatten();
        let largest_loss = losses.copied().fold(0.0, f64::max);
        Self {
            captured_fraction: rules.captured_fraction,
            pad_share: rules.pad_share,
            needs: Needs::of(parameters),
            wear_height: parameters.materials.wear_height,
            columns: mesh.pin_columns(),
            area: mesh.area().to_vec(),
            pin_loss: by_area(&coefficients.pin),
            disc_loss: by_area(&coefficients.disc),
            loss_exponent: if largest_loss > 0.0 { libm::ilogb(largest_loss) + 1 } else { 0 },
            pools: vec![RunningSum::default(); pools],
            share: vec![Chunk([0.0; LANES]); strips(mesh.rows())],
            deposits: Quantum::of(0.0, 1),
            rows: vec![0.0; mesh.rows()],
            totals: Totals::default(),
        }
    }

    /// The rows that share each pool.
    fn rows_of(&self, pool: usize) -> Range<usize> {
        let rows = self.area.len() / self.pools.len();
        pool * rows..(pool + 1) * rows
    }

    /// Spreads each pool evenly over its cells that do not touch: s = M/S; `touching` are the cells in contact by row.
    pub fn spread(&mut self, touching: &[f64]) {
        if !self.needs.forms {
            return;
        }
        self.rows.iter_mut().zip(touching).for_each(|(open, touching)| *open = self.columns as f64 - touching);
        let mut largest = 0.0_f64;
        for (index, pool) in self.pools.iter().enumerate() {
            let rows = self.rows_of(index);
            let open = dot(&self.rows[rows.clone()], &self.area[rows.clone()]);
            // Rounding may leave a trace of debt in an emptied pool; it is not spread, and the next step settles it.
            let share = if open > 0.0 { (pool.value() / open).max(0.0) } else { 0.0 };
            match self.pools.len() {
                1 => self.share.fill(Chunk([share; LANES])),
                _ => self.share[index / LANES].0[index % LANES] = share,
            }
            largest = largest.max(share);
        }
        self.deposits = Quantum::of(largest, self.columns);
    }

    /// s of every row, m: the height of debris that is at hand for each cell that does not touch.
    pub fn share(&self) -> &[Chunk] {
        &self.share
    }

    /// s of a row, m.
    fn share_of(&self, row: usize) -> f64 {
        self.share[row / LANES].0[row % LANES]
    }

    /// Of which this step's deposits are counted as multiples.
    pub fn deposits(&self) -> Quantum {
        self.deposits
    }

    /// Of which losses are counted as multiples where overlaps are multiples of `overlaps`.
    pub fn losses(&self, overlaps: Quantum) -> Quantum {
        overlaps.coarser(self.loss_exponent)
    }

    /// Books one step: M ← M + η worn + returned − deposited, emitted += (1 − η) worn, for each pool.
    ///
    /// What a pair in contact loses is proportional to its overlap, and resin loses its wear height; so the worn volume
    /// follows from the contact, less what cells were spared whose build-up was worn through.
    pub fn settle(&mut self, contact: &Contact, moved: &Moved, losses: Quantum) {
        for pool in 0..self.pools.len() {
            let rows = self.rows_of(pool);
            let volume = |heights: &[f64]| dot(&heights[rows.clone()], &self.area[rows.clone()]);
            let worn = |loss: &Table| -> f64 {
                let overlap = contact.overlap_by_pair();
                contact.pairs().iter().map(|pair| dot(&overlap[*pair][rows.clone()], &loss[*pair][rows.clone()])).sum()
            };
            let [resin, resin_on_debris] = [&contact.touching_by_pair()[0], &contact.touching_by_pair()[1]];

            let mut worn_pin = worn(&self.pin_loss);
            let worn_resin = self.wear_height * (volume(resin) + volume(resin_on_debris));
            let mut worn_disc = if self.needs.disc_wears { worn(&self.disc_loss) } else { 0.0 };
            let (mut returned, mut deposited_pin, mut deposited_disc) = (0.0, 0.0, 0.0);
            if self.needs.forms {
                let share = self.share_of(rows.start);
                let even_on_pin = share * self.pad_share;
                let mut deposited = |even: f64, beyond: &RowIntegers| {
                    let even = self.deposits.count(even);
                    let counts = beyond.rows(rows.clone()).iter().zip(&contact.touching()[rows.clone()]);
                    self.rows[rows.clone()].iter_mut().zip(counts).for_each(|(height, (beyond, touching))| {
                        let open = self.columns as i64 - *touching as i64;
                        *height = (even.wrapping_mul(open).wrapping_add(*beyond)) as f64 * self.deposits.value();
                    });
                    dot(&self.rows[rows.clone()], &self.area[rows.clone()])
                };
                deposited_pin = deposited(even_on_pin, &moved.deposited_pin);
                deposited_disc = deposited(share - even_on_pin, &moved.deposited_disc);
            }
            if self.needs.distinct {
                let mut spared = |counts: &RowIntegers| {
                    let counts = counts.rows(rows.clone());
                    let heights = self.rows[rows.clone()].iter_mut();
                    heights.zip(counts).for_each(|(height, count)| *height = *count as f64 * losses.value());
                    dot(&self.rows[rows.clone()], &self.area[rows.clone()])
                };
                worn_pin -= spared(&moved.spared_pin);
                if self.needs.disc_wears {
                    worn_disc -= spared(&moved.spared_disc);
                }
            }
            if moved.seldom.happened {
                let exact =
                    |heights: &[Exact]| volume(&heights.iter().map(|height| height.value()).collect::<Vec<_>>());
                worn_pin -= exact(&moved.seldom.spared);
                returned = exact(&moved.seldom.returned);
            }

            let worn = worn_pin + worn_resin + worn_disc;
            let pool = &mut self.pools[pool];
            pool.add(self.captured_fraction * worn);
            pool.add(returned);
            pool.add(-(deposited_pin + deposited_disc));

            self.totals.worn_pin.add(worn_pin);
            self.totals.worn_resin.add(worn_resin);
            self.totals.worn_disc.add(worn_disc);
            self.totals.returned.add(returned);
            self.totals.deposited_pin.add(deposited_pin);
            self.totals.deposited_disc.add(deposited_disc);
            self.totals.emitted.add((1.0 - self.captured_fraction) * worn);
        }
    }

    /// M, m³: debris in the contact that is not compacted, over all pools.
    pub fn pool(&self) -> f64 {
        self.pools.iter().map(RunningSum::value).sum()
    }

    /// Volumes moved since t = 0.
    pub fn totals(&self) -> &Totals {
        &self.totals
    }

    /// (worn + returned − deposited − emitted − pool) / worn; 0 if nothing is worn.
    pub fn balance_residual(&self) -> f64 {
        let totals = &self.totals;
        let worn = totals.worn_pin.value() + totals.worn_resin.value() + totals.worn_disc.value();
        if worn == 0.0 {
            return 0.0;
        }
        let mut rest = RunningSum::default();
        for term in [
            totals.worn_pin.value(),
            totals.worn_resin.value(),
            totals.worn_disc.value(),
            totals.returned.value(),
            -totals.deposited_pin.value(),
            -totals.deposited_disc.value(),
            -totals.emitted.value(),
            -self.pool(),
        ] {
            rest.add(term);
        }
        rest.value() / worn
    }
}
