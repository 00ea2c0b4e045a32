//! Debris balance: what wears, what is captured, compacted, returned and emitted (model 4.4 and 4.5).

use crate::mesh::Mesh;
use crate::parameters::{DebrisPool, PlateauRules};
use crate::sum::RunningSum;

/// Heights taken off and put on in one step, summed along each row, m.
#[derive(Debug, Clone, PartialEq)]
pub struct Transfer {
    /// Worn off plateaus of the pin.
    pub worn_pin: Vec<f64>,
    /// Worn off resin.
    pub worn_resin: Vec<f64>,
    /// Worn off the disc.
    pub worn_disc: Vec<f64>,
    /// Build-up of unsupported plateaus.
    pub returned: Vec<f64>,
    /// Compacted on the pin.
    pub deposited_pin: Vec<f64>,
    /// Compacted on the disc.
    pub deposited_disc: Vec<f64>,
}

impl Transfer {
    /// Nothing moved yet.
    pub fn new(rows: usize) -> Self {
        let zero = vec![0.0; rows];
        Self {
            worn_pin: zero.clone(),
            worn_resin: zero.clone(),
            worn_disc: zero.clone(),
            returned: zero.clone(),
            deposited_pin: zero.clone(),
            deposited_disc: zero,
        }
    }

    /// Starts a new step.
    pub fn clear(&mut self) {
        for heights in [
            &mut self.worn_pin,
            &mut self.worn_resin,
            &mut self.worn_disc,
            &mut self.returned,
            &mut self.deposited_pin,
            &mut self.deposited_disc,
        ] {
            heights.fill(0.0);
        }
    }
}

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
    formation: bool,
    /// M, m³: one pool, or one per row.
    pools: Vec<RunningSum>,
    /// s = M/S of every row, m; all 0 without formation.
    share: Vec<f64>,
    totals: Totals,
}

impl Debris {
    /// Empty pools.
    pub fn new(mesh: &Mesh, rules: &PlateauRules) -> Self {
        let pools = match rules.debris_pool {
            DebrisPool::Contact => 1,
            DebrisPool::Track => mesh.rows(),
        };
        Self {
            captured_fraction: rules.captured_fraction,
            formation: rules.formation,
            pools: vec![RunningSum::default(); pools],
            share: vec![0.0; mesh.rows()],
            totals: Totals::default(),
        }
    }

    /// Rows that share each pool.
    fn rows_per_pool(&self) -> usize {
        self.share.len() / self.pools.len()
    }

    /// Spreads each pool evenly over its cells that do not touch: s = M/S; `touching` are the cells in contact by row.
    pub fn spread(&mut self, mesh: &Mesh, touching: &[f64]) {
        if !self.formation {
            return;
        }
        let rows = self.rows_per_pool();
        let shares = self.share.chunks_mut(rows);
        for (((pool, share), touching), area) in
            self.pools.iter().zip(shares).zip(touching.chunks(rows)).zip(mesh.area().chunks(rows))
        {
            let open: f64 =
                touching.iter().zip(area).map(|(count, area)| (mesh.pin_columns() as f64 - count) * area).sum();
            // Rounding may leave a trace of debt in an emptied pool; it is not spread, and the next step settles it.
            let spread = if open > 0.0 { (pool.value() / open).max(0.0) } else { 0.0 };
            share.fill(spread);
        }
    }

    /// s of every row, m: the height of debris that is at hand for each cell that does not touch.
    pub fn share(&self) -> &[f64] {
        &self.share
    }

    /// Books one step: M ← M + η worn + returned − deposited, emitted += (1 − η) worn, for each pool.
    pub fn settle(&mut self, mesh: &Mesh, transfer: &Transfer) {
        let rows = self.rows_per_pool();
        for (index, pool) in self.pools.iter_mut().enumerate() {
            let span = index * rows..(index + 1) * rows;
            let volume = |heights: &[f64]| -> f64 {
                heights[span.clone()].iter().zip(&mesh.area()[span.clone()]).map(|(height, area)| height * area).sum()
            };
            let worn_pin = volume(&transfer.worn_pin);
            let worn_resin = volume(&transfer.worn_resin);
            let worn_disc = volume(&transfer.worn_disc);
            let returned = volume(&transfer.returned);
            let deposited_pin = volume(&transfer.deposited_pin);
            let deposited_disc = volume(&transfer.deposited_disc);

            let worn = worn_pin + worn_resin + worn_disc;
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
