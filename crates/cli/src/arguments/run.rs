//! The command lines of `plateau run` and `plateau check`: a scene, and how it is run.

use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::simulation::Engine;
use plateau_run::ExecutionOptions;

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
