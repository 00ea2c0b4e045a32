//! Equal scenes give equal bits, whatever the number of workers and the instruction set.

use std::path::Path;
use std::time::Duration;

use plateau_core::engine::kernel::InstructionSet;
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters};
use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::{Map, Sample};
use plateau_core::simulation::{Decomposition, Execution, Simulation, SimulationError};
use plateau_io::{scene as scene_file, surface};
use plateau_tests::divergence::{differences, first_divergence};
use plateau_tests::patience::within;
use plateau_tests::program::scene;
use plateau_tests::scenes::few_or_all;
use plateau_tests::scenes::{random_surfaces, wear_only};

/// Numbers of workers: fewer and more than cores, even and odd.
const WORKERS: [usize; 5] = [1, 2, 3, 5, 8];

/// No comparison takes nearly as long, not even with 8 workers on one core; one that does hangs.
const PATIENCE: Duration = Duration::from_secs(120);

#[derive(Clone)]
struct Scene {
    name: String,
    steps: u64,
    parameters: Parameters,
    surfaces: InitialSurfaces,
}

impl Scene {
    /// `quick.toml` with changes, for so many steps.
    fn quick(steps: u64, sets: &[&str]) -> Self {
        let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
        let scene = scene_file::load(Path::new(&scene("quick.toml")), &sets).expect("quick.toml");
        let surfaces = surface::load(&scene).expect("synthetic surfaces").surfaces;
        Self { name: format!("quick.toml {sets:?}"), steps, parameters: scene.parameters, surfaces }
    }

    /// Random surfaces and plateaus on a mesh of `rows`, `disc_columns` and `pin_columns`, changed.
    fn random([rows, disc_columns, pin_columns]: [usize; 3], change: impl FnOnce(&mut Parameters)) -> Self {
        let mut parameters = wear_only(rows, disc_columns, pin_columns);
        parameters.time_acceleration = 20.0;
        parameters.plateaus.captured_fraction = 0.5;
        parameters.plateaus.formation = true;
        parameters.plateaus.destruction = true;
        change(&mut parameters);
        let surfaces = random_surfaces(&parameters.mesh, 7);
        let name = format!("{rows} rows, {disc_columns} columns, {pin_columns} under the pin");
        Self { name, steps: 700, parameters, surfaces }
    }

    fn start(&self, execution: Execution) -> Simulation {
        Simulation::with_execution(self.parameters.clone(), self.surfaces.clone(), execution).expect("a simulation")
    }

    /// One worker with the plainest instruction set: what all others are held against.
    fn reference(&self) -> Simulation {
        self.start(Execution { workers: 1, instructions: InstructionSet::PORTABLE, ..Execution::default() })
    }

    /// Holds every number of workers with every instruction set against the reference, after a look whether what the
    /// scene is for really happens in it. In short, each with some of the others, in a long scene with one.
    fn agrees_for_all(self, happens: impl Fn(&Sample) -> bool) {
        let mut reference = self.reference();
        reference.advance_to(self.steps).expect("the reference");
        let end = reference.sample().expect("its sample");
        assert!(happens(&end), "{}: nothing to compare in {end:?}", self.name);
        // Sectors alone with every instruction set, and the best grid of sectors and bands.
        let best = InstructionSet::best();
        let grids = InstructionSet::available().map(|each| (each, Decomposition::Sectors));
        let grids = grids.chain([(best, Decomposition::Auto)]).collect::<Vec<_>>();
        let is_long = self.steps > 10_000;
        let stride = few_or_all(if is_long { grids.len() } else { 3 }, 1);
        for (place, workers) in WORKERS.into_iter().enumerate() {
            for (instructions, decomposition) in grids.iter().copied().skip(place % stride).step_by(stride) {
                let with = instructions.name();
                let variant = format!("{}, {workers} workers, {decomposition:?} with {with}", self.name);
                let scene = self.clone();
                let execution = Execution { workers, instructions, decomposition, ..Execution::default() };
                let compare = move || first_divergence(scene.steps, || scene.reference(), || scene.start(execution));
                if let Some(divergence) = within(PATIENCE, &variant, compare) {
                    panic!("{variant}: {divergence}");
                }
            }
        }
    }
}

