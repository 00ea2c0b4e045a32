//! What a step moves.

use std::ops::Add;

/// Volumes that one step moves, m³: worn + returned = deposited + emitted + what the pools gained.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Volumes {
    /// Worn off plateaus of the pin.
    pub worn_pin: f64,
    /// Worn off resin.
    pub worn_resin: f64,
    /// Worn off the disc.
    pub worn_disc: f64,
    /// Came off a surface without wearing, as a build-up does that lost its support; it is emitted or in a pool.
    pub returned: f64,
    /// Compacted on the pin.
    pub deposited_pin: f64,
    /// Compacted on the disc.
    pub deposited_disc: f64,
    /// Left the contact.
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
