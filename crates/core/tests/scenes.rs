//! Small simulations whose outcome is known, and random ones whose outcome must obey the model's laws.

use std::f64::consts::TAU;
use std::fmt::Debug;
use std::sync::Arc;

use plateau_core::model::cycle::{Cycle, Interpolation, Node};
use plateau_core::model::emission::Emission;
use plateau_core::model::friction::{Friction, FrictionLaw};
use plateau_core::model::mesh::{Mesh, Outline, columns_of_disc};
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters, PlateauRules};
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_core::model::thermal::{Coating, Disc, Factor, Pin as ThermalPin, Substance, Thermal};
use plateau_core::observe::Sample;
use plateau_core::simulation::{Engine, Execution, Simulation};

/// How much of a test that repeats itself is done: `few` as it goes without saying, `all` with `PLATEAU_LONG=1`.
pub fn few_or_all<T: Debug>(few: T, all: T) -> T {
    if std::env::var_os("PLATEAU_LONG").is_some() {
        return all;
    }
    println!("{few:?}, with PLATEAU_LONG=1 {all:?}");
    few
}

/// κ of the pin's plateaus in the paper, 1/Pa.
pub const WEAR_RATE: f64 = 5e-14;

/// The paper's operation on a mesh of these sizes with the paper's cells, without plateaus.
pub fn wear_only(rows: usize, disc_columns: usize, pin_columns: usize) -> Parameters {
    let mesh = Mesh::new(rows, disc_columns, pin_columns, 20e-3, 20e-3 + rows as f64 * 50e-6).expect("a valid mesh");
    let plateaus = PlateauRules { formation: false, destruction: false, ..PlateauRules::pool(0.0) };
    Parameters { mesh, normal_force: 10.0, plateaus, ..Parameters::paper() }
}

/// Stiffness per area of the pair of pin primary and disc primary in the paper's materials, Pa/m.
pub fn primary_stiffness(parameters: &Parameters) -> f64 {
    // Written out anew from model 4.1, not taken from the program.
    let compliance = (1.0 - 0.27 * 0.27) / 1e9 + (1.0 - 0.27 * 0.27) / 1e11;
    1.0 / (compliance * parameters.foundation_height)
}

/// Share of the worn volume that the rounding of heights of this size (m) explains: each step rounds the heights of the pin
/// and of the disc under it, once for wear and once for a deposit, and those of the whole disc are added up.
pub fn balance_rounding(parameters: &Parameters, highest: f64, sample: &Sample) -> f64 {
    let mesh = &parameters.mesh;
    let area = 2.0 * mesh.pin_area() * sample.step as f64 + mesh.disc_area() + mesh.pin_area();
    let worn = sample.worn_pin + sample.worn_resin + sample.worn_disc;
    if worn > 0.0 { f64::EPSILON * highest * area / worn } else { 0.0 }
}

/// A pin of fibre alone with these heights on a disc with these heights.
pub fn all_primary(parameters: Parameters, disc_height: Vec<f64>, pin_height: Vec<f64>) -> Simulation {
    let pin_base = vec![Base::Primary; pin_height.len()];
    Simulation::new(parameters, InitialSurfaces { disc_height, pin_height, pin_base }).expect("surfaces that fit")
}

/// A reproducible stream of numbers in 0..1 (SplitMix64), for surfaces whose statistics do not matter.
#[derive(Debug, Clone)]
pub struct Stream(pub u64);

impl Stream {
    /// The next number in 0..1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((word ^ (word >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next normal number, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * (1.0 - self.uniform()).ln()).sqrt(), TAU * self.uniform());
        radius * angle.cos()
    }
}

/// A rough disc and a pin of fibres in resin, all drawn from one seed.
pub fn random_surfaces(mesh: &Mesh, seed: u64) -> InitialSurfaces {
    let mut stream = Stream(seed);
    InitialSurfaces {
        disc_height: (0..mesh.disc_cells()).map(|_| 6e-6 * (stream.uniform() - 1.0)).collect(),
        pin_height: (0..mesh.pin_cells()).map(|_| 2e-6 * stream.uniform()).collect(),
        pin_base: (0..mesh.pin_cells())
            .map(|_| if stream.uniform() < 0.4 { Base::Primary } else { Base::Resin })
            .collect(),
    }
}

