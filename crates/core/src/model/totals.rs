//! Volumes that a step moved, and a simulation since its start, and whether they balance.

use std::ops::Add;

use serde::{Deserialize, Serialize};

use crate::model::sums::RunningSum;

/// Volumes that one step moves, m³: worn + returned = deposited + emitted + what the pools gained.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Volumes {
    /// Volume worn off plateaus of the pin.
    pub worn_pin: f64,
    /// Volume worn off resin.
    pub worn_resin: f64,
    /// Volume worn off the disc.
    pub worn_disc: f64,
    /// Volume that came off a surface without wearing, as a build-up does that lost its support; it is emitted or in a pool.
    pub returned: f64,
    /// Volume compacted on the pin.
    pub deposited_pin: f64,
    /// Volume compacted on the disc.
    pub deposited_disc: f64,
    /// Volume that left the contact.
    pub emitted: f64,
}

impl Add for Volumes {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            worn_pin: self.worn_pin + other.worn_pin,
            worn_resin: self.worn_resin + other.worn_resin,
            worn_disc: self.worn_disc + other.worn_disc,
            returned: self.returned + other.returned,
            deposited_pin: self.deposited_pin + other.deposited_pin,
            deposited_disc: self.deposited_disc + other.deposited_disc,
            emitted: self.emitted + other.emitted,
        }
    }
}

/// Volumes moved since t = 0, m³.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Volume worn off plateaus of the pin.
    pub worn_pin: RunningSum,
    /// Volume worn off resin.
    pub worn_resin: RunningSum,
    /// Volume worn off the disc.
    pub worn_disc: RunningSum,
    /// Build-up of the pin that lost its support or broke away.
    pub returned: RunningSum,
    /// Volume compacted on the pin.
    pub deposited_pin: RunningSum,
    /// Volume compacted on the disc.
    pub deposited_disc: RunningSum,
    /// Volume that left the contact.
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

    /// Missing share of the worn volume, 1, with this much (m³) in the pools, and `lost` (m³) the volume that the
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

/// Debris in the pools, and volumes moved since t = 0, m³.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// M, m³: none with local debris, else one pool, or one per row.
    pub pools: Vec<RunningSum>,
    /// Volumes moved since t = 0, m³.
    pub totals: Totals,
}

impl Account {
    /// M, m³: debris in the contact that is not compacted, over all pools.
    pub fn pool(&self) -> f64 {
        self.pools.iter().map(RunningSum::value).sum()
    }

    /// Missing share of the worn volume, 1: see [`Totals::balance_residual`].
    pub fn balance_residual(&self, lost: f64) -> f64 {
        self.totals.balance_residual(self.pool(), lost)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/totals.rs"]
mod tests;
