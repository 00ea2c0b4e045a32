//! What is reported at the end of a step.

use serde::{Deserialize, Serialize};

use crate::model::accounts::AccountsReport;

/// The reported quantities at the end of one step, in SI units.
///
/// Displacement, contact area and pressures are those of that step's load balance, everything else is the state after
/// the step.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sample {
    /// Steps done.
    pub step: u64,
    /// t, s.
    pub time: f64,
    /// δ, m: displacement of the rigid pin.
    pub displacement: f64,
    /// Σ A over cells in contact, m².
    pub contact_area: f64,
    /// Mean of the contact area over the last simulated revolution, m²; over all steps so far before the first is done.
    pub contact_area_mean: f64,
    /// Σ contact area · m Δt since t = 0, m² s.
    pub contact_area_integral: f64,
    /// Distance slid at the mean radius in the physical time, m.
    pub sliding_distance: f64,
    /// Contact area over the area of the pin.
    pub contact_ratio: f64,
    /// Σ p A / Σ A over cells in contact, Pa.
    pub mean_pressure: f64,
    /// Largest pressure of any cell, Pa.
    pub max_pressure: f64,
    /// Volume worn off plateaus of the pin, m³, cumulative.
    pub worn_pin: f64,
    /// Volume worn off resin, m³, cumulative.
    pub worn_resin: f64,
    /// Volume worn off the disc, m³, cumulative.
    pub worn_disc: f64,
    /// M, m³: debris in the contact that is not compacted (the sum over tracks where each has its own pool).
    pub pool: f64,
    /// Debris that left the contact, m³, cumulative.
    pub emitted: f64,
    /// Debris compacted on the pin, m³, cumulative.
    pub deposited_pin: f64,
    /// Debris compacted on the disc, m³, cumulative.
    pub deposited_disc: f64,
    /// Build-up of the pin that lost its support or broke away, m³, cumulative.
    pub returned: f64,
    /// Area fraction of the pin that is primary plateau.
    pub pin_primary: f64,
    /// Area fraction of the pin that is secondary plateau.
    pub pin_secondary: f64,
    /// Area fraction of the pin that is no plateau.
    pub pin_none: f64,
    /// Area fraction of the whole ring that is secondary plateau.
    pub disc_secondary: f64,
    /// 1 − V(t)/V(0), V = Σ A (z_ref − z_d)₊ with z_ref the highest initial disc height.
    pub filled_fraction: f64,
    /// |Σ k A u − F_N| / F_N.
    pub load_residual: f64,
    /// (worn + returned − deposited − emitted − pool) / worn; 0 if nothing is worn.
    pub balance_residual: f64,
    /// Of friction, heat and emission, where the scene asks for them.
    pub accounts: AccountsReport,
    /// Quantities that not every run has, by their names; none in a checkpoint.
    #[serde(skip)]
    pub extras: Vec<(&'static str, f64)>,
}

impl Sample {
    /// Volume worn off the whole pin, plateaus and resin, m³, cumulative.
    pub fn worn_whole_pin(&self) -> f64 {
        self.worn_pin + self.worn_resin
    }

    /// Volume that the whole pin has lost, m³: what a balance tells. Build-up is weighed with the pin, and wears as plateaus do, so
    /// that what was deposited and worn off again was not lost by the pin.
    pub fn lost_pin(&self) -> f64 {
        self.worn_whole_pin() + self.returned - self.deposited_pin
    }
}