/// Both bodies perfectly flat, the pin of one base.
pub fn flat(mesh: &Mesh, base: Base) -> InitialSurfaces {
    InitialSurfaces {
        disc_height: vec![0.0; mesh.disc_cells()],
        pin_height: vec![0.0; mesh.pin_cells()],
        pin_base: vec![base; mesh.pin_cells()],
    }
}

/// A simulation on [`random_surfaces`] of this seed.
pub fn start(parameters: &Parameters, seed: u64, execution: Execution) -> Simulation {
    let surfaces = random_surfaces(&parameters.mesh, seed);
    Simulation::with_execution(parameters.clone(), surfaces, execution).expect("surfaces that fit")
}

/// Both ways to take steps.
pub fn engines() -> [Execution; 2] {
    [Engine::Fast, Engine::Plain].map(|engine| Execution { engine, ..Execution::default() })
}

/// Any scene of the model on a small mesh, with every option, drawn from a seed.
pub fn random_scene(seed: u64, debris: DebrisRule) -> Parameters {
    let mut stream = Stream(seed ^ 0xA5A5_5A5A_0F0F_F0F0);
    let mut between = |low: f64, high: f64| low + (high - low) * stream.uniform();
    let (rows, disc_columns) = (between(1.0, 20.0) as usize, between(2.0, 40.0) as usize);
    let pin_columns = 1 + (between(0.0, 1.2).min(0.999) * disc_columns as f64) as usize;
    let mut parameters = wear_only(rows, disc_columns, pin_columns);
    parameters.normal_force = 10.0_f64.powf(between(-2.0, 2.0)) * rows as f64 * pin_columns as f64 / 100.0;
    parameters.time_acceleration = 10.0_f64.powf(between(0.0, 2.7));
    let often = |number: f64| number < 0.8;
    parameters.plateaus = PlateauRules {
        debris,
        captured_fraction: between(0.0, 1.3).min(1.0),
        captured_resin_fraction: if often(between(0.0, 1.0)) { None } else { Some(between(0.0, 1.0)) },
        pad_share: between(0.0, 1.0),
        formation: often(between(0.0, 0.9)),
        destruction: often(between(0.0, 1.2)),
        transport_length: None,
    };
    parameters.integrator = if between(0.0, 1.0) < 0.5 { Integrator::Explicit } else { Integrator::Exponential };
    let materials = &mut parameters.materials;
    materials.wear_height = between(0.2e-6, 6e-6);
    // Fibre wears: else heights tie, and rounding decides which cells touch.
    materials.pin_primary.specific_wear_rate = between(1e-15, 1e-13);
    materials.pin_secondary = materials.pin_primary;
    if between(0.0, 1.0) < 0.6 {
        materials.disc_primary.specific_wear_rate = between(-1e-14, 1e-14).max(0.0);
        materials.disc_secondary = materials.disc_primary;
    }
    if between(0.0, 1.0) < 0.5 {
        materials.pin_secondary.specific_wear_rate = between(1e-15, 2e-13);
        materials.pin_secondary.youngs_modulus = 4e8;
        materials.disc_secondary.specific_wear_rate = between(-1e-14, 2e-14).max(0.0);
        materials.disc_secondary.youngs_modulus = 5e9;
    }
    if parameters.stiffness_number() > 1.0 {
        // The explicit rule is unstable there, so that the rounding of either engine grows.
        parameters.integrator = Integrator::Exponential;
    }
    if between(0.0, 1.0) < 0.4 {
        parameters.cycle = random_cycle(&parameters, &mut between);
    }
    if between(0.0, 1.0) < 0.6 {
        add_dissipation(&mut parameters, &mut between);
    }
    add_findings(&mut parameters, &mut between);
    parameters
}

