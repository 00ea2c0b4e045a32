//! Coefficients of a pair of cells by status and row: stiffness (model 4.1) and wear per overlap (model 4.2).

use crate::material::{Materials, Status};
use crate::parameters::{Integrator, Parameters};

/// The statuses of a pin cell and the disc cell under it, as an index into the tables of [`Pairs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair(u8);

impl Pair {
    /// Number of different pairs: three statuses of the pin times two of the disc.
    pub const COUNT: usize = 6;

    /// The pair of these two statuses.
    pub fn new(pin: Status, disc_secondary: bool) -> Self {
        Self(2 * pin as u8 + u8::from(disc_secondary))
    }

    /// Every pair with its statuses.
    pub fn all() -> impl Iterator<Item = (Status, bool)> {
        [Status::None, Status::Primary, Status::Secondary].into_iter().flat_map(|pin| [(pin, false), (pin, true)])
    }

    /// Whether the pin cell of this pair is a plateau.
    pub fn pin_is_plateau(self) -> bool {
        self.0 >= 2
    }

    /// Index into a table of [`Pair::COUNT`] entries.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// Heights lost in one step per overlap u, dimensionless: the raw loss of a cell is its factor times u.
///
/// Whatever the integrator, the loss of a pair in contact is proportional to its overlap; so the integrator shapes this
/// table and nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WearFactors {
    /// Of the pin cell by its own κ; 0 for resin, which loses the wear height instead.
    pub pin: f64,
    /// Of the fibre below the pin's build-up, by the κ of pin primary.
    pub fibre: f64,
    /// Of the disc cell by its own κ.
    pub disc: f64,
    /// Of the coating below the disc's build-up, by the κ of disc primary.
    pub coating: f64,
}

/// The coefficients of every pair.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairs {
    /// k = E*/h by pair, Pa/m.
    stiffness: [f64; Pair::COUNT],
    /// By row, then by pair.
    wear: Vec<[WearFactors; Pair::COUNT]>,
}

impl Pairs {
    /// Tabulates the coefficients.
    pub fn new(parameters: &Parameters) -> Self {
        let mut stiffness = [0.0; Pair::COUNT];
        for (pin, disc_secondary) in Pair::all() {
            stiffness[Pair::new(pin, disc_secondary).index()] =
                parameters.materials.combined_modulus(pin, disc_secondary) / parameters.foundation_height;
        }
        let turn = parameters.time_acceleration * parameters.mesh.column_angle();
        let wear =
            parameters.mesh.radius().iter().map(|radius| wear_of_row(parameters, &stiffness, turn * radius)).collect();
        Self { stiffness, wear }
    }

    /// k, Pa/m.
    pub fn stiffness(&self, pair: Pair) -> f64 {
        self.stiffness[pair.index()]
    }

    /// k of every pair, by [`Pair::index`].
    pub fn stiffnesses(&self) -> &[f64; Pair::COUNT] {
        &self.stiffness
    }

    /// Wear factors of every pair in a row.
    pub fn wear(&self, row: usize) -> &[WearFactors; Pair::COUNT] {
        &self.wear[row]
    }
}

/// Wear factors of a row whose sliding distance in the step is `sliding` = m r_i Δθ, m.
fn wear_of_row(parameters: &Parameters, stiffness: &[f64; Pair::COUNT], sliding: f64) -> [WearFactors; Pair::COUNT] {
    let materials = &parameters.materials;
    let mut row = [WearFactors::default(); Pair::COUNT];
    for (pin, disc_secondary) in Pair::all() {
        let pair = Pair::new(pin, disc_secondary).index();
        let wear_rate_pin = pin_wear_rate(materials, pin);
        let wear_rate_disc = materials.disc(disc_secondary).specific_wear_rate;
        let factor = |own: f64, other: f64| wear_factor(parameters.integrator, own, other, stiffness[pair] * sliding);
        row[pair] = WearFactors {
            pin: factor(wear_rate_pin, wear_rate_disc),
            fibre: factor(materials.pin_primary.specific_wear_rate, wear_rate_disc),
            disc: factor(wear_rate_disc, wear_rate_pin),
            coating: factor(materials.disc_primary.specific_wear_rate, wear_rate_pin),
        };
    }
    row
}

/// κ of a pin cell; 0 for resin, which does not wear by Archard's law.
fn pin_wear_rate(materials: &Materials, status: Status) -> f64 {
    match status {
        Status::None => 0.0,
        plateau => materials.pin(plateau).specific_wear_rate,
    }
}

/// Loss per overlap of a cell with wear rate `own` (1/Pa) against one with `other`; `stiffness_sliding` is k ds, Pa.
fn wear_factor(integrator: Integrator, own: f64, other: f64, stiffness_sliding: f64) -> f64 {
    match integrator {
        Integrator::Explicit => own * stiffness_sliding,
        Integrator::Exponential if own == 0.0 => 0.0,
        Integrator::Exponential => -libm::expm1(-(own + other) * stiffness_sliding) * (own / (own + other)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_rule_wears_less_by_the_known_factor() {
        // Closed form (model section 8): (1 − e^(−Π))/Π per cell.
        for number in [1e-8, 1e-3, 1.0, 50.0] {
            let ratio = wear_factor(Integrator::Exponential, number, 0.0, 1.0)
                / wear_factor(Integrator::Explicit, number, 0.0, 1.0);
            let expected = -libm::expm1(-number) / number;
            assert!((ratio / expected - 1.0).abs() < 1e-15, "Π = {number}");
        }
    }

    #[test]
    fn the_exponential_rule_never_takes_more_than_the_overlap() {
        let pin = wear_factor(Integrator::Exponential, 3e-3, 1e-3, 1e6);
        let disc = wear_factor(Integrator::Exponential, 1e-3, 3e-3, 1e6);
        assert_eq!(pin + disc, 1.0);
        assert!((pin / disc - 3.0).abs() < 1e-15);
    }
}
