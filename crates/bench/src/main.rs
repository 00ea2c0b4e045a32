//! Times one step of the model on the paper's mesh and prints machine, build and settings beside the result.

use std::path::Path;
use std::time::Instant;

use plateau_core::simulation::Simulation;
use plateau_io::{scene, surface};
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
    settings: String,
    microseconds_per_step_min: f64,
    microseconds_per_step_median: f64,
    microseconds_per_step_max: f64,
    nanoseconds_per_cell_median: f64,
    load_evaluations_per_step: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/cermet.toml");
    let scene = scene::load(&path, &[])?;
    let mesh = &scene.parameters.mesh;
    let cells = mesh.pin_cells();
    let mesh_text = format!("{} x {} pin on {} columns", mesh.rows(), mesh.pin_columns(), mesh.disc_columns());
    let mut simulation = Simulation::new(scene.parameters.clone(), surface::load(&scene)?.surfaces)?;
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
        settings: format!(
            "cermet.toml, time_acceleration {}, load_tolerance {:e}, float64, {}, one worker",
            scene.parameters.time_acceleration,
            scene.parameters.load_tolerance,
            simulation.instructions().name()
        ),
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
