//! The command line of `plateau accuracy`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use plateau_io::units::Dimension;
use plateau_run::accuracy::Ladder;

use super::quantity::quantity;
use super::run::{ExecutionArguments, SceneArguments};

/// Arguments of `plateau accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Wall time that all runs together may take; the reference is as fine as half of it allows, and finer than the scene
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, default_value = "10min", value_parser = budget)]
    pub budget: f64,
    /// Ladders that are climbed, with commas between; all but mesh and perturbation unless given
    #[arg(long = "ladder", value_parser = ladder(), value_name = "NAME", value_delimiter = ',')]
    pub ladders: Vec<Ladder>,
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

/// What the runs of a ladder differ in.
fn meaning(ladder: Ladder) -> &'static str {
    match ladder {
        Ladder::TimeAcceleration => "Revolutions that a simulated one stands for",
        Ladder::Tolerance => "Accelerations that the run chooses itself, by the error that it may make",
        Ladder::Mesh => "Coarser meshes, with the initial surfaces averaged",
        Ladder::Integrator => "The other integrator of wear",
        Ladder::Perturbation => {
            "The reference anew with initial heights that differ a little: how much of the errors is chance"
        }
    }
}

/// A value of `--budget`, s.
fn budget(text: &str) -> Result<f64, String> {
    let time = quantity(text, Dimension::Time)?;
    if time > 0.0 && time.is_finite() { Ok(time) } else { Err("expected more than 0 s".to_owned()) }
}
