//! A scene, and for how many steps it runs.

use std::path::PathBuf;

use crate::case::{MeshSize, Source, mesh_size, repository};
use crate::error::BenchError;

/// The scenes in `data/scenes`, but for the pooled baseline: a debris pool is a variant of each.
pub const SHIPPED: [&str; 6] =
    ["cermet.toml", "cermet-10.toml", "cermet-100.toml", "measured.toml", "micrograph.toml", "quick.toml"];

/// About how many cells a run updates: it then takes some tenths of a second.
const CELLS: usize = 500_000_000;
/// How many cells take about as long as what a step does besides.
const CELLS_BESIDE: usize = 1000;
/// Revolutions of a run that only shows whether it runs.
const QUICK_REVOLUTIONS: usize = 3;

/// A scene that runs for a while.
#[derive(Debug)]
pub struct Subject {
    /// The scene.
    pub source: Source,
    /// Its mesh.
    pub mesh: MeshSize,
    /// Steps of a run: whole revolutions.
    pub steps: u64,
    /// Physical time of a step as the scene is, s.
    pub step_time: f64,
    /// Physical time of a step without acceleration, s.
    pub unaccelerated_step_time: f64,
    /// Young's modulus of the pin's fibres, Pa.
    pub fibre_modulus: f64,
}

impl Subject {
    /// A scene on its own mesh.
    pub fn new(source: Source, quick: bool) -> Result<Self, BenchError> {
        let parameters = source.parameters()?;
        let mesh = mesh_size(&parameters);
        let revolutions = if quick {
            QUICK_REVOLUTIONS
        } else {
            (CELLS / (mesh.pin_cells() + CELLS_BESIDE) / mesh.disc_columns).max(1)
        };
        let step_time = parameters.step_time();
        let unaccelerated_step_time = step_time / parameters.time_acceleration;
        let steps = (revolutions * mesh.disc_columns) as u64;
        let fibre_modulus = parameters.materials.pin_primary.youngs_modulus;
        Ok(Self { source, mesh, steps, step_time, unaccelerated_step_time, fibre_modulus })
    }

    /// File name of the scene.
    pub fn name(&self) -> String {
        self.source.name()
    }
}

/// Path of a scene in `data/scenes`.
pub fn shipped(name: &str) -> PathBuf {
    repository().join("data/scenes").join(name)
}
