//! Times one step of the model on the paper's mesh and prints machine, build and settings beside the result.

use std::time::Instant;

use plateau_core::material::{Material, Materials};
use plateau_core::mesh::Mesh;
use plateau_core::parameters::{DebrisPool, Integrator, Parameters, PlateauRules};
use plateau_core::simulation::Simulation;
use plateau_core::state::{Base, InitialSurfaces};
use plateau_core::surface::{Body, FibreSynthesis, HeightSynthesis};
use serde::Serialize;

/// Steps before the first measurement: one revolution, so that every column has been under the pin.
const WARM_UP: u64 = 2764;
/// Steps of one measurement.
const STEPS: u32 = 4000;
/// Measurements.
const REPEATS: usize = 7;

/// What was measured, on what.
#[derive(Debug, Serialize)]
struct Report {
    machine: String,
    cores: usize,
    build: &'static str,
    mesh: String,
    settings: &'static str,
    microseconds_per_step_min: f64,
    microseconds_per_step_median: f64,
    microseconds_per_step_max: f64,
    nanoseconds_per_cell_median: f64,
    load_evaluations_per_step: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let parameters = paper()?;
    let cells = parameters.mesh.pin_cells();
    let mesh = &parameters.mesh;
    let mesh_text = format!("{} x {} pin on {} columns", mesh.rows(), mesh.pin_columns(), mesh.disc_columns());
    let surfaces = surfaces(&parameters.mesh)?;
    let mut simulation = Simulation::new(parameters, surfaces)?;
    for _ in 0..WARM_UP {
        simulation.advance()?;
    }
    let mut times = Vec::with_capacity(REPEATS);
    let mut evaluations = 0;
    for _ in 0..REPEATS {
        let start = Instant::now();
        for _ in 0..STEPS {
            simulation.advance()?;
            evaluations += simulation.contact().iterations();
        }
        times.push(start.elapsed().as_secs_f64() * 1e6 / f64::from(STEPS));
    }
    times.sort_by(f64::total_cmp);
    let report = Report {
        machine: machine(),
        cores: std::thread::available_parallelism().map_or(0, usize::from),
        build: if cfg!(debug_assertions) { "debug" } else { "release" },
        mesh: mesh_text,
        settings: "cermet scene, time_acceleration 100, load_tolerance 1e-9, float64, one worker",
        microseconds_per_step_min: times[0],
        microseconds_per_step_median: times[REPEATS / 2],
        microseconds_per_step_max: times[REPEATS - 1],
        nanoseconds_per_cell_median: times[REPEATS / 2] * 1e3 / cells as f64,
        load_evaluations_per_step: f64::from(evaluations) / (f64::from(STEPS) * REPEATS as f64),
    };
    println!("{}", serde_json::to_string_pretty(&report)?);
    Ok(())
}

/// The processor's name.
fn machine() -> String {
    let information = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = information.lines().find_map(|line| line.strip_prefix("model name"));
    name.map_or_else(|| std::env::consts::ARCH.into(), |name| name.trim_start_matches([' ', '\t', ':']).into())
}

/// Tables 1 and 2 of the paper.
fn paper() -> Result<Parameters, Box<dyn std::error::Error>> {
    let pin = Material { youngs_modulus: 1e9, poisson_ratio: 0.27, specific_wear_rate: 5e-14 };
    let disc = Material { youngs_modulus: 1e11, specific_wear_rate: 0.0, ..pin };
    Ok(Parameters {
        mesh: Mesh::new(80, 2764, 161, 20e-3, 24e-3)?,
        normal_force: 47.0,
        angular_velocity: 850.0 * std::f64::consts::TAU / 60.0,
        steps: u64::MAX,
        foundation_height: 50e-6,
        load_tolerance: 1e-9,
        materials: Materials {
            disc_primary: disc,
            disc_secondary: disc,
            pin_primary: pin,
            pin_secondary: pin,
            pin_resin: Material { youngs_modulus: 1e5, ..pin },
            wear_height: 5e-6,
        },
        plateaus: PlateauRules {
            captured_fraction: 0.06,
            pad_share: 0.5,
            debris_pool: DebrisPool::Contact,
            formation: true,
            destruction: true,
        },
        time_acceleration: 100.0,
        integrator: Integrator::Explicit,
    })
}

/// The surfaces of the shipped scene cermet.toml.
fn surfaces(mesh: &Mesh) -> Result<InitialSurfaces, Box<dyn std::error::Error>> {
    let disc = HeightSynthesis { seed: 1, rms_height: 3e-6, correlation_length: 120e-6, patch: Some(8e-3) };
    let disc_height = disc.field(Body::Disc, mesh)?.into_iter().map(|height| height.min(3e-6)).collect();
    let fibres = FibreSynthesis { seed: 2, fibre_fraction: 0.3, fibre_length: 400e-6, fibre_width: 100e-6 };
    let pin_base = fibres.base(mesh)?;
    let pin = HeightSynthesis { seed: 3, rms_height: 0.5e-6, correlation_length: 100e-6, patch: None };
    let pin_height = pin.field(Body::Pin, mesh)?.into_iter().zip(&pin_base);
    let pin_height =
        pin_height.map(|(height, base)| if *base == Base::None { height + 8e-6 } else { height }).collect();
    Ok(InitialSurfaces { disc_height, pin_height, pin_base })
}
