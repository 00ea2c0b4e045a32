//! Coefficients of a pair of cells by status and row: stiffness (model 4.1) and wear per overlap (model 4.2).

use crate::model::material::Status;
use crate::model::parameters::{Integrator, Parameters};

/// The statuses of a pin cell and the disc cell under it, as an index into the tables of [`Coefficients`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StatusPair(u8);

impl StatusPair {
    /// Number of different pairs: three statuses of the pin times two of the disc.
    pub const COUNT: usize = 6;

    /// Pair of these two statuses.
    pub fn new(pin: Status, disc_secondary: bool) -> Self {
        Self(2 * pin as u8 + u8::from(disc_secondary))
    }

    /// Returns every pair as the status of the pin and whether the disc is secondary.
    pub fn all() -> impl Iterator<Item = (Status, bool)> {
        [Status::Resin, Status::Primary, Status::Secondary].into_iter().flat_map(|pin| [(pin, false), (pin, true)])
    }

    /// Index into a table of [`StatusPair::COUNT`] entries.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// Table of one coefficient by [`StatusPair::index`] and row.
pub type Table = [Vec<f64>; StatusPair::COUNT];

/// The coefficients of every pair in every row.
///
/// Whatever the integrator, the loss of a pair in contact is proportional to its overlap u; so the integrator shapes
/// these tables and nothing else.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    /// Stiffness k A, N/m, with k = E*/h.
    pub stiffness: Table,
    /// Raw loss of the pin cell per overlap, 1; 0 for resin, which loses the wear height instead.
    pub pin: Table,
    /// Raw loss of the disc cell per overlap, 1.
    pub disc: Table,
    /// Raw loss of the fibre below the pin cell's build-up over that of the build-up, Δh_sub/Δh, 1.
    pub fibre: Table,
    /// Raw loss of the coating below the disc cell's build-up over that of the build-up, Δh_sub/Δh, 1.
    pub coating: Table,
}

impl Coefficients {
    /// Tabulates the coefficients.
    pub fn new(parameters: &Parameters) -> Self {
        let Parameters { mesh, materials, integrator, .. } = parameters;
        let table = || std::array::from_fn(|_| vec![0.0; mesh.rows()]);
        let mut tables = Self { stiffness: table(), pin: table(), disc: table(), fibre: table(), coating: table() };
        for (pin, disc_secondary) in StatusPair::all() {
            let pair = StatusPair::new(pin, disc_secondary).index();
            let stiffness = materials.combined_modulus(pin, disc_secondary) / parameters.foundation_height;
            let wear_rate_pin = materials.pin_wear_rate(pin, disc_secondary);
            let wear_rate_disc = materials.disc(disc_secondary).specific_wear_rate;
            for (row, (radius, area)) in mesh.radius().iter().zip(mesh.area()).enumerate() {
                let sliding = parameters.time_acceleration * radius * mesh.column_angle();
                let factor = |own: f64, other: f64| wear_factor(*integrator, own, other, stiffness * sliding);
                let below = |substrate: f64, own: f64, other: f64| {
                    if own == 0.0 { 0.0 } else { factor(substrate, other) / factor(own, other) }
                };
                tables.stiffness[pair][row] = stiffness * area;
                tables.pin[pair][row] = factor(wear_rate_pin, wear_rate_disc);
                tables.disc[pair][row] = factor(wear_rate_disc, wear_rate_pin);
                let fibre = materials.pin_wear_rate(Status::Primary, disc_secondary);
                tables.fibre[pair][row] = below(fibre, wear_rate_pin, wear_rate_disc);
                tables.coating[pair][row] =
                    below(materials.disc_primary.specific_wear_rate, wear_rate_disc, wear_rate_pin);
            }
        }
        tables
    }

    /// Largest loss of pin and disc per overlap that any pair can have, 1: that of what is there, or of what lies below.
    pub fn largest_losses(&self) -> [f64; 2] {
        let largest = |own: &Table, below: &Table| {
            let pairs = own.iter().flatten().zip(below.iter().flatten());
            pairs.map(|(own, below)| most(own, below)).fold(0.0, f64::max)
        };
        [largest(&self.pin, &self.fibre), largest(&self.disc, &self.coating)]
    }

    /// Largest loss of pin and disc together per overlap, 1.
    pub fn largest_loss(&self) -> f64 {
        self.largest_losses().into_iter().sum()
    }

    /// Largest loss of pin and disc together that each kind of pairs can have.
    pub fn pair_losses(&self) -> [PairLoss; StatusPair::COUNT] {
        std::array::from_fn(|pair| {
            let pin = self.pin[pair].iter().zip(&self.fibre[pair]);
            let disc = self.disc[pair].iter().zip(&self.coating[pair]);
            let rows = pin.zip(disc).zip(&self.stiffness[pair]);
            rows.fold(PairLoss::default(), |largest, ((pin, disc), stiffness)| {
                let loss = most(pin.0, pin.1) + most(disc.0, disc.1);
                // Resin without stiffness loses nothing.
                let per_load = if loss > 0.0 { loss / stiffness } else { 0.0 };
                PairLoss { per_overlap: largest.per_overlap.max(loss), per_load: largest.per_load.max(per_load) }
            })
        })
    }

    /// Stiffness k A of the softest pair with a plateau of the pin, N/m.
    pub fn least_plateau_stiffness(&self) -> f64 {
        let plateaus = StatusPair::all().filter(|(pin, _)| *pin != Status::Resin);
        let rows = plateaus.flat_map(|(pin, disc)| &self.stiffness[StatusPair::new(pin, disc).index()]);
        rows.copied().fold(f64::INFINITY, f64::min)
    }
}

/// Larger loss per overlap of what is there (`own`) and of what lies below it (`own` times `below`), 1.
fn most(own: &f64, below: &f64) -> f64 {
    own * below.max(1.0)
}

/// Largest loss of pin and disc together of one kind of pairs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairLoss {
    /// Loss per overlap, 1.
    pub per_overlap: f64,
    /// Loss per load of the cell, m/N.
    pub per_load: f64,
}

/// Loss per overlap, 1, of a cell with wear rate `own` (1/Pa) against one with `other`; `stiffness_sliding` is k ds, Pa.
fn wear_factor(integrator: Integrator, own: f64, other: f64, stiffness_sliding: f64) -> f64 {
    match integrator {
        Integrator::Explicit => own * stiffness_sliding,
        Integrator::Exponential if own == 0.0 => 0.0,
        Integrator::Exponential => -libm::expm1(-(own + other) * stiffness_sliding) * (own / (own + other)),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/engine/coefficients.rs"]
mod tests;
