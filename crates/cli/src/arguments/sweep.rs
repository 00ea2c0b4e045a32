//! The command line of `plateau sweep`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use plateau_io::study::plan::Plan;
use plateau_run::sweep::{self, Part};

use crate::arguments::{CoresArguments, HandedArguments};
use crate::failure::{Failure, of_study};

/// What to do with a study.
#[derive(Debug, Subcommand)]
pub enum SweepCommand {
    /// Show the design, the number of runs and what they will cost, without running any
    #[command(after_help = "Example:\n  plateau sweep plan data/studies/published/factors.toml")]
    Plan(PlanArguments),
    /// Make the runs that are not there yet, several at a time
    #[command(after_help = "Examples:\n  plateau sweep run data/studies/published/factors.toml\n  \
                      plateau sweep run data/studies/published/factors.toml --task 3/10\n  \
                      plateau sweep run data/studies/published/factors.toml --run 54 -o r54.h5\n\n\
                      It can be stopped and started again at any time, and several times at once, on several machines that share a folder: \
                      no run is made twice.")]
    Run(SweepRunArguments),
    /// Print the scene of a run, whole, as `plateau run` takes it
    #[command(after_help = "Example:\n  plateau sweep scene data/studies/published/factors.toml 54\n\n\
                      To change it: plateau sweep scene STUDY 54 > r54.toml, then plateau run r54.toml -o r54.h5")]
    Scene(SweepSceneArguments),
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

/// A study, and where its results are.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Folder of the results, relative to the working directory; overrides `directory` of the study
    #[arg(long, value_name = "DIR")]
    pub directory: Option<PathBuf>,
}

impl StudyArguments {
    /// Reads the study and makes its design.
    pub fn load(&self) -> Result<Plan, Failure> {
        sweep::load(&self.study, self.directory.as_deref()).map_err(of_study)
    }
}

#[derive(Debug, Args)]
pub struct PlanArguments {
    #[command(flatten)]
    pub study: StudyArguments,
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

#[derive(Debug, Args)]
pub struct SweepRunArguments {
    #[command(flatten)]
    pub study: StudyArguments,
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
    /// Keep the run file of every run in `runs` of the study's folder; runs that have none are made again
    #[arg(long)]
    pub keep_files: bool,
    /// Make this run alone, whether or not it is there, and write its run file; nothing of the study changes
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..),
          conflicts_with_all = ["jobs", "task", "max_failures", "retry", "keep_files"])]
    pub run: Option<u32>,
    /// Run file of --run; unless given such as run-0054.h5 in the working directory
    #[arg(short, long, value_name = "FILE", requires = "run")]
    pub output: Option<PathBuf>,
    /// Replace that file if it exists
    #[arg(long, requires = "run")]
    pub force: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct SweepSceneArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Number of the run
    #[arg(allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub run: u32,
}

/// A value of `--task`.
fn task(text: &str) -> Result<Part, &'static str> {
    let expected = "expected I/N with 1 <= I <= N, such as 3/10";
    let (number, count) = text.split_once('/').ok_or(expected)?;
    let parse = |text: &str| text.trim().parse().map_err(|_| expected);
    let task = Part { number: parse(number)?, count: parse(count)? };
    if (1..=task.count).contains(&task.number) { Ok(task) } else { Err(expected) }
}

#[derive(Debug, Args)]
pub struct SlurmArguments {
    #[command(flatten)]
    pub study: StudyArguments,
    /// Tasks of the array; as many as take about an hour each unless given
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub tasks: Option<u32>,
    /// Cores of each task, on which it makes as many runs at a time
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    pub cores: u32,
    /// Keep the run file of every run, as `sweep run --keep-files`
    #[arg(long)]
    pub keep_files: bool,
    /// Script to write; the study's name with .sbatch in the working directory unless given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replace the script if it exists
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub struct CollectArguments {
    #[command(flatten)]
    pub study: StudyArguments,
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
