//! Input that is legal but cannot be meant: a wrong unit, a slip of the pen.
//!
//! | known | rules |
//! |---|---|
//! | from the scene alone | [`of_scene`] |
//! | with its surfaces | [`of_surfaces`] |
//! | from what a run recorded | [`Recorded`] |
//!
//! Each is a list of rules. A rule belongs to the key that is most likely wrong, and tells what it found, the bound and what to
//! do. `docs/scenes.md` lists them all.

use std::ops::RangeInclusive;

use plateau_core::model::first_contact::FirstContact;
use plateau_core::model::material::{Material, Materials, Status};
use plateau_core::model::parameters::Parameters;
use plateau_core::model::thermal::{Substance, Thermal};
use plateau_core::observe::Sample;
use plateau_core::surface::{HeightSynthesis, Length, Texture};

use crate::scene::{BaseSource, HeightSettings, HeightSource, Origin, Scene, Warning};
use crate::surface::Loaded;

/// The part of the modulus of a plateau that the mean pressure cannot reach in earnest: beyond it nothing is elastic, and
/// the overlap is a tenth of the foundation.
const LARGEST_STRAIN: f64 = 0.1;

struct Finding {
    /// The value found, in words, with its number.
    found: String,
    /// The bound that it misses, with its number.
    bound: String,
    advice: &'static str,
}

/// Warnings of what rules found, for keys that the scene gives and that no warning has named yet.
///
/// Where a key has its default, the key that this follows from is named.
fn warnings<const RULES: usize>(scene: &Scene, found: [(&str, Option<Finding>); RULES]) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = Vec::new();
    for (key, finding) in found {
        let place = scene.places.get(key).filter(|place| **place != Origin::Default);
        let named = scene.warnings.iter().chain(&warnings).any(|warning| warning.key == key);
        if let (Some(place), false, Some(Finding { found, bound, advice })) = (place, named, finding) {
            let (place, key, advice) = (place.clone(), key.to_owned(), advice.to_owned());
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
        found: format!("{what} {}", pressure_in_words(pressure)),
        bound: format!("more than a tenth of the softest plateau's modulus of {}", pressure_in_words(modulus)),
        advice: "check the force, the size of the pin in [mesh] and the moduli in [materials]",
    })
}

/// Says that an overlap is more than the foundation is high; `what` is the overlap in words.
fn too_much_overlap(overlap: f64, foundation_height: f64, what: &str) -> Option<Finding> {
    (overlap > foundation_height).then(|| Finding {
        found: format!("{what} {}", Length(overlap)),
        bound: format!("more than the foundation's height of {}", Length(foundation_height)),
        advice: "check the foundation's height, the force and the moduli in [materials]",
    })
}

