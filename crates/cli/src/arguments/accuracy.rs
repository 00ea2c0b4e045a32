//! The command line of `plateau accuracy`.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use plateau_io::units::{self, Dimension};
use plateau_run::accuracy::Ladder;

use super::{ExecutionArguments, SceneArguments};

/// Arguments of `plateau accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Wall time that all runs together may take; the reference is as fine as half of it allows, and finer than the scene
    #[arg(long, value_name = "TIME", default_value = "10min", value_parser = budget)]
    pub budget: f64,
    /// Ladders that are climbed, with commas between; all but mesh and perturbation unless given
    #[arg(long = "ladder", value_enum, value_name = "NAME", value_delimiter = ',')]
    pub ladders: Vec<LadderArgument>,
    /// Run file of the same scene, numerics and output apart, that is the reference instead of a run made here; finer than
    /// the scene
    #[arg(long, value_name = "RUN")]
    pub reference: Option<PathBuf>,
    /// Folder for accuracy.csv, .json, .png and .svg, made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "accuracy")]
    pub output: PathBuf,
    /// Replace these files if they exist
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub execution: ExecutionArguments,
}

/// A value of `--ladder`.
#[derive(Debug, Clone, Copy)]
pub struct LadderArgument(pub Ladder);

impl ValueEnum for LadderArgument {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [LadderArgument; 5] = [
            LadderArgument(Ladder::ALL[0]),
            LadderArgument(Ladder::ALL[1]),
            LadderArgument(Ladder::ALL[2]),
            LadderArgument(Ladder::ALL[3]),
            LadderArgument(Ladder::ALL[4]),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self.0 {
            Ladder::TimeAcceleration => "Revolutions that a simulated one stands for",
            Ladder::Tolerance => "Accelerations that the run chooses itself, by the error that it may make",
            Ladder::Mesh => "Coarser meshes, with the initial surfaces averaged",
            Ladder::Integrator => "The other integrator of wear",
            Ladder::Perturbation => {
                "The reference anew with initial heights that differ a little: how much of the errors is chance"
            }
        };
        Some(PossibleValue::new(self.0.name()).help(help))
    }
}

/// A value of `--budget`, s.
fn budget(text: &str) -> Result<f64, String> {
    let time = units::parse(text.trim(), Dimension::Time).map_err(|error| error.to_string())?;
    if time > 0.0 && time.is_finite() { Ok(time) } else { Err("expected more than 0 s".to_owned()) }
}
