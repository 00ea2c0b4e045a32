//! Times several things in turn, A B C A B C .., so that all share what else goes on on the machine.

use std::time::Duration;

use plateau_core::simulation::Exchange;
use serde::Serialize;

use crate::case::{MeshSize, Outcome, Source};

/// Something that makes steps.
pub trait Runner {
    /// Makes so many steps and returns the time that they took.
    fn advance(&mut self, steps: u64) -> Outcome<Duration>;

    /// Returns the load evaluations per step, mean over all steps so far; none where they are not known.
    fn load_evaluations_per_step(&self) -> Option<f64> {
        None
    }

    /// Returns the exchanges of each worker with the others so far; empty where they are not known.
    fn exchanges(&self) -> Vec<Exchange> {
        Vec::new()
    }
}

/// Something that is timed.
pub struct Entry {
    /// Name that sets it apart from the others.
    pub name: String,
    /// Place of the entry that it is compared with, which may be its own.
    pub against: usize,
    /// Counts of cells of its mesh.
    pub mesh: MeshSize,
    /// Threads that share the ring.
    pub workers: usize,
    /// Simulation or peer that makes its steps.
    pub runner: Box<dyn Runner>,
}

/// Number and time of the blocks of steps, and steps before them.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Pace {
    /// Blocks of steps of each entry.
    pub repeats: usize,
    /// Time of a block of the slowest entry on a mesh, about.
    pub block: Duration,
    /// Steps before the first block; one revolution if none are given, so that the pin has met every column.
    pub warm_up: Option<u64>,
}

/// A benchmark under way.
pub struct Session {
    /// The scene, on the mesh from which the benchmark starts.
    pub source: Source,
    /// Counts of cells of that mesh.
    pub mesh: MeshSize,
    /// Number and time of the blocks of steps, and steps before them.
    pub pace: Pace,
    /// Numbers of workers to measure, increasing.
    pub workers: Vec<usize>,
    /// True if the benchmark is only tried, on a small mesh: its times mean nothing.
    pub quick: bool,
}

/// Times of one [`Entry`], with what it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measurement {
    pub name: String,
    pub against: usize,
    pub mesh: MeshSize,
    pub workers: usize,
    /// Steps of a block.
    pub steps_per_block: u64,
    /// Load evaluations per step, mean over all steps; none where they are not known.
    pub load_evaluations_per_step: Option<f64>,
    /// Time of a step in every block, µs, in the order of measurement.
    pub microseconds_per_step: Vec<f64>,
    /// Sharing of the work of all blocks among its workers; none of one alone.
    pub sharing: Option<Sharing>,
}

/// Sharing of the work among several workers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sharing {
    /// Bytes of columns that crossed boundaries between sectors in a step.
    pub halo_bytes_per_step: f64,
    /// Part of the time in which a worker waited for others, mean over the workers.
    pub waiting: f64,
    /// Mean over the workers of the time in which one worked over that of the one that worked longest.
    pub balance: f64,
}

impl Sharing {
    /// Computes the sharing from exchanges before and after so many steps, which took such a time; none for one worker alone.
    pub fn of(before: &[Exchange], after: &[Exchange], steps: u64, time: Duration) -> Option<Self> {
        let bytes: u64 = after.iter().zip(before).map(|(after, before)| after.halo_bytes - before.halo_bytes).sum();
        let waited = after.iter().zip(before).map(|(after, before)| (after.waited - before.waited).as_secs_f64());
        let worked: Vec<f64> = waited.map(|waited| 1.0 - waited / time.as_secs_f64()).collect();
        let mean = worked.iter().sum::<f64>() / worked.len() as f64;
        (worked.len() > 1).then(|| Self {
            halo_bytes_per_step: bytes as f64 / steps as f64,
            waiting: 1.0 - mean,
            balance: mean / worked.iter().copied().fold(0.0, f64::max),
        })
    }
}

impl Measurement {
    /// Time of a cell of the pin over that of `other`: ratios of blocks that were measured next to each other, so that what
    /// slowed both down cancels.
    pub fn ratio_to(&self, other: &Self) -> Spread {
        let cells = other.mesh.pin_cells() as f64 / self.mesh.pin_cells() as f64;
        let pairs = self.microseconds_per_step.iter().zip(&other.microseconds_per_step);
        Spread::of(&pairs.map(|(this, other)| cells * this / other).collect::<Vec<_>>())
    }
}

/// Least, middle and largest of several values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Least.
    pub minimum: f64,
    /// Middle; of an even number of values the mean of the two in the middle.
    pub median: f64,
    /// Largest.
    pub maximum: f64,
}

impl Spread {
    /// Computes the spread of these values; NaN if there are none.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(f64::NAN);
        let last = sorted.len().saturating_sub(1);
        Self { minimum: at(0), median: 0.5 * (at(last / 2) + at(last.div_ceil(2))), maximum: at(last) }
    }
}

/// Warms up all entries, then times them in turn. Entries on equal meshes make equal numbers of steps.
pub fn race(mut entries: Vec<Entry>, pace: Pace) -> Outcome<Vec<Measurement>> {
    let mut steps = Vec::with_capacity(entries.len());
    for Entry { name, mesh, workers, runner, .. } in &mut entries {
        eprintln!("warming up: {name}, {mesh}, workers: {workers}");
        let warm_up = pace.warm_up.unwrap_or(mesh.disc_columns as u64).max(1);
        runner.advance(warm_up)?;
        let trial = (warm_up / 20).max(1);
        let step = runner.advance(trial)?.as_secs_f64() / trial as f64;
        steps.push((*mesh, (pace.block.as_secs_f64() / step.max(1e-9)).max(1.0) as u64));
    }
    let of_mesh = |mesh| steps.iter().filter(|(other, _)| *other == mesh).map(|(_, steps)| *steps).min().unwrap_or(1);
    let blocks: Vec<u64> = entries.iter().map(|entry| of_mesh(entry.mesh)).collect();

    let before: Vec<_> = entries.iter().map(|entry| entry.runner.exchanges()).collect();
    let mut times = vec![Vec::with_capacity(pace.repeats); entries.len()];
    for repeat in 1..=pace.repeats {
        eprintln!("round {repeat} of {}", pace.repeats);
        for ((entry, steps), times) in entries.iter_mut().zip(&blocks).zip(&mut times) {
            times.push(entry.runner.advance(*steps)?.as_secs_f64() * 1e6 / *steps as f64);
        }
    }
    let mut measurements = Vec::with_capacity(entries.len());
    for (((entry, steps_per_block), microseconds_per_step), before) in
        entries.into_iter().zip(blocks).zip(times).zip(before)
    {
        let time = microseconds_per_step.iter().sum::<f64>() * steps_per_block as f64 * 1e-6;
        let steps = steps_per_block * pace.repeats as u64;
        let Entry { name, against, mesh, workers, runner } = entry;
        measurements.push(Measurement {
            name,
            against,
            mesh,
            workers,
            steps_per_block,
            load_evaluations_per_step: runner.load_evaluations_per_step(),
            microseconds_per_step,
            sharing: Sharing::of(&before, &runner.exchanges(), steps, Duration::from_secs_f64(time)),
        });
    }
    Ok(measurements)
}

#[cfg(test)]
#[path = "../tests/unit/race.rs"]
mod tests;