/// Four significant digits, without the zeros that would pretend more.
fn number(value: f64) -> String {
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
fn pressure_in_words(value: f64) -> String {
    let units = [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")];
    let (pascals, unit) = units.into_iter().find(|(pascals, _)| value >= *pascals).unwrap_or((1.0, "Pa"));
    format!("{} {unit}", number(value / pascals))
}

/// Young's moduli of what brakes are made of, soft rubber and diamond included, Pa.
const MODULI: RangeInclusive<f64> = 1e3..=1e12;
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

/// Values that cannot be meant, as far as the scene tells without its surfaces.
pub fn of_scene(scene: &Scene) -> Vec<Warning> {
    let Scene { disc_surface: disc, pin_surface: pin, .. } = scene;
    let Parameters { materials, emission, .. } = &scene.parameters;
    let thermal = scene.parameters.thermal.as_deref();
    let coating = thermal.and_then(|thermal| thermal.disc.coating);
    let rules = [
        ("operation.normal_force", nominal_pressure(scene)),
        ("operation.rotational_speed", sliding_speed(scene)),
        ("operation.sliding_speed", sliding_speed(scene)),
        ("operation.duration", duration(scene)),
        ("materials.disc_primary.youngs_modulus", modulus(&materials.disc_primary)),
        ("materials.disc_secondary.youngs_modulus", modulus(&materials.disc_secondary)),
        ("materials.pin_primary.youngs_modulus", modulus(&materials.pin_primary)),
        ("materials.pin_secondary.youngs_modulus", modulus(&materials.pin_secondary)),
        ("materials.pin_resin.youngs_modulus", modulus(&materials.pin_resin)),
        ("disc.surface.synthetic.correlation_length", correlation_length(scene, disc, "disc")),
        ("disc.surface.synthetic.correlation_length_across", correlation_length_across(scene, disc)),
        ("disc.surface.synthetic.patch", patch(disc)),
        ("pin.surface.synthetic.correlation_length", correlation_length(scene, pin, "pin")),
        ("pin.surface.synthetic.correlation_length_across", correlation_length_across(scene, pin)),
        ("pin.base.synthetic.fibre_length", fibre_length(scene)),
        ("plateaus.transport_length", transport_length(scene)),
        ("friction.shear_strength", shear_strength(scene)),
        ("thermal.ambient", thermal.and_then(ambient)),
        ("thermal.disc.conductivity", thermal.and_then(|thermal| substance(&thermal.disc.substance))),
        ("thermal.disc.coating.conductivity", coating.and_then(|coating| substance(&coating.substance))),
        ("thermal.disc.coating.thickness", thermal.and_then(coating_thickness)),
        ("thermal.pin.conductivity", thermal.and_then(|thermal| substance(&thermal.pin.substance))),
        ("thermal.disc.thickness", thermal.and_then(|thermal| heat_capacity(scene, thermal))),
        ("thermal.pin.area", thermal.and_then(|thermal| pin_area(scene, thermal))),
        ("emission.pin_density", emission.as_ref().and_then(|emission| density(emission.pin_density))),
        ("emission.disc_density", emission.as_ref().and_then(|emission| density(emission.disc_density))),
    ];
    warnings(scene, rules)
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
    let shorter_side = mesh.column_width().min(mesh.row_height());
    let cell = if scene.places.contains_key(&across) { mesh.column_width() } else { shorter_side };
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

fn too_few_cells(length: f64, cell: f64) -> Option<Finding> {
    (length < LEAST_CELLS * cell * (1.0 - ROUNDING)).then(|| Finding {
        found: format!("{}, which is {} cells of {}", Length(length), number(length / cell), Length(cell)),
        bound: format!("less than {LEAST_CELLS} cells"),
        advice: "heights of neighbouring cells are all but independent: check its unit, or make the mesh finer",
    })
}

fn patch(heights: &HeightSettings) -> Option<Finding> {
    let (patch, [length, _]) = (synthesis(heights)?.patch?, lengths(heights)?);
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

fn shear_strength(scene: &Scene) -> Option<Finding> {
    let strength = scene.parameters.friction?.primary.shear_strength;
    (strength > STRONGEST).then(|| Finding {
        found: format!("a shear strength of {}", pressure_in_words(strength)),
        bound: format!("more than {}", pressure_in_words(STRONGEST)),
        advice: "check its unit",
    })
}

fn ambient(thermal: &Thermal) -> Option<Finding> {
    outside(thermal.ambient, AMBIENT, "an ambient temperature of", "K", "check its unit: degC or K")
}

/// Of the three properties, the first that is out of all proportion.
fn substance(substance: &Substance) -> Option<Finding> {
    let advice = "check the units of conductivity, density and specific heat";
    outside(substance.conductivity, CONDUCTIVITY, "a conductivity of", "W/(m K)", advice)
        .or_else(|| outside(substance.density, DENSITY, "a density of", "kg/m^3", advice))
        .or_else(|| outside(substance.specific_heat, SPECIFIC_HEAT, "a specific heat of", "J/(kg K)", advice))
}

/// Heat goes through the coating into the disc; the coating of a brake disc is a small part of it.
fn coating_thickness(thermal: &Thermal) -> Option<Finding> {
    let disc = &thermal.disc;
    let thickness = disc.coating?.thickness;
    (thickness > disc.thickness).then(|| Finding {
        found: format!("a coating of {}", Length(thickness)),
        bound: format!("more than the disc below it, {}", Length(disc.thickness)),
        advice: "check both thicknesses and their units",
    })
}

/// Heat capacity of a brake disc over the area of its pads, J/(K m²): 4e5 of a passenger car's (8 kg of iron, 100 cm²), 8e5 of a
/// pin of 78.5 mm² on a rig of 67 J/K; and ten times less and more.
const CAPACITY_PER_AREA: RangeInclusive<f64> = 4e4..=8e6;

/// The heat of the simulated pin warms the disc, so the disc must be as small a part of the real one as the pin is of the pads.
fn heat_capacity(scene: &Scene, thermal: &Thermal) -> Option<Finding> {
    let disc = &thermal.disc;
    let capacity = disc.substance.density * disc.substance.specific_heat * disc.area * disc.thickness;
    let per_area = capacity / scene.parameters.mesh.pin_area();
    let advice = if scene.brake.is_some() {
        "it would stay cold, or glow: check area, thickness and density in [thermal.disc], which make the mass of the whole disc, and \
         pad_area in [brake]"
    } else {
        "it would stay cold, or glow: give area and cooling of the disc as much smaller as the simulated pin is than pin or pads, or \
         the whole brake with [brake]"
    };
    let what = "a disc whose heat capacity over the area of the simulated pin is";
    outside(
        per_area * 1e-6,
        CAPACITY_PER_AREA.start() * 1e-6..=CAPACITY_PER_AREA.end() * 1e-6,
        what,
        "J/(K mm^2)",
        advice,
    )
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
fn pin_area(scene: &Scene, thermal: &Thermal) -> Option<Finding> {
    let (area, of_mesh) = (thermal.pin.area, scene.parameters.mesh.pin_area());
    (area < 0.5 * of_mesh).then(|| Finding {
        found: format!("{} mm^2", number(area * 1e6)),
        bound: format!("less than half of the {} mm^2 of the pin in [mesh]", number(of_mesh * 1e6)),
        advice: "check its unit",
    })
}

/// Fraction of the points that a cutoff takes off peaks alone: from here on it is in the valleys.
const HALF: f64 = 0.5;

/// Values that cannot be meant, now that the surfaces are known, of keys that `scene.warnings` does not name yet.
pub fn of_surfaces(scene: &Scene, loaded: &Loaded) -> Vec<Warning> {
    let parameters = &scene.parameters;
    // Where heights are flat nothing can be cut, and whoever tries a flat disc in a scene need not take its cutoff away.
    let cutoff = |heights: &HeightSettings, cut: Option<f64>| match heights.source {
        HeightSource::Flat => None,
        HeightSource::File { .. } | HeightSource::Synthetic(_) => useless(heights.preparation.cutoff?, cut?),
    };
    let contact = FirstContact::of(parameters, &loaded.surfaces);
    let pressure = contact.and_then(|contact| {
        let what = "in the first step a mean contact pressure of";
        too_much_pressure(contact.mean_pressure, softest_plateau(&parameters.materials), what)
    });
    let overlap = contact.and_then(|contact| {
        let what = "in the first step an overlap of";
        too_much_overlap(contact.largest_overlap, parameters.foundation_height, what)
    });
    let rules = [
        ("disc.prepare.cutoff", cutoff(&scene.disc_surface, loaded.disc_cut)),
        ("pin.prepare.cutoff", cutoff(&scene.pin_surface, loaded.pin_cut)),
        ("operation.normal_force", pressure),
        ("contact.foundation_height", overlap),
    ];
    warnings(scene, rules)
}

/// Says that a cutoff, m above the mean, cuts nothing, or a fraction of the points that is more than peaks.
fn useless(height: f64, cut: f64) -> Option<Finding> {
    let (bound, advice) = if cut == 0.0 {
        ("no point at all", "no peak is so high: check its unit, or say cutoff = \"none\"")
    } else if cut >= HALF {
        (
            "half of them or more",
            "it is meant for the peaks: check its unit, and what prepare.level takes out before it",
        )
    } else {
        return None;
    };
    Some(Finding {
        found: format!("at {} above the mean it cuts {} % of the points", Length(height), number(100.0 * cut)),
        bound: bound.to_owned(),
        advice,
    })
}

/// Extent to which a filled fraction may leave 0 to 1: a disc that wears opens a little before the first debris fills it.
const SLACK: f64 = 1e-3;

/// A number and when it was reached, s.
#[derive(Debug, Clone, Copy)]
struct Reached {
    value: f64,
    time: f64,
}

/// The extremes of what a run recorded.
#[derive(Debug)]
pub struct Recorded {
    parameters: Parameters,
    mean_pressure: Reached,
    /// m: what the largest pressure takes in the stiffest pair that there is. A softer pair overlaps more.
    overlap: Reached,
    /// The one furthest outside of 0 to 1, if any is outside by more than [`SLACK`].
    filled_fraction: Option<Reached>,
}

impl Recorded {
    /// Nothing recorded yet of a run with these parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let none = Reached { value: 0.0, time: 0.0 };
        Self { parameters: parameters.clone(), mean_pressure: none, overlap: none, filled_fraction: None }
    }

    /// Takes note of a sample.
    pub fn add(&mut self, sample: &Sample) {
        let reached = |value| Reached { value, time: sample.time };
        if sample.mean_pressure > self.mean_pressure.value {
            self.mean_pressure = reached(sample.mean_pressure);
        }
        let overlap = sample.max_pressure / largest_stiffness(&self.parameters, sample);
        if overlap > self.overlap.value {
            self.overlap = reached(overlap);
        }
        let beyond = |fraction: f64| (-fraction).max(fraction - 1.0);
        let so_far = self.filled_fraction.map_or(SLACK, |filled| beyond(filled.value));
        if beyond(sample.filled_fraction) > so_far {
            self.filled_fraction = Some(reached(sample.filled_fraction));
        }
    }

    /// Values that cannot be meant, of keys that `scene.warnings` does not name yet.
    pub fn warnings(&self, scene: &Scene) -> Vec<Warning> {
        let rules = [
            ("operation.normal_force", pressure(self)),
            ("contact.foundation_height", overlap(self)),
            ("materials.disc_primary.specific_wear_rate", filled_fraction(self)),
        ];
        warnings(scene, rules)
    }
}

/// k of the stiffest pair whose statuses a sample has, Pa/m.
fn largest_stiffness(parameters: &Parameters, sample: &Sample) -> f64 {
    let pin = [
        (Status::Resin, sample.pin_none),
        (Status::Primary, sample.pin_primary),
        (Status::Secondary, sample.pin_secondary),
    ];
    let disc = [(false, 1.0 - sample.disc_secondary), (true, sample.disc_secondary)];
    let mut largest = 0.0_f64;
    for (pin, _) in pin.into_iter().filter(|(_, area)| *area > 0.0) {
        for (disc_secondary, _) in disc.into_iter().filter(|(_, area)| *area > 0.0) {
            largest = largest.max(parameters.materials.combined_modulus(pin, disc_secondary));
        }
    }
    largest / parameters.foundation_height
}

fn pressure(recorded: &Recorded) -> Option<Finding> {
    let Reached { value, time } = recorded.mean_pressure;
    let what = format!("at {} s a mean contact pressure of", number(time));
    too_much_pressure(value, softest_plateau(&recorded.parameters.materials), &what)
}

fn overlap(recorded: &Recorded) -> Option<Finding> {
    let Reached { value, time } = recorded.overlap;
    let what = format!("at {} s an overlap of at least", number(time));
    too_much_overlap(value, recorded.parameters.foundation_height, &what)
}

fn filled_fraction(recorded: &Recorded) -> Option<Finding> {
    let Reached { value, time } = recorded.filled_fraction?;
    Some(Finding {
        found: format!("at {} s a filled fraction of {}", number(time), number(value)),
        bound: format!("outside of 0 to 1 by more than {SLACK}"),
        advice: "the disc wears deeper than its lowlands were: check the wear rate, or do not use the filled fraction",
    })
}

#[cfg(test)]
#[path = "../tests/unit/plausibility.rs"]
mod tests;
