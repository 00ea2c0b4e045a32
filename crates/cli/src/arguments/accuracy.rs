//! The command line of `plateau accuracy`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use plateau_io::units::Dimension;
use plateau_run::accuracy::{COMPARED, Ladder};

use super::quantity;
use super::run::{ExecutionArguments, SceneArguments};

/// Arguments of `plateau accuracy`.
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
    let time = quantity(text, Dimension::Time)?;
    if time > 0.0 && time.is_finite() { Ok(time) } else { Err("expected more than 0 s".to_owned()) }
}
