//! The command line; that of studies and of surfaces in files of their own.

mod surface;
mod sweep;

use std::ffi::OsString;
use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::simulation::{Engine, Execution};
use plateau_io::scene::schema::choices;
use plateau_io::text::{odd_character, shown_on_one_line};
use plateau_io::units::{self, Dimension};
use plateau_run::accuracy::{COMPARED, Ladder};
use plateau_run::execution::cores;

use crate::failure::Failure;
use crate::program;

pub use surface::{ReadArguments, SurfaceArguments, SurfaceWord, as_options};
pub use sweep::{
    CollectArguments, PlanArguments, SlurmArguments, SweepCommand, SweepRunArguments, SweepSceneArguments,
};

/// How a pin of friction material and a rough, coated brake disc wear into each other.
#[derive(Debug, Parser)]
#[command(name = "plateau", version = program::WITH_REVISION, max_term_width = 100, arg_required_else_help = true)]
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
    /// Make the cycle and the scene of a front brake from a drive of a vehicle
    #[command(disable_help_flag = true)]
    Cycle(HandedArguments),
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

#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}

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

/// A time of the run, s.
fn run_time(text: &str) -> Result<f64, String> {
    let time = units::parse(text, Dimension::Time)?;
    if time >= 0.0 {
        Ok(time)
    } else {
        Err(format!("{text} is before the start of a run, expected a time such as \"100 s\""))
    }
}

/// A length, m.
fn length(text: &str) -> Result<f64, String> {
    units::parse(text, Dimension::Length)
}

/// Gives a text if it is a quantity of this dimension above 0.
fn positive(dimension: Dimension) -> impl Fn(&str) -> Result<String, String> + Clone {
    move |text| {
        let value = units::parse(text, dimension)?;
        if value > 0.0 { Ok(text.to_owned()) } else { Err("expected more than 0".to_owned()) }
    }
}

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
    /// What each of several workers has: sectors, bands (of rows) or auto; overrides the scene
    #[arg(long, value_name = "KIND", value_parser = PossibleValuesParser::new(choices::DECOMPOSITION.map(|(word, _)| word)))]
    pub decomposition: Option<String>,
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
    #[arg(long, value_name = "NAME", value_parser = engine(), default_value_t)]
    pub engine: Engine,
    /// Instruction set of the kernels, for tests; the widest that the processor has unless given
    #[arg(long, value_name = "NAME", value_parser = instruction_set)]
    pub isa: Option<InstructionSet>,
    /// Keep each worker on a core of its own, as far as there are enough; a single worker is left free
    #[arg(long)]
    pub pin: bool,
}

impl ExecutionArguments {
    /// As the library takes them.
    pub fn execution(&self) -> Execution {
        let usual = Execution::default();
        Execution { engine: self.engine, instructions: self.isa.unwrap_or(usual.instructions), pin: self.pin, ..usual }
    }
}

/// A value of `--engine`.
fn engine() -> impl TypedValueParser<Value = Engine> {
    let values = [(Engine::Fast, "On any number of workers"), (Engine::Plain, "On one worker")];
    let named = |name: String| if name == Engine::Plain.name() { Engine::Plain } else { Engine::Fast };
    PossibleValuesParser::new(values.map(|(engine, help)| PossibleValue::new(engine.name()).help(help))).map(named)
}

/// A value of `--isa`.
fn instruction_set(text: &str) -> Result<InstructionSet, String> {
    let available = || InstructionSet::available().map(InstructionSet::name);
    let found = InstructionSet::available().find(|instructions| instructions.name() == text);
    found.ok_or_else(|| format!("this processor has {}", available().collect::<Vec<_>>().join(", ")))
}

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

#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Run files
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Print one JSON document instead of text: an array with an object for each file
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct RepairArguments {
    /// Run files
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Repair also what another machine has written a moment ago, or what another user may still be writing
    #[arg(long)]
    pub force: bool,
}

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

