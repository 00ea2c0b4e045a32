//! Airborne emission: what of the debris that leaves the contact is mass and number in the air (model 12).

use serde::{Deserialize, Serialize};

use crate::model::sums::RunningSum;
use crate::model::thermal::Factor;
use crate::model::totals::Volumes;

/// Parameters of airborne emission (model 12).
#[derive(Debug, Clone, PartialEq)]
pub struct Emission {
    /// φ₁₀, 1: PM10 as a fraction of the emitted mass.
    pub pm10_fraction: f64,
    /// φ₂.₅, 1: PM2.5 as a fraction of the emitted mass.
    pub pm25_fraction: f64,
    /// n₁₀, 1/kg: particles for each mass of PM10.
    pub number_per_mass: f64,
    /// ρ_p, kg/m³, of plateaus and resin.
    pub pin_density: f64,
    /// ρ_d, kg/m³.
    pub disc_density: f64,
    /// f_N, where temperature is reckoned.
    pub number_factor: Factor,
}

impl Emission {
    /// Δm_e, kg: the emitted volume of a step at the mean density of what wore in it.
    pub fn mass(&self, moved: &Volumes) -> f64 {
        let of_pin = moved.worn_pin + moved.worn_resin;
        let worn = of_pin + moved.worn_disc;
        if worn == 0.0 {
            return 0.0;
        }
        moved.emitted * ((self.pin_density * of_pin + self.disc_density * moved.worn_disc) / worn)
    }
}

/// Mass and particles emitted in the steps so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EmissionAccount {
    /// Σ Δm_e, kg.
    mass: RunningSum,
    /// Mass whose particles are not counted yet, kg: with temperatures they are counted interval by interval.
    open: f64,
    number: RunningSum,
}

/// Emission since t = 0 as it is reported.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EmissionReport {
    /// m_e, kg.
    pub mass: f64,
    /// φ₁₀ m_e, kg.
    pub pm10: f64,
    /// φ₂.₅ m_e, kg.
    pub pm25: f64,
    /// N: number of airborne particles.
    pub number: f64,
}

impl EmissionAccount {
    /// Adds the mass (kg) of a step.
    pub fn record(&mut self, mass: f64) {
        self.mass.add(mass);
        self.open += mass;
    }

    /// Counts the particles of what was added since the last count, at a contact temperature (K) if there is one.
    pub fn count(&mut self, emission: &Emission, temperature: Option<f64>) {
        let factor = temperature.map_or(1.0, |temperature| emission.number_factor.at(temperature));
        let pm10 = emission.pm10_fraction * std::mem::take(&mut self.open);
        self.number.add(emission.number_per_mass * pm10 * factor);
    }

    /// Reports the emission up to the last step.
    pub fn report(&self, emission: &Emission) -> EmissionReport {
        let mass = self.mass.amount();
        EmissionReport {
            mass,
            pm10: emission.pm10_fraction * mass,
            pm25: emission.pm25_fraction * mass,
            number: self.number.amount(),
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/emission.rs"]
mod tests;
