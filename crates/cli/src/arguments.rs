//! The command line.

mod accuracy;
mod answers;
mod cores;
mod fit;
mod model;
mod new;
mod plot;
mod reading;
mod surface;
mod sweep;

use std::ffi::OsString;
use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::simulation::Engine;
use plateau_io::text::{odd_character, shown_on_one_line};
use plateau_io::units::{self, Dimension};
use plateau_run::ExecutionOptions;

use crate::failure::Failure;

pub use accuracy::AccuracyArguments;
pub use answers::{ImportArguments, LimitOn, OptimizeArguments, PredictArguments};
pub use cores::CoresArguments;
pub use fit::FitArguments;
pub use model::Terms;
pub use new::NewArguments;
pub use plot::PlotArguments;
pub use reading::{ReadArguments, as_options};
pub use surface::SurfaceArguments;
pub use sweep::{
    CollectArguments, EffectsArguments, PlanArguments, SensitivityArguments, SlurmArguments, SweepCommand,
    SweepRunArguments,
};

/// How a pin of friction material and a rough, coated brake disc wear into each other.
#[derive(Debug, Parser)]
#[command(name = "plateau", version, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Say errors only: no warnings, notes, progress
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say also what is done to surfaces
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// Refuses what a terminal would obey, and names of several lines: they stand in messages and tables. Values of `--set` may have
/// line breaks, as TOML has.
///
/// # Errors
/// [`Failure::Input`] with the argument.
pub fn refuse_odd_characters(arguments: impl Iterator<Item = OsString>) -> Result<(), Failure> {
    let mut is_value = false;
    for argument in arguments.skip(1) {
        let text = argument.to_string_lossy();
        let is_set = is_value || text.starts_with("--set=");
        is_value = text == "--set";
        let text = if is_set { text.replace(['\n', '\t'], " ") } else { text.into_owned() };
        if let Some(found) = odd_character(&text) {
            return Err(Failure::input(format_args!(
                "the argument \"{}\" has {found}; take it out, rename the file if it is one",
                shown_on_one_line(&text)
            )));
        }
    }
    Ok(())
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented scene to begin with, from a measured surface and the rig's numbers
    #[command(
        after_help = "Example:\n  plateau new mine.toml --disc data/surfaces/afm_256x256.sdf --radius \"30 mm\" --load \"30 N\""
    )]
    New(NewArguments),
    /// Run a scene and write a run file
    #[command(
        after_help = "Example:\n  plateau run data/scenes/quick.toml -o quick.h5 --set operation.normal_force=\"20 N\""
    )]
    Run(RunArguments),
    /// Check a scene without running it: what it resolves to, needs and costs
    #[command(after_help = "Example:\n  plateau check data/scenes/cermet.toml")]
    Check(CheckArguments),
    /// Draw the figures of a run, or of several side by side
    #[command(
        after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  plateau plot quick.h5 -o figures"
    )]
    Plot(PlotArguments),
    /// Make one HTML page of a run, or of several to compare: numbers, charts, maps
    #[command(after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  \
                      plateau report quick.h5 -o quick.html")]
    Report(ReportArguments),
    /// Follow a run in the terminal: state, progress, contact area
    #[command(after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  plateau watch quick.h5")]
    Watch(WatchArguments),
    /// Write a run file for other programs: tables, NumPy arrays, ParaView's grids
    #[command(after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  \
                      plateau export quick.h5 --to csv\n  plateau export quick.h5 --to vtk -o quick-vtk")]
    Export(ExportArguments),
    /// Measure how exact a scene's runs are against the time they take
    #[command(after_help = "Example:\n  plateau accuracy data/scenes/quick.toml --budget 20s -o quick-accuracy")]
    Accuracy(AccuracyArguments),
    /// Make many runs of a scene with other values, and tell what these values do
    #[command(subcommand, after_help = "Example:\n  plateau sweep plan data/studies/pad-properties.toml")]
    Sweep(SweepCommand),
    /// Find the values of keys with which runs give what was measured
    #[command(after_help = "Example:\n  plateau fit data/studies/fit-captured-fraction.toml --plan\n\n\
                      Without --plan the fit is made. It can be stopped and started again at any time: runs that are there are not made again.")]
    Fit(FitArguments),
    /// Describe surfaces by the parameters of ISO 25178-2, draw and convert them
    #[command(after_help = "Examples:\n  plateau surface data/surfaces/afm_256x256.sdf --plot afm.png\n  \
                      plateau surface --prepare data/scenes/quick.toml")]
    Surface(SurfaceArguments),
    /// Tell whether run files still hold what was written
    #[command(after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  plateau verify quick.h5")]
    Verify(VerifyArguments),
    /// Make the file of a killed run readable by every program
    #[command(
        after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  plateau repair quick.h5\n\n\
                      A file that was closed in good order is not touched. To go on with the run: plateau run SCENE --resume"
    )]
    Repair(RepairArguments),
    /// Print the JSON Schema of scenes, with which editors complete and check them
    #[command(
        after_help = "Example:\n  plateau schema\n\nFor an editor: plateau schema > scene.schema.json; see docs/scenes.md."
    )]
    Schema,
    /// Print what lets a shell complete commands, options and files on the Tab key
    #[command(after_help = "Example:\n  plateau completions bash\n\n\
                      Once for all: plateau completions bash > ~/.local/share/bash-completion/completions/plateau\n\
                      For zsh, fish and others see docs/recipes.md.")]
    Completions(CompletionsArguments),
    /// Print a manual page, or write all of them
    #[command(after_help = "Example:\n  plateau man run\n\n\
                      To read it: plateau man run | man -l -")]
    Man(ManArguments),
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

/// Arguments of `plateau check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// Arguments of `plateau report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Run files, also of runs that go on or were stopped; at most 8, of which the others are compared with the first
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Page to write; named like the run file, or "report.html" for several, unless given
    #[arg(short, long, value_name = "HTML")]
    pub output: Option<PathBuf>,
    /// Replace the page if it exists
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `plateau completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}

/// Arguments of `plateau man`.
#[derive(Debug, Args)]
pub struct ManArguments {
    /// Command whose page is printed; that of the program unless given
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub page: Option<String>,
    /// Folder for the pages of the program and of every command, made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace pages that exist
    #[arg(long, requires = "output")]
    pub force: bool,
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

/// A time of the run, s.
fn run_time(text: &str) -> Result<f64, String> {
    let time = quantity(text, Dimension::Time)?;
    if time >= 0.0 {
        Ok(time)
    } else {
        Err(format!("{text} is before the start of a run, expected a time such as \"100 s\""))
    }
}

/// A quantity of this dimension, SI.
fn quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    units::parse(text.trim(), dimension).map_err(|error| error.to_string())
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

/// Arguments of `plateau export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Run file, also of a run that goes on or was stopped
    pub run: PathBuf,
    /// Format of the files
    #[arg(long, value_name = "FORMAT", alias = "format")]
    pub to: ExportFormat,
    /// File to write, for vtk the folder, made if it is not there; named like the run file unless given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Write the maps too; for csv, as the other formats have them anyway
    #[arg(long)]
    pub maps: bool,
    /// Replace files that exist
    #[arg(long)]
    pub force: bool,
}

/// A format of other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ExportFormat {
    /// Comma-separated values: the series; with --maps the maps
    Csv,
    /// NumPy archive: series and maps as arrays
    Npz,
    /// ParaView: maps on the cells of ring and pin, as a time series
    Vtk,
}

#[cfg(test)]
mod tests;
