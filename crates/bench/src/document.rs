//! Results as JSON: what was measured, on what, with what.

use std::fs;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::case::MeshSize;
use crate::circumstances::{Build, Machine};
use crate::error::BenchError;

/// Which benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Benchmark {
    /// One step by instruction set and number of workers.
    Kernel,
    /// Number of workers against size of the mesh.
    Scaling,
    /// Optional parts of the model.
    Parts,
    /// Runs of the program with optional parts on and off.
    Costs,
    /// The same step in Python.
    Peers,
}

impl Benchmark {
    /// All of them, in the order in which they are reported.
    pub const ALL: [Self; 5] = [Self::Kernel, Self::Scaling, Self::Parts, Self::Costs, Self::Peers];

    /// Name of the subcommand.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kernel => "kernel",
            Self::Scaling => "scaling",
            Self::Parts => "parts",
            Self::Costs => "costs",
            Self::Peers => "peers",
        }
    }
}

/// Results of one benchmark.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Version of this format.
    pub format: u32,
    /// Which benchmark.
    pub benchmark: Benchmark,
    /// When it began, seconds since 1970-01-01 UTC.
    pub began: u64,
    /// The machine.
    pub machine: Machine,
    /// The program.
    pub build: Build,
    /// What was asked for.
    pub settings: Settings,
    /// Times, in the order of the race.
    pub measurements: Vec<Measurement>,
    /// Runs of the program, scene by scene in the order of the race (costs).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<RunCost>,
    /// How well the peers agree with us (peers).
    pub agreements: Vec<Agreement>,
    /// What a reader must know besides.
    pub notes: Vec<String>,
}

/// Version of the format of [`Document`].
const FORMAT: u32 = 1;

/// Name of what is measured on meshes that do not depend on the number of workers.
pub const STRONG: &str = "strong";
/// Name of what is measured on meshes that are longer the more workers there are.
pub const WEAK: &str = "weak";

/// What was asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// File name of the scene, or of all.
    pub scene: String,
    /// Changes of the scene.
    pub sets: Vec<String>,
    /// Physical time for which the pin had worn in, s.
    #[serde(default)]
    pub worn_in: f64,
    /// m, where it is the same for all that is measured.
    pub time_acceleration: Option<f64>,
    /// Blocks of each entry.
    pub repeats: usize,
    /// About how long a block of the slowest entry on a mesh takes, ms; none where a block is a run.
    pub block_milliseconds: Option<f64>,
    /// Steps before the first block; none: one revolution.
    pub warm_up_steps: Option<u64>,
    /// Only a look at whether it runs: the numbers mean nothing.
    pub quick: bool,
}

/// Least, middle and largest of several values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Least.
    pub minimum: f64,
    /// Middle; of an even number of values the mean of the two in the middle.
    pub median: f64,
    /// Largest.
    pub maximum: f64,
}

impl Spread {
    /// Of these values; not a number if there are none.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(f64::NAN);
        let middle = sorted.len() / 2;
        let below = if sorted.len().is_multiple_of(2) { middle.saturating_sub(1) } else { middle };
        Self { minimum: at(0), median: 0.5 * (at(below) + at(middle)), maximum: at(sorted.len().saturating_sub(1)) }
    }
}

/// Times of one entry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// What sets it apart from the others.
    pub name: String,
    /// Its mesh.
    pub mesh: MeshSize,
    /// Threads that share the ring.
    pub workers: usize,
    /// Instruction set of the kernels.
    pub instructions: String,
    /// Steps of a block.
    pub steps_per_block: u64,
    /// Time of a step.
    pub microseconds_per_step: Spread,
    /// Median time of a step over the cells of the pin.
    pub nanoseconds_per_cell: f64,
    /// Mean over all steps, where it is known.
    pub load_evaluations_per_step: Option<f64>,
    /// Time of a step in every block, in the order of measurement.
    pub raw_microseconds_per_step: Vec<f64>,
}

impl Measurement {
    /// How many times as long as `other` this takes: spread of the ratios of blocks that were measured next to each
    /// other, so that what slowed both down cancels.
    pub fn ratio_to(&self, other: &Self) -> Spread {
        ratios(&self.raw_microseconds_per_step, &other.raw_microseconds_per_step)
    }
}

/// Spread of the ratios of values that were measured next to each other.
pub fn ratios(these: &[f64], others: &[f64]) -> Spread {
    Spread::of(&these.iter().zip(others).map(|(this, other)| this / other).collect::<Vec<_>>())
}

/// What runs of the program cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunCost {
    /// File name of the scene.
    pub scene: String,
    /// Its mesh.
    pub mesh: MeshSize,
    /// What sets these runs apart from others of the scene.
    pub name: String,
    /// Name of those that they are set against.
    pub against: String,
    /// Steps of a run.
    pub steps: u64,
    /// Wall time from before the first step until the run file is complete, over the steps.
    pub microseconds_per_step: Spread,
    /// The same of every run, in the order of measurement.
    pub raw_microseconds_per_step: Vec<f64>,
    /// Largest memory of the process in every run, bytes; none where the system does not tell.
    pub peak_memory_bytes: Vec<u64>,
    /// Size of the run file, bytes.
    pub file_bytes: u64,
}

/// How well a peer agrees with us: largest difference over largest value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Which peer.
    pub peer: String,
    /// Its versions.
    pub versions: String,
    /// m of the comparison.
    pub time_acceleration: f64,
    /// Steps compared.
    pub steps: usize,
    /// Of the displacement after each step.
    pub displacement: f64,
    /// Of the contact area after each step.
    pub contact_area: f64,
    /// Of the debris pool after each step; none where debris has no pool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pool: Option<f64>,
    /// Of the volume deposited until after each step; none in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deposited: Option<f64>,
    /// Of the heights of disc and pin after the last step.
    pub heights: f64,
}

impl Document {
    /// Results of a benchmark that begins now, on this machine: none yet.
    pub fn begin(benchmark: Benchmark, settings: Settings) -> Self {
        Self {
            format: FORMAT,
            benchmark,
            began: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs()),
            machine: Machine::this(),
            build: Build::this(),
            settings,
            measurements: Vec::new(),
            runs: Vec::new(),
            agreements: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Reads what [`Document::write`] wrote.
    pub fn read(path: &Path) -> Result<Self, BenchError> {
        let text = fs::read_to_string(path).map_err(BenchError::file(path))?;
        serde_json::from_str(&text).map_err(|source| BenchError::NoResults { path: path.to_owned(), source })
    }

    /// Writes the document as JSON.
    pub fn write(&self, path: &Path) -> Result<(), BenchError> {
        let no_results = |source| BenchError::NoResults { path: path.to_owned(), source };
        let text = serde_json::to_string_pretty(self).map_err(no_results)?;
        fs::write(path, text + "\n").map_err(BenchError::file(path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(Spread::of(&[3.0, 1.0, 8.0]), Spread { minimum: 1.0, median: 3.0, maximum: 8.0 });
        assert_eq!(Spread::of(&[3.0, 1.0, 8.0, 4.0]), Spread { minimum: 1.0, median: 3.5, maximum: 8.0 });
    }
}
