//! What is switched on or off.

use super::subject::Subject;
use crate::case::{DISC_WEAR, FASTER_DEBRIS, NO_DESTRUCTION, ONE_POOL, POOL_PER_TRACK, POOLED_FRACTION, SOFTER_DEBRIS};

/// The scene as it is, for the steps of the subject.
const SCENE: &str = "the scene";
/// The scene without maps, whose writing sets the largest memory and a good part of the time of a short run.
const NO_MAPS: &str = "no maps";
/// Without maps, and with the debris of the contact in one pool.
const POOLED: &str = "no maps, one debris pool";
/// Without maps and with few steps.
const ONE_REVOLUTION: &str = "no maps, one revolution";
/// That, with nearly all of its time spent on samples.
const SAMPLED: &str = "no maps, one revolution, a sample every step";
/// Without maps, at an acceleration that is given.
const ACCELERATED: &str = "no maps, acceleration 8";
/// That acceleration.
const ACCELERATION: f64 = 8.0;
/// The table of keys that say how long a run is: of two that say it only one can be set.
const LENGTH: &str = "operation.";
/// Without maps, and with friction.
const WITH_FRICTION: &str = "no maps, friction";
/// That, and heat with a coated disc and a feedback on wear and friction that is felt.
const WITH_HEAT: &str = "no maps, friction, heat";
/// A law of friction, and another one for build-ups.
const FRICTION: &str = "friction={ pressure_coefficient = 0.33, shear_strength = \"0.75 MPa\", maximum = 0.6 }";
const FRICTION_OF_BUILD_UPS: &str = "friction.secondary={ shear_strength = \"1 MPa\" }";
/// The rig of model section 12.
const HEAT: [&str; 5] = [
    "thermal.ambient=\"23 degC\"",
    "thermal.wear_rate_factor=[[\"23 degC\", 1.0], [\"100 degC\", 1.5]]",
    "thermal.disc={ conductivity = \"50 W/(m K)\", density = \"7200 kg/m^3\", specific_heat = \"500 J/(kg K)\", \
     area = \"31 cm^2\", thickness = \"6 mm\", cooling = \"0.4 W/K\" }",
    "thermal.disc.coating={ thickness = \"60 um\", conductivity = \"15 W/(m K)\", density = \"13500 kg/m^3\", \
     specific_heat = \"250 J/(kg K)\" }",
    "thermal.pin={ conductivity = \"1.5 W/(m K)\", density = \"2600 kg/m^3\", specific_heat = \"900 J/(kg K)\", \
     area = \"78.5 mm^2\", length = \"12 mm\", cooling = \"0.02 W/K\" }",
];
const EMISSION: &str = "emission={ pm10_fraction = 0.4, pm25_fraction = 0.15, number_per_mass = \"1e15 1/kg\", \
     pin_density = \"2600 kg/m^3\", disc_density = \"7200 kg/m^3\" }";
/// How many times a run with many maps has them.
const MAP_TIMES: u32 = 9;

/// Changes of a scene.
#[derive(Debug)]
pub struct Variant {
    /// What sets it apart: the name of what it is set against, a comma, and the change; or the change of the scene alone.
    pub name: String,
    /// Changes, as after `--set`.
    pub sets: Vec<String>,
}

impl Variant {
    /// Name of the variant from which it differs by one change; the scene is set against itself.
    pub fn against(&self) -> &str {
        self.name.rsplit_once(", ").map_or(SCENE, |(against, _)| against)
    }
}

