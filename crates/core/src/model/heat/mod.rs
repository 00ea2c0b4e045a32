//! Heat of friction: one chain from the pin's holder to the air, and the temperature of the contact (model 11).
//!
//! | model 11 | file |
//! |---|---|
//! | one chain | `chain.rs` |
//! | its sub-steps, and very many of them at once | `sub_step.rs`, `repeated.rs` |
//! | passing under the pin | `passing.rs`, `reflections.rs` |
//! | order: intervals, pauses, what holds for the next interval | `account.rs` |
//! | feedback | `factor.rs` |
//! | contact temperature map | `map.rs` |

pub mod account;
pub mod chain;
pub mod factor;
pub mod map;
pub mod passing;
mod reflections;
mod repeated;
mod sub_step;

use self::factor::Factor;

/// What conducts heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substance {
    /// λ, W/(m K).
    pub conductivity: f64,
    /// ρ, kg/m³.
    pub density: f64,
    /// c, J/(kg K).
    pub specific_heat: f64,
}

impl Substance {
    /// b = √(λ ρ c), W √s/(m² K).
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.density * self.specific_heat).sqrt()
    }

    /// a = λ/(ρ c), m²/s.
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.specific_heat)
    }
}

/// A layer on the disc that shows while a cell passes under the pin; the chain leaves it out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coating {
    /// d, m; 0 is none.
    pub thickness: f64,
    /// What it is of.
    pub substance: Substance,
}

/// The disc as heat sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Below the coating.
    pub substance: Substance,
    /// A_d, m².
    pub area: f64,
    /// m.
    pub thickness: f64,
    /// H₀, W/K.
    pub cooling: f64,
    /// H₁, J/(K rad).
    pub cooling_per_speed: f64,
    /// If it has one.
    pub coating: Option<Coating>,
}

/// The pin as heat sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    /// All of it.
    pub substance: Substance,
    /// A_p, m².
    pub area: f64,
    /// m.
    pub length: f64,
    /// H_p, W/K.
    pub cooling: f64,
}

/// Where the heat of friction goes, and what temperature changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermal {
    /// K.
    pub ambient: f64,
    /// The disc.
    pub disc: Disc,
    /// The pin.
    pub pin: Pin,
    /// f_κ of the pin's plateaus.
    pub wear_rate_factor: Factor,
    /// f_μ.
    pub friction_factor: Factor,
}
