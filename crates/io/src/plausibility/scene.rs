//! Rules of the scene by itself, with friction, heat and emission.

use std::ops::RangeInclusive;

use plateau_core::model::heat::{Substance, Thermal};
use plateau_core::model::material::Material;
use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{HeightSynthesis, Length, Texture};

use super::rule::{Finding, Rule, apply, number, pressure_in_words, softest_plateau, too_much_pressure};
use crate::scene::{BaseSource, HeightSettings, HeightSource, Scene, Warning};

/// Young's moduli of what brakes are made of, soft rubber and diamond included, Pa.
const MODULI: std::ops::RangeInclusive<f64> = 1e3..=1e12;
/// No brake slides faster, m/s.
const FASTEST: f64 = 200.0;
/// No brake slides as long, s: a year.
const LONGEST: f64 = 365.25 * 86_400.0;
/// Cells that a correlation length must have: with fewer, heights of neighbours are all but independent.
const LEAST_CELLS: f64 = 2.0;
/// Correlation lengths that a patch must have: with fewer, a few hills are repeated over and over.
const LEAST_LENGTHS: f64 = 10.0;
/// Part that rounding may take off a length that was given as a whole number of others.
const ROUNDING: f64 = 1e-9;

const RULES: &[Rule<Scene>] = &[
    Rule { key: "operation.normal_force", look: nominal_pressure },
    Rule { key: "operation.rotational_speed", look: sliding_speed },
    Rule { key: "operation.sliding_speed", look: sliding_speed },
    Rule { key: "operation.duration", look: duration },
    Rule {
        key: "materials.disc_primary.youngs_modulus",
        look: |scene| modulus(&scene.parameters.materials.disc_primary),
    },
    Rule {
        key: "materials.disc_secondary.youngs_modulus",
        look: |scene| modulus(&scene.parameters.materials.disc_secondary),
    },
    Rule {
        key: "materials.pin_primary.youngs_modulus",
        look: |scene| modulus(&scene.parameters.materials.pin_primary),
    },
    Rule {
        key: "materials.pin_secondary.youngs_modulus",
        look: |scene| modulus(&scene.parameters.materials.pin_secondary),
    },
    Rule { key: "materials.pin_resin.youngs_modulus", look: |scene| modulus(&scene.parameters.materials.pin_resin) },
    Rule {
        key: "disc.surface.synthetic.correlation_length",
        look: |scene| correlation_length(scene, &scene.disc_surface, "disc"),
    },
    Rule {
        key: "disc.surface.synthetic.correlation_length_across",
        look: |scene| correlation_length_across(scene, &scene.disc_surface),
    },
    Rule { key: "disc.surface.synthetic.patch", look: patch },
    Rule {
        key: "pin.surface.synthetic.correlation_length",
        look: |scene| correlation_length(scene, &scene.pin_surface, "pin"),
    },
    Rule {
        key: "pin.surface.synthetic.correlation_length_across",
        look: |scene| correlation_length_across(scene, &scene.pin_surface),
    },
    Rule { key: "pin.base.synthetic.fibre_length", look: fibre_length },
    Rule { key: "plateaus.transport_length", look: transport_length },
];

/// Values that cannot be meant, as far as the scene tells without its surfaces.
pub fn of_scene(scene: &Scene) -> Vec<Warning> {
    let mut warnings = apply(RULES, scene, scene);
    warnings.extend(apply(DISSIPATION_RULES, scene, scene));
    warnings
}

fn nominal_pressure(scene: &Scene) -> Option<Finding> {
    let parameters = &scene.parameters;
    let pressure = parameters.usual_load() / parameters.mesh.pin_area();
    too_much_pressure(pressure, softest_plateau(&parameters.materials), "a nominal pressure of")
}

fn sliding_speed(scene: &Scene) -> Option<Finding> {
    let speed = scene.parameters.angular_velocity * scene.parameters.mesh.mean_radius();
    (speed > FASTEST * (1.0 + ROUNDING)).then(|| Finding {
        found: format!("sliding at {} m/s at the mean radius", number(speed)),
        bound: format!("more than {FASTEST} m/s"),
        advice: "check the speed, its unit and the radii in [mesh]",
    })
}

fn duration(scene: &Scene) -> Option<Finding> {
    let parameters = &scene.parameters;
    if parameters.cycle.is_some() {
        return None;
    }
    let duration = scene.steps as f64 * parameters.step_time();
    (duration > LONGEST * (1.0 + ROUNDING)).then(|| Finding {
        found: format!("sliding for {} s", number(duration)),
        bound: "longer than a year".to_owned(),
        advice: "check the duration and its unit",
    })
}

/// Below two columns, what a transport length is rounded to decides too much (model 4L).
fn transport_length(scene: &Scene) -> Option<Finding> {
    let mesh = &scene.parameters.mesh;
    let columns = scene.parameters.plateaus.transport_length? / mesh.column_width();
    let found = || format!("a transport length of {} cells", number(columns));
    if columns > mesh.pin_columns() as f64 * (1.0 + ROUNDING) {
        let bound = format!("longer than the pin, which has {}", mesh.pin_columns());
        return Some(Finding { found: found(), bound, advice: "check its unit" });
    }
    (columns < 2.0 * (1.0 - ROUNDING)).then(|| Finding {
        found: found(),
        bound: "fewer than 2, so that its rounding to whole cells shows".to_owned(),
        advice: "take a finer mesh or a longer transport length",
    })
}

