//! What all benchmarks of a step have in common: options, and the document that their results go into.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use plateau_io::units::{self, Dimension};

use crate::case::{MeshSize, Source, mesh_size};
use crate::document::{Benchmark, Document, Settings};
use crate::error::BenchError;
use crate::race::Pace;

/// Options of every benchmark.
#[derive(Debug, Args)]
pub struct Options {
    /// Scene file (TOML); the paper's scene if none is given
    pub scene: Option<PathBuf>,
    /// Set a key of the scene; numerics.time_acceleration is 1 unless it is set here; may be repeated
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    pub sets: Vec<String>,
    /// Time for which the pin has worn in before anything is timed, such as "2000 s": how much a step has to do changes with it
    #[arg(long, value_name = "TIME", default_value = "0 s", value_parser = time)]
    pub worn_in: f64,
    /// Blocks of steps of everything that is timed; the blocks are measured in turn
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: Option<u32>,
    /// About how long a block takes, ms
    #[arg(long, value_name = "MS", value_parser = clap::value_parser!(u32).range(1..))]
    pub block_ms: Option<u32>,
    /// Only look whether it runs: small meshes, few steps; the numbers mean nothing
    #[arg(long)]
    pub quick: bool,
    /// Write the results to a file, as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// A time on the command line, s.
fn time(text: &str) -> Result<f64, String> {
    units::parse(text, Dimension::Time).map_err(|error| error.to_string())
}

/// Options of a benchmark that is made for several numbers of workers.
#[derive(Debug, Args)]
pub struct WorkerOptions {
    #[command(flatten)]
    options: Options,
    /// Numbers of workers, such as 1,2,4; by default 1, 2, 4 .. and all cores
    #[arg(long, value_name = "N,..", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..))]
    workers: Vec<u16>,
}

/// A benchmark under way.
#[derive(Debug)]
pub struct Session {
    /// The scene, on the mesh from which the benchmark starts.
    pub source: Source,
    /// That mesh.
    pub mesh: MeshSize,
    /// How much is measured.
    pub pace: Pace,
    /// Numbers of workers to measure, increasing.
    pub workers: Vec<usize>,
    /// Only a look at whether it runs.
    pub quick: bool,
    /// Results, none yet.
    pub document: Document,
    /// Where they are to be written.
    pub json: Option<PathBuf>,
}

impl Options {
    /// Begins a benchmark, of one worker.
    pub fn begin(self, benchmark: Benchmark) -> Result<Session, BenchError> {
        let mut source = Source::new(self.scene, self.sets, self.worn_in);
        if self.quick {
            source = source.on(MeshSize::QUICK)?;
        }
        let pace = Pace {
            repeats: self.repeats.unwrap_or(if self.quick { 3 } else { 21 }) as usize,
            block: Duration::from_millis(self.block_ms.unwrap_or(if self.quick { 1 } else { 200 }).into()),
            warm_up: self.quick.then_some(20),
        };
        let parameters = source.parameters()?;
        let settings = Settings {
            scene: source.name(),
            sets: source.sets.clone(),
            worn_in: source.worn_in,
            time_acceleration: Some(parameters.time_acceleration),
            repeats: pace.repeats,
            block_milliseconds: Some(pace.block.as_secs_f64() * 1e3),
            warm_up_steps: pace.warm_up,
            quick: self.quick,
        };
        let document = Document::begin(benchmark, settings);
        let (mesh, workers) = (mesh_size(&parameters), vec![1]);
        Ok(Session { mesh, source, pace, workers, quick: self.quick, document, json: self.json })
    }
}

impl WorkerOptions {
    /// Begins a benchmark.
    pub fn begin(self, benchmark: Benchmark) -> Result<Session, BenchError> {
        let mut session = self.options.begin(benchmark)?;
        let cores = session.document.machine.cores;
        session.workers = workers(&self.workers, cores);
        Ok(session)
    }
}

impl Session {
    /// The meshes from that of the scene to a full pad, with the same cells: 1, 4 and 16 times as many, and the pad.
    pub fn meshes(&self) -> Vec<MeshSize> {
        let grown = [1, 2, 4].map(|factor| self.mesh.times(factor));
        if self.quick { grown[..2].to_vec() } else { [&grown[..], &[MeshSize::FULL_PAD]].concat() }
    }
}

/// The numbers asked for, or 1, 2, 4 .. and all cores.
fn workers(asked: &[u16], cores: usize) -> Vec<usize> {
    let mut workers: Vec<usize> = if asked.is_empty() {
        let powers = std::iter::successors(Some(1), |workers| Some(2 * workers)).take_while(|workers| *workers < cores);
        powers.chain([cores]).collect()
    } else {
        asked.iter().map(|workers| usize::from(*workers)).collect()
    };
    workers.sort_unstable();
    workers.dedup();
    workers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_worker_is_always_measured() {
        for cores in [1, 2, 6, 64] {
            let found = workers(&[], cores);
            assert_eq!(found[0], 1, "{cores} cores: {found:?}");
            assert!(found.is_sorted_by(|a, b| a < b) && found[found.len() - 1] <= cores, "{cores} cores: {found:?}");
        }
    }
}
