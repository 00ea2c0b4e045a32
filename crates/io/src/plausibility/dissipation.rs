//! What friction, heat and emission say by themselves.

use std::ops::RangeInclusive;

use plateau_core::model::heat::{Substance, Thermal};
use plateau_core::surface::Length;

use super::words::{number, pressure};
use super::{Finding, Rule, apply};
use crate::scene::Scene;
use crate::scene::Warning;

/// Where brakes are used, K.
const AMBIENT: RangeInclusive<f64> = 200.0..=400.0;
/// From air to diamond, W/(m K).
const CONDUCTIVITY: RangeInclusive<f64> = 0.02..=2500.0;
/// From foam to osmium, kg/m³.
const DENSITY: RangeInclusive<f64> = 10.0..=23_000.0;
/// From gold to water, J/(kg K).
const SPECIFIC_HEAT: RangeInclusive<f64> = 100.0..=4200.0;
/// No film that shears is stronger than what it lies on, Pa.
const STRONGEST: f64 = 1e9;

const RULES: &[Rule<Scene>] = &[
    Rule { key: "friction.shear_strength", look: shear_strength },
    Rule { key: "thermal.ambient", look: ambient },
    Rule { key: "thermal.disc.conductivity", look: |scene| substance(&thermal(scene)?.disc.substance) },
    Rule {
        key: "thermal.disc.coating.conductivity",
        look: |scene| substance(&thermal(scene)?.disc.coating?.substance),
    },
    Rule { key: "thermal.disc.coating.thickness", look: coating_thickness },
    Rule { key: "thermal.pin.conductivity", look: |scene| substance(&thermal(scene)?.pin.substance) },
    Rule { key: "thermal.pin.area", look: pin_area },
    Rule { key: "emission.pin_density", look: |scene| density(scene.parameters.emission.as_ref()?.pin_density) },
    Rule { key: "emission.disc_density", look: |scene| density(scene.parameters.emission.as_ref()?.disc_density) },
];

/// What cannot be meant.
pub(super) fn of_scene(scene: &Scene) -> Vec<Warning> {
    apply(RULES, scene, scene)
}

fn thermal(scene: &Scene) -> Option<&Thermal> {
    scene.parameters.thermal.as_deref()
}

fn shear_strength(scene: &Scene) -> Option<Finding> {
    let strength = scene.parameters.friction?.primary.shear_strength;
    (strength > STRONGEST).then(|| Finding {
        found: format!("a shear strength of {}", pressure(strength)),
        bound: format!("more than {}", pressure(STRONGEST)),
        advice: "check its unit",
    })
}

fn ambient(scene: &Scene) -> Option<Finding> {
    let ambient = thermal(scene)?.ambient;
    outside(ambient, AMBIENT, "an ambient temperature of", "K", "check its unit: degC or K")
}

/// Of the three properties, the first that is out of all proportion.
fn substance(substance: &Substance) -> Option<Finding> {
    let advice = "check the units of conductivity, density and specific heat";
    outside(substance.conductivity, CONDUCTIVITY, "a conductivity of", "W/(m K)", advice)
        .or_else(|| outside(substance.density, DENSITY, "a density of", "kg/m^3", advice))
        .or_else(|| outside(substance.specific_heat, SPECIFIC_HEAT, "a specific heat of", "J/(kg K)", advice))
}

/// Heat goes through the coating into the disc; the coating of a brake disc is a small part of it.
fn coating_thickness(scene: &Scene) -> Option<Finding> {
    let disc = &thermal(scene)?.disc;
    let thickness = disc.coating?.thickness;
    (thickness > disc.thickness).then(|| Finding {
        found: format!("a coating of {}", Length(thickness)),
        bound: format!("more than the disc below it, {}", Length(disc.thickness)),
        advice: "check both thicknesses and their units",
    })
}

fn density(density: f64) -> Option<Finding> {
    outside(density, DENSITY, "a density of", "kg/m^3", "check its unit")
}

fn outside(value: f64, range: RangeInclusive<f64>, what: &str, unit: &str, advice: &'static str) -> Option<Finding> {
    (!range.contains(&value)).then(|| Finding {
        found: format!("{what} {} {unit}", number(value)),
        bound: format!("outside of {} to {} {unit}", number(*range.start()), number(*range.end())),
        advice,
    })
}

/// The pin of the mesh is a part of the pin that heat sees, or all of it; its corners may reach beyond a round pin.
fn pin_area(scene: &Scene) -> Option<Finding> {
    let (area, of_mesh) = (thermal(scene)?.pin.area, scene.parameters.mesh.pin_area());
    (area < 0.5 * of_mesh).then(|| Finding {
        found: format!("{} mm^2", number(area * 1e6)),
        bound: format!("less than half of the {} mm^2 of the pin in [mesh]", number(of_mesh * 1e6)),
        advice: "check its unit",
    })
}
