//! Times several things in turn, A B C A B C .., so that all share what else goes on on the machine.

use std::time::Duration;

use crate::case::MeshSize;
use crate::document::{Measurement, Spread};
use crate::error::BenchError;

/// Something that makes steps.
pub trait Runner {
    /// Makes so many steps; the time that they took.
    fn advance(&mut self, steps: u64) -> Result<Duration, BenchError>;

    /// Mean over all steps so far, where it is known.
    fn load_evaluations_per_step(&self) -> Option<f64> {
        None
    }
}

/// What takes part, and under which name.
pub struct Entry {
    /// What sets it apart from the others.
    pub name: String,
    /// Its mesh.
    pub mesh: MeshSize,
    /// Threads that share the ring.
    pub workers: usize,
    /// Instruction set of its kernels.
    pub instructions: String,
    /// It.
    pub runner: Box<dyn Runner>,
}

/// How much is measured.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// Blocks of steps of each entry.
    pub repeats: usize,
    /// How long a block of the slowest entry on a mesh takes, about.
    pub block: Duration,
    /// Steps before the first block; one revolution if none are given, so that the pin has met every column.
    pub warm_up: Option<u64>,
}

/// Warms up all entries, then times them in turn. Entries on equal meshes make equal numbers of steps.
pub fn race(mut entries: Vec<Entry>, pace: Pace) -> Result<Vec<Measurement>, BenchError> {
    let mut steps = Vec::with_capacity(entries.len());
    for entry in &mut entries {
        let Entry { name, mesh, workers, runner, .. } = entry;
        eprintln!("warming up: {name}, {mesh}, workers: {workers}");
        let warm_up = pace.warm_up.unwrap_or(mesh.disc_columns as u64).max(1);
        runner.advance(warm_up)?;
        let trial = (warm_up / 20).max(1);
        let step = runner.advance(trial)?.as_secs_f64() / trial as f64;
        steps.push((pace.block.as_secs_f64() / step.max(1e-9)).max(1.0) as u64);
    }
    let blocks: Vec<u64> = entries
        .iter()
        .map(|entry| {
            let same = entries.iter().zip(&steps).filter(|(other, _)| other.mesh == entry.mesh);
            same.map(|(_, steps)| *steps).min().unwrap_or(1)
        })
        .collect();

    let mut times = vec![Vec::with_capacity(pace.repeats); entries.len()];
    for repeat in 1..=pace.repeats {
        eprintln!("round {repeat} of {}", pace.repeats);
        for ((entry, steps), times) in entries.iter_mut().zip(&blocks).zip(&mut times) {
            times.push(entry.runner.advance(*steps)?.as_secs_f64() * 1e6 / *steps as f64);
        }
    }
    let results = entries.into_iter().zip(blocks).zip(times);
    Ok(results.map(|((entry, steps), times)| measurement(&entry, steps, times)).collect())
}

fn measurement(entry: &Entry, steps_per_block: u64, times: Vec<f64>) -> Measurement {
    let microseconds_per_step = Spread::of(&times);
    Measurement {
        name: entry.name.clone(),
        mesh: entry.mesh,
        workers: entry.workers,
        instructions: entry.instructions.clone(),
        steps_per_block,
        microseconds_per_step,
        nanoseconds_per_cell: microseconds_per_step.median * 1e3 / entry.mesh.pin_cells() as f64,
        load_evaluations_per_step: entry.runner.load_evaluations_per_step(),
        raw_microseconds_per_step: times,
    }
}