/// Without this, resin touches only after 16 000 steps.
const FAST: &str = "numerics.time_acceleration=400";

/// Build-up that breaks away.
const BRITTLE: [&str; 2] = [FAST, "materials.pin_secondary.strength=2 MPa"];
/// Debris that is gathered and spread over four cells.
const TRANSPORT: [&str; 2] = [FAST, "plateaus.transport_length=770 um"];
/// Wear by what plateaus slide on.
const COUNTERFACE: &str = "materials.pin_primary.wear_rate_against_secondary=1e-14 1/Pa";

/// Materials of their own for all that can touch, on a disc that wears.
const OWN_MATERIALS: [&str; 7] = [
    "materials.disc_primary.specific_wear_rate=2e-15 1/Pa",
    "materials.disc_secondary.youngs_modulus=3e10 Pa",
    "materials.disc_secondary.poisson_ratio=0.25",
    "materials.disc_secondary.specific_wear_rate=4e-14 1/Pa",
    "materials.pin_secondary.youngs_modulus=2e9 Pa",
    "materials.pin_secondary.poisson_ratio=0.3",
    "materials.pin_secondary.specific_wear_rate=8e-14 1/Pa",
];

/// Local debris, of which nothing is kept back.
fn local(parameters: &mut Parameters) {
    parameters.plateaus.debris = DebrisRule::Local;
    parameters.plateaus.captured_fraction = 1.0;
}

/// What a scene is for.
type Happens = fn(&Sample) -> bool;

fn plateaus_form_and_break(end: &Sample) -> bool {
    end.worn_resin > 0.0 && end.deposited_pin > 0.0 && end.deposited_disc > 0.0 && end.returned > 0.0
}

fn the_disc_wears_too(end: &Sample) -> bool {
    plateaus_form_and_break(end) && end.worn_disc > 0.0
}

fn plateaus_form_of_local_debris(end: &Sample) -> bool {
    end.worn_resin > 0.0 && end.deposited_pin > 0.0 && end.deposited_disc > 0.0 && end.emitted > 0.0
}

/// A round pin, whose rows begin and end in other columns, on the cells of the quick scene.
const ROUND: [&str; 4] = ["mesh.shape=disc", "mesh.pin_width=4 mm", "mesh.cell_size=200 um", "mesh.mean_radius=22 mm"];
const NO_FORMATION: [&str; 2] = [FAST, "plateaus.formation=false"];
const EXPONENTIAL: &[&str] = &["numerics.integrator=exponential"];
/// Of the disc alone.
const DISC_WEARS: &[&str] = &[OWN_MATERIALS[0]];

#[test]
fn the_quick_scene_with_every_option() {
    let break_up: Happens = plateaus_form_and_break;
    let local: Happens = plateaus_form_of_local_debris;
    let local_on_a_disc_that_wears: Happens = |end| plateaus_form_of_local_debris(end) && end.worn_disc > 0.0;
    let no_formation: Happens = |end| end.worn_resin > 0.0 && end.deposited_disc == 0.0;
    let no_formation_on_a_disc_that_wears: Happens = |end| end.worn_disc > 0.0 && end.deposited_disc == 0.0;
    let scenes: [(&[&[&str]], Happens); 13] = [
        (&[&[FAST]], local),
        (&[&BRITTLE], break_up),
        (&[&TRANSPORT], local),
        (&[&TRANSPORT, &BRITTLE[1..], &[COUNTERFACE]], break_up),
        (&[&ROUND, &[FAST]], local),
        (&[&ROUND, &BRITTLE], break_up),
        (&[&ROUND, &TRANSPORT, &OWN_MATERIALS], local_on_a_disc_that_wears),
        (&[&BRITTLE, &OWN_MATERIALS, EXPONENTIAL], the_disc_wears_too),
        (&[&TRANSPORT, &BRITTLE[1..], &OWN_MATERIALS], the_disc_wears_too),
        (&[&[FAST], &OWN_MATERIALS], local_on_a_disc_that_wears),
        (&[&[FAST], DISC_WEARS], local_on_a_disc_that_wears),
        (&[&NO_FORMATION], no_formation),
        (&[&NO_FORMATION, DISC_WEARS], no_formation_on_a_disc_that_wears),
    ];
    for (sets, happens) in scenes {
        Scene::quick(1500, &sets.concat()).agrees_for_all(happens);
    }
}

