//! A rule of what can hardly be meant, its finding, and how findings of several rules become warnings.

use plateau_core::model::material::Materials;
use plateau_core::surface::Length;

use crate::scene::{Origin, Scene, Warning};

/// The part of the modulus of a plateau that the mean pressure cannot reach in earnest: beyond it nothing is elastic, and
/// the overlap is a tenth of the foundation.
const LARGEST_STRAIN: f64 = 0.1;

/// Look at a subject, and the key that is named when it cannot be meant.
pub struct Rule<Subject> {
    pub key: &'static str,
    pub look: fn(&Subject) -> Option<Finding>,
}

/// Finding of a rule.
pub struct Finding {
    /// The value found, in words, with its number.
    pub found: String,
    /// The bound that it misses, with its number.
    pub bound: String,
    /// Advice.
    pub advice: &'static str,
}

/// Warnings of the rules, for keys that the scene gives and that no warning has named yet.
///
/// Where a key has its default, the key that this follows from is named.
pub fn apply<Subject>(rules: &[Rule<Subject>], subject: &Subject, scene: &Scene) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = Vec::new();
    for Rule { key, look } in rules {
        let place = scene.places.get(*key).filter(|place| **place != Origin::Default);
        let named = scene.warnings.iter().chain(&warnings).any(|warning| warning.key == *key);
        let (Some(place), false) = (place, named) else { continue };
        if let Some(Finding { found, bound, advice }) = look(subject) {
            let (place, key, advice) = (place.clone(), (*key).to_owned(), advice.to_owned());
            warnings.push(Warning { place, key, found, bound, advice });
        }
    }
    warnings
}

/// Young's modulus of the softest plateau, Pa.
pub fn softest_plateau(materials: &Materials) -> f64 {
    let Materials { disc_primary, disc_secondary, pin_primary, pin_secondary, .. } = materials;
    let plateaus = [disc_primary, disc_secondary, pin_primary, pin_secondary];
    plateaus.map(|plateau| plateau.youngs_modulus).into_iter().fold(f64::INFINITY, f64::min)
}

/// Says that a mean pressure is more than the plateaus bear; `what` is the pressure in words.
pub fn too_much_pressure(pressure: f64, modulus: f64, what: &str) -> Option<Finding> {
    (pressure > LARGEST_STRAIN * modulus).then(|| Finding {
        found: format!("{what} {}", pressure_in_words(pressure)),
        bound: format!("more than a tenth of the softest plateau's modulus of {}", pressure_in_words(modulus)),
        advice: "check the force, the size of the pin in [mesh] and the moduli in [materials]",
    })
}

/// Says that an overlap is more than the foundation is high; `what` is the overlap in words.
pub fn too_much_overlap(overlap: f64, foundation_height: f64, what: &str) -> Option<Finding> {
    (overlap > foundation_height).then(|| Finding {
        found: format!("{what} {}", Length(overlap)),
        bound: format!("more than the foundation's height of {}", Length(foundation_height)),
        advice: "check the foundation's height, the force and the moduli in [materials]",
    })
}

/// Four significant digits, without the zeros that would pretend more.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    // As it is rounded: 9.9996 is 10.
    let scientific = format!("{value:.3e}");
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        format!("{digits}e{exponent}")
    }
}

/// A pressure in the unit that suits it, Pa to GPa.
pub fn pressure_in_words(value: f64) -> String {
    let units = [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")];
    let (pascals, unit) = units.into_iter().find(|(pascals, _)| value >= *pascals).unwrap_or((1.0, "Pa"));
    format!("{} {unit}", number(value / pascals))
}

#[cfg(test)]
#[path = "../../tests/unit/plausibility/rule.rs"]
mod tests;
