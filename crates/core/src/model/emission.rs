//! Airborne emission: what of the debris that leaves the contact is mass and number in the air (model 12).

use serde::{Deserialize, Serialize};

use crate::model::heat::thermal::Factor;
use crate::model::sums::RunningSum;
use crate::model::totals::Volumes;

/// How much of the emitted debris is airborne, and as how many particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Emission {
    /// φ₁₀.
    pub pm10_fraction: f64,
    /// φ₂.₅.
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

/// What was emitted in the steps so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EmissionAccount {
    /// Σ Δm_e, kg.
    mass: RunningSum,
    /// Of which the particles are not counted yet, kg: with temperatures they are, interval by interval.
    open: f64,
    number: RunningSum,
}

/// What is reported of emission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EmissionReport {
    /// m_e, kg.
    pub mass: f64,
    /// φ₁₀ m_e, kg.
    pub pm10: f64,
    /// φ₂.₅ m_e, kg.
    pub pm25: f64,
    /// N.
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

    /// What is reported after the last step.
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
mod tests {
    use super::*;

    fn emission() -> Emission {
        Emission {
            pm10_fraction: 0.4,
            pm25_fraction: 0.15,
            number_per_mass: 1e15,
            pin_density: 2600.0,
            disc_density: 7200.0,
            number_factor: Factor::new(vec![(443.15, 1.0), (463.15, 100.0)]).unwrap(),
        }
    }

    #[test]
    fn what_leaves_has_the_mean_density_of_what_wore() {
        let moved =
            Volumes { worn_pin: 2e-15, worn_resin: 1e-15, worn_disc: 1e-15, emitted: 2e-15, ..Volumes::default() };
        // Three parts of 2600 and one of 7200 kg/m³ are 3750 kg/m³ in the mean.
        assert!((emission().mass(&moved) / (2e-15 * 3750.0) - 1.0).abs() < 1e-15);
        assert_eq!(emission().mass(&Volumes::default()), 0.0);
    }

    #[test]
    fn particles_are_counted_at_the_temperature_of_their_interval() {
        let (emission, mut account) = (emission(), EmissionAccount::default());
        account.record(1e-9);
        account.record(2e-9);
        assert_eq!(account.report(&emission).number, 0.0);
        account.count(&emission, Some(300.0));
        assert!((account.report(&emission).number / 1.2e6 - 1.0).abs() < 1e-15);
        account.record(1e-9);
        account.count(&emission, Some(453.15));
        // Half-way between 1 and 100.
        let EmissionReport { mass, pm10, pm25, number } = account.report(&emission);
        assert!((number / (1.2e6 + 0.4e6 * 50.5) - 1.0).abs() < 1e-12);
        assert!((mass - 4e-9).abs() < 1e-24 && (pm10 - 1.6e-9).abs() < 1e-24 && (pm25 - 6e-10).abs() < 1e-24);
    }
}