/// What experiments ask for: wear by counterface, a strength of build-up, a transport length, a braking torque.
fn add_findings(parameters: &mut Parameters, between: &mut impl FnMut(f64, f64) -> f64) {
    let mut sometimes = |parts: f64| between(0.0, 1.0) < parts;
    let [by_pin, by_build_up, breaks, travels, brakes] = [0.3, 0.3, 0.3, 0.5, 0.3].map(&mut sometimes);
    let materials = &mut parameters.materials;
    materials.pin_primary_against_secondary = by_pin.then(|| between(1e-15, 1e-13));
    materials.pin_secondary_against_secondary = by_build_up.then(|| between(-1e-14, 1e-13).max(0.0));
    materials.strength = breaks.then(|| 10.0_f64.powf(between(4.0, 9.0)));
    if parameters.plateaus.debris == DebrisRule::Local && travels {
        let column = parameters.mesh.column_width();
        parameters.plateaus.transport_length = Some(between(0.3, 7.0) * column);
        parameters.plateaus.captured_resin_fraction = None;
    }
    if brakes && parameters.friction.is_some_and(|friction| friction.maximum.is_finite()) {
        parameters.by_torque = true;
        parameters.normal_force *= 0.3 * parameters.mesh.mean_radius();
        if parameters.cycle.is_some() {
            parameters.cycle = random_cycle(parameters, between);
        }
    }
    let factor = parameters.thermal.as_ref().map_or(1.0, |_| LARGEST_FACTOR);
    if parameters.with_wear_rate_factor(factor).stiffness_number() > 1.0 {
        parameters.integrator = Integrator::Exponential;
    }
}

/// Any scene of the model under a round pin: on a mesh of its own, with the other options of [`random_scene`].
pub fn random_round_scene(seed: u64, debris: DebrisRule) -> Parameters {
    let mut stream = Stream(seed ^ 0x0DD0_0DD0_1234_4321);
    let rectangle = random_scene(seed, debris);
    let rows = 4 + (14.0 * stream.uniform()) as usize;
    let mesh = round_mesh(rows, 1.0 + stream.uniform(), 0.6 + 0.4 * stream.uniform());
    let normal_force = rectangle.normal_force * mesh.present_cells() as f64 / rectangle.mesh.present_cells() as f64;
    let mut plateaus = rectangle.plateaus;
    plateaus.transport_length =
        plateaus.transport_length.map(|length| length * mesh.column_width() / rectangle.mesh.column_width());
    // Steps are of another length on this mesh, so that a cycle would no longer fit.
    Parameters { mesh, normal_force, plateaus, cycle: None, ..rectangle }
}

/// A short ring of so many rows of 50 µm, with columns `per_row` times as wide as rows are high, under a round pin that takes
/// this part of the track's width.
pub fn round_mesh(rows: usize, per_row: f64, part: f64) -> Mesh {
    let width = rows as f64 * 50e-6;
    // Near the axis.
    let (mean_radius, radius) = (0.8 * width, 0.5 * part * width);
    let disc_columns = (TAU * mean_radius / (per_row * 50e-6)).round();
    let pin_columns = columns_of_disc(radius, mean_radius, TAU / disc_columns).expect("a circle beside the axis");
    let [inner, outer] = [mean_radius - 0.5 * width, mean_radius + 0.5 * width];
    let mesh = Mesh::new(rows, disc_columns as usize, pin_columns as usize, inner, outer).expect("a valid mesh");
    mesh.with_outline(Outline::Disc { radius }).expect("an outline that fits")
}

