//! The command lines of `plateau sweep predict`, `optimize` and `import`: what the results of a study answer.

use std::path::PathBuf;

use clap::Args;

use super::cores::CoresArguments;
use super::model::ModelArguments;

/// Arguments of `plateau sweep predict`.
#[derive(Debug, Args)]
#[command(mut_args(CoresArguments::for_confirming))]
pub struct PredictArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Set a factor (its name or its key), such as load="7 N"; may be repeated. Factors that are not given are in the middle of
    /// their range, or at their first level
    #[arg(long, value_name = "FACTOR=VALUE", value_parser = assignment)]
    pub at: Vec<String>,
    /// Predict at so many values of each range and at all levels, but for factors of --at
    #[arg(long, value_name = "N", allow_hyphen_values = true, requires = "output", conflicts_with_all = ["points", "confirm"],
          value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub grid: Option<u32>,
    /// Predict at the points of a table in CSV: a column for each factor, with units in brackets as in results.csv
    #[arg(long, value_name = "FILE", requires = "output")]
    pub points: Option<PathBuf>,
    /// Write the predictions as a table in CSV
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replace that file if it exists
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Predict beyond the runs of the study, too
    #[arg(long)]
    pub extrapolate: bool,
    /// Make runs at the point, or at all points of the table, with all seeds of the study, and compare
    #[arg(long)]
    pub confirm: bool,
    #[command(flatten)]
    pub cores: CoresArguments,
    #[command(flatten)]
    pub fit: ModelArguments,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `plateau sweep optimize`.
#[derive(Debug, Args)]
#[command(mut_args(CoresArguments::for_confirming))]
pub struct OptimizeArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Make a response as large as can be; with the values at which it is worth nothing and everything, such as
    /// "contact area=1 mm2..2 mm2", else those of the runs. May be repeated, as all that follows
    #[arg(long, value_name = "RESPONSE")]
    pub maximize: Vec<String>,
    /// Make a response as small as can be
    #[arg(long, value_name = "RESPONSE")]
    pub minimize: Vec<String>,
    /// Bring a response to a value, such as "filled=0.7"; with the values at which it is worth nothing, "filled=0.5..0.7..0.8"
    #[arg(long, value_name = "RESPONSE=VALUE")]
    pub target: Vec<String>,
    /// Keep a response below or above a value, such as "filled<=0.9"
    #[arg(long, value_name = "RESPONSE<=VALUE")]
    pub limit: Vec<String>,
    /// What has to keep the limits: the predicted mean, which half of all runs miss where it lies on a limit; its interval; or the
    /// interval of one more run
    #[arg(long, value_enum, default_value = "mean")]
    pub limit_on: LimitOn,
    /// Hold a factor at a value, such as load="8 N"
    #[arg(long, value_name = "FACTOR=VALUE", value_parser = assignment)]
    pub hold: Vec<String>,
    /// How much a goal counts in the mean of all, such as "contact area=2"; 1 unless given
    #[arg(long, value_name = "RESPONSE=NUMBER")]
    pub importance: Vec<String>,
    /// Power of a goal's desirability: above 1 a response has to come near to what is best; 1 unless given
    #[arg(long, value_name = "RESPONSE=NUMBER")]
    pub weight: Vec<String>,
    /// Draw the desirability over two factors, by their names with a comma between; the two that matter most unless given
    #[arg(long, value_name = "FACTOR,FACTOR")]
    pub contour: Option<String>,
    /// Make runs at the optimum, with all seeds of the study, and compare
    #[arg(long)]
    pub confirm: bool,
    #[command(flatten)]
    pub cores: CoresArguments,
    #[command(flatten)]
    pub fit: ModelArguments,
    /// Folder for figures and table; "optimum" in the study's own unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace the files of an earlier call, and remove those of them that this call does not write
    #[arg(long)]
    pub force: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// What has to keep a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum LimitOn {
    /// The predicted mean
    Mean,
    /// The interval of the mean of many runs
    Means,
    /// The interval of one more run
    Runs,
}

/// Arguments of `plateau sweep import`.
#[derive(Debug, Args)]
pub struct ImportArguments {
    /// Study file (TOML)
    pub study: PathBuf,
    /// Table (CSV) with a column for each factor and for each response with imported = true, units in the head as in results.csv
    pub table: PathBuf,
    /// Replace values that were imported before
    #[arg(long)]
    pub force: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// A name and a value with `=` between them. Which `=` parts them is known when names are: one may have `=` in it.
fn assignment(text: &str) -> Result<String, &'static str> {
    let is_whole = |(name, value): (&str, &str)| !name.trim().is_empty() && !value.trim().is_empty();
    match text.split_once('=').is_some_and(is_whole) {
        true => Ok(text.to_owned()),
        false => Err("expected a factor and its value, such as load=\"7 N\""),
    }
}
