//! The command line of `plateau sweep`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use plateau_run::sweep::Part;

use crate::arguments::{CoresArguments, HandedArguments};

/// What to do with a study.
#[derive(Debug, Subcommand)]
pub enum SweepCommand {
    /// Show the design, the number of runs and what they will cost, without running any
    #[command(after_help = "Example:\n  plateau sweep plan data/studies/published/factors.toml")]
    Plan(PlanArguments),
    /// Make the runs that are not there yet, several at a time
    #[command(after_help = "Examples:\n  plateau sweep run data/studies/published/factors.toml\n  \
                      plateau sweep run data/studies/published/factors.toml --task 3/10\n\n\
                      It can be stopped and started again at any time, and several times at once, on several machines that share a folder: \
                      no run is made twice.")]
    Run(SweepRunArguments),
    /// Write a batch script that makes the runs as a Slurm job array
    #[command(
        after_help = "Example:\n  plateau sweep slurm data/studies/published/factors.toml --tasks 4 -o factors.sbatch\n  \
                      sbatch factors.sbatch"
    )]
    Slurm(SlurmArguments),
    /// Put all results into one HDF5 file and a table
    #[command(after_help = "Example:\n  plateau sweep collect data/studies/published/factors.toml")]
    Collect(CollectArguments),
    /// Tell what the factors do: effects, analysis of variance, figures
    #[command(disable_help_flag = true)]
    Effects(HandedArguments),
    /// Tell what responses are expected to be where no run was made
    #[command(disable_help_flag = true)]
    Predict(HandedArguments),
    /// Find the settings at which responses are best
    #[command(disable_help_flag = true)]
    Optimize(HandedArguments),
    /// Tell which part of a response's variation each factor has
    #[command(disable_help_flag = true)]
    Sensitivity(HandedArguments),
    /// Take in responses that were measured or computed elsewhere
    #[command(disable_help_flag = true)]
    Import(HandedArguments),
}

/// Arguments of `plateau sweep plan`.
#[derive(Debug, Args)]
pub struct PlanArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Runs at a time, for the estimates; one on each core unless given
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub jobs: Option<u32>,
    /// Write every run of the design as a table in CSV
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Replace that file if it exists
    #[arg(long, requires = "csv")]
    pub force: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `plateau sweep run`.
#[derive(Debug, Args)]
pub struct SweepRunArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    #[command(flatten)]
    pub cores: CoresArguments,
    /// Make only every N-th run, beginning with the I-th: one task of N that share the study
    #[arg(long, value_name = "I/N", allow_hyphen_values = true, value_parser = task)]
    pub task: Option<Part>,
    /// Stop when so many runs have failed; unless given, the others go on
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub max_failures: Option<u32>,
    /// Make runs again that failed before, or that did not keep a series which a response asks for
    #[arg(long)]
    pub retry: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// A value of `--task`.
fn task(text: &str) -> Result<Part, &'static str> {
    let expected = "expected I/N with 1 <= I <= N, such as 3/10";
    let (number, count) = text.split_once('/').ok_or(expected)?;
    let parse = |text: &str| text.trim().parse().map_err(|_| expected);
    let task = Part { number: parse(number)?, count: parse(count)? };
    if (1..=task.count).contains(&task.number) { Ok(task) } else { Err(expected) }
}

/// Arguments of `plateau sweep slurm`.
#[derive(Debug, Args)]
pub struct SlurmArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Tasks of the array; as many as take about an hour each unless given
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub tasks: Option<u32>,
    /// Cores of each task, on which it makes as many runs at a time
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    pub cores: u32,
    /// Script to write; the study's name with .sbatch in the working directory unless given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replace the script if it exists
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `plateau sweep collect`.
#[derive(Debug, Args)]
pub struct CollectArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Folder for results.h5 and results.csv; the study's own unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files of these names that were not collected from a study, or that have more finished runs than there are now
    #[arg(long)]
    pub force: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}
