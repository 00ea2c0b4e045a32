//! Parameters of heat: substances, coating, disc and pin; and factors that depend on the temperature of the contact (model 11, feedback).

use thiserror::Error;

/// Thermal properties of a substance.
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
    /// Substance of the coating.
    pub substance: Substance,
}

/// The disc as heat sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Substance below the coating.
    pub substance: Substance,
    /// A_d, m².
    pub area: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// H₀, W/K.
    pub cooling: f64,
    /// H₁, J/(K rad).
    pub cooling_per_speed: f64,
    /// Coating, if the disc has one.
    pub coating: Option<Coating>,
}

/// The pin as heat sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    /// Substance of the whole pin.
    pub substance: Substance,
    /// A_p, m².
    pub area: f64,
    /// Length, m.
    pub length: f64,
    /// H_p, W/K.
    pub cooling: f64,
}

/// Bodies that the heat of friction goes into, and factors that depend on temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermal {
    /// Ambient temperature, K.
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

/// A factor over temperature: straight lines between points, constant beyond them, 1 without any.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Factor {
    /// Temperature, K, increasing, and factor.
    points: Vec<(f64, f64)>,
}

/// Error in the points of a factor. They are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum FactorError {
    #[error("a temperature of {temperature} K after {before} K: temperatures must rise from point to point")]
    Order { point: usize, temperature: f64, before: f64 },
    #[error("a factor of {factor}, expected 0 or more")]
    Value { point: usize, factor: f64 },
}

impl Factor {
    /// Factor with straight lines between points of temperature (K) and factor.
    ///
    /// # Errors
    /// [`FactorError`] when temperatures do not rise or a factor is negative.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, FactorError> {
        for (point, (temperature, factor)) in points.iter().copied().enumerate() {
            if !(factor >= 0.0 && factor.is_finite()) {
                return Err(FactorError::Value { point, factor });
            }
            let before = if point == 0 { f64::NEG_INFINITY } else { points[point - 1].0 };
            if !(temperature > before && temperature.is_finite()) {
                return Err(FactorError::Order { point, temperature, before });
            }
        }
        Ok(Self { points })
    }

    /// Points of the factor: temperature, K, increasing, and factor.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Tells whether the factor is 1 at every temperature.
    pub fn is_one(&self) -> bool {
        self.points.iter().all(|(_, factor)| *factor == 1.0)
    }

    /// The largest factor at any temperature; none if it is 1 at all.
    pub fn largest(&self) -> Option<f64> {
        self.points.iter().map(|(_, factor)| *factor).reduce(f64::max).filter(|_| !self.is_one())
    }

    /// The factor at a temperature, K.
    pub fn at(&self, temperature: f64) -> f64 {
        let above = self.points.partition_point(|(point, _)| *point <= temperature);
        match (above.checked_sub(1).map(|below| self.points[below]), self.points.get(above)) {
            (None, None) => 1.0,
            (None, Some((_, first))) => *first,
            (Some((_, last)), None) => last,
            (Some((low, one)), Some((high, other))) => one + (other - one) * ((temperature - low) / (high - low)),
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/thermal.rs"]
mod tests;
