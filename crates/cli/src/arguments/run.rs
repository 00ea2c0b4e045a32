//! Command lines of the commands that make, show, check and mend run files, cores of the runs of a study, and arguments of words that
//! another program answers.

use std::ffi::OsString;
use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::simulation::Engine;
use plateau_run::ExecutionOptions;
use plateau_run::execution::cores;

/// Arguments of `plateau run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Run file to write, relative to the working directory; overrides the scene
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replace the run file if it exists
    #[arg(long)]
    pub force: bool,
    /// Go on with a run that was stopped or killed, from its last checkpoint
    #[arg(long)]
    pub resume: bool,
    /// Go on with a run beyond its end, to this time, such as "7200 s"
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub extend_to: Option<String>,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// Arguments of `plateau check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Print also the resolved scene, what is done to surfaces, and what of the model is needed and left out
    #[arg(long)]
    pub all: bool,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// A scene, with changes.
#[derive(Debug, Clone, Args)]
pub struct SceneArguments {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Set a key of the scene, such as operation.normal_force="20 N"; may be repeated
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    pub sets: Vec<String>,
    /// Threads that share the ring: a number or "auto"; overrides the scene
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = workers)]
    pub workers: Option<String>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// A value of `--workers`, which is checked here so that the message names what was typed.
fn workers(text: &str) -> Result<String, &'static str> {
    match text.parse::<NonZeroU64>() {
        Err(_) if text != "auto" => Err("expected an integer, at least 1, or \"auto\""),
        _ => Ok(text.to_owned()),
    }
}

/// How a run is carried out, which does not show in its results, but that the two engines round differently.
#[derive(Debug, Args)]
pub struct ExecutionArguments {
    /// What takes the steps: the fast engine, or the plain model, cell by cell, which is slow and rounds otherwise
    #[arg(long, value_name = "NAME", value_enum, default_value_t = EngineArgument::Fast)]
    pub engine: EngineArgument,
    /// Instruction set of the kernels, for tests; the widest that the processor has unless given
    #[arg(long, value_name = "NAME", value_parser = instruction_set)]
    pub isa: Option<InstructionSet>,
    /// Keep each worker on a core of its own, as far as there are enough; a single worker is left free
    #[arg(long)]
    pub pin: bool,
}

impl ExecutionArguments {
    /// As the library takes them.
    pub fn options(&self) -> ExecutionOptions {
        let engine = match self.engine {
            EngineArgument::Fast => Engine::Fast,
            EngineArgument::Plain => Engine::Plain,
        };
        ExecutionOptions { engine, instructions: self.isa, pin: self.pin }
    }
}

/// A value of `--engine`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EngineArgument {
    /// On any number of workers.
    Fast,
    /// On one worker.
    Plain,
}

/// A value of `--isa`.
fn instruction_set(text: &str) -> Result<InstructionSet, String> {
    let available = || InstructionSet::available().map(InstructionSet::name);
    let found = InstructionSet::available().find(|instructions| instructions.name() == text);
    found.ok_or_else(|| format!("this processor has {}", available().collect::<Vec<_>>().join(", ")))
}

/// Arguments of `plateau watch`.
#[derive(Debug, Args)]
pub struct WatchArguments {
    /// Run file, which need not be there yet
    pub run: PathBuf,
    /// Print the state once and end
    #[arg(long)]
    pub once: bool,
    /// Give up after so many seconds without a new sample; unless given, after 10 s without a file, else never
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = seconds)]
    pub timeout: Option<u64>,
}

/// A value of `--timeout`.
fn seconds(text: &str) -> Result<u64, &'static str> {
    text.parse::<NonZeroU64>().map(NonZeroU64::get).map_err(|_| "expected whole seconds, at least 1")
}

/// Arguments of `plateau verify`.
#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Run files
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Print one JSON document instead of text: an array with an object for each file
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `plateau repair`.
#[derive(Debug, Args)]
pub struct RepairArguments {
    /// Run files
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Repair also what another machine has written a moment ago, or what another user may still be writing
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `plateau summary`.
#[derive(Debug, Args)]
pub struct SummaryArguments {
    /// Run file, also of a run that goes on or was stopped
    pub run: PathBuf,
    /// Print JSON, as it does anyway
    #[arg(long)]
    pub json: bool,
}

/// Runs at a time and threads of each.
#[derive(Debug, Args)]
pub struct CoresArguments {
    /// Runs at a time; as many as there are cores for their workers unless given
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub jobs: Option<u32>,
    /// Threads of each run
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    pub workers: u32,
}

impl CoresArguments {
    /// Runs at a time: as many as are asked for, else as there are cores for their workers.
    pub fn runs_at_a_time(&self) -> usize {
        self.jobs.map_or_else(|| (cores() / self.workers()).max(1), |jobs| jobs as usize)
    }

    /// Threads of each run.
    pub fn workers(&self) -> usize {
        self.workers as usize
    }
}

/// Arguments that are handed over as they are; `--help` among them tells what they may be.
#[derive(Debug, Args)]
pub struct HandedArguments {
    /// What the answering program takes; --help tells
    #[arg(value_name = "ARGUMENTS", trailing_var_arg = true, allow_hyphen_values = true)]
    pub arguments: Vec<OsString>,
}