/// The variants of a scene, each after the one that it is set against.
pub fn variants(subject: &Subject) -> Vec<Variant> {
    let mut all = vec![Variant { name: SCENE.into(), sets: vec![format!("operation.steps={}", subject.steps)] }];
    let mut add = |from: &str, change: &str, sets: &[&str]| {
        let base = all.iter().find(|variant| variant.name == from);
        let kept = base.into_iter().flat_map(|base| &base.sets).filter(|set| !replaced(set, sets)).cloned();
        let sets = kept.chain(sets.iter().map(|set| (*set).to_owned()));
        let name = if from == SCENE { change.to_owned() } else { format!("{from}, {change}") };
        let variant = Variant { name, sets: sets.collect() };
        all.push(variant);
    };
    let revolution = format!("operation.steps={}", subject.mesh.disc_columns);
    let sample_every_revolution = format!("output.sample_every_steps={}", subject.mesh.disc_columns);
    let maps_at = maps_at(subject);
    let same_debris = format!("materials.pin_secondary.youngs_modulus=\"{} Pa\"", subject.fibre_modulus);
    let accelerated = format!("numerics.time_acceleration={ACCELERATION}");
    let duration = ACCELERATION * subject.steps as f64 * subject.unaccelerated_step_time;
    let duration = format!("operation.duration=\"{duration} s\"");

    add(SCENE, "the scene once more", &[]);
    add(SCENE, "maps at nine times", &[&maps_at]);
    add(SCENE, "no formation", &["plateaus.formation=false"]);
    add(SCENE, NO_MAPS, &["output.maps=[]"]);
    add(NO_MAPS, "once more", &[]);

    add(NO_MAPS, "no formation", &["plateaus.formation=false"]);
    add(NO_MAPS, "no debris captured", &["plateaus.captured_fraction=0"]);
    add(NO_MAPS, "no resin", &["pin.base.uniform=primary"]);
    let nothing = ["plateaus.formation=false", "pin.base.uniform=primary", &sample_every_revolution];
    add(NO_MAPS, "nothing optional", &nothing);
    add(NO_MAPS, "exponential wear", &["numerics.integrator=exponential"]);
    add(NO_MAPS, "wear of the disc", &[DISC_WEAR]);
    add(NO_MAPS, "materials of build-ups given as those below", &[&same_debris]);
    add(NO_MAPS, "materials of their own for build-ups", &[SOFTER_DEBRIS, FASTER_DEBRIS]);
    add(NO_MAPS, "two workers", &["numerics.workers=2"]);

    add(NO_MAPS, "friction", &[FRICTION]);
    add(WITH_FRICTION, "another law for build-ups", &[FRICTION_OF_BUILD_UPS]);
    add(WITH_FRICTION, "heat", &HEAT);
    add(WITH_HEAT, "contact temperatures with every sample", &["output.contact_temperature=true"]);
    add(NO_MAPS, "emission", &[EMISSION]);

    add(NO_MAPS, "one debris pool", &[ONE_POOL, POOLED_FRACTION]);
    add(POOLED, "no destruction", &[NO_DESTRUCTION]);
    add(POOLED, "one per track instead", &[POOL_PER_TRACK]);

    add(NO_MAPS, "a sample every revolution", &[&sample_every_revolution]);
    add(NO_MAPS, "a sample every 100 steps", &["output.sample_every_steps=100"]);
    add(NO_MAPS, "roughness with every sample", &["output.roughness=true"]);
    add(NO_MAPS, "one revolution", &[&revolution]);
    add(ONE_REVOLUTION, "a sample every step", &["output.sample_every_steps=1"]);
    add(SAMPLED, "no formation", &["plateaus.formation=false"]);

    add(NO_MAPS, "acceleration 8", &[&accelerated, &duration]);
    let by_tolerance = "numerics.time_acceleration={ tolerance = 0.01, max = 1000 }";
    add(ACCELERATED, "by tolerance instead", &[by_tolerance]);
    all
}

/// Whether one of `sets` says the same as `set`: how long a run is, in steps or as a time.
fn replaced(set: &str, sets: &[&str]) -> bool {
    set.starts_with(LENGTH) && sets.iter().any(|other| other.starts_with(LENGTH))
}

/// All maps at nine times from the beginning to the end.
fn maps_at(subject: &Subject) -> String {
    let end = subject.steps as f64 * subject.step_time;
    let times = (0..MAP_TIMES).map(|index| end * f64::from(index) / f64::from(MAP_TIMES - 1));
    let times: Vec<String> = times.map(|time| format!("\"{time} s\"")).collect();
    format!("output.maps_at=[{}]", times.join(", "))
}

#[cfg(test)]
mod tests {
    use super::super::subject::shipped;
    use super::*;
    use crate::case::Source;

    #[test]
    fn a_variant_differs_by_one_change_from_one_that_comes_before() {
        let source = Source { path: shipped("quick.toml"), sets: Vec::new(), worn_in: 0.0 };
        let variants = variants(&Subject::new(source, true).unwrap());
        for (index, variant) in variants.iter().enumerate() {
            let before = variants[..index.max(1)].iter().find(|other| other.name == variant.against());
            let before = before.unwrap_or_else(|| panic!("{:?} stands before its reference", variant.name));
            let mut kept = before.sets.iter().filter(|set| !set.starts_with(LENGTH));
            assert!(kept.all(|set| variant.sets.contains(set)), "{:?}", variant.name);
            assert_eq!(variant.sets.iter().filter(|set| set.starts_with(LENGTH)).count(), 1, "{:?}", variant.name);
            assert_eq!(variants.iter().filter(|other| other.name == variant.name).count(), 1, "{:?}", variant.name);
        }
    }
}
