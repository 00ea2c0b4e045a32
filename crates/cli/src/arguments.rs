//! The command line.

use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use plateau_core::kernel::InstructionSet;

/// How a pin of friction material and a rough, coated brake disc wear into each other.
#[derive(Debug, Parser)]
#[command(name = "plateau", version, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene and write a run file
    #[command(
        after_help = "Example:\n  plateau run data/scenes/quick.toml -o quick.h5 --set operation.normal_force=\"20 N\""
    )]
    Run(RunArguments),
    /// Check a scene without running it: what it resolves to, needs and costs
    #[command(after_help = "Example:\n  plateau check data/scenes/cermet.toml")]
    Check(CheckArguments),
}

/// A scene, with changes.
#[derive(Debug, Args)]
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
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// How a run is carried out, which does not show in its results.
#[derive(Debug, Args)]
pub struct ExecutionArguments {
    /// Instruction set of the kernels, for tests; the widest that the processor has unless given
    #[arg(long, value_name = "NAME", value_parser = instruction_set)]
    pub isa: Option<InstructionSet>,
    /// Keep each worker on a core of its own, as far as there are enough; a single worker is left free
    #[arg(long)]
    pub pin: bool,
}

/// A value of `--isa`.
fn instruction_set(text: &str) -> Result<InstructionSet, String> {
    let available = || InstructionSet::available().map(InstructionSet::name);
    let found = InstructionSet::available().find(|instructions| instructions.name() == text);
    found.ok_or_else(|| format!("this processor has {}", available().collect::<Vec<_>>().join(", ")))
}

/// Arguments of `plateau check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}
