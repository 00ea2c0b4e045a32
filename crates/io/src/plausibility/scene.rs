//! What a scene says by itself.

use plateau_core::model::material::Material;
use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{HeightSynthesis, Length, Texture};

use super::words::{number, pressure};
use super::{Finding, Rule, apply, dissipation, softest_plateau, too_much_pressure};
use crate::scene::Warning;
use crate::scene::{BaseSource, HeightSettings, HeightSource, Scene};

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
/// What rounding may take off a length that was given as a whole number of others.
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
];

/// What cannot be meant, as far as the scene tells without its surfaces.
pub fn of_scene(scene: &Scene) -> Vec<Warning> {
    let mut warnings = apply(RULES, scene, scene);
    warnings.extend(dissipation::of_scene(scene));
    warnings
}

fn nominal_pressure(scene: &Scene) -> Option<Finding> {
    let parameters = &scene.parameters;
    let pressure = parameters.normal_force / parameters.mesh.pin_area();
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

fn modulus(material: &Material) -> Option<Finding> {
    let modulus = material.youngs_modulus;
    let [least, most] = [MODULI.start(), MODULI.end()].map(|bound| pressure(*bound));
    (!MODULI.contains(&modulus)).then(|| Finding {
        found: format!("a modulus of {}", pressure(modulus)),
        bound: format!("outside of {least} to {most}"),
        advice: "check its unit",
    })
}

/// What is synthetic about the heights, if they are.
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