/// Friction, by one law or by one for each status; often with heat, whose factors change much from revolution to
/// revolution. Emission with it or without it.
fn add_dissipation(parameters: &mut Parameters, between: &mut impl FnMut(f64, f64) -> f64) {
    let half = |between: &mut dyn FnMut(f64, f64) -> f64| between(0.0, 1.0) < 0.5;
    if between(0.0, 1.0) < 0.8 {
        let mut law =
            || FrictionLaw { pressure_coefficient: between(0.0, 0.6), shear_strength: between(-1e5, 2e6).max(0.0) };
        let [primary, secondary, resin] = [law(), law(), law()];
        let maximum = if half(between) { f64::INFINITY } else { between(0.3, 2.0) };
        let friction = Friction::of(primary, maximum);
        parameters.friction = Some(if half(between) { friction } else { Friction { secondary, resin, ..friction } });
        if between(0.0, 1.0) < 0.7 {
            parameters.thermal = Some(Arc::new(random_thermal(parameters, between)));
            let is_stiff = parameters.with_wear_rate_factor(LARGEST_FACTOR).stiffness_number() > 1.0;
            parameters.integrator = if is_stiff { Integrator::Exponential } else { parameters.integrator };
        }
    }
    if half(between) {
        parameters.emission = Some(Emission {
            pm10_fraction: between(0.0, 1.0),
            pm25_fraction: between(0.0, 0.5),
            number_per_mass: 1e15,
            pin_density: between(1e3, 5e3),
            disc_density: between(2e3, 9e3),
            number_factor: random_factor(between),
        });
    }
}

/// No factor is larger.
const LARGEST_FACTOR: f64 = 3.0;
/// K.
const AMBIENT: f64 = 296.15;

/// A factor that changes within some kelvin above the ambient, and is not 1 there.
fn random_factor(between: &mut impl FnMut(f64, f64) -> f64) -> Factor {
    let points = [-1.0, 0.5, 10.0].map(|excess| (AMBIENT + excess, between(0.3, LARGEST_FACTOR)));
    Factor::new(points.to_vec()).expect("temperatures that rise")
}

/// Small bodies that a load of this size warms by some kelvin.
fn random_thermal(parameters: &Parameters, between: &mut impl FnMut(f64, f64) -> f64) -> Thermal {
    let mut substance = || Substance {
        conductivity: 10.0_f64.powf(between(-1.0, 2.0)),
        density: between(1e3, 1e4),
        specific_heat: between(200.0, 1000.0),
    };
    let [disc, pin, coating] = [substance(), substance(), substance()];
    let size = parameters.normal_force.sqrt();
    let is_coated = between(0.0, 1.0) < 0.5;
    let coating = Coating { thickness: 10.0_f64.powf(between(-6.0, -3.0)), substance: coating };
    Thermal {
        ambient: AMBIENT,
        disc: Disc {
            substance: disc,
            area: 1e-4 * size,
            thickness: between(1e-4, 1e-2),
            cooling: between(-0.1, 0.4).max(0.0) * size,
            cooling_per_speed: between(-2e-3, 4e-3).max(0.0) * size,
            coating: is_coated.then_some(coating),
        },
        pin: ThermalPin { substance: pin, area: 5e-5, length: between(1e-3, 2e-2), cooling: between(0.0, 0.05) },
        wear_rate_factor: if between(0.0, 1.0) < 0.7 { random_factor(between) } else { Factor::default() },
        friction_factor: if between(0.0, 1.0) < 0.7 { random_factor(between) } else { Factor::default() },
    }
}

/// Ramps, jumps, lifted pauses and stops about the load and speed of a scene, in intervals of some steps, played again
/// and again.
fn random_cycle(parameters: &Parameters, between: &mut impl FnMut(f64, f64) -> f64) -> Option<Arc<Cycle>> {
    let (mut nodes, mut time) = (Vec::new(), 0.0);
    let mut value = |largest: f64| (between(-0.5, 1.0) * largest).max(0.0);
    for _ in 0..8 {
        let node = |time, force, speed| Node::new(time, force, speed);
        nodes.push(node(time, value(2.0 * parameters.normal_force), value(2.0 * parameters.angular_velocity)));
        // Sometimes two rows have one time.
        time += value(10.0 * parameters.step_time());
    }
    let interpolation = if value(1.0) < 0.6 { Interpolation::Linear } else { Interpolation::Hold };
    Cycle::new(&nodes, interpolation, 10_000).ok().filter(|cycle| cycle.constant().is_none()).map(Arc::new)
}