fn modulus(material: &Material) -> Option<Finding> {
    let modulus = material.youngs_modulus;
    let [least, most] = [MODULI.start(), MODULI.end()].map(|bound| pressure_in_words(*bound));
    (!MODULI.contains(&modulus)).then(|| Finding {
        found: format!("a modulus of {}", pressure_in_words(modulus)),
        bound: format!("outside of {least} to {most}"),
        advice: "check its unit",
    })
}

/// Settings of synthetic heights, if they are synthetic.
fn synthesis(heights: &HeightSettings) -> Option<&HeightSynthesis> {
    match &heights.source {
        HeightSource::Synthetic(synthesis) => Some(synthesis),
        HeightSource::File { .. } | HeightSource::Flat => None,
    }
}

/// One length for both directions may be as short as the shorter side of a cell allows; one of its own for the sliding
/// direction only as short as the cell along it.
fn correlation_length(scene: &Scene, heights: &HeightSettings, body: &str) -> Option<Finding> {
    let mesh = &scene.parameters.mesh;
    let across = format!("{body}.surface.synthetic.correlation_length_across");
    let cell = if scene.places.contains_key(&across) { mesh.column_width() } else { shorter_side(mesh) };
    too_few_cells(lengths(heights)?[0], cell)
}

fn correlation_length_across(scene: &Scene, heights: &HeightSettings) -> Option<Finding> {
    too_few_cells(lengths(heights)?[1], scene.parameters.mesh.row_height())
}

/// The correlation lengths along and across the sliding direction, m. A power law has none; where it begins is checked as
/// heights are made.
fn lengths(heights: &HeightSettings) -> Option<[f64; 2]> {
    match synthesis(heights)?.texture {
        Texture::Correlation { along, across } => Some([along, across]),
        Texture::PowerLaw { .. } => None,
    }
}

fn shorter_side(mesh: &Mesh) -> f64 {
    mesh.column_width().min(mesh.row_height())
}

fn too_few_cells(length: f64, cell: f64) -> Option<Finding> {
    (length < LEAST_CELLS * cell * (1.0 - ROUNDING)).then(|| Finding {
        found: format!("{}, which is {} cells of {}", Length(length), number(length / cell), Length(cell)),
        bound: format!("less than {LEAST_CELLS} cells"),
        advice: "heights of neighbouring cells are all but independent: check its unit, or make the mesh finer",
    })
}

fn patch(scene: &Scene) -> Option<Finding> {
    let (patch, [length, _]) = (synthesis(&scene.disc_surface)?.patch?, lengths(&scene.disc_surface)?);
    (patch < LEAST_LENGTHS * length * (1.0 - ROUNDING)).then(|| Finding {
        found: format!(
            "{}, which is {} correlation lengths of {}",
            Length(patch),
            number(patch / length),
            Length(length)
        ),
        bound: format!("less than {LEAST_LENGTHS} of them"),
        advice: "a few hills are repeated over and over: give a longer patch, or leave it out",
    })
}

fn fibre_length(scene: &Scene) -> Option<Finding> {
    let BaseSource::Synthetic(synthesis) = &scene.pin_base else { return None };
    let mesh = &scene.parameters.mesh;
    let [along, across] = [mesh.pin_columns() as f64 * mesh.column_width(), mesh.rows() as f64 * mesh.row_height()];
    (synthesis.fibre_length > along.max(across) * (1.0 + ROUNDING)).then(|| Finding {
        found: format!("fibres of {}", Length(synthesis.fibre_length)),
        bound: format!("longer than the pin of {} by {}", Length(along), Length(across)),
        advice: "check its unit, and the size of the pin in [mesh]",
    })
}

/// Ambient temperatures at which brakes are used, K.
const AMBIENT: RangeInclusive<f64> = 200.0..=400.0;
/// From air to diamond, W/(m K).
const CONDUCTIVITY: RangeInclusive<f64> = 0.02..=2500.0;
/// From foam to osmium, kg/m³.
const DENSITY: RangeInclusive<f64> = 10.0..=23_000.0;
/// From gold to water, J/(kg K).
const SPECIFIC_HEAT: RangeInclusive<f64> = 100.0..=4200.0;
/// No film that shears is stronger than what it lies on, Pa.
const STRONGEST: f64 = 1e9;

/// Rules of friction, heat and emission.
const DISSIPATION_RULES: &[Rule<Scene>] = &[
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

fn thermal(scene: &Scene) -> Option<&Thermal> {
    scene.parameters.thermal.as_deref()
}

fn shear_strength(scene: &Scene) -> Option<Finding> {
    let strength = scene.parameters.friction?.primary.shear_strength;
    (strength > STRONGEST).then(|| Finding {
        found: format!("a shear strength of {}", pressure_in_words(strength)),
        bound: format!("more than {}", pressure_in_words(STRONGEST)),
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
