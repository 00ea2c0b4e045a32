//! The program `plateau-bench`: how long a step of the model takes, as a table in Markdown.
//!
//! ```text
//! case            scene -> parameters and surfaces, on meshes of several sizes
//! steps, peers    what is timed: a step and its parts; the same step in Python (peers/step.py, a process of its own)
//! race            times several things in turn
//! table           the table, with machine, build and settings below it
//! ```

mod case;
mod peers;
mod race;
mod steps;
mod table;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::{Args, Parser};
use plateau_io::process;
use plateau_io::units::{self, Dimension};

use case::{MeshSize, Outcome, Source, mesh_size, of_file};
use race::{Pace, Session};
use table::Results;

/// How long a step of Plateau takes, and why.
#[derive(Debug, Parser)]
#[command(name = "plateau-bench", version, max_term_width = 100, arg_required_else_help = true)]
enum Arguments {
    /// Time a step for every instruction set and number of workers
    Kernel(WorkerOptions),
    /// Time a step for every number of workers on meshes from the scene's to a full pad
    Scaling(WorkerOptions),
    /// Time a step with optional parts of the model and of the output on and off
    Parts(Options),
    /// Time the same step written in Python, as loops that Numba compiles; installs Numba into .venv-peers in the checkout
    Peers(Options),
}

/// Options of every benchmark.
#[derive(Debug, Args)]
struct Options {
    /// Scene file (TOML); the paper's scene if none is given
    scene: Option<PathBuf>,
    /// Set a key of the scene; numerics.time_acceleration is 1 unless it is set here; may be repeated
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    sets: Vec<String>,
    /// Time for which the pin has worn in before anything is timed, such as "2000 s": how much a step has to do changes with it
    #[arg(long, value_name = "TIME", default_value = "0 s", value_parser = time)]
    worn_in: f64,
    /// Blocks of steps of everything that is timed; the blocks are measured in turn
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    repeats: Option<u32>,
    /// About how long a block takes, ms
    #[arg(long, value_name = "MS", value_parser = clap::value_parser!(u32).range(1..))]
    block_ms: Option<u32>,
    /// Only look whether it runs: small meshes, few steps; the numbers mean nothing
    #[arg(long)]
    quick: bool,
    /// Write the times of all blocks to a file, too, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Options of a benchmark that is made for several numbers of workers.
#[derive(Debug, Args)]
struct WorkerOptions {
    #[command(flatten)]
    options: Options,
    /// Numbers of workers, such as 1,2,4; by default 1, 2, 4 .. and all cores
    #[arg(long, value_name = "N,..", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..))]
    workers: Vec<u16>,
}

/// A time on the command line, s.
fn time(text: &str) -> Result<f64, String> {
    units::parse(text, Dimension::Time)
}

impl Options {
    fn begin(&self, asked: &[u16]) -> Outcome<Session> {
        let mut source = Source::new(self.scene.clone(), self.sets.clone(), self.worn_in);
        if self.quick {
            source = source.on(MeshSize::QUICK)?;
        }
        let [repeats, block] = if self.quick { [3, 1] } else { [21, 200] };
        let pace = Pace {
            repeats: self.repeats.unwrap_or(repeats) as usize,
            block: Duration::from_millis(self.block_ms.unwrap_or(block).into()),
            warm_up: self.quick.then_some(20),
        };
        let mesh = mesh_size(&source.parameters()?);
        Ok(Session { source, mesh, pace, workers: workers(asked), quick: self.quick })
    }
}

/// The numbers asked for, or 1, 2, 4 .. and all cores.
fn workers(asked: &[u16]) -> Vec<usize> {
    let cores = process::cores();
    let powers = std::iter::successors(Some(1), |workers| Some(2 * workers)).take_while(|workers| *workers < cores);
    let mut workers: Vec<usize> = asked.iter().map(|workers| usize::from(*workers)).collect();
    if workers.is_empty() {
        workers = powers.chain([cores]).collect();
    }
    workers.sort_unstable();
    workers.dedup();
    workers
}

fn perform(arguments: &Arguments) -> Outcome<()> {
    let (name, options, workers, perform): (_, _, &[u16], fn(&Session) -> Outcome<_>) = match arguments {
        Arguments::Kernel(asked) => ("kernel", &asked.options, &asked.workers, steps::kernel),
        Arguments::Scaling(asked) => ("scaling", &asked.options, &asked.workers, steps::scaling),
        Arguments::Parts(options) => ("parts", options, &[], steps::parts),
        Arguments::Peers(options) => ("peers", options, &[], peers::peers),
    };
    let session = options.begin(workers)?;
    // Before anything is timed: the load of the machine is that of others.
    let mut results = Results::begin(name, &session);
    (results.measurements, results.agreements) = perform(&session)?;
    if let Some(path) = &options.json {
        fs::write(path, serde_json::to_string_pretty(&results)? + "\n").map_err(of_file(path))?;
    }
    print!("{}", results.markdown());
    Ok(())
}

fn main() -> ExitCode {
    match perform(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("plateau-bench: {error}");
            ExitCode::FAILURE
        }
    }
}