/// Arguments of `plateau new`. Values have a unit, as in a scene.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// Scene file to write
    pub scene: PathBuf,
    /// Measured surface of the disc, told by its content; of a profile say --profile-lay
    #[arg(long, value_name = "FILE")]
    pub disc: Option<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Micrograph of the pin's face, its right side in the direction of sliding, its top outward: PNG, TIFF, JPEG
    #[arg(long, value_name = "FILE")]
    pub micrograph: Option<PathBuf>,
    /// Distance of the micrograph's pixels; what the file states unless given
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, requires = "micrograph", value_parser = positive(Dimension::Length))]
    pub pixel: Option<String>,
    /// Width of the pin, along the radius
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "4 mm", value_parser = positive(Dimension::Length))]
    pub pin_width: String,
    /// Length of the pin, along sliding
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "8 mm", value_parser = positive(Dimension::Length))]
    pub pin_length: String,
    /// A round pin of this diameter
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, conflicts_with_all = ["pin_width", "pin_length"],
          value_parser = positive(Dimension::Length))]
    pub diameter: Option<String>,
    /// Radius at which the middle of the pin slides
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "22 mm", value_parser = positive(Dimension::Length))]
    pub radius: String,
    /// Force on the pin
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, default_value = "47 N", value_parser = positive(Dimension::Force))]
    pub load: String,
    /// Rotational speed of the disc, or the sliding speed ("3 m/s") at --radius
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, default_value = "850 rpm", value_parser = speed)]
    pub speed: String,
    /// Time to simulate
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, default_value = "3000 s", value_parser = positive(Dimension::Time))]
    pub duration: String,
    /// Replace the scene file if it exists
    #[arg(long)]
    pub force: bool,
}

impl NewArguments {
    /// The key of the scene that the speed is given by.
    pub fn speed_key(&self) -> &'static str {
        if is_sliding_speed(&self.speed) { "sliding_speed" } else { "rotational_speed" }
    }
}

fn speed(text: &str) -> Result<String, String> {
    let dimension = if is_sliding_speed(text) { Dimension::Speed } else { Dimension::RotationalSpeed };
    positive(dimension)(text).map_err(|error| match dimension {
        Dimension::Speed => error,
        _ => format!("{error}, or a sliding speed such as \"3 m/s\""),
    })
}

/// Whether a speed is a length over a time.
fn is_sliding_speed(text: &str) -> bool {
    units::parse(text, Dimension::Speed).is_ok()
}

#[derive(Debug, Args)]
pub struct AccuracyArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Wall time that all runs together may take; the reference is as fine as half of it allows, and finer than the scene
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, default_value = "10min", value_parser = budget)]
    pub budget: f64,
    /// Ladders of runs, with commas between; all but perturbation unless given
    #[arg(long = "ladder", value_parser = ladder(), value_name = "NAME", value_delimiter = ',')]
    pub ladders: Vec<Ladder>,
    /// Quantities that the advice is for, with commas between; all unless given
    #[arg(long = "quantity", value_parser = quantities(), value_name = "NAME", value_delimiter = ',')]
    pub quantities: Vec<&'static str>,
    /// Error for which a time acceleration is advised, as a part of the quantity
    #[arg(long, value_name = "PART", allow_hyphen_values = true, default_value = "0.01", value_parser = tolerance)]
    pub tolerance: f64,
    /// Run file of the same scene, numerics and output apart, that is the reference instead of a run made here; finer than
    /// the scene
    #[arg(long, value_name = "RUN")]
    pub reference: Option<PathBuf>,
    /// Folder for accuracy.csv, .json, .png, .svg and .pdf, made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "accuracy")]
    pub output: PathBuf,
    /// Replace these files if they exist
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// A value of `--ladder`.
fn ladder() -> impl TypedValueParser<Value = Ladder> {
    let value = |ladder: Ladder| PossibleValue::new(ladder.name()).help(meaning(ladder));
    let named = |name: String| Ladder::ALL.into_iter().find(|ladder| ladder.name() == name).ok_or("no such ladder");
    PossibleValuesParser::new(Ladder::ALL.map(value)).try_map(named)
}

/// Difference between the runs of a ladder.
fn meaning(ladder: Ladder) -> &'static str {
    match ladder {
        Ladder::TimeAcceleration => "Revolutions that a simulated one stands for",
        Ladder::Mesh => "The same with cells half and twice as long, in a scene with a transport length",
        Ladder::Tolerance => "Accelerations that the run chooses itself, by the error that it may make",
        Ladder::Perturbation => {
            "The reference anew with initial heights that differ a little: how much of the errors is chance"
        }
    }
}

/// A value of `--quantity`.
fn quantities() -> impl TypedValueParser<Value = &'static str> {
    let named =
        |name: String| COMPARED.iter().find(|one| one.name == name).map(|one| one.name).ok_or("no such quantity");
    PossibleValuesParser::new(COMPARED.map(|one| one.name)).try_map(named)
}

/// A value of `--tolerance`.
fn tolerance(text: &str) -> Result<f64, &'static str> {
    text.parse()
        .ok()
        .filter(|part| (f64::MIN_POSITIVE..1.0).contains(part))
        .ok_or("expected a number between 0 and 1, such as 0.01")
}

/// A value of `--budget`, s.
fn budget(text: &str) -> Result<f64, String> {
    let time = units::parse(text, Dimension::Time)?;
    if time > 0.0 { Ok(time) } else { Err("expected more than 0 s".to_owned()) }
}

#[cfg(test)]
#[path = "../tests/unit/arguments.rs"]
mod tests;