#[test]
fn a_time_acceleration_at_which_much_changes() {
    let sets = ["numerics.time_acceleration=1000", "numerics.integrator=exponential", "plateaus.captured_fraction=0.9"];
    Scene::quick(3000, &sets).agrees_for_all(plateaus_form_of_local_debris);
}

#[test]
fn a_pin_as_wide_as_the_ring() {
    let over_a_length = |parameters: &mut Parameters| {
        local(parameters);
        parameters.plateaus.transport_length =
            Some(3.0 * parameters.mesh.mean_radius() * parameters.mesh.column_angle());
    };
    Scene::random([9, 37, 37], over_a_length).agrees_for_all(plateaus_form_of_local_debris);
    Scene::random([9, 37, 37], local).agrees_for_all(plateaus_form_of_local_debris);
}

#[test]
fn rows_that_fill_no_strip_and_columns_that_no_number_of_workers_divides() {
    let change = |parameters: &mut Parameters| {
        parameters.materials.disc_primary.specific_wear_rate = 1e-15;
        parameters.materials.pin_secondary.specific_wear_rate = 9e-14;
        parameters.materials.disc_secondary.youngs_modulus = 2e10;
        local(parameters);
        parameters.plateaus.transport_length =
            Some(5.0 * parameters.mesh.mean_radius() * parameters.mesh.column_angle());
        parameters.integrator = Integrator::Exponential;
    };
    Scene::random([13, 211, 29], change)
        .agrees_for_all(|end| plateaus_form_of_local_debris(end) && end.worn_disc > 0.0);
}

#[test]
fn rows_that_fill_no_strip_and_columns_that_are_prime_in_the_plainest_case() {
    Scene::random([13, 211, 29], local).agrees_for_all(plateaus_form_of_local_debris);
}

#[test]
fn a_pin_of_one_column() {
    Scene::random([9, 31, 1], |_| ()).agrees_for_all(|end| end.deposited_disc > 0.0);
    // Nothing is ahead of a single column.
    Scene::random([9, 31, 1], local).agrees_for_all(|end| end.emitted > 0.0 && end.deposited_disc == 0.0);
}

#[test]
fn sectors_of_two_columns() {
    Scene::random([1, 16, 5], |_| ()).agrees_for_all(|end| end.deposited_disc > 0.0);
    Scene::random([1, 16, 5], local).agrees_for_all(|end| end.deposited_disc > 0.0);
}

#[test]
fn looking_changes_nothing() {
    for workers in [1, 3] {
        let scene = Scene::quick(150, &[&[FAST][..], &OWN_MATERIALS].concat());
        let compare = move || {
            let execution = Execution { workers, ..Execution::default() };
            let mut pair = [scene.start(execution), scene.start(execution)];
            for step in 0..150 {
                pair[0].advance_to(step).expect("a step");
                pair[0].sample().expect("a sample");
                pair[0].disc().expect("a disc");
            }
            differences(&mut pair, 150)
        };
        assert_eq!(within(PATIENCE, "two simulations", compare), []);
    }
}

#[test]
fn pressures_that_were_not_kept_are_not_reported() {
    for workers in [1, 3] {
        let scene = Scene::quick(150, &[FAST]);
        let compare = move || {
            let execution = Execution { workers, ..Execution::default() };
            let mut pair = [scene.start(execution), scene.start(execution)];
            pair[0].pass_to(149).expect("steps");
            // Threads that answered with an error give no other answers: asked of ones that are dropped.
            let mut passed = scene.start(execution);
            passed.pass_to(20).expect("steps");
            assert_eq!(passed.snapshot(&[Map::DiscHeight]).map(drop), Ok(()));
            assert_eq!(passed.snapshot(&Map::ALL).map(drop), Err(SimulationError::NotWatched { step: 20 }));
            let mut passed = scene.start(execution);
            passed.pass_to(20).expect("steps");
            assert_eq!(passed.sample().map(drop), Err(SimulationError::NotWatched { step: 20 }));
            differences(&mut pair, 150)
        };
        assert_eq!(within(PATIENCE, "two simulations", compare), []);
    }
}
