//! Heat of friction (model 11), and friction and emission with it (10, 12): closed forms, energy, extremes.
//!
//! | what | where |
//! |---|---|
//! | the chain against slabs, lumps and circuits | [`chain`] |
//! | very many sub-steps at once, and long pauses | [`long`] |
//! | energy over very many intervals | [`energy`] |
//! | the contact temperature map, and passing under the pin at extremes | [`passing`] |
//! | intervals, pauses, samples: what is reported when | [`accounts`], [`expected`] |
//! | conductivities, coatings, speeds, loads and pauses at extremes | [`extremes`] |
//! | friction and emission of flat surfaces, and of all that one density wears | [`flat`] |
//! | a whole simulation: workers, samples, restarts | [`simulation`] |

mod accounts;
mod chain;
mod energy;
mod expected;
mod extremes;
mod flat;
mod long;
mod passing;
mod simulation;

use plateau_core::model::thermal::{Coating, Disc, Factor, Pin, Substance, Thermal};

/// Grey cast iron, of the table in model 12.
pub const IRON: Substance = Substance { conductivity: 50.0, density: 7200.0, specific_heat: 500.0 };
/// A WC cermet, of the same table.
pub const CERMET: Substance = Substance { conductivity: 15.0, density: 13500.0, specific_heat: 250.0 };
/// A low-metallic pad, of the same table.
pub const PAD: Substance = Substance { conductivity: 1.5, density: 2600.0, specific_heat: 900.0 };

/// The scene values of model 12, without feedback.
pub fn thermal() -> Thermal {
    Thermal {
        ambient: 296.15,
        disc: Disc {
            substance: IRON,
            area: 31e-4,
            thickness: 6e-3,
            cooling: 0.4,
            cooling_per_speed: 0.0,
            coating: Some(Coating { thickness: 60e-6, substance: CERMET }),
        },
        pin: Pin { substance: PAD, area: 78.5e-6, length: 12e-3, cooling: 0.02 },
        wear_rate_factor: Factor::default(),
        friction_factor: Factor::default(),
    }
}

/// A pin that conducts nothing, so that all heat goes into the disc.
pub fn insulating_pin() -> Pin {
    Pin { substance: Substance { conductivity: 1e-15, ..PAD }, cooling: 0.0, ..thermal().pin }
}

/// The relative deviation of two numbers.
pub fn off(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}
