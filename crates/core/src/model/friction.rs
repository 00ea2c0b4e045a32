//! Friction of what touches (model 10; Briscoe and Tabor's shear of a thin film).

use serde::{Deserialize, Serialize};

use crate::model::material::Status;
use crate::model::sums::{Revolution, RunningSum};

/// The stress that resists sliding, τ = τ₀ + α p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionLaw {
    /// α, 1.
    pub pressure_coefficient: f64,
    /// τ₀, Pa.
    pub shear_strength: f64,
}

/// Friction of each status of the pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Law of fibres.
    pub primary: FrictionLaw,
    /// Law of compacted debris.
    pub secondary: FrictionLaw,
    /// Law of bare resin.
    pub resin: FrictionLaw,
    /// μ_max; infinite where there is no ceiling.
    pub maximum: f64,
}

/// Contact of the cells of one status.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct StatusContact {
    /// A_s, m².
    pub area: f64,
    /// N_s, N.
    pub load: f64,
}

/// Sums over the contact of a step that friction needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSums {
    /// F̄, N.
    pub load: f64,
    /// A_c, m².
    pub area: f64,
    /// Sums by [`Status`] of the pin; none where one law holds for all.
    pub statuses: Option<[StatusContact; 3]>,
}

impl Friction {
    /// Friction with the same law for every status.
    pub fn of(law: FrictionLaw, maximum: f64) -> Self {
        Self { primary: law, secondary: law, resin: law, maximum }
    }

    /// Tells whether the law depends on the status, so that the sums of each are needed.
    pub fn depends_on_status(&self) -> bool {
        self.secondary != self.primary || self.resin != self.primary
    }

    fn law(&self, status: Status) -> &FrictionLaw {
        match status {
            Status::Resin => &self.resin,
            Status::Primary => &self.primary,
            Status::Secondary => &self.secondary,
        }
    }

    /// μ = min(Σ_s (α_s N_s + τ₀_s A_s)/F̄, μ_max), at the temperature at which the law holds.
    pub fn coefficient(&self, contact: &ContactSums) -> f64 {
        let coefficient = match &contact.statuses {
            None => self.primary.pressure_coefficient + self.primary.shear_strength * contact.area / contact.load,
            Some(statuses) => {
                let resistance = [Status::Resin, Status::Primary, Status::Secondary].map(|status| {
                    let (law, StatusContact { area, load }) = (self.law(status), statuses[status as usize]);
                    law.pressure_coefficient * load + law.shear_strength * area
                });
                resistance.into_iter().sum::<f64>() / contact.load
            }
        };
        coefficient.min(self.maximum)
    }
}

/// Friction of the steps so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrictionAccount {
    /// μ of the last step; none before the first.
    coefficient: Option<f64>,
    /// Σ μ F̄ r̄ m Δθ, J.
    work: RunningSum,
    /// Σ F̄ r̄ m Δθ, J: what the work would be with μ = 1.
    load_work: RunningSum,
    /// μ F̄ of the steps of the last revolution, N.
    forces: Revolution,
    /// F̄ of the same steps, N.
    loads: Revolution,
}

/// Friction as it is reported.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrictionReport {
    /// μ of the step; no number before the first.
    pub coefficient: f64,
    /// Σ μ F̄/Σ F̄ over the last revolution; no number before the first step.
    pub coefficient_mean: f64,
    /// Work of friction since t = 0, J.
    pub work: f64,
    /// Load times sliding distance since t = 0, J: the work would be that with μ = 1.
    pub load_work: f64,
}

impl FrictionAccount {
    /// Account before the first step; a revolution has so many steps.
    pub fn new(steps_per_revolution: usize) -> Self {
        let revolution = || Revolution::new(steps_per_revolution);
        let (work, load_work) = (RunningSum::default(), RunningSum::default());
        Self { coefficient: None, work, load_work, forces: revolution(), loads: revolution() }
    }

    /// μ of the last step; none before the first.
    pub fn coefficient(&self) -> Option<f64> {
        self.coefficient
    }

    /// Adds a step with this μ and F̄ (N) over a distance (m) at the mean radius; returns its work, J.
    pub fn record(&mut self, coefficient: f64, load: f64, distance: f64) -> f64 {
        let work = coefficient * load * distance;
        self.coefficient = Some(coefficient);
        self.work.add(work);
        self.load_work.add(load * distance);
        self.forces.record(coefficient * load);
        self.loads.record(load);
        work
    }

    /// Reports friction up to the last step.
    pub fn report(&self) -> FrictionReport {
        FrictionReport {
            coefficient: self.coefficient.unwrap_or(f64::NAN),
            coefficient_mean: self.forces.sum() / self.loads.sum(),
            work: self.work.value(),
            load_work: self.load_work.value(),
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/friction.rs"]
mod tests;
