//! Input that is legal but cannot be meant: a wrong unit, a slip of the pen.
//!
//! | known | rules |
//! |---|---|
//! | from the scene alone | [`of_scene`] |
//! | with its surfaces | [`of_surfaces`] |
//! | from what a run recorded | [`Recorded`] |
//!
//! Each is a list of rules. A rule belongs to the key that is most likely wrong; it looks, and tells what it found, the
//! bound and what to do. `docs/scenes.md` lists them all.

mod dissipation;
mod recorded;
mod scene;
mod surfaces;
mod words;

pub use recorded::Recorded;
pub use scene::of_scene;
pub use surfaces::of_surfaces;

use plateau_core::model::material::Materials;

use crate::scene::Scene;
use crate::scene::{Origin, Warning};

/// The part of the modulus of a plateau that the mean pressure cannot reach in earnest: beyond it nothing is elastic, and
/// the overlap is a tenth of the foundation.
const LARGEST_STRAIN: f64 = 0.1;

/// What is looked at, and the key that is named when it cannot be meant.
struct Rule<Subject> {
    key: &'static str,
    look: fn(&Subject) -> Option<Finding>,
}

/// What a rule has to say.
struct Finding {
    /// What was found, with its number.
    found: String,
    /// The bound that it misses, with its number.
    bound: String,
    /// What to do.
    advice: &'static str,
}

/// What the rules find, for keys that the scene gives and that no warning has named yet.
///
/// Where a key has its default, the key that this follows from is named.
fn apply<Subject>(rules: &[Rule<Subject>], subject: &Subject, scene: &Scene) -> Vec<Warning> {
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
fn softest_plateau(materials: &Materials) -> f64 {
    let Materials { disc_primary, disc_secondary, pin_primary, pin_secondary, .. } = materials;
    let plateaus = [disc_primary, disc_secondary, pin_primary, pin_secondary];
    plateaus.map(|plateau| plateau.youngs_modulus).into_iter().fold(f64::INFINITY, f64::min)
}

/// Says that a mean pressure is more than the plateaus bear; `what` is the pressure in words.
fn too_much_pressure(pressure: f64, modulus: f64, what: &str) -> Option<Finding> {
    (pressure > LARGEST_STRAIN * modulus).then(|| Finding {
        found: format!("{what} {}", words::pressure(pressure)),
        bound: format!("more than a tenth of the softest plateau's modulus of {}", words::pressure(modulus)),
        advice: "check the force, the size of the pin in [mesh] and the moduli in [materials]",
    })
}

/// Says that an overlap is more than the foundation is high; `what` is the overlap in words.
fn too_much_overlap(overlap: f64, foundation_height: f64, what: &str) -> Option<Finding> {
    use plateau_core::surface::Length;
    (overlap > foundation_height).then(|| Finding {
        found: format!("{what} {}", Length(overlap)),
        bound: format!("more than the foundation's height of {}", Length(foundation_height)),
        advice: "check the foundation's height, the force and the moduli in [materials]",
    })
}
