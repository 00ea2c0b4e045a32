//! Numbers of runs change only together with the generation by which results are known: all bits of the results of these scenes are those
//! that the generation was recorded with.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use plateau_core::observe::event::event_quantities;
use plateau_core::observe::{Quantity, Sample, quantities};
use plateau_core::simulation::{Execution, SimulationError};
use plateau_io::generation::GENERATIONS;
use plateau_io::input::sha256_of;
use plateau_io::{scene, surface};
use plateau_run::{Assembly, Sink};

/// Series of which the bits are looked at, as far as a scene has them. A new series changes no number of those that there are, so it
/// need not be here.
const SERIES: &str = "
    acceleration_error balance_residual contact_area contact_area_integral contact_area_mean contact_ratio
    contact_temperature contact_time deposited_disc deposited_pin disc_secondary disc_temperature displacement
    emitted emitted_mass filled_fraction friction_coefficient friction_coefficient_mean friction_work heat_lost
    heat_residual load_residual max_pressure mean_pressure normal_force particle_number pin_none pin_primary
    pin_secondary pin_temperature pm10_mass pm25_mass pool returned rotational_speed sliding_distance
    time_acceleration worn_disc worn_pin worn_resin
";
/// The same of the events of a cycle.
const EVENTS: &str = "
    contact_area_end contact_area_start distance emitted end final_speed initial_speed start worn
";

/// The vectors, and scenes with what these do not have: synthetic surfaces of each kind, measured ones, pictures, cycles, pools, rules and
/// an acceleration that a run chooses.
const SCENES: [(&str, &[&str]); 16] = [
    ("tests/vectors/flat/scene.toml", &[]),
    ("tests/vectors/rough/scene.toml", &[]),
    ("tests/vectors/track/scene.toml", &[]),
    ("tests/vectors/local/scene.toml", &[]),
    ("tests/vectors/cycle/scene.toml", &[]),
    ("tests/vectors/heat/scene.toml", &[]),
    ("tests/vectors/pair/scene.toml", &[]),
    ("tests/vectors/reach/scene.toml", &[]),
    ("tests/vectors/torque/scene.toml", &[]),
    ("data/scenes/quick.toml", &["operation.duration=10 s"]),
    (
        "data/scenes/quick.toml",
        &["operation.duration=10 s", "plateaus.debris=contact", "plateaus.captured_fraction=0.5"],
    ),
    (
        "data/scenes/quick.toml",
        &["operation.duration=20 s", "numerics.time_acceleration={ max = 50, tolerance = 0.05 }"],
    ),
    ("data/scenes/stops.toml", &["operation.duration=24 s", "output.sample_every=0.5 s"]),
    // The pin stands under load before the first step.
    ("data/scenes/drive.toml", &["operation.duration=60 s", "numerics.time_acceleration=100"]),
    ("data/scenes/measured.toml", &["operation.duration=0.3 s", "numerics.time_acceleration=20"]),
    ("data/scenes/micrograph.toml", &["operation.duration=0.3 s", "numerics.time_acceleration=20"]),
];

fn is_among(names: &str, name: &str) -> bool {
    names.split_whitespace().any(|each| each == name)
}

/// The values of a run, sample after sample, as bytes.
struct Bits {
    quantities: Vec<&'static Quantity>,
    bytes: Vec<u8>,
}

impl Sink for Bits {
    type Error = SimulationError;

    fn sample(&mut self, sample: Sample) -> Result<(), SimulationError> {
        let values = self.quantities.iter().map(|quantity| quantity.value(&sample));
        self.bytes.extend(values.flat_map(bits));
        Ok(())
    }
}

/// A number as bytes; all that are none are the same, for their bits are the processor's.
fn bits(value: f64) -> [u8; 8] {
    if value.is_nan() { f64::NAN.to_le_bytes() } else { value.to_le_bytes() }
}

/// Digest of a scene's results; the names of its series and quantities of events are added to those that were `seen`.
fn results(path: &Path, sets: &[&str], seen: &mut [BTreeSet<&'static str>; 2]) -> String {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = scene::load(path, &sets).unwrap_or_else(|error| panic!("{error}"));
    let surfaces = surface::load(&scene).unwrap_or_else(|error| panic!("{error}")).surfaces;
    let extras = scene.extras(scene.adaptive.is_some());
    seen[0].extend(quantities(&extras).map(|quantity| quantity.name));
    let of_series = quantities(&extras).filter(|quantity| is_among(SERIES, quantity.name)).collect();
    let mut bytes = Bits { quantities: of_series, bytes: Vec::new() };
    let mut assembly = Assembly::new(&scene, surfaces, Execution::default()).unwrap();
    assembly.run_to_end(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    for event in assembly.events() {
        seen[1].extend(event_quantities(&extras).map(|quantity| quantity.name));
        let looked_at = event_quantities(&extras).filter(|quantity| is_among(EVENTS, quantity.name));
        bytes.bytes.extend(looked_at.flat_map(|quantity| bits((quantity.value)(event))));
    }
    assert!(!bytes.bytes.is_empty(), "{}", path.display());
    sha256_of(&bytes.bytes)
}

#[test]
fn numbers_of_a_generation_stay_as_they_are() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut seen = [BTreeSet::new(), BTreeSet::new()];
    let places = SCENES.map(|(path, sets)| (root.join(path), sets));
    let digests: Vec<String> =
        places.iter().map(|(path, sets): &(PathBuf, &[&str])| results(path, sets, &mut seen)).collect();
    for (names, looked_at) in seen.iter().zip([SERIES, EVENTS]) {
        for name in looked_at.split_whitespace() {
            assert!(names.contains(name), "{name}: no scene has this any more");
        }
    }
    let found = sha256_of(digests.concat().as_bytes());
    let last = GENERATIONS.last().unwrap();
    assert_eq!(
        found,
        last.results,
        "runs have other numbers than generation {} of crates/io/src/generation.rs. If that is meant, add a generation with the reason and these \
         results; each scene: {digests:?}",
        GENERATIONS.len()
    );
}

#[test]
fn every_generation_has_a_reason_and_results_of_its_own() {
    let results: BTreeSet<&str> = GENERATIONS.iter().map(|generation| generation.results).collect();
    assert_eq!(results.len(), GENERATIONS.len(), "a generation that computes the same as another is none");
    assert!(GENERATIONS.iter().all(|generation| generation.reason.len() > 20 && generation.results.len() == 64));
}
