//! Cost of the runs of a study, before any is made.

use std::time::Duration;

use plateau_core::simulation::{Execution, Simulation};
use plateau_io::scene::{Scene, memory_estimate};
use plateau_io::study::plan::Plan;
use plateau_io::surface;

use super::error::SweepError;
use super::resolved::{refuse_without_scene, run_in_words};
use super::warnings::{SceneWarnings, of_surfaces};
use crate::execution::time_per_step;

/// Runs whose steps are counted.
const COUNTED: usize = 64;
/// Runs whose first steps are timed.
const TIMED: usize = 3;
/// Time for which they are tried.
const TRIAL: Duration = Duration::from_millis(150);

/// Cost of one run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Estimate {
    /// Memory of the largest run, bytes.
    pub memory: u64,
    /// Wall time of a run, mean, s.
    pub mean_time: f64,
    /// Wall time of the longest, s.
    pub longest_time: f64,
    /// Warnings of the surfaces of the runs that were tried.
    pub warnings: SceneWarnings,
}

impl Estimate {
    /// Looks at some of the runs.
    pub fn of(plan: &Plan) -> Result<Self, SweepError> {
        refuse_without_scene(plan)?;
        let (mut per_cell, mut warnings) = (0.0_f64, SceneWarnings::default());
        for number in spread(plan.runs(), TIMED) {
            let scene = scene(plan, number)?;
            let start = std::time::Instant::now();
            let loaded = surface::load(&scene).map_err(SweepError::input)?;
            let making = start.elapsed().as_secs_f64();
            warnings.add(of_surfaces(&scene, &loaded));
            let surfaces = loaded.surfaces;
            let execution = Execution { workers: 1, ..Execution::default() };
            let mut simulation =
                Simulation::with_execution(scene.parameters.clone(), surfaces, execution).map_err(SweepError::input)?;
            let step = time_per_step(&mut simulation, scene.steps, TRIAL).map_err(SweepError::failed)?;
            // Surfaces are a part of the run that does not grow with its steps.
            let steps = scene.steps.max(1) as f64;
            per_cell = per_cell.max((step + making / steps) / scene.parameters.mesh.pin_cells() as f64);
        }
        let (mut memory, mut times) = (0, Vec::new());
        for number in spread(plan.runs(), COUNTED) {
            let scene = scene(plan, number)?;
            memory = memory.max(memory_estimate(&scene));
            times.push(scene.steps as f64 * scene.parameters.mesh.pin_cells() as f64 * per_cell);
        }
        let mean_time = times.iter().sum::<f64>() / times.len().max(1) as f64;
        Ok(Self { memory, mean_time, longest_time: times.iter().copied().fold(0.0, f64::max), warnings })
    }
}

/// The scene of a run.
fn scene(plan: &Plan, number: usize) -> Result<Scene, SweepError> {
    let failed = |error| SweepError::Input(format!("{}:\n{error}", run_in_words(plan, number)));
    plan.scene(&plan.run(number)).map_err(failed)
}

/// Some of so many numbers from 1 on, evenly spread, with the first and the last.
fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let taken = most.min(count);
    (0..taken).map(move |at| if taken == 1 { 1 } else { 1 + at * (count - 1) / (taken - 1) })
}

#[cfg(test)]
#[path = "../../tests/unit/sweep/estimate.rs"]
mod tests;
