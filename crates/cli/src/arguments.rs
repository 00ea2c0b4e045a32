//! The command line.

mod accuracy;
mod new;
mod reading;
mod run;
mod surface;
mod sweep;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use plateau_io::text::{odd_character, shown_on_one_line};
use plateau_io::units::{self, Dimension};

use crate::failure::Failure;
use crate::version;

pub use accuracy::AccuracyArguments;
pub use new::NewArguments;
pub use reading::{ReadArguments, as_options};
pub use run::{
    CheckArguments, HandedArguments, RepairArguments, RunArguments, SceneArguments, SummaryArguments, VerifyArguments,
    WatchArguments,
};
pub use surface::{SurfaceArguments, SurfaceWord};
pub use sweep::{CollectArguments, PlanArguments, SlurmArguments, SweepCommand, SweepRunArguments};

/// How a pin of friction material and a rough, coated brake disc wear into each other.
#[derive(Debug, Parser)]
#[command(name = "plateau", version = version::WITH_REVISION, max_term_width = 100, arg_required_else_help = true)]
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
pub fn refuse_odd_characters(arguments: impl Iterator<Item = OsString>) -> Result<(), Failure> {
    let mut is_value = false;
    for argument in arguments.skip(1) {
        let text = argument.to_string_lossy();
        let is_set = is_value || text.starts_with("--set=");
        is_value = text == "--set";
        let text = if is_set { text.replace(['\n', '\t'], " ") } else { text.into_owned() };
        if let Some(found) = odd_character(&text) {
            return Err(Failure::input(format!(
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
    #[command(disable_help_flag = true)]
    Plot(HandedArguments),
    /// Make one HTML page of a run, or of several to compare: the answer, figures, tables
    #[command(disable_help_flag = true)]
    Report(HandedArguments),
    /// Follow a run in the terminal: state, progress, contact area
    #[command(after_help = "Examples:\n  plateau run data/scenes/quick.toml -o quick.h5\n  plateau watch quick.h5")]
    Watch(WatchArguments),
    /// Write a run file for other programs: CSV, Excel, NumPy, netCDF, ParaView
    #[command(disable_help_flag = true)]
    Export(HandedArguments),
    /// Measure how exact a scene's runs are against the time they take
    #[command(after_help = "Example:\n  plateau accuracy data/scenes/quick.toml --budget 20s -o quick-accuracy")]
    Accuracy(AccuracyArguments),
    /// Make many runs of a scene with other values, and tell what these values do
    #[command(subcommand, after_help = "Example:\n  plateau sweep plan data/studies/published/factors.toml")]
    Sweep(SweepCommand),
    /// Find the values of keys with which runs give what was measured
    #[command(disable_help_flag = true)]
    Fit(HandedArguments),
    /// Tell how surely scenes differ, by runs with the same seeds
    #[command(disable_help_flag = true)]
    Compare(HandedArguments),
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
    /// Print what the Python package asks of a run file, as JSON
    #[command(hide = true)]
    Summary(SummaryArguments),
    /// Print the JSON Schema of scenes, with which editors complete and check them
    #[command(
        after_help = "Example:\n  plateau schema\n\nFor an editor: plateau schema > scene.schema.json; see docs/scenes.md."
    )]
    Schema,
    /// Print what lets a shell complete commands, options and files on the Tab key
    #[command(after_help = "Example:\n  plateau completions bash\n\n\
                      Once for all: plateau completions bash > ~/.local/share/bash-completion/completions/plateau\n\
                      For zsh, fish and others see docs/install.md.")]
    Completions(CompletionsArguments),
    /// Print a manual page, or write all of them
    #[command(after_help = "Example:\n  plateau man run\n\n\
                      To read it: plateau man run | man -l -")]
    Man(ManArguments),
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

/// A quantity of this dimension, SI.
fn quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    units::parse(text.trim(), dimension)
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

/// A finite length, m.
fn length(text: &str) -> Result<f64, String> {
    let length = quantity(text, Dimension::Length)?;
    if length.is_finite() { Ok(length) } else { Err("expected a finite length".to_owned()) }
}

/// The text, if it is a quantity of this dimension above 0.
fn positive(text: &str, dimension: Dimension) -> Result<String, String> {
    let value = units::parse(text, dimension)?;
    if value > 0.0 && value.is_finite() { Ok(text.to_owned()) } else { Err("expected more than 0".to_owned()) }
}

#[cfg(test)]
#[path = "../tests/unit/arguments.rs"]
mod tests;

#[cfg(test)]
#[path = "../tests/unit/arguments/quantity.rs"]
mod quantity_tests;
